/* Ranks by MPI. Rank 0 computes like the others, and answers their requests between its batches. A rank requests its next
 * numbers one batch or more before it needs them, so that it does not wait for that. Whoever waits sleeps between looks: MPI's own
 * waiting takes a core, which another rank's device may need. */
#include "common/say.h"
#include "scan/ranks.h"

#include <mpi.h>
#include <stdlib.h>
#include <time.h>

/* The variables by which launchers say how many processes there are. */
static int launched_ranks(void) {
    static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "PMIX_SIZE"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *value = getenv(names[i]);
        if (value) return atoi(value);
    }
    return 1;
}

enum { TAG_REQUEST = 1, TAG_ANSWER, PARTS_PER_RANK = 8, PART_LEAST = 16, PART_MAX = 64 };

/* An answer of rank 0 that is on its way. */
typedef struct {
    MPI_Request sent;
    int64_t numbers[2];
} answer;

/* Nobody sends by MPI_Send: in shared memory it may spin until the other rank looks, which is when its batch is finished. */
typedef struct {
    MPI_Request asked, answered; /* of a rank: its request, and the answer to it */
    int64_t numbers[2];          /* the answer: first and count */
    int has_asked, ended;        /* ended: ranks that know that nothing is left */
    answer *answers;             /* [ranks] of rank 0 */
} mpi_state;

static void rest(void) {
    const struct timespec pause = {.tv_nsec = 100000};
    nanosleep(&pause, NULL);
}

static void wait_for(MPI_Request *request) {
    for (int is_done = 0; MPI_Test(request, &is_done, MPI_STATUS_IGNORE), !is_done;) rest();
}

int ranks_open(cli_ranks *ranks) {
    int provided = 0;
    *ranks = (cli_ranks){.count = 1};
    if (launched_ranks() < 2) return CLI_DONE;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &ranks->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks->count);
    mpi_state *state = calloc(1, sizeof *state);
    if (state) state->answers = calloc((size_t)ranks->count, sizeof *state->answers);
    if (!state || !state->answers)
        MPI_Abort(MPI_COMM_WORLD, cli_error(CLI_DEVICE, "out of host memory"));
    else {
        state->asked = state->answered = MPI_REQUEST_NULL;
        for (int r = 0; r < ranks->count; r++) state->answers[r].sent = MPI_REQUEST_NULL;
    }
    ranks->state = state;
    return CLI_DONE;
}

void ranks_close(cli_ranks *ranks) {
    mpi_state *state = ranks->state;
    if (!state) return;
    MPI_Finalize();
    free(state->answers);
    free(state);
    ranks->state = NULL;
}

int ranks_agree(const cli_ranks *ranks, int exit_status) {
    int worst = exit_status;
    MPI_Request request;
    if (!ranks->state) return worst;
    MPI_Iallreduce(&exit_status, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD, &request);
    wait_for(&request);
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

static int64_t clamp(int64_t value, int64_t low, int64_t high) {
    return value < low ? low : value > high ? high : value;
}

/* Rank 0 alone: the next numbers. Not fewer than a batch, unless the whole is small: answers would come too late. */
static void share_out(cli_ranks *ranks, int64_t numbers[2]) {
    const int64_t parts = (int64_t)PARTS_PER_RANK * ranks->count, left = ranks->total - ranks->next;
    const int64_t part = clamp(left / parts, clamp(ranks->total / parts, 1, PART_LEAST), PART_MAX);
    numbers[0] = ranks->next;
    numbers[1] = left < part ? left : part;
    ranks->next += numbers[1];
}

static void ask(mpi_state *state) {
    wait_for(&state->asked);
    MPI_Isend(NULL, 0, MPI_BYTE, 0, TAG_REQUEST, MPI_COMM_WORLD, &state->asked);
    MPI_Irecv(state->numbers, 2, MPI_INT64_T, 0, TAG_ANSWER, MPI_COMM_WORLD, &state->answered);
    state->has_asked = 1;
}

int ranks_take(cli_ranks *ranks, int waits, int64_t *first, int64_t *count) {
    mpi_state *state = ranks->state;
    int is_here = 1;
    if (ranks->rank > 0) {
        if (!state->has_asked) ask(state);
        if (waits)
            wait_for(&state->answered);
        else
            MPI_Test(&state->answered, &is_here, MPI_STATUS_IGNORE);
        if (!is_here) return 0;
    } else
        share_out(ranks, state->numbers);
    *first = state->numbers[0];
    *count = state->numbers[1];
    if (ranks->rank > 0 && *count > 0)
        ask(state);
    else if (ranks->rank > 0)
        wait_for(&state->asked);
    return 1;
}

static void reply(cli_ranks *ranks, int to) {
    mpi_state *state = ranks->state;
    answer *its = &state->answers[to];
    MPI_Recv(NULL, 0, MPI_BYTE, to, TAG_REQUEST, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    wait_for(&its->sent); /* it has arrived, or there would be no other request */
    share_out(ranks, its->numbers);
    state->ended += its->numbers[1] == 0;
    MPI_Isend(its->numbers, 2, MPI_INT64_T, to, TAG_ANSWER, MPI_COMM_WORLD, &its->sent);
}

void ranks_serve(cli_ranks *ranks, int until_end) {
    mpi_state *state = ranks->state;
    if (ranks->rank > 0) return;
    for (;;) {
        MPI_Status from;
        int is_here = 0;
        MPI_Iprobe(MPI_ANY_SOURCE, TAG_REQUEST, MPI_COMM_WORLD, &is_here, &from);
        if (is_here)
            reply(ranks, from.MPI_SOURCE);
        else if (!until_end || state->ended == ranks->count - 1)
            break;
        else
            rest();
    }
    for (int r = 1; until_end && r < ranks->count; r++) wait_for(&state->answers[r].sent);
}

void ranks_abort(const cli_ranks *ranks, int exit_status) {
    if (ranks->state) MPI_Abort(MPI_COMM_WORLD, exit_status);
}
