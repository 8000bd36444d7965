/* library.c: the library itself, and the keys of its handles. */
#include "example.h"
#include <stdio.h>
#include <stdlib.h>

static int facts(void) {
    /* [plm_version] */
    int32_t major, minor, patch;
    TRY(plm_version(&major, &minor, &patch));
    printf("libplm %d.%d.%d\n", (int)major, (int)minor, (int)patch);
    /* [plm_version] */

    /* [plm_build_info] */
    int64_t needed;
    TRY(plm_build_info(0, NULL, &needed)); /* how long is it? */
    char *line = malloc((size_t)needed);
    if (!line) return __LINE__;
    TRY(plm_build_info(needed, line, NULL));
    puts(line);
    free(line);
    /* [plm_build_info] */

    /* [plm_status_text] */
    char text[100]; /* longer texts are cut */
    TRY(plm_status_text(PLM_ERR_SINGULAR, sizeof text, text, NULL));
    printf("%d means: %s\n", PLM_ERR_SINGULAR, text);
    /* [plm_status_text] */
    EXPECT(text[0]);
    return 0;
}

static int keys(void) {
    /* [plm_key_count] [plm_key_info] [plm_key_text] */
    int32_t count, type, is_option;
    double minimum, maximum;
    TRY(plm_key_count(PLM_KIND_HBM, &count));
    for (int32_t i = 0; i < count; i++) {
        char name[64], about[200];
        TRY(plm_key_info(PLM_KIND_HBM, i, &type, &is_option, &minimum, &maximum));
        TRY(plm_key_text(PLM_KIND_HBM, i, PLM_KEY_NAME, sizeof name, name, NULL));
        TRY(plm_key_text(PLM_KIND_HBM, i, PLM_KEY_DESCRIPTION, sizeof about, about, NULL));
        printf("%s %s: %s\n", is_option ? "option" : "result", name, about);
    }
    /* [plm_key_count] [plm_key_info] [plm_key_text] */
    EXPECT(count > 5);
    return 0;
}

int example(plm_context *ctx) {
    (void)ctx;
    const int line = facts();
    return line ? line : keys();
}
