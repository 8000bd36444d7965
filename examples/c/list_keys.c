/* list_keys.c: prints the reference of all options and results, docs/keys.md. */
#include <plm/plm.h>
#include <stdio.h>

enum { text_size = 1024 };

static const char *const type_name[] = {"", "int", "double", "string", "array", "int array"};

/* One field of a key; a bar would end the cell of the table. */
static void print_text(int32_t kind, int32_t index, int32_t field) {
    char text[text_size] = "";
    plm_key_text(kind, index, field, sizeof text, text, NULL);
    for (const char *c = text; *c; c++) printf(*c == '|' ? "\\|" : "%c", *c);
}

static void print_range(int32_t kind, int32_t index, int32_t type, double minimum, double maximum) {
    const double huge = 1e60; /* no bound but that squares must not overflow */
    if (type == PLM_TYPE_STRING)
        print_text(kind, index, PLM_KEY_CHOICES);
    else if (maximum >= huge)
        printf(minimum <= -huge ? "any" : ">= %.12g", minimum);
    else
        printf("%.12g .. %.12g", minimum, maximum);
}

static void print_key(int32_t kind, int32_t index, int32_t options) {
    int32_t type = 0, is_option = 0;
    double minimum = 0, maximum = 0;
    if (plm_key_info(kind, index, &type, &is_option, &minimum, &maximum) || is_option != options) return;
    printf("| `");
    print_text(kind, index, PLM_KEY_NAME);
    printf("` | %s | ", type_name[type]);
    if (is_option) {
        print_text(kind, index, PLM_KEY_DEFAULT);
        printf(" | ");
        print_range(kind, index, type, minimum, maximum);
        printf(" | ");
    }
    print_text(kind, index, PLM_KEY_DESCRIPTION);
    printf(" |\n");
}

static int has(int32_t kind, int32_t options) {
    int32_t n = 0, type, is_option;
    double minimum, maximum;
    plm_key_count(kind, &n);
    for (int32_t i = 0; i < n; i++)
        if (!plm_key_info(kind, i, &type, &is_option, &minimum, &maximum) && is_option == options) return 1;
    return 0;
}

static void print_kind(int32_t kind, const char *handle) {
    int32_t n = 0;
    plm_key_count(kind, &n);
    printf("\n## `%s`\n", handle);
    if (has(kind, 1)) printf("\n| option | type | default | allowed | |\n|---|---|---|---|---|\n");
    for (int32_t i = 0; i < n; i++) print_key(kind, i, 1);
    if (has(kind, 0)) printf("\n| result | type | |\n|---|---|---|\n");
    for (int32_t i = 0; i < n; i++) print_key(kind, i, 0);
}

int main(void) {
    printf("# Options and results by key\n\n"
           "Options are set by `plm_<handle>_set_int`, `_set_double` and `_set_string` before the handle is "
           "built or run;\n"
           "results are read by `plm_<handle>_get_...` of their type afterwards. Units are the model's own "
           "unless a unit is\n"
           "given; pairs run fastest in matrices over pairs.\n\n"
           "Printed by `list_keys` (`examples/c/list_keys.c`) from the library itself; a test compares. To "
           "renew:\n\n"
           "    build/dev/examples/c/list_keys > docs/keys.md\n");
    print_kind(PLM_KIND_MODEL, "plm_model");
    print_kind(PLM_KIND_SAMPLER, "plm_sampler");
    print_kind(PLM_KIND_BASIS, "plm_basis");
    print_kind(PLM_KIND_HBM, "plm_hbm");
    print_kind(PLM_KIND_BRANCH, "plm_branch");
    print_kind(PLM_KIND_TRANSIENT, "plm_transient");
    print_kind(PLM_KIND_STUDY, "plm_study");
    return 0;
}
