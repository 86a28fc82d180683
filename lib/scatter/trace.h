/* Histories of photons on the device. Private. */
#ifndef SKG_SCATTER_TRACE_H
#define SKG_SCATTER_TRACE_H

#include "scatter/sight.h"
#include "scatter/tables.h"
#include "stage/kernels.h"

/* Independent batches, whose spread is the error. */
enum { SKG_SCATTER_BATCHES = 32 };

/* Histories of a batch that the lattice has points for. */
#define SKG_SCATTER_HISTORIES ((int64_t)1 << 25)

/* All zero: nothing is allocated. */
typedef struct {
    skg_buffer cells, energies, momenta, angles, beam, profiles, spots, lattice, detector, sums;
    skg_scatter_args args; /* `end`: so many histories of each batch were followed */
    int32_t noise, parallel, grid, heel, bowtie;
    int32_t layers, bands, oblique, layered; /* bands: 1: there are some */
    int32_t world;
    int64_t sums_count;
} skg_tracing;

/* The grid on which photons are counted. */
void skg_trace_places(const skg_scatter_work *work, int64_t *columns, int64_t *rows);

/* How many histories of each batch follow `end` of them, whose error is above the tolerance. */
int64_t skg_trace_next(int64_t end, double error, double tolerance);

/* Uploads what a frame needs and clears the sums. columns, rows: places of the detector. */
skg_status skg_trace_begin(skg_context *context, const skg_scatter_work *work,
                           const skg_scatter_object *object, const skg_scatter_tables *tables,
                           int64_t columns, int64_t rows, skg_tracing *tracing);

/* Follows the histories of each batch up to number `end`, and waits for them. */
skg_status skg_trace_until(skg_context *context, skg_tracing *tracing, int64_t end);

/* Reads the sums: [SKG_SCATTER_BATCHES][layers][channels][SKG_SCATTER_PLANES][rows][columns]. */
skg_status skg_trace_read(skg_context *context, const skg_tracing *tracing, int64_t *sums);

void skg_trace_release(skg_tracing *tracing);
int64_t skg_trace_bytes(const skg_tracing *tracing);

#endif
