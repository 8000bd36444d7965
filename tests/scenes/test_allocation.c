/* test_allocation.c: when memory runs out at any point, a scene fails with the right code and leaves nothing
 * behind. */
#include <stdlib.h>

#include "groups.h"
#include "scene.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void __real_free(void *block);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void __wrap_free(void *block);

static int watching; /* count and fail only between the two ends of a test */
static int allowed;  /* allocations that still succeed; negative = all */
static long live;    /* blocks taken and not given back while watching */

static int refused(void) {
    if (!watching) return 0;
    if (allowed == 0) return 1;
    if (allowed > 0) allowed--;
    live++;
    return 0;
}

void *__wrap_malloc(size_t size) {
    return refused() ? NULL : __real_malloc(size);
}
void *__wrap_calloc(size_t count, size_t size) {
    return refused() ? NULL : __real_calloc(count, size);
}
void __wrap_free(void *block) {
    if (watching && block) live--;
    __real_free(block);
}

/* Number of allocations a scene takes; fails the test unless each one's failure is reported and cleaned up.
 */
static int fail_everywhere(const char *name) {
    for (int n = 0;; n++) {
        scene *s = NULL;
        live = 0;
        allowed = n;
        watching = 1;
        const int status = scene_create(name, "quick", 1, &s);
        const int made = s != NULL;
        scene_destroy(&s);
        watching = 0;
        assert_int_equal(live, 0);
        assert_int_equal(made, status == SCENE_OK);
        if (status == SCENE_OK) return n;
        assert_int_equal(status, SCENE_ERR_MEMORY);
    }
}

static void every_failed_allocation_is_reported_and_leaves_nothing(void **state) {
    (void)state;
    for (int i = 0; i < scene_count(); i++) assert_true(fail_everywhere(scene_name(i)) > 10);
}

int run_allocation(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_failed_allocation_is_reported_and_leaves_nothing)};
    return cmocka_run_group_tests_name("allocation", tests, NULL, NULL);
}
