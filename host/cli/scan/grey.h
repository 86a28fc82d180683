/* Grey values of a scan, and the layout of CTSimU. These functions return an exit status and print the error. */
#ifndef SKG_CLI_SCAN_GREY_H
#define SKG_CLI_SCAN_GREY_H

#include "scan/state.h"

/* Decides whether grey values are written. */
int grey_decide(const cli_arguments *arguments, cli_acquisition *a);

/* Finds where the free beam is strongest, once there is a plan. */
int grey_prepare(cli_acquisition *a);

/* The type of the output's elements, and the bytes of an image. */
int32_t grey_type(const cli_acquisition *a);
int64_t grey_bytes(const cli_acquisition *a);

/* Reads a batch out. *images: what is written, in memory of the acquisition. */
skg_status grey_batch(cli_acquisition *a, const skg_scan_batch *batch, const void **images);

/* Reads flat fields (energies) and dark fields (no energies) out, one after another in `to`. */
skg_status grey_fields(const cli_acquisition *a, int64_t count, const void *energies, void *to);

#endif
