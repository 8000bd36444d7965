/* main.c: test_scenes [group]; without a group it runs all of them. */
#include "groups.h"

#include <stdio.h>
#include <string.h>

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        int (*run)(void);
    } groups[] = {{"allocation", run_allocation},
                  {"brick", run_brick},
                  {"frequency", run_frequency},
                  {"preload", run_preload},
                  {"scene", run_scene}};
    int failed = 0, found = 0;
    for (size_t g = 0; g < sizeof groups / sizeof *groups; g++)
        if (argc < 2 || !strcmp(argv[1], groups[g].name)) {
            found = 1;
            failed += groups[g].run();
        }
    if (!found) fprintf(stderr, "no such group: %s\n", argv[1]);
    return failed || !found;
}
