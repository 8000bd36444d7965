/* Hands a scene of the host's FE code over to libplm: what an in-house code would write once. */
#ifndef SCENE_MODEL_H
#define SCENE_MODEL_H

#include "plm/plm.h"
#include "scene.h"

/* Hands it over without building it: options of the model may be set before. */
plm_status scene_to_unbuilt_model(plm_context *ctx, const scene *s, plm_model **model);

/* Builds a plm_model from the scene; *model is a new handle. Returns the first status that is not 0. */
plm_status scene_to_model(plm_context *ctx, const scene *s, plm_model **model);

/* Prints "what: error text" to stderr and ends the program when status < 0; warnings are printed only. */
void must(plm_context *ctx, plm_status status, const char *what);

#endif
