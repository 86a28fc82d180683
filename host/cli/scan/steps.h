/* From the flags of `scan` to a finished output. Functions that return int return an exit status and print the error. */
#ifndef CLI_SCAN_STEPS_H
#define CLI_SCAN_STEPS_H

#include "scan/state.h"

#include <skiagraph/scanning.h>

int acquisition_read_flags(const cli_arguments *arguments, cli_acquisition *a);

/* Opens the session, makes plan and motion, and opens the output. */
int acquisition_open(const cli_arguments *arguments, cli_acquisition *a);

/* Computes and writes what is missing. */
int acquisition_run(const cli_arguments *arguments, cli_acquisition *a);

void acquisition_close(cli_acquisition *a);

/* Computes and writes the next batch of a run. count: its projections; 0: the run is finished */
skg_status write_batch(cli_acquisition *a, skg_scan_run *run, int64_t *count);

/* Computes and writes a run, batch after batch. begun_ms: when the run was created, by cli_now_ms */
skg_status write_batches(cli_acquisition *a, skg_scan_run *run, double begun_ms);

/* Computes and writes the missing projections together with the other ranks. Returns an exit status that all ranks
 * agree on. */
int shared_run(const cli_arguments *arguments, cli_acquisition *a);

/* Shards: blocks of a scan in files of their own, for job arrays without MPI. */

/* Reads --shard I/N. */
int shards_read_flag(const cli_arguments *arguments, cli_acquisition *a);

/* With --shard: chooses the block, its file and its hash. */
int shards_choose_part(cli_acquisition *a);

/* With --join: copies the projections of all shards into the output. options: of the output. */
int shards_join(cli_acquisition *a, const skg_scan_file_options *options);

/* CTSimU scenarios, which --geometry writes: whether a path names one, and all of them. */
int scenario_is(const char *path);
int scenario_write(const cli_arguments *arguments, const cli_acquisition *a);

/* Grey values of a scan, and the layout of CTSimU. */

/* Decides whether grey values are written. */
int grey_decide(const cli_arguments *arguments, cli_acquisition *a);

/* Finds the levels of the output, of the free beam and of darkness, once there is a plan, and whether fields are written. */
int grey_prepare(const cli_arguments *arguments, cli_acquisition *a);

/* The type of the output's elements, and the bytes of an image. */
int32_t grey_type(const cli_acquisition *a);
int64_t grey_bytes(const cli_acquisition *a);

/* Reads a batch out. *images: what is written, in memory of the acquisition. */
skg_status grey_batch(cli_acquisition *a, const skg_scan_batch *batch, const void **images);

/* Warns of pixels that were cut off at the greatest value of their bits. */
void grey_warn(const cli_acquisition *a);

/* Reads all flat fields or all dark fields out, one after another in `to`. */
skg_status grey_fields(const cli_acquisition *a, int is_dark, const void *energies, void *to);

/* Refuses, before anything is laid out, what a detector with lag cannot do. */
int lag_check(const cli_arguments *arguments, const cli_acquisition *a);

/* Makes the lag, once it is known which projections there are. */
int lag_open(cli_acquisition *a);
void lag_close(cli_acquisition *a);

/* Makes and writes flat and dark fields. */
int fields_write(cli_acquisition *a);

/* A sentence that says where they are; "" without them. */
int fields_describe(const cli_acquisition *a, char *text, size_t size);

/* The projections as DICOM files beside the output: reads --dicom, and writes them when the scan is finished. */
int pictures_read_flag(const cli_arguments *arguments, cli_acquisition *a);
int pictures_write(cli_acquisition *a);

/* A scan of a breathing scene, sorted into phases of the breath. */

/* Reads --phases N. */
int phases_read_flag(const cli_arguments *arguments, cli_acquisition *a);

/* Writes a file for each phase beside the finished output: scan.phase-1-of-8.h5 for scan.h5. */
int phases_write(cli_acquisition *a);

/* A finished .h5 again, compressed. */

int packed_read_flags(const cli_arguments *arguments, cli_acquisition *a);

/* Writes the file of --packed if the scan is finished. */
int packed_write(const cli_arguments *arguments, const cli_acquisition *a);

/* Checksums of a scan. */

/* Refuses, before anything is laid out, --verify of an output that is not there. samples: of its scan; 0: there is none. */
int verify_check(const cli_arguments *arguments, const cli_acquisition *a, int64_t samples);

/* Notes how many projections were found damaged when the output was opened. */
void verify_note(const cli_acquisition *a);

/* Reads the output and prints what is damaged or missing: exit status 1. Computes nothing. */
int verify_run(const cli_arguments *arguments, cli_acquisition *a);

/* Writes FOLDER/STEM_metadata.json. */
int metadata_write(const cli_acquisition *a);

#endif
