#define _GNU_SOURCE /* sched_getaffinity */
#include "affinity/affinity.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* The variable by which MPI or a batch system says that this process is one of several, or NULL. Such
 * processes share the cores: if each pinned its threads from core 0 on, they would all use the same cores. */
static const char *batch_variable(void) {
    static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE",     "PMI_RANK",   "PMIX_RANK",
                                        "MPI_LOCALNRANKS",      "SLURM_JOB_ID", "PBS_JOBID",  "LSB_JOBID",
                                        "LOADL_STEP_ID",        "SGE_TASK_ID",  "PE_HOSTFILE"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (getenv(names[i])) return names[i];
    return NULL;
}

static int may_run_everywhere(void) {
    cpu_set_t mask;
    if (sched_getaffinity(0, sizeof mask, &mask) != 0) return 0; /* more cores than cpu_set_t holds */
    return CPU_COUNT(&mask) == sysconf(_SC_NPROCESSORS_ONLN);
}

/* Pinned threads are faster, but PoCL pins from core 0 on, whatever the process's mask is. */
const char *host_pin_threads(void) {
    static char sentence[128];
    const char *batch = batch_variable();
    if (getenv("POCL_AFFINITY")) return "as the environment says";
    if (batch) {
        snprintf(sentence, sizeof sentence, "not pinned: %s says that this is one of several processes",
                 batch);
        return sentence;
    }
    if (!may_run_everywhere()) return "not pinned: this process may run on some of the cores only";
    setenv("POCL_AFFINITY", "1", 1);
    return "pinned: this process may run on all cores, and it is the only one of its job";
}
