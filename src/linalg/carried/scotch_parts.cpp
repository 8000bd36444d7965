// Parts of our own in the carried SCOTCH: it prints nothing, reads neither the environment nor a clock, works
// on the calling thread, and does not end the process. It asks for its number of threads where it reads the
// environment.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <pthread.h>

extern "C" {
// What SCOTCH says on stderr; that something failed its functions return, too.
void SCOTCH_errorProg(const char *) {}
void SCOTCH_errorPrint(const char *, ...) {}
void SCOTCH_errorPrintW(const char *, ...) {}

int _SCOTCHenvGetInt(const char *name, int otherwise) {
    return std::strcmp(name, "SCOTCH_PTHREAD_NUMBER") == 0 ? 1 : otherwise;
}
const char *_SCOTCHenvGetStr(const char *, const char *otherwise) {
    return otherwise;
}
double _SCOTCHclockGet() {
    return 0;
}
void _SCOTCHusagePrint(std::FILE *, const char **) {}

/// None is started, and none of the host's is moved to another processor.
int pthread_create(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *) noexcept {
    return EAGAIN;
}
int pthread_setaffinity_np(pthread_t, std::size_t, const cpu_set_t *) noexcept {
    return 0;
}

/// The scanner of strategies, where it gets no memory: SCOTCH has no way on from there.
[[noreturn]] void exit(int) {
    throw std::bad_alloc();
}
}
