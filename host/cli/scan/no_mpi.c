/* A build without MPI: one process. */
#include "common/say.h"
#include "scan/ranks.h"

#include <stdlib.h>

int ranks_open(cli_ranks *ranks) {
    static const char *const names[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "PMIX_SIZE"};
    *ranks = (cli_ranks){.count = 1};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *value = getenv(names[i]);
        if (value && atoi(value) > 1)
            return cli_error(
                CLI_USAGE,
                "this build of skiagraph has no MPI, so its %s processes would not share the scan; build "
                "it with MPI, or use --shard",
                value);
    }
    return CLI_DONE;
}

void ranks_close(cli_ranks *ranks) {
    (void)ranks; /* nothing was opened */
}

int ranks_agree(const cli_ranks *ranks, int exit_status) {
    (void)ranks;
    return exit_status;
}

void ranks_share(const cli_ranks *ranks, void *bytes, int count) {
    (void)ranks;
    (void)bytes;
    (void)count;
}

int64_t ranks_sum(const cli_ranks *ranks, int64_t number) {
    (void)ranks;
    return number;
}

int ranks_take(cli_ranks *ranks, int waits, int64_t *first, int64_t *count) {
    (void)waits;
    *first = ranks->next;
    *count = ranks->total - ranks->next;
    ranks->next = ranks->total;
    return 1;
}

void ranks_serve(cli_ranks *ranks, int until_end) {
    (void)ranks;
    (void)until_end;
}

void ranks_abort(const cli_ranks *ranks, int exit_status) {
    (void)ranks;
    (void)exit_status;
}
