/* ccx_files.h: reads what CalculiX ccx and host_files.py write. Every function returns 0, or prints what is
 * wrong and returns 1. */
#ifndef CCX_FILES_H
#define CCX_FILES_H

#include <stdint.h>
#include <stdio.h>

/* jobname.sti, jobname.mas (*FREQUENCY, SOLVER=MATRIXSTORAGE): "row column value", counted from 1, the upper
 * triangle. */
typedef struct ccx_matrix {
    int64_t n_entries;
    int32_t *row, *column;
    double *value;
} ccx_matrix;

/* n_more: room for entries behind those of the file. */
int ccx_read_matrix(const char *path, int64_t n_more, ccx_matrix *matrix);
void ccx_free_matrix(ccx_matrix *matrix);

/* model.txt of host_files.py: "word integers reals", then so many integers and so many reals. */
typedef struct host_record {
    char word[32];
    int64_t n_integers, n_reals;
    int64_t *integer;
    double *real;
} host_record;

/* The next record of the file; *end: there is none. Free it, or read the next one into it. */
int host_read_record(FILE *file, host_record *record, int *end);
void host_free_record(host_record *record);

/* jobname.dat: the first n natural frequencies in cycles/time, written by ccx with 7 digits. */
int ccx_read_frequencies(const char *path, int32_t n, double *frequency_hz);

#endif
