/* The number of PoCL's threads, and the cores on which they run. */
#define _GNU_SOURCE /* sched_getaffinity */
#include "affinity/affinity.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include <unistd.h>

/* The first of these variables that is set, or NULL. */
static const char *first_set(const char *const *names) {
    while (*names && !getenv(*names)) names++;
    return *names;
}

/* The variable by which MPI or a batch system says that this process is one of several, or NULL. Such
 * processes share the cores: if each pinned its threads from core 0 on, they would all use the same cores. */
static const char *batch_variable(void) {
    static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE",     "PMI_RANK",    "PMIX_RANK",
                                        "MPI_LOCALNRANKS",      "SLURM_JOB_ID", "PBS_JOBID",   "LSB_JOBID",
                                        "LOADL_STEP_ID",        "SGE_TASK_ID",  "PE_HOSTFILE", NULL};
    return first_set(names);
}

/* The variable by which OpenMP binds threads, so that the mask of this one is not that of the process, or NULL. */
static const char *binding_variable(void) {
    static const char *const names[] = {"OMP_PROC_BIND", "OMP_PLACES", "GOMP_CPU_AFFINITY", NULL};
    const char *bind = getenv("OMP_PROC_BIND");
    return bind && strcasecmp(bind, "false") == 0 ? NULL : first_set(names);
}

/* The number of cores on which this thread may run; 0: unknown. */
static long cores_allowed(void) {
    cpu_set_t mask;
    return sched_getaffinity(0, sizeof mask, &mask) == 0 ? CPU_COUNT(&mask)
                                                         : 0; /* 0: more than cpu_set_t holds */
}

static const char *fewer_threads(long allowed, long cores) {
    static char sentence[128];
    char number[32];
    snprintf(number, sizeof number, "%ld", allowed);
    if (allowed > 0 && !getenv("POCL_MAX_PTHREAD_COUNT")) setenv("POCL_MAX_PTHREAD_COUNT", number, 1);
    snprintf(sentence, sizeof sentence, "not pinned: this process may run on %ld of %ld cores only", allowed,
             cores);
    return sentence;
}

const char *host_pin_threads(void) {
    static char sentence[128];
    const char *batch = batch_variable(), *binding = binding_variable(),
               *most = getenv("POCL_MAX_PTHREAD_COUNT");
    const long cores = sysconf(_SC_NPROCESSORS_ONLN), allowed = cores_allowed();
    if (getenv("POCL_AFFINITY")) return "as the environment says";
    if (binding) {
        snprintf(sentence, sizeof sentence, "not pinned: %s binds threads", binding);
        return sentence;
    }
    if (allowed != cores) return fewer_threads(allowed, cores);
    if (batch) {
        snprintf(sentence, sizeof sentence, "not pinned: %s says that this is one of several processes",
                 batch);
        return sentence;
    }
    if (most && strtol(most, NULL, 10) > cores)
        return "not pinned: POCL_MAX_PTHREAD_COUNT asks for more threads than there are cores";
    setenv("POCL_AFFINITY", "1", 1);
    return "pinned: this process may run on all cores, and it is the only one of its job";
}
