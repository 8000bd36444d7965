/* study_files.c: the folder and small CSV files beside those of plm_study_write. */
#define _POSIX_C_SOURCE 200809L /* mkdir */
#include <errno.h>
#include <inttypes.h>
#include <string.h>
#include <sys/stat.h>

#include "study.h"

int study_make_folder(const char *path) {
    if (mkdir(path, 0777) == 0 || errno == EEXIST) return 0;
    fprintf(stderr, "%s: %s\n", path, strerror(errno));
    return 1;
}

FILE *study_open_file(const study_options *o, const char *name) {
    char path[STUDY_PATH];
    snprintf(path, sizeof path, "%s/%s", o->output, name);
    FILE *file = fopen(path, "w");
    if (!file) fprintf(stderr, "%s: %s\n", path, strerror(errno));
    return file;
}

int study_close_file(FILE *file) {
    const int failed = ferror(file) != 0;
    return (fclose(file) != 0) | failed;
}

int study_write_facts(study_case *c) {
    const study_options *o = c->options;
    FILE *file = study_open_file(o, "study.csv");
    if (!file) return 1;
    fprintf(file, "key,value\nscene,%s\nsize,%s\npreload,%d\nharmonics,%" PRId64 "\nlevels,%" PRId64 "\n",
            o->scene, o->size, o->with_preload, o->n_harmonics, o->n_levels);
    fprintf(file, "n_dof,%" PRId64 "\nn_pairs,%" PRId64 "\n", c->scene->n_dof, c->scene->n_pairs);
    return study_close_file(file);
}

static int write_steps(study_case *c, const char *name, const study_step *step, int32_t n) {
    FILE *file = study_open_file(c->options, name);
    if (!file) return 1;
    fprintf(file, "number,harmonics,points,seconds,peak_hz,peak_amplitude\n");
    for (int32_t i = 0; i < n; i++)
        fprintf(file, "%" PRId64 ",%" PRId64 ",%" PRId64 ",%.6g,%.15g,%.15g\n", step[i].number,
                step[i].harmonics, step[i].n_points, step[i].seconds, step[i].hz, step[i].amplitude);
    return study_close_file(file);
}

int study_write_steps(study_case *c, const study_steps *s) {
    return write_steps(c, "harmonics.csv", s->harmonics, s->n_harmonics) |
           write_steps(c, "time_samples.csv", s->samples, s->n_samples);
}
