#include "study_case.h"

plm_status study_case_make(plm_context *ctx, study_case *c) {
    return study_case_with_gap(ctx, 5, c);
}

plm_status study_case_with_gap(plm_context *ctx, double gap, study_case *c) {
    const oscillator o = {1, 0.04, 0.3, gap, 1};
    plm_status s = oscillator_built(ctx, &o, 1, &c->model, &c->basis);
    if (!s) s = plm_hbm_create(c->basis, &c->hbm);
    if (!s) s = plm_hbm_set_int(c->hbm, "n_harmonics", 7);
    if (!s) s = plm_hbm_set_double(c->hbm, "frequency_min_hz", 0.12);
    if (!s) s = plm_hbm_set_double(c->hbm, "frequency_max_hz", 0.2);
    if (!s) s = plm_study_create(c->model, &c->study);
    if (!s) s = plm_study_set_output(c->study, 0, PLM_HALF_PEAK_TO_PEAK, 0);
    if (!s) s = plm_study_set_int(c->study, "repeats", 1);
    return s;
}

enum { MOST = 20 };

double study_real(plm_study *study, const char *key, int64_t index) {
    double values[MOST];
    int64_t n = 0;
    if (plm_study_get_array(study, key, MOST, values, &n) || index >= n) return NAN;
    return values[index];
}

int64_t study_int(plm_study *study, const char *key, int64_t index) {
    int64_t values[MOST], n = 0;
    if (plm_study_get_int_array(study, key, MOST, values, &n) || index >= n) return -99;
    return values[index];
}

double study_scalar(plm_study *study, const char *key) {
    double value = NAN;
    return plm_study_get_double(study, key, &value) ? NAN : value;
}
