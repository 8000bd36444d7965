// Structures drawn by chance: sensible ones, and ones that a confused host might hand over.
#pragma once
#include "witness.hpp"
#include <deque>

namespace scenarios {

/// Arrays that a model borrows must outlive its build.
struct Borrowed {
    std::deque<std::vector<std::int32_t>> i32;
    std::deque<std::vector<std::int64_t>> i64;
    std::deque<std::vector<double>> values;
};

/// Matrices, supports, contact pairs and loads for a fresh model of n DOFs. tame: a chain or a small random
/// structure as an engineer would have it; otherwise with every defect, at scales from 1e-300 to 1e300.
void draw_structure(Witness &w, Random &random, plm_model *model, std::int64_t n, bool tame,
                    Borrowed &arrays);

} // namespace scenarios
