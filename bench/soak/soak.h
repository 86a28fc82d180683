/* A long mixed run: what is drawn, what is done with it, and what must not change meanwhile. */
#ifndef SOAK_H
#define SOAK_H

#include "common/bench.h"

#include <stdint.h>

enum { SOAK_PROJECTIONS = 6, SOAK_CASES = 1 << 16, SOAK_VARIANTS = 8, SOAK_PATH = 512 };

/* A deliberate fault of every round, to show that the run finds it. */
enum { FAULT_NONE, FAULT_PIECE, FAULT_HEAP, FAULT_HANDLE, FAULT_FILE, FAULT_BITS, FAULT_COUNT };

typedef struct {
    uint64_t seed;
    int fault; /* FAULT_... */
    int has_mpi, has_hdf5;
    const char *command, *device;
    char folder[SOAK_PATH]; /* everything is written here */
    skg_context *contexts[2];
    int64_t cases;               /* that were drawn so far */
    uint64_t images[SOAK_CASES]; /* hash of the projections of each; 0: not computed yet */
    uint64_t state;              /* of the random numbers */
    int64_t kills, restarts, frames;
} soak;

/* A drawn scene: parts, beam, options and the views of a short scan. Its number and the seed of the run decide it. */
typedef struct {
    skg_scene *scene;
    skg_spectrum *beam;
    skg_scan *scan;
    skg_view views[SOAK_PROJECTIONS];
    skg_plan_options options;
    int64_t pixels;
} soak_case;

void soak_case_make(const soak *s, int64_t number, skg_context *context, soak_case *out);
void soak_case_free(soak_case *c);
skg_plan *soak_case_plan(const soak_case *c, skg_context *context);
/* A scene file of the same kind, with a scan of `projections`, for the command. */
void soak_scene_write(const soak *s, int64_t number, int projections, const char *path);

/* FNV-1a, 64 bits, never 0. */
uint64_t soak_hash(const void *bytes, size_t count);
uint64_t soak_hash_file(const char *path);

/* A round of the soak. A wrong result ends the program. */
typedef void (*soak_round)(soak *s, int64_t number);

/* In this process (rounds.c, threads.c): images in one job, in several jobs at once, a scan, a file of it that is closed
 * half-way and continued, two threads with a context each, two that take turns with one context, new contexts. */
void soak_frames(soak *s, int64_t number);
void soak_jobs(soak *s, int64_t number);
void soak_scan(soak *s, int64_t number);
void soak_file(soak *s, int64_t number);
void soak_two_contexts(soak *s, int64_t number);
void soak_one_context(soak *s, int64_t number);
void soak_new_contexts(soak *s, int64_t number);
/* Compares the projections of a case with those of before, or keeps their hash. */
void soak_same(soak *s, int64_t number, uint64_t hash, const char *what);

/* By children (children.c): scans and images that are killed and started again, and two ranks. */
void soak_killed_scan(soak *s, int64_t number);
void soak_killed_image(soak *s, int64_t number);
void soak_mpi(soak *s, int64_t number);
int soak_mpi_is_there(const soak *s);

/* Numbers that have to stay flat (health.c). */
typedef struct {
    long resident_kib, heap_kib; /* after free pages were given back to the system */
    int kernels;                 /* that the driver has compiled, here or in children */
    int handles, threads;
} soak_health;

soak_health soak_health_now(void);
/* Ends the program if a file but `kept` (may be NULL) is in the folder. */
void soak_folder_check(const soak *s, const char *kept, const char *what);
void soak_folder_clear(const soak *s);

#endif
