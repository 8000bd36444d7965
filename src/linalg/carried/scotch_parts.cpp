// Parts of our own in the carried SCOTCH: it prints nothing, reads neither the environment nor a clock, works
// on the calling thread, and does not end the process. It asks for its number of threads where it reads the
// environment.
#include "linalg/carried/scotch_parts.hpp"
#include "linalg/carried/reserve.hpp"
#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <pthread.h>

namespace {

/// Stands before each block of SCOTCH's, in a ring with those that carried_scotch_release() gives back.
struct alignas(16) Header {
    Header *before, *after;
    std::size_t bytes;
};
Header ring{&ring, &ring, 0};
bool scanning = false;
plm_carried::Reserve<std::size_t(1) << 18> reserve; // for the scanner

void give_back(Header *block) {
    block->before->after = block->after;
    block->after->before = block->before;
    if (!reserve.give_back(block)) std::free(block);
}

} // namespace

extern "C" {
void *carried_scotch_malloc(std::size_t bytes);
void *carried_scotch_realloc(void *old, std::size_t bytes);
void carried_scotch_free(void *old);
}

void *carried_scotch_malloc(std::size_t bytes) {
    const std::size_t whole = bytes + sizeof(Header);
    void *raw = whole > bytes ? std::malloc(whole) : nullptr;
    if (!raw && scanning) raw = reserve.take(whole);
    if (!raw) throw std::bad_alloc();
    auto *block = new (raw) Header{nullptr, nullptr, bytes};
    block->before = block->after = block;
    if (!scanning) { // what the scanner makes it keeps
        block->before = &ring, block->after = ring.after;
        ring.after->before = block;
        ring.after = block;
    }
    return block + 1;
}
void *carried_scotch_realloc(void *old, std::size_t bytes) {
    void *block = carried_scotch_malloc(bytes);
    if (!old) return block;
    std::memcpy(block, old, std::min(bytes, (static_cast<Header *>(old) - 1)->bytes));
    carried_scotch_free(old);
    return block;
}
void carried_scotch_free(void *old) {
    if (old) give_back(static_cast<Header *>(old) - 1);
}

void carried_scotch_scans(bool it_does) {
    scanning = it_does;
}
void carried_scotch_release() {
    while (ring.after != &ring) give_back(ring.after);
}

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
void exit(int) {
    throw std::bad_alloc();
}
}
