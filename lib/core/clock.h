/* Wall time. Private. */
#ifndef SKG_CLOCK_H
#define SKG_CLOCK_H

#include <time.h>

/* Seconds since some moment. */
static inline double skg_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
