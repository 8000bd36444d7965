/* A build without PLM_WITH_STUDY: no study can be made, so every handle of one is refused. */
#include "chain.h"
#include "check.h"

static void it_says_which_option(void **state) {
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    plm_study *study = NULL;
    char text[400];
    int32_t n = 0;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    assert_int_equal(chain_built(ctx, 0, &model), PLM_OK);
    assert_true(refused(ctx, plm_study_create(model, &study), PLM_ERR_NOT_BUILT, "plm_study_create", "", -1,
                        "PLM_WITH_STUDY"));
    assert_null(study);
    assert_int_equal(plm_study_create(NULL, &study), PLM_ERR_HANDLE);
    assert_int_equal(plm_study_run((plm_study *)(void *)model), PLM_ERR_HANDLE);
    assert_int_equal(plm_key_count(PLM_KIND_STUDY, &n),
                     PLM_OK); /* the table of keys is the same in all builds */
    assert_true(n > 3);
    assert_int_equal(plm_build_info(400, text, NULL), PLM_OK);
    assert_null(strstr(text, "study"));
    plm_context_destroy(&ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_says_which_option)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
