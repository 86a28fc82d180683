/* OpenMP after a fork, where its threads are gone. */
#include "core/threads.h"

#include <omp.h>
#include <stdatomic.h>
#include <unistd.h>

static atomic_llong user; /* the process that used OpenMP first; 0: none */

skg_status skg_openmp_enter(void) {
    long long process = 0;
    const long long self = (long long)getpid();
    if (omp_get_max_threads() < 2) return SKG_OK;
    if (atomic_compare_exchange_strong(&user, &process, self) || process == self) return SKG_OK;
    return skg_fail(
        SKG_ERR_FORK,
        "OpenMP was used by the process that forked this one, and does not survive a fork; start the child process "
        "by exec or spawn, fork before the first call that computes, or set OMP_NUM_THREADS=1");
}
