#include "cantilever.h"

#include <math.h>

cracked_plate_params cantilever(int solid, double dofs, double pairs) {
    cracked_plate_params p;
    cracked_plate_paper(&p);
    p.n_loads = 0;
    const double nodes = dofs / 3, side = solid ? cbrt(nodes / 8) : sqrt(nodes / 8);
    p.nz = solid ? (int32_t)side : 3;
    p.ny = (int32_t)(solid ? 2 * side : side);
    const double most = p.ny / 2 * (p.nz + 1), cracks = pairs > 0 ? ceil(pairs / most) : 1;
    p.crack_rows = (int32_t)(pairs > 0 ? lround(pairs / cracks / (p.nz + 1)) : p.ny / 2);
    p.further_cracks = (int32_t)cracks - 1;
    p.nx = (int32_t)(nodes / ((p.ny + 1.0) * (p.nz + 1)));
    p.length = p.nx, p.width = p.ny, p.thickness = p.nz;
    p.crack_position = 0.5 * p.length;
    return p;
}
