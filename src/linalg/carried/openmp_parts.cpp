// What the carried CHOLMOD asks of OpenMP, on the calling thread. libgomp would start threads that no
// OMP_NUM_THREADS governs (CHOLMOD asks for four), wait for ever in the child of a fork, and end the process
// where it gets no memory.
extern "C" {
void GOMP_parallel(void (*body)(void *), void *data, unsigned n_threads, unsigned flags);
int omp_get_num_threads();
int omp_get_thread_num();
}

void GOMP_parallel(void (*body)(void *), void *data, unsigned, unsigned) {
    body(data);
}
int omp_get_num_threads() {
    return 1;
}
int omp_get_thread_num() {
    return 0;
}
