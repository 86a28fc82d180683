/* The processes of an MPI job that share a scan. Without MPI, or outside of a job, there is one. */
#ifndef SKG_CLI_RANKS_H
#define SKG_CLI_RANKS_H

#include <stdint.h>

typedef struct {
    int rank, count;
    void *state; /* of MPI; NULL: one process */
    /* numbers that are shared out, and how many of them were; next is known to rank 0 only */
    int64_t total, next;
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

/* Takes the next of the numbers 0 to total - 1, which all ranks share: many at first, fewer towards the end. The next ones are
 * requested at once, so that they are here when they are needed.
 *
 *     waits    1: waits for them; 0: returns 0 if they are not here yet
 *     count    result: how many; 0: none are left */
int ranks_take(cli_ranks *ranks, int waits, int64_t *first, int64_t *count);

/* Rank 0 answers the requests of the others, which compute meanwhile: between batches, and when it has finished until all know
 * that nothing is left. Others return at once. */
void ranks_serve(cli_ranks *ranks, int until_end);

/* Ends the processes of all ranks. */
void ranks_abort(const cli_ranks *ranks, int exit_status);

#endif
