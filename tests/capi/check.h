/* check.h: cmocka with what it needs, and one check for a failed call with all its details. */
#ifndef CHECK_H
#define CHECK_H

#include "plm/plm.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Was it refused with this status, argument and index, and does the text begin with "function: " and contain
 * `words`? Prints what differs. */
int refused(plm_context *ctx, plm_status got, plm_status want, const char *function, const char *argument,
            int64_t index, const char *words);

/* |got - want| <= relative |want|, printed when not */
int close_to(double got, double want, double relative);

/* 1, or where a sanitizer watches, which takes ten times as long, `watched`: how far a loop goes on to its
 * next case, where all cases take the same paths through the library. */
int next_case(int watched);

/* the larger one; NaN when one of them is, which fmax() would lose */
double larger(double a, double b);

/* PLM_OK, or the error text printed */
int done(plm_context *ctx, plm_status got);

/* The same, or PLM_WARNING for this reason alone */
int done_but_for(plm_context *ctx, plm_status got, int32_t reason);

#endif
