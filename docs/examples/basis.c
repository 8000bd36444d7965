/* basis.c: the columns a structure is reduced to. */
#include "example.h"
#include <stdio.h>
#include <stdlib.h>

/* [plm_basis_write_to] */
static int32_t to_file(plm_context *ctx, int64_t n, const void *bytes, void *file) {
    (void)ctx;
    return fwrite(bytes, 1, (size_t)n, file) == (size_t)n ? 0 : 1; /* 1: PLM_ERR_CALLBACK, "library_code" 1 */
}
static int keep_in_file(plm_basis *basis, FILE *file) {
    TRY(plm_basis_write_to(basis, to_file, file));
    return fflush(file);
}
/* [plm_basis_write_to] */

/* Kept as bytes, and read again, here in the same program; a host writes them to a file between. */
static int keep(plm_context *ctx, plm_model *model, plm_basis *basis) {
    plm_basis *read = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    double residual;
    /* [plm_basis_write] */
    int64_t size;
    void *bytes;
    TRY(plm_basis_write(basis, 0, NULL, &size)); /* how many? */
    bytes = malloc((size_t)size);
    EXPECT(bytes);
    TRY(plm_basis_write(basis, size, bytes, &size));
    /* [plm_basis_write] */
    FILE *file = tmpfile();
    EXPECT(file && keep_in_file(basis, file) == 0 && ftell(file) == (long)size);
    fclose(file);

    /* [plm_basis_read] */
    TRY(plm_basis_read(ctx, size, bytes, &read)); /* in another process, say */
    free(bytes);
    TRY(plm_hbm_create(read, &hbm));
    EXPECT(plm_hbm_sweep(hbm, &curve) >=
           0); /* PLM_WARNING: not compared with the structure, which is not there */
    /* [plm_basis_read] */
    EXPECT(plm_branch_get_full_residual(curve, 0, &residual) == PLM_ERR_STATE);

    /* [plm_basis_attach] */
    TRY(plm_basis_attach(read, model)); /* now it is */
    TRY(plm_hbm_sweep(hbm, &curve));
    TRY(plm_branch_get_full_residual(curve, 0, &residual));
    /* [plm_basis_attach] */
    EXPECT(residual < 1e-6);
    return 0;
}

static int build(plm_context *ctx, plm_model *model, plm_sampler *sampler) {
    /* [plm_basis_create] [plm_basis_destroy] */
    plm_basis *basis = NULL, *full = NULL;
    TRY(plm_basis_create(model, &basis));
    TRY(plm_basis_destroy(&basis));
    /* [plm_basis_create] [plm_basis_destroy] */
    TRY(plm_basis_create(model, &basis));
    TRY(plm_basis_create(model, &full));

    /* [plm_basis_set_sampler] */
    TRY(plm_basis_set_sampler(basis, sampler)); /* a sampler that has run */
    /* [plm_basis_set_sampler] */

    /* [plm_basis_set_int] [plm_basis_set_double] [plm_basis_set_string] */
    TRY(plm_basis_set_string(basis, "selection", "below"));
    TRY(plm_basis_set_int(basis, "n_harmonics", 7));
    TRY(plm_basis_set_double(basis, "svd_tolerance", 1e-8));
    /* [plm_basis_set_int] [plm_basis_set_double] [plm_basis_set_string] */

    /* [plm_basis_set_parent] */
    TRY(plm_basis_set_string(full, "kind", "full"));
    TRY(plm_basis_set_sampler(full, sampler));
    TRY(plm_basis_build(full));
    TRY(plm_basis_set_parent(basis, full)); /* the modes are then computed in the columns of `full` */
    /* [plm_basis_set_parent] */

    /* [plm_basis_build] [plm_basis_get_string] */
    const plm_status built = plm_basis_build(basis);
    if (built == PLM_WARNING) {
        char warning[300];
        TRY(plm_basis_get_string(basis, "warning", sizeof warning, warning, NULL));
        printf("the basis may have lost the resonance: %s\n", warning);
    }
    /* [plm_basis_build] [plm_basis_get_string] */
    EXPECT(built >= 0);

    /* [plm_basis_get_int] [plm_basis_get_double] */
    int64_t size;
    double residual;
    TRY(plm_basis_get_int(basis, "size", &size));
    TRY(plm_basis_get_double(basis, "preload_residual", &residual));
    printf("%d columns, residual of the pre-load %.2g\n", (int)size, residual);
    /* [plm_basis_get_int] [plm_basis_get_double] */

    /* [plm_basis_get_array] [plm_basis_get_int_array] */
    double hz[8];
    int64_t count, kept[64];
    TRY(plm_basis_get_array(basis, "frequencies_hz", 8, hz, &count));
    TRY(plm_basis_get_int_array(basis, "sample_kept", 0, NULL, &count)); /* capacity 0: how many? */
    if (count <= 64) TRY(plm_basis_get_int_array(basis, "sample_kept", 64, kept, &count));
    /* [plm_basis_get_array] [plm_basis_get_int_array] */

    /* [plm_basis_get_vectors] */
    double p[2 * 2]; /* all columns of P: n_dof x size, the leading dimension is n_dof */
    EXPECT(size <= 2);
    TRY(plm_basis_get_vectors(basis, 0, 0, size, p, 2));
    /* [plm_basis_get_vectors] */

    /* [plm_basis_get_residual] */
    const double deflection[] = {1, 2};
    double r;
    TRY(plm_basis_get_residual(basis, 0, 0, 2, deflection, &r));
    printf("the basis misses %.2g of this deflection\n", r);
    /* [plm_basis_get_residual] */
    EXPECT(r < 1e-9 && hz[0] > 0 && kept[0] == 1);
    return keep(ctx, model, basis);
}

/* Of a basis and a curve on it a smaller one with nearly the same curve. */
static int compress(plm_context *ctx) {
    plm_basis *basis = NULL, *small = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    plm_model *model = NULL;
    int64_t size;
    TRY(start_model(ctx, &model));
    TRY(plm_model_build(model));
    TRY(basis_of(model, &basis));
    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_sweep(hbm, &curve));
    /* [plm_basis_set_responses] */
    TRY(plm_basis_create(model, &small));
    TRY(plm_basis_set_string(small, "kind", "pod"));
    TRY(plm_basis_set_parent(small, basis)); /* the curve was computed on it */
    TRY(plm_basis_set_responses(small, 1, &curve));
    TRY(plm_basis_set_double(small, "pod_tolerance", 1e-4)); /* or "pod_size" */
    TRY(plm_basis_build(small));
    /* [plm_basis_set_responses] */
    TRY(plm_basis_get_int(small, "size", &size));
    EXPECT(size >= 1 && size <= 2);
    return 0;
}

int example(plm_context *ctx) {
    int line;
    plm_model *model = NULL;
    plm_sampler *sampler = NULL;
    TRY(start_model(ctx, &model));
    TRY(plm_model_build(model));
    TRY(plm_sampler_create(model, &sampler));
    TRY(plm_sampler_run(sampler));
    line = build(ctx, model, sampler);
    return line ? line : compress(ctx);
}
