/* Contents of a set-up: the sections of its scene file as they were read. Private. */
#ifndef SKG_SETUP_TYPES_H
#define SKG_SETUP_TYPES_H

#include "body/parameters.h"
#include "core/core.h"

#include <skiagraph/breathing.h>
#include <skiagraph/readout.h>
#include <skiagraph/setup.h>

/* The section Scan. */
typedef struct {
    skg_scan *scan;       /* NULL: the file has no Scan */
    int32_t has_count;    /* 1: it says how many projections there are */
    int32_t flat_field;   /* as given, without effect */
    int64_t white_images; /* as given, without effect */
    char *folder;         /* OutFolder relative to the scene file's own, or NULL */
    int64_t view_count;
    skg_view *views;     /* [view_count] a sample of the projections after the first */
    skg_scan *known;     /* KnownTable, or NULL */
    double *intensities; /* [projections], or NULL */
    int64_t flats, flat_frames, darks, dark_frames;
    int32_t flat_noise, dark_noise, fields, ctsimu;
    int64_t moving_count; /* samples with Poses */
    int64_t *moving;      /* [moving_count] their parts */
    double *poses;        /* [projections][moving_count][16] */
} skg_scan_section;

/* The key GreyValues of the detector. */
typedef struct {
    int32_t is_given;
    skg_readout readout; /* points to the arrays below */
    double *curve, *noise, *lag, *ghosting;
    float *bad_pixels, *gain, *offset;
} skg_grey_section;

/* A value over time: linear between its points (s, value), constant beyond them. */
typedef struct {
    double *points; /* [count][2], times rising */
    int64_t count;  /* 0: not given */
} skg_curve;

/* The key Fit of Breathing: what the verb fit searches. */
typedef struct {
    int32_t chooses; /* 1: chosen is given; otherwise all are fitted */
    int32_t chosen[BODY_PARAMETERS];
    int32_t has_range[BODY_PARAMETERS];
    double low[BODY_PARAMETERS], high[BODY_PARAMETERS];
} skg_body_fit_section;

/* The section Breathing; without it the defaults. */
typedef struct {
    skg_breath breath; /* its samples and holds point to those below */
    skg_body_options body;
    double *samples;
    double *signal; /* recorded; NULL: none */
    skg_breath_hold *holds;
    int32_t lung_density; /* 1: the lungs keep their mass */
    int32_t is_given;     /* 1: the file has it */
    int64_t organ_count;
    struct skg_breathing_organ {
        int64_t part;
        char *as;        /* label whose rule the organ follows; NULL: its own */
        skg_organ organ; /* kind, tissue, rotation and links; no mesh */
        char **to;       /* labels to which the links point */
        skg_organ_link *links;
    } * organs;
    skg_body_fit_section fit;
    skg_curve weight; /* factor on the weights of both channels */
    skg_curve needle; /* depth below the skin, mm */
    int64_t contrast_count;
    struct skg_breathing_contrast {
        int64_t part;
        skg_curve fill_fraction;
    } * contrasts;
} skg_breathing_section;

/* The key Noise. None: all is 0 but swank, which is 1. */
typedef struct {
    int32_t quantum, reserved;
    double electronic_kev, step_kev, swank;
    int64_t seed;
} skg_setup_noise;

/* LSF, PSF or MTF. */
typedef struct {
    skg_detector_blur shape;
    double *samples; /* to which shape points */
} skg_setup_blur;

/* A file that the scene names. */
typedef struct {
    char *name; /* as the scene has it */
    char *path; /* where it was read */
} skg_setup_file;

struct skg_setup {
    skg_setup_file *files;
    int64_t file_count;
    skg_scene *scene;
    skg_spectrum *spectrum;
    int32_t absolute;       /* 1: photons come from mAs */
    int32_t falloff;        /* enum skg_falloff */
    skg_response *response; /* NULL: ideal */
    skg_counter *counter;   /* NULL: the detector integrates energy */
    skg_material *world;    /* around the parts; NULL: vacuum */
    skg_setup_blur blur;    /* columns 0: none */
    skg_depth_blur depths;  /* of the scintillator; count 0: none */
    double depth_to[SKG_DEPTHS_MAX];
    skg_setup_blur depth_blurs[SKG_DEPTHS_MAX];
    skg_detector_blur depth_shapes[SKG_DEPTHS_MAX]; /* of these */
    skg_dqe dqe;                                    /* by frequency; count 0: none */
    double *dqe_columns;
    skg_setup_noise noise;
    skg_grey_section grey;
    skg_spot spot;
    /* Options that the file sets, which replace the caller's: precision, tolerance, repair, band_weight (negative: the file does not have
     * the key), heel, bowtie, grid, collimation, scatter (those below; NULL: it does not have the key). */
    skg_plan_options said;
    skg_heel heel;     /* kvp, anode, angle and bins are those of the tube, if the beam is one */
    int32_t has_tube;  /* 1: the beam is a tube */
    skg_bowtie bowtie; /* its material is the set-up's, its rows are those below */
    double *bowtie_rows;
    skg_grid grid; /* its materials are the set-up's */
    skg_collimation collimation;
    skg_scatter scatter;
    int32_t oblique;       /* 1: rays cross the scintillator obliquely */
    int32_t supersampling; /* rays along a side of a pixel */
    int32_t bins_once;     /* 1: electronic noise is that of a bin */
    /* behind a blur: the variance of a bin over that of the sum of blurred pixels; 0: no blur */
    double bins_variance;
    int64_t bins[2]; /* sensor pixels of a pixel, along a row and along a column */
    skg_view view;   /* of the first projection */
    skg_scan_section scan;
    skg_breathing_section breathing;
    int32_t clip, unite, world_scatter_off;
    int32_t orient;   /* 1: inverted components of meshes are turned */
    int32_t as_wound; /* 1: triangles that are wound otherwise than their neighbours are not */
    char *text;       /* the scene file after its settings, with its keys in order */
};

/* Overwrites an organ, but for mesh and inside, with what the key Organs says of a part, if it does. */
void skg_setup_describe_organ(const skg_breathing_section *section, int64_t part, skg_organ *organ);

#endif
