/* The key table: every option can be set and read, bounds hold, the nearest key is proposed. */
#include "check.h"

static plm_context *ctx;
static plm_model *model;
static plm_sampler *sampler;
static plm_basis *basis;
static plm_hbm *hbm;
static plm_transient *motion; /* these two are NULL when left out of the build */
static plm_study *study;

static int set_up(void **state) {
    plm_status s;
    (void)state;
    s = plm_context_create(PLM_API_VERSION, &ctx) || plm_model_create(ctx, 3, &model) ||
        plm_sampler_create(model, &sampler) || plm_basis_create(model, &basis) || plm_hbm_create(basis, &hbm);
    if (s) return s;
    s = plm_transient_create(model, basis, &motion);
    if (s && s != PLM_ERR_NOT_BUILT) return s;
    s = plm_study_create(model, &study);
    return s && s != PLM_ERR_NOT_BUILT;
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

static plm_status set_int(int32_t kind, const char *key, int64_t v) {
    return kind == PLM_KIND_MODEL       ? plm_model_set_int(model, key, v)
           : kind == PLM_KIND_SAMPLER   ? plm_sampler_set_int(sampler, key, v)
           : kind == PLM_KIND_BASIS     ? plm_basis_set_int(basis, key, v)
           : kind == PLM_KIND_TRANSIENT ? plm_transient_set_int(motion, key, v)
           : kind == PLM_KIND_STUDY     ? plm_study_set_int(study, key, v)
                                        : plm_hbm_set_int(hbm, key, v);
}
static plm_status set_double(int32_t kind, const char *key, double v) {
    return kind == PLM_KIND_MODEL       ? plm_model_set_double(model, key, v)
           : kind == PLM_KIND_SAMPLER   ? plm_sampler_set_double(sampler, key, v)
           : kind == PLM_KIND_BASIS     ? plm_basis_set_double(basis, key, v)
           : kind == PLM_KIND_TRANSIENT ? plm_transient_set_double(motion, key, v)
           : kind == PLM_KIND_STUDY     ? plm_study_set_double(study, key, v)
                                        : plm_hbm_set_double(hbm, key, v);
}
static plm_status set_string(int32_t kind, const char *key, const char *v) {
    return kind == PLM_KIND_MODEL       ? plm_model_set_string(model, key, v)
           : kind == PLM_KIND_SAMPLER   ? plm_sampler_set_string(sampler, key, v)
           : kind == PLM_KIND_BASIS     ? plm_basis_set_string(basis, key, v)
           : kind == PLM_KIND_TRANSIENT ? plm_transient_set_string(motion, key, v)
           : kind == PLM_KIND_STUDY     ? plm_study_set_string(study, key, v)
                                        : plm_hbm_set_string(hbm, key, v);
}
static plm_status get_int(int32_t kind, const char *key, int64_t *v) {
    return kind == PLM_KIND_MODEL       ? plm_model_get_int(model, key, v)
           : kind == PLM_KIND_SAMPLER   ? plm_sampler_get_int(sampler, key, v)
           : kind == PLM_KIND_BASIS     ? plm_basis_get_int(basis, key, v)
           : kind == PLM_KIND_TRANSIENT ? plm_transient_get_int(motion, key, v)
           : kind == PLM_KIND_STUDY     ? plm_study_get_int(study, key, v)
                                        : plm_hbm_get_int(hbm, key, v);
}
static plm_status get_double(int32_t kind, const char *key, double *v) {
    return kind == PLM_KIND_MODEL       ? plm_model_get_double(model, key, v)
           : kind == PLM_KIND_SAMPLER   ? plm_sampler_get_double(sampler, key, v)
           : kind == PLM_KIND_BASIS     ? plm_basis_get_double(basis, key, v)
           : kind == PLM_KIND_TRANSIENT ? plm_transient_get_double(motion, key, v)
           : kind == PLM_KIND_STUDY     ? plm_study_get_double(study, key, v)
                                        : plm_hbm_get_double(hbm, key, v);
}
static plm_status get_string(int32_t kind, const char *key, int64_t n, char *v) {
    return kind == PLM_KIND_MODEL       ? plm_model_get_string(model, key, n, v, NULL)
           : kind == PLM_KIND_SAMPLER   ? plm_sampler_get_string(sampler, key, n, v, NULL)
           : kind == PLM_KIND_BASIS     ? plm_basis_get_string(basis, key, n, v, NULL)
           : kind == PLM_KIND_TRANSIENT ? plm_transient_get_string(motion, key, n, v, NULL)
           : kind == PLM_KIND_STUDY     ? plm_study_get_string(study, key, n, v, NULL)
                                        : plm_hbm_get_string(hbm, key, n, v, NULL);
}

/* default readable, both bounds settable and read back, beyond them refused */
static int int_option(int32_t kind, const char *key, double low, double high) {
    int64_t v = -1;
    return get_int(kind, key, &v) == 0 && (double)v >= low && (double)v <= high &&
           set_int(kind, key, (int64_t)low) == 0 && get_int(kind, key, &v) == 0 && (double)v == low &&
           set_int(kind, key, (int64_t)high) == 0 && get_int(kind, key, &v) == 0 && (double)v == high &&
           set_int(kind, key, (int64_t)high + 1) == PLM_ERR_ARGUMENT &&
           set_int(kind, key, (int64_t)low - 1) == PLM_ERR_ARGUMENT && get_int(kind, key, &v) == 0 &&
           (double)v == high && set_string(kind, key, "x") == PLM_ERR_ARGUMENT &&
           set_double(kind, key, 1) == PLM_ERR_ARGUMENT;
}
static int double_option(int32_t kind, const char *key, double low, double high) {
    double v = -1;
    int64_t i = 0;
    return get_double(kind, key, &v) == 0 && v >= low && v <= high && set_double(kind, key, low) == 0 &&
           get_double(kind, key, &v) == 0 && v == low && set_double(kind, key, high) == 0 &&
           get_double(kind, key, &v) == 0 && v == high &&
           set_double(kind, key, 1.001 * high) == PLM_ERR_ARGUMENT &&
           set_double(kind, key, low - 0.001 * high) == PLM_ERR_ARGUMENT &&
           set_double(kind, key, NAN) == PLM_ERR_ARGUMENT &&
           set_double(kind, key, INFINITY) == PLM_ERR_ARGUMENT && get_double(kind, key, &v) == 0 &&
           v == high && get_int(kind, key, &i) == PLM_ERR_ARGUMENT;
}
static int choice_option(int32_t kind, const char *key, char *choices) {
    char now[64] = "", *word;
    if (get_string(kind, key, 64, now) || !strstr(choices, now)) return 0;
    for (word = strtok(choices, ","); word; word = strtok(NULL, ","))
        if (set_string(kind, key, word) || get_string(kind, key, 64, now) || strcmp(now, word) != 0) return 0;
    return set_string(kind, key, "nonsense") == PLM_ERR_ARGUMENT &&
           set_string(kind, key, NULL) == PLM_ERR_ARGUMENT && set_int(kind, key, 1) == PLM_ERR_ARGUMENT;
}

static int option_works(int32_t kind, int32_t index) {
    char name[64], choices[200], standard[64];
    int32_t type = 0, is_option = -1;
    double low = 0, high = 0;
    int ok;
    if (plm_key_info(kind, index, &type, &is_option, &low, &high) ||
        plm_key_text(kind, index, PLM_KEY_NAME, 64, name, NULL) ||
        plm_key_text(kind, index, PLM_KEY_DEFAULT, 64, standard, NULL) ||
        plm_key_text(kind, index, PLM_KEY_CHOICES, 200, choices, NULL))
        return 0;
    if (!is_option) {
        ok = standard[0] == 0 && choices[0] == 0 &&
             (kind == PLM_KIND_BRANCH || set_int(kind, name, 1) == PLM_ERR_ARGUMENT);
    } else {
        ok = standard[0] != 0 && kind != PLM_KIND_BRANCH &&
             (type == PLM_TYPE_INT      ? int_option(kind, name, low, high)
              : type == PLM_TYPE_DOUBLE ? double_option(kind, name, low, high)
                                        : choice_option(kind, name, choices));
    }
    if (!ok) printf("    kind %d, key %s\n", (int)kind, name);
    return ok;
}

static void every_option_can_be_set_and_read(void **state) {
    int32_t kind, index, n = 0;
    int ok = 1;
    (void)state;
    for (kind = PLM_KIND_MODEL; kind <= PLM_KIND_STUDY; ++kind) {
        assert_int_equal(plm_key_count(kind, &n), PLM_OK);
        assert_true(n > 3);
        if (kind == PLM_KIND_TRANSIENT && !motion) continue;
        if (kind == PLM_KIND_STUDY && !study) continue;
        for (index = 0; index < n; ++index) ok &= option_works(kind, index);
    }
    assert_true(ok);
}

static void keys_are_unique_and_described(void **state) {
    char name[100][64], text[200];
    int32_t kind, i, j, n = 0;
    (void)state;
    for (kind = PLM_KIND_MODEL; kind <= PLM_KIND_STUDY; ++kind) {
        assert_int_equal(plm_key_count(kind, &n), PLM_OK);
        assert_true(n <= 100);
        for (i = 0; i < n; ++i) {
            assert_int_equal(plm_key_text(kind, i, PLM_KEY_NAME, 64, name[i], NULL), PLM_OK);
            assert_int_equal(plm_key_text(kind, i, PLM_KEY_DESCRIPTION, 200, text, NULL), PLM_OK);
            assert_true(strlen(text) > 5);
            for (j = 0; j < i; ++j) assert_string_not_equal(name[i], name[j]);
        }
    }
}

static void introspection_checks_its_arguments(void **state) {
    int32_t n = 7, type = 7, is_option = 7;
    double low = 7, high = 7;
    (void)state;
    assert_int_equal(plm_key_count(0, &n), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_key_count(8, &n), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_key_count(1, NULL), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_key_info(1, -1, &type, &is_option, &low, &high), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_key_info(1, 1000, &type, &is_option, &low, &high), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_key_info(1, 0, &type, NULL, &low, &high), PLM_ERR_ARGUMENT);
    assert_int_equal(plm_key_text(1, 0, 9, 0, NULL, NULL), PLM_ERR_ARGUMENT);
    assert_true(n == 7 && type == 7 && is_option == 7 && low == 7 && high == 7);
}

static void nearest_key_is_proposed(void **state) {
    int64_t v = 3;
    double d;
    (void)state;
    assert_true(refused(ctx, plm_sampler_set_int(sampler, "n_sample", 3), PLM_ERR_KEY, "plm_sampler_set_int",
                        "key", -1, "did you mean \"n_samples\"?"));
    assert_true(refused(ctx, plm_hbm_set_double(hbm, "frequency_min", 3), PLM_ERR_KEY, "plm_hbm_set_double",
                        "key", -1, "frequency_min_hz"));
    assert_true(refused(ctx, plm_basis_get_int(basis, "sise", &v), PLM_ERR_KEY, "plm_basis_get_int", "key",
                        -1, "\"size\""));
    assert_true(refused(ctx, plm_model_get_double(model, NULL, &d), PLM_ERR_ARGUMENT, "plm_model_get_double",
                        "key", -1, "NULL"));
    assert_int_equal(v, 3);
}

/* with one letter wrong, the first or one in the middle, that one is the nearest of all keys */
static int proposes(int32_t kind, char *name, size_t at) {
    char wanted[80], text[500] = "", letter = name[at];
    int64_t v = 0;
    int ok;
    sprintf(wanted, "did you mean \"%s\"?", name);
    name[at] = '#';
    ok = get_int(kind, name, &v) == PLM_ERR_KEY &&
         !plm_context_get_error_text(ctx, sizeof text, text, NULL) && strstr(text, wanted);
    if (!ok) printf("    %s: %s\n", name, text);
    name[at] = letter;
    return ok;
}
static void every_key_is_proposed_for_one_wrong_letter(void **state) {
    char name[64];
    int32_t kind, index, n = 0;
    int ok = 1;
    (void)state;
    for (kind = PLM_KIND_MODEL; kind <= PLM_KIND_STUDY; ++kind) {
        if (kind == PLM_KIND_BRANCH || (kind == PLM_KIND_TRANSIENT && !motion) ||
            (kind == PLM_KIND_STUDY && !study))
            continue;
        assert_int_equal(plm_key_count(kind, &n), PLM_OK);
        for (index = 0; index < n; ++index) {
            assert_int_equal(plm_key_text(kind, index, PLM_KEY_NAME, 64, name, NULL), PLM_OK);
            ok &= proposes(kind, name, 0) && proposes(kind, name, strlen(name) / 2);
        }
    }
    assert_true(ok);
}

static void refusals_say_why(void **state) {
    int64_t n = 0;
    (void)state;
    assert_true(refused(ctx, plm_hbm_set_int(hbm, "n_harmonics", -1), PLM_ERR_ARGUMENT, "plm_hbm_set_int",
                        "value", -1, "\"n_harmonics\" is -1; it must lie in 0..1000"));
    assert_true(refused(ctx, plm_hbm_set_string(hbm, "aft", "fft"), PLM_ERR_ARGUMENT, "plm_hbm_set_string",
                        "value", -1, "event,sampled"));
    assert_true(refused(ctx, plm_basis_set_int(basis, "size", 3), PLM_ERR_ARGUMENT, "plm_basis_set_int",
                        "key", -1, "is a result"));
    assert_true(refused(ctx, plm_hbm_set_int(hbm, "aft", 1), PLM_ERR_ARGUMENT, "plm_hbm_set_int", "key", -1,
                        "use the set_string function"));
    assert_true(refused(ctx, plm_sampler_get_array(sampler, "sweep_samples", 0, NULL, &n), PLM_ERR_ARGUMENT,
                        "plm_sampler_get_array", "key", -1, "get_int_array"));
    assert_true(refused(ctx, plm_basis_get_int_array(basis, "lambda", 0, NULL, &n), PLM_ERR_ARGUMENT,
                        "plm_basis_get_int_array", "key", -1, "get_array"));
    assert_true(refused(ctx, plm_hbm_get_int(hbm, "n_harmonics", NULL), PLM_ERR_ARGUMENT, "plm_hbm_get_int",
                        "value", -1, "NULL"));
}

static void an_int_is_taken_for_a_double(void **state) {
    double v = 0;
    (void)state;
    assert_int_equal(plm_hbm_set_int(hbm, "force_scale", 3), PLM_OK);
    assert_int_equal(plm_hbm_get_double(hbm, "force_scale", &v), PLM_OK);
    assert_true(v == 3);
    assert_int_equal(plm_hbm_get_double(hbm, "n_harmonics", &v), PLM_OK);
    assert_true(v == 0);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(every_option_can_be_set_and_read),
        TEST(keys_are_unique_and_described),
        TEST(introspection_checks_its_arguments),
        TEST(nearest_key_is_proposed),
        TEST(refusals_say_why),
        TEST(an_int_is_taken_for_a_double),
        TEST(every_key_is_proposed_for_one_wrong_letter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
