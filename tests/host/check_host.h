/* check_host.h: EXPECT counts what is wrong and says where; a test program returns wrong(). No longjmp, so
 * that it also holds under sanitizers, valgrind and traps. */
#ifndef CHECK_HOST_H
#define CHECK_HOST_H

#include <stdio.h>

static int wrong_count;

#define EXPECT(condition)                                                                                    \
    do {                                                                                                     \
        if (!(condition) && ++wrong_count <= 20)                                                             \
            printf("%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);                                   \
    } while (0)

static int wrong(void) {
    if (wrong_count) printf("%d wrong\n", wrong_count);
    return wrong_count != 0;
}

#endif
