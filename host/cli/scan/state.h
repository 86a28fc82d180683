/* A scan that the command computes and writes. */
#ifndef SKG_CLI_SCAN_STATE_H
#define SKG_CLI_SCAN_STATE_H

#include "scan/ranks.h"
#include "session/session.h"

#include <skiagraph/breathing.h>
#include <skiagraph/scanning.h>

typedef struct {
    cli_ranks ranks;
    cli_session session;
    skg_spot spot;  /* with the samples of a scan that is continued */
    skg_scan *scan; /* owned by the set-up */
    skg_motion *motion;
    skg_plan *plan;
    skg_scan_file *file;
    skg_scan_file_options file_options; /* of the output */
    const char *pictures;               /* folder of --dicom; NULL: none */
    int64_t phases;                     /* files of phases of the breath beside it; 0: none */
    skg_scan_run_options options;
    int64_t *only;
    char hash[65];
    const char *place;
    int64_t projections, found, computed, flats, darks;
    int has_fields;    /* 1: flat and dark fields are written */
    int fields_beside; /* 1: as files of their own */
    double plan_ms, seconds;
    int range_warned;
    int is_stopped;        /* 1: a signal ended it before its last projection */
    int64_t shard, shards; /* from 1; 0: none is asked for */
    char *shard_place;
    int64_t part_from, part_count; /* of a shard; 0 and 0: the whole scan */
    int64_t whole_projections;     /* of the scan, whatever the shard */
    skg_scan_record record;
    skg_readout readout;
    int is_grey; /* 1: grey values are written */
    char *stem;  /* of the files of a folder; NULL: ours */
    void *grey;  /* [grey_capacity] images that were read out */
    int64_t grey_capacity;
    int64_t clipped; /* pixels at the greatest grey value of their bits */
    skg_lag *lag;    /* NULL: none */
    void *lagged;    /* a projection with it */
} cli_acquisition;

#endif
