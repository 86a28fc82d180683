/* The processes of an MPI job that share a scan. Without MPI, or outside of a job, there is one. */
#ifndef SKG_CLI_RANKS_H
#define SKG_CLI_RANKS_H

#include <stdint.h>

typedef struct {
    int rank, count;
    void *state; /* of MPI; NULL: one process */
} cli_ranks;

/* Starts MPI in a process that mpirun or srun started as one of several. Returns an exit status: a build without MPI
 * refuses to be one of several. */
int ranks_open(cli_ranks *ranks);
void ranks_close(cli_ranks *ranks);

/* The worst exit status of all ranks, for all of them. Waits for them. */
int ranks_agree(const cli_ranks *ranks, int exit_status);

/* Copies bytes of rank 0 to all. */
void ranks_share(const cli_ranks *ranks, void *bytes, int count);

/* The sum over ranks, for all of them. */
int64_t ranks_sum(const cli_ranks *ranks, int64_t number);

/* Takes the next `count` numbers, counted from 0 over all ranks, and returns the first. */
int64_t ranks_take(cli_ranks *ranks, int64_t count);

/* Ends the processes of all ranks. */
void ranks_abort(const cli_ranks *ranks, int exit_status);

#endif
