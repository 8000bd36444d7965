/* keys.c: one line per key: kind, name, option or result, type, default. With a file of such lines as
 * argument: every line of the file is still true (keys may be added; none goes, and no default that could
 * move an answer changes). */
#include <plm/plm.h>
#include <stdio.h>
#include <string.h>

enum { LINE = 512 };

static int describe(int32_t kind, int32_t index, char *line) {
    char name[128], preset[256];
    int32_t type = 0, is_option = 0;
    double minimum, maximum;
    if (plm_key_info(kind, index, &type, &is_option, &minimum, &maximum) ||
        plm_key_text(kind, index, PLM_KEY_NAME, sizeof name, name, NULL) ||
        plm_key_text(kind, index, PLM_KEY_DEFAULT, sizeof preset, preset, NULL))
        return 1;
    sprintf(line, "%d %s %s %d %s", (int)kind, name, is_option ? "option" : "result", (int)type,
            preset[0] ? preset : "-");
    return 0;
}

/* calls visit for every key until it returns non-zero */
static int each(int (*visit)(const char *line, void *user), void *user) {
    char line[LINE];
    int32_t kind, index, count;
    for (kind = PLM_KIND_MODEL; kind <= PLM_KIND_STUDY; ++kind) {
        if (plm_key_count(kind, &count)) return -1;
        for (index = 0; index < count; ++index) {
            if (describe(kind, index, line)) return -1;
            if (visit(line, user)) return 1;
        }
    }
    return 0;
}

static int print(const char *line, void *user) {
    (void)user;
    puts(line);
    return 0;
}
static int is_it(const char *line, void *user) {
    return strcmp(line, (const char *)user) == 0;
}

int main(int argc, char **argv) {
    char line[LINE];
    int bad = 0, known = 0;
    FILE *file;
    if (argc < 2) return each(print, NULL) != 0;
    file = fopen(argv[1], "r");
    if (!file) return 1;
    while (fgets(line, LINE, file)) {
        line[strcspn(line, "\n")] = 0;
        ++known;
        if (each(is_it, line) != 1) {
            printf("no longer true: %s\n", line);
            bad = 1;
        }
    }
    fclose(file);
    if (!bad) printf("%d keys as they were\n", known);
    return bad || known < 10;
}
