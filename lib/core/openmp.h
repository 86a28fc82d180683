/* OpenMP and fork. Private. */
#ifndef SKG_OPENMP_H
#define SKG_OPENMP_H

#include "core/core.h"

/* At the start of every public call whose loops OpenMP shares among threads. Its threads do not survive a fork, and GCC's
 * OpenMP would wait for them forever: SKG_ERR_FORK in a child of a process in which the library has used OpenMP with more
 * than one thread. With one thread (OMP_NUM_THREADS=1) it succeeds always. */
skg_status skg_openmp_enter(void);

#endif
