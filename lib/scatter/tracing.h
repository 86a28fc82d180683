/* Histories on the device, and their result in the image's units. Private. */
#ifndef SKG_TRACING_H
#define SKG_TRACING_H

#include "scatter/beams.h"
#include "scatter/interactions.h"
#include "scatter/smoothing.h"
#include "scatter/subject.h"
#include "stage/kernels.h"

/* --- Histories of photons on the device. */

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

/* --- Scatter as images: per pixel, in the units of the stages and of the plan's quantity. */

typedef struct {
    const skg_scatter_work *work;
    const skg_cosines *mean;     /* [channels]; NULL: nothing scatters */
    const skg_cosines *staged;   /* [layers][channels] */
    const skg_cosines *variance; /* [layers][channels]; NULL: without noise */
    double photons;              /* that a sum of 1 stands for: photons of the spectrum per pixel */
    double signal, power;        /* what a photon of 1 in the tables adds to the image and to its variance */
} skg_shown_scatter;

/* [channels][rows][columns] floats on the device each, and what they are on average. All zero: none. */
typedef struct {
    skg_buffer mean,
        variance; /* what each layer of images gets, before detector and quantity; variance: with noise alone */
    skg_buffer shown, sigma; /* in the plan's quantity */
    skg_buffer component;    /* likewise; the one that was asked for last */
    double average;          /* of `shown`, over the channels */
    double error;            /* root mean square of sigma */
} skg_scatter_images;

/* Fills the images, but for the component. */
skg_status skg_shown_scatter_send(skg_context *context, const skg_shown_scatter *shown,
                                  skg_scatter_images *images);
/* Fills images->component. shown->mean: [channels][SKG_SCATTER_KINDS] */
skg_status skg_shown_component_send(skg_context *context, const skg_shown_scatter *shown, int component,
                                    skg_scatter_images *images);
void skg_scatter_images_release(skg_scatter_images *images);
int64_t skg_scatter_images_bytes(const skg_scatter_images *images);

#endif
