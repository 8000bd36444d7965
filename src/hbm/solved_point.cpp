#include "hbm/solved_point.hpp"
#include "motions/branch_path.hpp"

namespace plm {

vector<double> unknowns_of(HbmSystem &system, const BranchPoint &point) {
    vector<double> x(system.size());
    system.from_point(point, x.data());
    return x;
}

void put_solution(HbmSystem &system, const PathState &at, double residual, std::int64_t iterations,
                  BranchPoint &point) {
    system.to_point(at.x.data(), at.parameter, point);
    point.motion.reset();
    put_record(residual, iterations, system.piece(), point);
}

BranchPoint solved_point(HbmSystem &system, const PathState &at, double residual, std::int64_t iterations) {
    BranchPoint point;
    put_solution(system, at, residual, iterations, point);
    return point;
}

BranchPoint solved_point(HbmSystem &system, const PathPoint &p) {
    BranchPoint point = solved_point(system, {p.x, p.parameter}, p.residual, p.iterations);
    put_place(p, point);
    return point;
}

} // namespace plm
