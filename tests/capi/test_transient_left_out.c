/* A build without PLM_WITH_TRANSIENT: no transient can be made, so every handle of one is refused. */
#include "chain.h"
#include "check.h"

static void it_says_which_option(void **state) {
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    plm_transient *t = NULL;
    char text[400];
    int32_t n = 0;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    assert_int_equal(chain_built(ctx, 0, &model), PLM_OK);
    assert_true(refused(ctx, plm_transient_create(model, NULL, &t), PLM_ERR_NOT_BUILT, "plm_transient_create",
                        "", -1, "PLM_WITH_TRANSIENT"));
    assert_null(t);
    assert_int_equal(plm_transient_create(NULL, NULL, &t), PLM_ERR_HANDLE);
    assert_int_equal(plm_transient_run((plm_transient *)(void *)model), PLM_ERR_HANDLE);
    assert_int_equal(plm_key_count(PLM_KIND_TRANSIENT, &n),
                     PLM_OK); /* the table of keys is the same in all builds */
    assert_true(n > 3);
    assert_int_equal(plm_build_info(400, text, NULL), PLM_OK);
    assert_null(strstr(text, "transient"));
    plm_context_destroy(&ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_says_which_option)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
