/* ccx_files.h: reads what CalculiX ccx writes. Every function returns 0, or prints what is wrong and
 * returns 1. */
#ifndef CCX_FILES_H
#define CCX_FILES_H

#include <stdint.h>

/* jobname.sti, jobname.mas (*FREQUENCY, SOLVER=MATRIXSTORAGE): "row column value", counted from 1, the upper
 * triangle. */
typedef struct ccx_matrix {
    int64_t n_entries;
    int32_t *row, *column;
    double *value;
} ccx_matrix;

int ccx_read_matrix(const char *path, ccx_matrix *matrix);
void ccx_free_matrix(ccx_matrix *matrix);

/* jobname.dof: line i holds "node.direction" of matrix row i. DOFs under a *BOUNDARY have no row. C3D8I
 * elements bring three nodes each for their incompatible modes; they have rows like all others. */
typedef struct ccx_dofs {
    int32_t n_rows, n_nodes;
    int32_t *row; /* 3 n_nodes */
} ccx_dofs;

int ccx_read_dofs(const char *path, ccx_dofs *dofs);
void ccx_free_dofs(ccx_dofs *dofs);
/* Matrix row, from 1, of a node (from 1) and a direction (1, 2, 3); 0 when there is none. */
int32_t ccx_row(const ccx_dofs *dofs, int32_t node, int32_t direction);

/* jobname.dat: the first n natural frequencies in cycles/time, written by ccx with 7 digits. */
int ccx_read_frequencies(const char *path, int32_t n, double *frequency_hz);

#endif
