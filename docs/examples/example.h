/* example.h: what the examples of the API reference share.
 *
 * Every function of plm.h is called in one of these programs between two lines that hold its name in
 * brackets, as comments; the reference shows what is between them. The test
 * docs.every_function_has_an_example says what is missing, the tests docs.example_* run the programs. */
#ifndef EXAMPLE_H
#define EXAMPLE_H

#include <plm/plm.h>

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        if ((call) < 0) return __LINE__;                                                                     \
    } while (0)
#define EXPECT(condition)                                                                                    \
    do {                                                                                                     \
        if (!(condition)) return __LINE__;                                                                   \
    } while (0)

/* Each program's own part: 0, or the line that went wrong. */
int example(plm_context *ctx);

/* Two masses of 1 kg on springs of 10 kN/m, the second one beside a stop, pushed by 1 N at it. Not built yet.
 */
plm_status start_model(plm_context *ctx, plm_model **model);
/* The same, built, and on to piecewise-linear modes. */
plm_status start_basis(plm_context *ctx, plm_basis **basis);
/* From a built model to piecewise-linear modes. */
plm_status basis_of(plm_model *model, plm_basis **basis);

#endif
