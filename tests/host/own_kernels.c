/* The OpenBLAS that a self-contained libplm carries takes the widest kernels that it has for the processor.
 */
#include "check_host.h"
#include <plm/plm.h>
#include <string.h>

int main(void) {
    char text[500];
    int wide = 0;
#ifdef __x86_64__
    __builtin_cpu_init();
    wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#endif
    EXPECT(!plm_build_info(sizeof text, text, NULL));
    printf("%s\n", text);
    EXPECT(strstr(text, "BLAS: its own OpenBLAS ("));
    if (wide)
        EXPECT(strstr(text, "(SkylakeX)") || strstr(text, "(Cooperlake)") ||
               strstr(text, "(SapphireRapids)"));
    else
        EXPECT(!strstr(text, "(SkylakeX)"));
    return wrong();
}
