/* Ranks by MPI. Numbers are taken from a counter of rank 0 by one-sided communication, so that rank 0 computes like the
 * others. */
#include "common/say.h"
#include "scan/ranks.h"

#include <mpi.h>
#include <stdlib.h>

/* The variables by which launchers say how many processes there are. */
static int launched_ranks(void) {
    static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "PMIX_SIZE"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *value = getenv(names[i]);
        if (value) return atoi(value);
    }
    return 1;
}

typedef struct {
    MPI_Win window;
    int64_t counter;
} mpi_state;

int ranks_open(cli_ranks *ranks) {
    int provided = 0;
    *ranks = (cli_ranks){.count = 1};
    if (launched_ranks() < 2) return CLI_DONE;
    mpi_state *state = calloc(1, sizeof *state);
    if (!state) return cli_error(CLI_DEVICE, "out of host memory");
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &ranks->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks->count);
    MPI_Win_create(&state->counter, sizeof state->counter, sizeof state->counter, MPI_INFO_NULL,
                   MPI_COMM_WORLD, &state->window);
    ranks->state = state;
    return CLI_DONE;
}

void ranks_close(cli_ranks *ranks) {
    mpi_state *state = ranks->state;
    if (!state) return;
    MPI_Win_free(&state->window);
    MPI_Finalize();
    free(state);
    ranks->state = NULL;
}

int ranks_agree(const cli_ranks *ranks, int exit_status) {
    int worst = exit_status;
    if (ranks->state) MPI_Allreduce(&exit_status, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return worst;
}

void ranks_share(const cli_ranks *ranks, void *bytes, int count) {
    if (ranks->state) MPI_Bcast(bytes, count, MPI_BYTE, 0, MPI_COMM_WORLD);
}

int64_t ranks_sum(const cli_ranks *ranks, int64_t number) {
    int64_t sum = number;
    if (ranks->state) MPI_Allreduce(&number, &sum, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
    return sum;
}

int64_t ranks_take(cli_ranks *ranks, int64_t count) {
    mpi_state *state = ranks->state;
    int64_t first = 0;
    MPI_Win_lock(MPI_LOCK_EXCLUSIVE, 0, 0, state->window);
    MPI_Fetch_and_op(&count, &first, MPI_INT64_T, 0, 0, MPI_SUM, state->window);
    MPI_Win_unlock(0, state->window);
    return first;
}

void ranks_abort(const cli_ranks *ranks, int exit_status) {
    if (ranks->state) MPI_Abort(MPI_COMM_WORLD, exit_status);
}
