#define _GNU_SOURCE /* sched_getaffinity */
#include "affinity/affinity.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Processes of one job share the cores; each of them pinned from core 0 on would meet the others there. */
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
    if (sched_getaffinity(0, sizeof mask, &mask) != 0) return 0; /* more cores than the mask holds */
    return CPU_COUNT(&mask) == sysconf(_SC_NPROCESSORS_ONLN);
}

/* Pinned threads are faster, but PoCL pins from core 0 on without regard to the mask of the process. */
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
    return "pinned: this process may run on all cores, and alone";
}
