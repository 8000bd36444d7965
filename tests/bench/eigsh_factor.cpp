// The library's factorization and set-up for eigsh.py, which loads this by ctypes.
#include "apart.hpp"
#include "cantilever.h"
#include "space/space.hpp"
#include "structure/solver/make_factor.hpp"

namespace {

struct Solid {
    scene *s = nullptr;
    plm::ModelInput input;
    plm::SparseMatrix k, m;
    std::unique_ptr<plm::Factor> factor;
};

Solid solid;

} // namespace

extern "C" {

/// The solid of bench_scale; sizes: free DOFs, entries of K, entries of M, pairs.
[[gnu::visibility("default")]] int eigsh_make(double dofs, std::int64_t sizes[4]) {
    const cracked_plate_params p = cantilever(1, dofs, 0);
    if (cracked_plate_create(&p, &solid.s) != SCENE_OK) return 1;
    solid.input = input_of(*solid.s);
    solid.k = free_matrix(solid.input, *solid.input.stiffness);
    solid.m = free_matrix(solid.input, *solid.input.mass);
    sizes[0] = solid.k.cols, sizes[1] = solid.k.nnz(), sizes[2] = solid.m.nnz(), sizes[3] = solid.s->n_pairs;
    return 0;
}

/// Compressed columns of K (which = 0) or M.
[[gnu::visibility("default")]] void eigsh_matrix(int which, std::int64_t *ptr, std::int64_t *idx,
                                                 double *val) {
    const plm::SparseMatrix &a = which == 0 ? solid.k : solid.m;
    std::copy(a.ptr.begin(), a.ptr.end(), ptr);
    std::copy(a.idx.begin(), a.idx.end(), idx);
    std::copy(a.val.begin(), a.val.end(), val);
}

[[gnu::visibility("default")]] void eigsh_factor() {
    solid.factor = plm::make_factor(solid.k);
}
/// x becomes K^-1 x.
[[gnu::visibility("default")]] void eigsh_solve(double *x) {
    solid.factor->solve(x, 1, solid.k.cols);
}

/// Matrices to the contact space of just below half of the highest mode, as in bench_scale; its size.
[[gnu::visibility("default")]] std::int64_t eigsh_set_up(double highest, int n_modes) {
    solid.factor.reset();
    const auto model =
        std::make_shared<const plm::Model>(solid.input, plm::SpaceOptions(), nullptr, plm::Watch());
    return plm::make_contact_space(model, 0.499 * highest, n_modes, plm::Watch())->size();
}
}
