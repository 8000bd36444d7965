// What a model knows of its surfaces, and what became of the contacts between them.
#pragma once
#include "structure/surface_contact.hpp"
#include <string>

namespace plm::capi {

struct ContactSurface {
    MeshSurface mesh;
    bool is_wall = false;
    vector<double> area; // of its nodes, as handed over: 0, or none, what the faces give
};

/// Of all surface contacts, point by point as they came.
struct SurfaceReport {
    vector<std::int64_t> point, face, pair; // pair: -1 where there is none
    vector<double> gap, normal, area;       // normal: 3 for each
    std::int64_t n_contacts = 0, n_alone = 0, n_opposed = 0;
    double distance = 0, interference = 0; // largest
    std::string text;
};

} // namespace plm::capi
