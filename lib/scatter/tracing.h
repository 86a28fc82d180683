/* Histories on the device, and their result in the image's units. Private. */
#ifndef SKG_TRACING_H
#define SKG_TRACING_H

#include "scatter/beams.h"
#include "scatter/smoothing.h"
#include "stage/kernels.h"

/* --- Tables of a frame's photons as the device has them. */

typedef struct {
    float (*energies)[SKG_SCATTER_RANK]; /* [energies][SKG_SCATTER_COLUMNS], then [energies][shells] */
    int64_t energy_rows;                 /* of both */
    float (*momenta)[SKG_SCATTER_RANK];  /* [momenta][2] S, F^2 */
    float *angles;                       /* [SKG_ANGLE_ROWS][SKG_SCATTER_ANGLES + 1] */
    float (*beam)
        [4]; /* [bins] keV, share of the photons that are followed up to here, weight, 1/mm of a bow-tie filter; then [lines] of shells */
    int64_t bins, lines;
    skg_beam_profile profile;
    float *profiles; /* [profile_count] as kernels/scatter/profile.clh has them; NULL: none */
    int64_t profile_count;
    /* [detector_count] as kernels/scatter/scatter.cl has it; NULL: neither bands, nor layers, nor oblique */
    float *detector;
    int64_t detector_count;
    int32_t bands, layers, cosines, oblique; /* images of a frame; of the table of layers: 0: none */
    double photons;                          /* of the spectrum, those that leave towards the field */
    double signal, variance;                 /* what 1 in the columns of what a photon adds stands for */
} skg_scatter_tables;

/* More photons are followed of energies that add more to the image. Free the tables also after a failure. */
skg_status skg_scatter_tables_make(const skg_scatter_work *work, const skg_scatter_object *object,
                                   skg_scatter_tables *tables);
void skg_scatter_tables_free(skg_scatter_tables *tables);

/* --- Histories of photons on the device. */

/* Independent batches, whose spread is the error. */
enum { SKG_SCATTER_BATCHES = 32 };

/* Histories of a batch that the lattice has points for. */
#define SKG_SCATTER_HISTORIES ((int64_t)1 << 25)

/* All zero: nothing is allocated. */
typedef struct {
    skg_buffer media, tree, faces, energies, momenta, angles, beam, profiles, spots, lattice, detector, sums;
    skg_scatter_args args;   /* `end`: so many histories of each batch were followed */
    int32_t parallel, fours; /* fours: of coefficients in a mixture */
    int64_t sums_count;
    skg_progress *progress; /* of the frame, whose caller owns it; NULL: none */
} skg_tracing;

/* The grid on which photons are counted. */
void skg_trace_places(const skg_scatter_work *work, int64_t *columns, int64_t *rows);

/* Rounds of histories, each of which says how many the next one needs. */
typedef struct {
    int32_t is_fixed, gave_up; /* is_fixed: one round; gave_up: the tolerance is out of reach */
    double tolerance, last_error;
    int64_t end, last_end; /* histories of each batch: after this round; after the one before */
} skg_rounds;

/* first: histories of each batch in the first round; tolerance: of histories, over the mean */
skg_rounds skg_rounds_begin(const skg_scatter *asked, int64_t first, double tolerance);

/* Whether another round follows one that has reached an error, up to rounds->end. */
int skg_rounds_next(skg_rounds *rounds, double error);

/* Warns of rounds that gave up. error: what is stated */
void skg_rounds_warn(const skg_context *context, const skg_rounds *rounds, const skg_scatter *asked,
                     double error);

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
    /* what each layer of images gets, before detector and quantity; variance: with noise alone */
    skg_buffer mean, variance;
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

/* --- Scatter of a series of frames, from few of them. */

struct skg_scatter_series {
    skg_refs refs;
    skg_recipe *recipe;       /* retained */
    int64_t number;           /* no other series of the process has it */
    int64_t owner;            /* of the plan's scatterer */
    skg_joint mean, variance; /* in photons of the spectrum; variance: with noise alone */
    double signal, power;     /* as of skg_shown_scatter */
    skg_scatter_series_report report;
};

/* Describes frame `index` of a series; what *work points to must stay until the next call. */
typedef skg_status (*skg_series_frame)(int64_t index, skg_scatter_work *work, void *user);

/* Fills a series whose recipe is set. *is_smooth: 0: neighbouring frames differ too much, and nothing was filled in */
skg_status skg_series_make(skg_context *context, int64_t count, skg_series_frame frame, void *user,
                           skg_scatter_series *series, int32_t *is_smooth);
void skg_series_drop(skg_scatter_series *series);

#endif
