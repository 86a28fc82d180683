/* Shards: blocks of a scan in files of their own, for job arrays without MPI. */
#ifndef SKG_CLI_SHARDS_H
#define SKG_CLI_SHARDS_H

#include "scan/state.h"

/* Reads --shard I/N. These functions return an exit status and print the error. */
int shards_read_flag(const cli_arguments *arguments, cli_acquisition *a);

/* With --shard: chooses the block, its file and its hash. */
int shards_choose_part(cli_acquisition *a);

/* With --join: copies the projections of all shards into the output. options: of the output. */
int shards_join(cli_acquisition *a, const skg_scan_file_options *options);

#endif
