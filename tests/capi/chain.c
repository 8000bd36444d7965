#include "chain.h"
#include <string.h>

/* mass 1, springs 1e4 along x (the first one holds the chain), 5e4 + node number along y and z */
void chain_fill(chain *c) {
    int64_t p = 0;
    int j;
    memset(c, 0, sizeof *c);
    for (j = 0; j < CHAIN_DOFS; ++j) {
        const int node = j / 3, along_x = j % 3 == 0, last = node == CHAIN_NODES - 1;
        c->col_ptr[j] = p;
        if (along_x && node > 0) c->row[p] = j - 3, c->k[p++] = -1e4;
        c->row[p] = j, c->m[p] = 1;
        c->k[p++] = along_x ? (last ? 1e4 : 2e4) : 5e4 * (j % 3) + 100 * node;
        if (along_x && !last) c->row[p] = j + 3, c->k[p++] = -1e4;
    }
    c->col_ptr[CHAIN_DOFS] = p;
    for (j = 0; j <= CHAIN_DOFS; ++j) c->col_ptr32[j] = (int32_t)c->col_ptr[j];
    for (j = 0; j < CHAIN_NNZ_FULL; ++j) c->row32[j] = (int32_t)c->row[j];
    c->preload[3 * 7] = 5;
    c->force[3 * 4] = 10;
}

plm_status chain_model(plm_context *ctx, const chain *c, int with_preload, plm_model **model) {
    static const int32_t a[] = {6, 7, 8}, b[] = {15, 16, 17}, g[] = {21, 22, 23};
    static const double normal[] = {1, 0, 0}, stiffness[] = {PLM_AUTO_STIFFNESS}, given[] = {2e4},
                        gap[] = {0.0};
    plm_model *m = NULL;
    plm_status s = plm_model_create(ctx, CHAIN_DOFS, &m);
    *model = NULL;
    if (!s)
        s = plm_model_set_matrix_i64(m, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, CHAIN_NNZ_FULL, c->col_ptr,
                                     c->row, c->m);
    if (!s)
        s = plm_model_set_matrix_i32(m, PLM_STIFFNESS, PLM_CSR, PLM_FULL, 0, PLM_BORROW, CHAIN_NNZ_FULL,
                                     c->col_ptr32, c->row32, c->k);
    if (!s) s = plm_model_set_rayleigh_damping(m, 0.5, 2e-4);
    if (!s) s = plm_model_add_node_pairs_i32(m, 0, 1, a, b, normal, stiffness, NULL);
    if (!s) s = plm_model_add_ground_contacts_i32(m, 0, 1, g, normal, given, gap);
    if (!s) s = plm_model_set_excitation(m, 1, CHAIN_DOFS, c->force, NULL);
    if (!s && with_preload) s = plm_model_set_preload(m, CHAIN_DOFS, c->preload);
    if (s) {
        plm_model_destroy(&m);
        return s;
    }
    *model = m;
    return PLM_OK;
}

plm_status chain_built(plm_context *ctx, int with_preload, plm_model **model) {
    chain c; /* the borrowed stiffness may go once the model is built */
    double bytes = 0;
    plm_status s;
    chain_fill(&c);
    s = chain_model(ctx, &c, with_preload, model);
    if (!s) s = plm_model_estimate_memory(*model, &bytes); /* results like the others */
    if (!s) s = plm_model_build(*model);
    return s;
}
