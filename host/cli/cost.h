/* What accuracy costs: the dials of a scene swept against the best reference that the device can give. Shared
 * by the files of `skiagraph cost`. Functions that return int return an exit status, with the sentence said.
 */
#ifndef SKG_CLI_COST_H
#define SKG_CLI_COST_H

#include "session.h"

enum { COST_SCENE, COST_PRECISION, COST_TOLERANCE, COST_BINS, COST_SAMPLES, COST_SUPERSAMPLING, COST_DIALS };
enum { COST_MOST_POINTS = 96, COST_MOST_NOTES = 16, COST_MOST_SPECTRA = 16, COST_TOLERANCES = 4 };
enum { COST_FINEST_BINS = 5000 }; /* the schema's largest: bins of 1 keV up to the highest voltage */

extern const char *const cost_dial_names[COST_DIALS];
extern const double cost_tolerances[COST_TOLERANCES];

typedef struct {
    int32_t precision, supersampling;
    double tolerance;
    int64_t bins;    /* MaxNumberOfEnergyBins of a tube; 0: as the scene has it */
    int64_t samples; /* of an extended source; 0: the source is a point or a grid */
} cost_setting;

/* A reference image, keV per pixel in double. */
typedef struct {
    cost_setting setting;
    double *image;
} cost_reference;

/* A setting that was timed and compared. Errors are shares: of the open beam, and of the reference's pixel.
 */
typedef struct {
    int dial, reference, on_frontier;
    cost_setting setting;
    int64_t nodes, planes, bins, runs;
    double plan_ms, min_ms, median_ms;
    double max_open, rms_open, max_ref, rms_ref;
    double max_mm; /* largest error of a path length of any part; NaN: not looked at */
    float *
        difference; /* (I - Iref) / open, the largest of each block of pixels; [rows][columns] of the study */
} cost_point;

enum { COST_WHOLE_IS_RAYS, COST_WHOLE_MEASURED, COST_WHOLE_TOO_LONG };

/* For one tolerance. Numbers are of points; -1: the scene has no such dial. */
typedef struct {
    double tolerance;
    double bar;                 /* the tolerance, or a tenth of the noise where that is more */
    int rays;                   /* the fastest whose largest error is within it, or else the best */
    int samples, supersampling; /* the cheapest whose root mean square is, or else the best */
    int rays_met, sampling_met; /* 1 or 0 */
    int whole_state;            /* COST_WHOLE_... */
    cost_point whole; /* rays, samples and supersampling together, against the best rays of the same number */
    char *rays_command, *whole_command;
} cost_advice;

typedef struct {
    const cli_arguments *arguments;
    cli_session session;
    int quick;
    int64_t pixels, thumb_columns, thumb_rows, thumb_block;
    int noisy;        /* 1: images have the noise that the scene asks for */
    double noise;     /* root mean square of it, of the open beam; 0: none is asked for */
    double open;      /* keV per pixel of the open beam */
    cost_setting own; /* the scene's */
    int64_t finest;   /* bins of the reference: 0 or COST_FINEST_BINS */
    int has_tube, has_energies, has_spot;
    struct {
        int64_t bins;
        skg_spectrum *spectrum;
    } spectra[COST_MOST_SPECTRA]; /* of the tube, as they were asked for: the scene is read again for each */
    int spectrum_count;
    double pass_ms;               /* of one ray a pixel at the scene's setting */
    cost_reference references[3]; /* of the rays; of source samples; of supersampling */
    cost_point points[COST_MOST_POINTS];
    int count;
    char notes[COST_MOST_NOTES][512];
    int note_count;
    cost_advice advice[COST_TOLERANCES];
} cost_study;

/* --- cost_measure.c ------------------------------------------------------------------------------------- */

/* Reads what the dials can be, and the scene's own setting. */
int cost_open(cost_study *study);
void cost_close(cost_study *study);
void cost_note(cost_study *study, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The image of a setting, [pixels]; point: its times and what was planned, with enough runs; NULL: one run.
 */
skg_status cost_image(cost_study *study, const cost_setting *setting, double *image, cost_point *point);

/* Errors of an image against a reference, and the difference in small. */
int cost_compare(const cost_study *study, const double *image, const double *reference, cost_point *point);

/* Largest error in mm of the path lengths of all parts at a precision; NaN where it has none. */
double cost_length_error(cost_study *study, int32_t precision);

/* Whether the scene's tube can have so few bins. */
int cost_has_bins(cost_study *study, int64_t bins);

/* Passes over the scene that one image takes. */
double cost_passes(const cost_setting *setting);

/* What one image may take, in ms, before a setting is left out. */
double cost_patience_ms(const cost_study *study);

/* --- cost_advice.c -------------------------------------------------------------------------------------- */

/* Marks the frontier of the rays' settings: no other is both faster and better. */
void cost_find_frontier(cost_study *study);

/* Fills study->advice; runs what was not run yet. */
int cost_advise(cost_study *study);

/* --- cost_report.c -------------------------------------------------------------------------------------- */

/* "single, tolerance 0.0001, 32 bins, 16 samples, 2 x 2 rays" */
void cost_describe(const cost_setting *setting, char *text, size_t size);
void cost_print(const cost_study *study);
json_t *cost_json(const cost_study *study);

/* The table as .csv. The caller frees the text; NULL: no memory. */
char *cost_csv(const cost_study *study);

/* --- cost_html.c ---------------------------------------------------------------------------------------- */

/* Writes a page that needs nothing from outside: plots, pictures, advice. */
int cost_write_page(const cost_study *study, const char *path);

#endif
