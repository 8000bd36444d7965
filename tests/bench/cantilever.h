/* The structures that the benchmarks of scale grow: cracked cantilevers of bricks, a solid block (4:2:1) and
 * a plate three bricks thick. */
#ifndef CANTILEVER_H
#define CANTILEVER_H

#include "cracked_plate.h"

#ifdef __cplusplus
extern "C" {
#endif

/* About so many DOFs and pairs: a crack at mid length, or as many cracks as it takes, over half of the
 * section at most; 0 pairs: one crack over half of it. */
cracked_plate_params cantilever(int solid, double dofs, double pairs);

#ifdef __cplusplus
}
#endif

#endif
