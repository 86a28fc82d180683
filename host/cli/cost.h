/* What accuracy costs: the dials of a scene swept against the best reference that the device can give. Shared
 * by the files of `skiagraph cost`. Functions that return int return an exit status, with the sentence said.
 */
#ifndef SKG_CLI_COST_H
#define SKG_CLI_COST_H

#include "session.h"

enum {
    COST_SCENE,
    COST_PRECISION,
    COST_TOLERANCE,
    COST_BINS,
    COST_SAMPLES,
    COST_SUPERSAMPLING,
    COST_REPAIR,
    COST_TRIANGLES,
    COST_RELAXATION,
    COST_HYSTERESIS,
    COST_DIALS
};

/* What settings are compared with: all others but one thing, or one kind of things, as the scene has them. */
enum {
    COST_OF_RAYS, /* precision, tolerance, bins */
    COST_OF_SAMPLES,
    COST_OF_AREAS, /* supersampling */
    COST_OF_REPAIR,
    COST_OF_TRIANGLES,
    COST_OF_BREATH,
    COST_REFERENCES
};

enum {
    COST_MOST_POINTS = 112,
    COST_MOST_NOTES = 24,
    COST_MOST_SPECTRA = 16,
    COST_MOST_MESHINGS = 9,
    COST_TOLERANCES = 4
};
enum { COST_FINEST_BINS = 5000 }; /* the schema's largest: bins of 1 keV up to the highest voltage */

extern const char *const cost_dial_names[COST_DIALS];
extern const double cost_tolerances[COST_TOLERANCES];

typedef struct {
    int32_t precision, supersampling;
    double tolerance;
    int64_t bins;    /* MaxNumberOfEnergyBins of a tube; 0: as the scene has it */
    int64_t samples; /* of an extended source; 0: the source is a point or a grid */
    /* Negative: as the scene has it. */
    int32_t repair, meshing; /* SKG_REPAIR_...; number in study->meshings */
    int32_t relaxation;
    double hysteresis;
} cost_setting;

/* The scene with its round parts, or its parts of the generated thorax, of other numbers of triangles. */
typedef struct {
    skg_scene *scene;
    int64_t triangles; /* of all parts */
    int64_t thorax;    /* of `skiagraph thorax --triangles`; 0: round parts */
    char **settings;   /* [setting_count] "Samples.bone.Sphere.0=128" */
    int64_t setting_count;
} cost_meshing;

/* A reference image, keV per pixel in double. */
typedef struct {
    cost_setting setting;
    double *image;     /* of breath: one for each of COST_PHASES phases */
    double *positions; /* of breath only: [COST_PHASES][vertices][3] of the parts that move, mm */
    int64_t vertices;
} cost_reference;

enum { COST_PHASES = 4 }; /* of the breath, evenly from end-inspiration */

/* A setting that was timed and compared. Errors are shares: of the open beam, and of the reference's pixel.
 */
typedef struct {
    int dial, reference, on_frontier;
    cost_setting setting;
    int64_t nodes, planes, bins, runs;
    double plan_ms, min_ms, median_ms;
    double max_open, rms_open, max_ref, rms_ref;
    double max_mm, rms_mm; /* errors of path lengths, rms of rays that meet a part; of breath: displacements
                              of vertices; NaN: not looked at */
    /* [rows][columns] of the study: (I - Iref) / open, the largest of each block of pixels; the mean of I /
     * open */
    float *difference, *small;
} cost_point;

enum { COST_WHOLE_IS_RAYS, COST_WHOLE_MEASURED, COST_WHOLE_TOO_LONG };

/* For one tolerance. Numbers are of points; -1: the scene has no such dial. */
typedef struct {
    double tolerance;
    double bar; /* the tolerance, or a tenth of the noise where that is more */
    int rays;   /* the fastest whose largest error is within it, or else the best */
    int samples, supersampling, triangles; /* the cheapest whose root mean square is, or else the best */
    int repair;                            /* the cheapest whose largest error is, or else the best */
    int rays_met, sampling_met;            /* 1 or 0 */
    int whole_state;                       /* COST_WHOLE_... */
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
    int has_tube, has_energies, has_spot, has_open, has_breath;
    int64_t triangles;     /* of the scene */
    skg_body_options body; /* of a scene that breathes */
    struct {
        int64_t bins;
        skg_spectrum *spectrum;
    } spectra[COST_MOST_SPECTRA]; /* of the tube, as they were asked for: the scene is read again for each */
    int spectrum_count;
    double pass_ms;                            /* of one ray a pixel at the scene's setting */
    cost_meshing meshings[COST_MOST_MESHINGS]; /* rising; the last one is the reference */
    int meshing_count;
    cost_reference references[COST_REFERENCES];
    cost_point points[COST_MOST_POINTS];
    int count;
    char notes[COST_MOST_NOTES][512];
    int note_count;
    cost_advice advice[COST_TOLERANCES];
} cost_study;

/* --- cost_sweep.c --------------------------------------------------------------------------------------- */

/* Measures every setting. */
int cost_sweep(cost_study *study);

/* --- cost_open.c ---------------------------------------------------------------------------------------- */

/* Reads what the dials can be, and the scene's own setting. */
int cost_open(cost_study *study);
void cost_close(cost_study *study);
void cost_note(cost_study *study, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Reads the scene again with `count` more settings, KEY=VALUE. The caller releases the set-up. */
skg_status cost_load(const cost_study *study, int64_t count, const char *const *settings, skg_setup **setup);

/* The scene's spectrum with so many bins at most (0: as the scene has it); it belongs to the study. */
skg_status cost_spectrum(cost_study *study, int64_t bins, skg_spectrum **spectrum);

/* Whether the scene's tube can have so few bins. */
int cost_has_bins(cost_study *study, int64_t bins);

/* --- cost_measure.c ------------------------------------------------------------------------------------- */

/* A plan of a setting. scene NULL: the one that the setting means. */
skg_status cost_plan(cost_study *study, const cost_setting *setting, skg_scene *scene, skg_plan **plan);

/* The image of a setting, [pixels]; point: its times and what was planned, with enough runs; NULL: one run.
 */
skg_status cost_image(cost_study *study, const cost_setting *setting, double *image, cost_point *point);

/* Times of as many runs as are enough; and what was planned. */
typedef skg_status (*cost_run)(void *user);
skg_status cost_time(const cost_study *study, cost_run run, void *user, cost_point *point);
skg_status cost_report_plan(const skg_plan *plan, cost_point *point);

/* The type of the images of a precision, and its values in double, from the end in place. */
int32_t cost_type(int32_t precision);
void cost_widen(int32_t type, int64_t count, double *values);

/* Passes over the scene that one image takes. */
double cost_passes(const cost_setting *setting);

/* What one image may take, in ms, before a setting is left out. */
double cost_patience_ms(const cost_study *study);

/* --- cost_compare.c ------------------------------------------------------------------------------------- */

/* Errors of `images` images against those of a reference, and both in small. */
int cost_compare(const cost_study *study, int64_t images, const double *image, const double *reference,
                 cost_point *point);

/* Errors in mm of the path lengths of all parts, against a setting in the best precision there is. */
void cost_compare_lengths(cost_study *study, const cost_setting *reference, cost_point *point);

/* --- cost_meshing.c ------------------------------------------------------------------------------------- */

/* Remakes spheres and cylinders of 8 sectors or more, or the generated thorax, finer and coarser. */
int cost_find_meshings(cost_study *study);
void cost_meshing_free(cost_meshing *meshing);

/* --- cost_breath.c -------------------------------------------------------------------------------------- */

/* Poses and images of a setting over a breath, into the reference where point is NULL, or else compared with
 * it. */
skg_status cost_breathe(cost_study *study, const cost_setting *setting, cost_point *point, int *exit_status);

/* --- cost_advice.c -------------------------------------------------------------------------------------- */

/* Marks the frontier of the rays' settings: no other is both faster and better. */
void cost_find_frontier(cost_study *study);

/* Fills study->advice; runs what was not run yet. */
int cost_advise(cost_study *study);

/* --- cost_command.c ------------------------------------------------------------------------------------- */

/* The command line of `image` that a setting stands for, which the caller frees; NULL: no memory. */
char *cost_command(const cost_study *study, const cost_setting *setting);

/* --- cost_report.c -------------------------------------------------------------------------------------- */

extern const char *const cost_repair_names[3]; /* by SKG_REPAIR_ value */

/* What the settings of a reference change, as "precision, tolerance, bins". */
extern const char *const cost_reference_names[COST_REFERENCES];

/* "single, tolerance 0.0001, 32 bins, 16 samples, 2 x 2 rays" */
void cost_describe(const cost_study *study, const cost_setting *setting, char *text, size_t size);
void cost_print(const cost_study *study);

/* --- cost_data.c ---------------------------------------------------------------------------------------- */

json_t *cost_json(const cost_study *study);

/* The table as .csv. The caller frees the text; NULL: no memory. */
char *cost_csv(const cost_study *study);

/* --- cost_html.c ---------------------------------------------------------------------------------------- */

/* Writes a page that needs nothing from outside: plots, pictures, advice. */
int cost_write_page(const cost_study *study, const char *path);

#endif
