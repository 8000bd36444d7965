/* A host's plug-in that brings libplm with it: unload.c loads and unloads it. */
#include "whole_run.h"
#include <stddef.h>

__attribute__((visibility("default"))) int plugin_run(void);

int plugin_run(void) {
    outcome o;
    plm_context *ctx = NULL;
    plm_status s = plm_context_create(PLM_API_VERSION, &ctx);
    if (s >= 0) s = whole_run(ctx, CURVE, &o);
    if (s >= 0) s = plm_context_destroy(&ctx);
    return s >= 0 ? 0 : (int)s;
}
