/* The metadata file of CTSimU beside the projections. */
#ifndef SKG_CLI_SCAN_METADATA_H
#define SKG_CLI_SCAN_METADATA_H

#include "scan/state.h"

/* Writes FOLDER/STEM_metadata.json. Returns an exit status and prints the error. */
int metadata_write(const cli_acquisition *a);

#endif
