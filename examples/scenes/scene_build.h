/* scene_build.h: what the scenes' own files share to fill a scene; not for programs that only use one. */
#ifndef SCENE_BUILD_H
#define SCENE_BUILD_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A zeroed scene with its name, or NULL. */
scene *scene_new(const char *name);

/* Allocates (zeroed) supports, pairs, force and pre-load; n_dof must be set. scene_destroy() cleans up after
 * failure. */
int scene_allocate(scene *s, int64_t n_fixed, int64_t n_pairs, int with_preload);

/* Fills pair number `pair`; node_b < 0 is the ground. `normal` points out of the body of node_a. */
void scene_set_pair(scene *s, int64_t pair, int64_t node_a, int64_t node_b, const double normal[3],
                    double gap, double contact_stiffness);

#ifdef __cplusplus
}
#endif

#endif
