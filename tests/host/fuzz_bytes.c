/* libFuzzer over bases and branches as bytes, begun with the files of tests/formats. Length and checksum are
 * made right first, so that what stands behind them is reached; what is read must be written again, and
 * asked, and a curve goes on. */
#include "plm/plm.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = 32, MOST = 1 << 16 };

static void expect_known(plm_status s) {
    if (s < PLM_ERR_CALLBACK || s > PLM_WARNING) abort(); /* PLM_ERR_INTERNAL is a defect */
}

static void put(uint8_t *to, uint64_t x) {
    for (int k = 0; k < 8; ++k) to[k] = (uint8_t)(x >> 8 * k);
}

static uint64_t crc64(const uint8_t *p, size_t n) { /* bit by bit: shares nothing with the library's tables */
    uint64_t crc = ~(uint64_t)0;
    for (; n; --n, ++p) {
        crc ^= *p;
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xC96C5795D7870F42u : crc >> 1;
    }
    return ~crc;
}

static plm_basis *kept_basis(plm_context *ctx) { /* on which branches are read */
    static uint8_t bytes[MOST];
    static size_t n;
    plm_basis *basis = NULL;
    if (!n) {
        FILE *file = fopen(PLM_FORMATS "/version_1/basis.plm", "rb");
        if (!file) abort();
        n = fread(bytes, 1, MOST, file);
        fclose(file);
    }
    if (plm_basis_read(ctx, (int64_t)n, bytes, &basis)) abort();
    return basis;
}

static void ask_basis(plm_basis *basis) {
    static char again[4 * MOST];
    double p[64];
    int64_t n = 0;
    expect_known(plm_basis_get_int(basis, "n_dof", &n));
    if (n <= 64) expect_known(plm_basis_get_vectors(basis, 0, 0, 1, p, n));
    expect_known(plm_basis_write(basis, sizeof again, again, &n));
}

static void go_on(plm_context *ctx, plm_basis *basis, plm_branch *branch) {
    plm_hbm *hbm = NULL;
    plm_branch *resumed = NULL;
    if (plm_context_set_effort(ctx, 0.02) || plm_hbm_create(basis, &hbm)) abort();
    expect_known(plm_hbm_resume(hbm, branch, &resumed));
}

static void ask_branch(plm_branch *branch) {
    static char again[4 * MOST];
    double amplitude[64];
    int64_t n = 0;
    expect_known(plm_branch_get_amplitude(branch, 0, PLM_HARMONIC, 1, 64, amplitude, &n));
    expect_known(plm_branch_write(branch, sizeof again, again, &n));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static uint8_t bytes[MOST + 8];
    plm_context *ctx = NULL;
    plm_basis *basis = NULL;
    plm_branch *branch = NULL;
    plm_status s;
    if (size < HEAD + 8 || size > MOST) return 0;
    if (plm_context_create(PLM_API_VERSION, &ctx)) abort();
    memcpy(bytes, data, size);
    put(bytes + 24, size);
    put(bytes + size - 8, crc64(bytes, size - 8));
    expect_known(s = plm_basis_read(ctx, (int64_t)size, bytes, &basis));
    if (s >= 0) ask_basis(basis);
    basis = kept_basis(ctx);
    expect_known(s = plm_branch_read(basis, (int64_t)size, bytes, &branch));
    if (s >= 0) ask_branch(branch), go_on(ctx, basis, branch);
    if (plm_context_destroy(&ctx)) abort();
    return 0;
}
