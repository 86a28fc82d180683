/* Study of accuracy and time: the dials of a scene, swept against the best reference that the device can give. In
 * this folder a function that returns int returns an exit status and prints the error. */
#ifndef SKG_CLI_COST_STUDY_H
#define SKG_CLI_COST_STUDY_H

#include "session/prediction.h"
#include "session/sensitivity.h"
#include "session/session.h"

#include <skiagraph/breathing.h>

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

/* The references. Each varies one dial, or one kind of dials, and has all others as the scene has them; the last one has
 * the best of every dial. */
enum {
    COST_OF_RAYS, /* precision, tolerance, bins */
    COST_OF_SAMPLES,
    COST_OF_AREAS, /* supersampling */
    COST_OF_REPAIR,
    COST_OF_TRIANGLES,
    COST_OF_BREATH,
    COST_OF_ALL,
    COST_REFERENCES
};

enum {
    COST_POINTS_MAX = 144,
    COST_SHOTS_MAX = 144,
    COST_VISITS_MAX = 6,
    COST_RUNS_MAX = 240,
    COST_NOTES_MAX = 24,
    COST_SPECTRA_MAX = 16,
    COST_MESHINGS_MAX = 9,
    COST_TOLERANCES = 4
};
enum { COST_UNITE = 3 };          /* added to a repair: components are united */
enum { COST_FINEST_BINS = 5000 }; /* the schema's largest: gives bins of 1 keV at every voltage */
enum {
    COST_SEVERAL = COST_DIALS
}; /* instead of a dial: a setting that differs from the scene's in several */

typedef struct {
    int32_t precision, supersampling;
    double tolerance;
    int64_t bins;    /* MaxNumberOfEnergyBins of a tube; 0: as the scene has it */
    int64_t samples; /* of an extended source; 0: the source is a point or a grid */
    /* Negative: as the scene has it. */
    int32_t repair, meshing; /* SKG_REPAIR_..., + COST_UNITE; number in study->meshings */
    int32_t relaxation;
    double hysteresis;
} cost_setting;

/* The scene in which the round parts, or the parts of the generated thorax, have another number of triangles. */
typedef struct {
    skg_scene *scene;  /* NULL: not made yet */
    int64_t triangles; /* of all parts */
    int64_t thorax;    /* the N of `skiagraph thorax --triangles N`; 0: round parts */
    char **settings;   /* [setting_count] "Samples.bone.Sphere.0=128" */
    int64_t setting_count;
} cost_meshing;

/* A reference image, keV per pixel in double. */
typedef struct {
    cost_setting setting;
    double *image;     /* [pixels]; for breathing dials [COST_PHASES][pixels] */
    double *positions; /* for breathing dials: [COST_PHASES][vertices][3] of the parts that move, mm */
    int64_t vertices;
} cost_reference;

enum { COST_PHASES = 4 }; /* evenly over the breath, from end-inspiration */

/* A setting that was computed and timed. Each setting is a shot once, whichever points it belongs to. */
typedef struct {
    cost_setting setting;
    skg_plan *plan; /* kept for further visits while memory suffices, otherwise NULL */
    int64_t nodes, planes, bins, device_bytes;
    double plan_ms;
    /* Times of single runs, in the order in which they were measured, on the wall and by the clock of prices (clock.h). A visit is
     * a number of runs in a row; visits to different shots alternate. */
    int64_t frames; /* of a run; times are those of one frame */
    int64_t runs, visits;
    double run_wall_ms[COST_RUNS_MAX], run_price_ms[COST_RUNS_MAX];
    double wall_now_ms;              /* the median of run_wall_ms: what one waits on the machine as it is */
    double price_ms, uncertainty_ms; /* what an image takes on an idle machine; cost_find_price */
    /* Errors against the reference COST_OF_ALL, as fractions of the flat field. NaN: not compared. */
    double total_rms, total_max;
    /* Small pictures, [thumb_rows][thumb_columns], in fractions of the flat field: of each block of pixels the difference from
     * COST_OF_ALL that is largest in magnitude, and the mean intensity. NULL: none. */
    float *difference, *small;
    int on_frontier; /* 1: no other shot is both faster and nearer to COST_OF_ALL */
    char *command;
} cost_shot;

enum { COST_PLANNED, COST_MEASURED, COST_LEFT_OUT };

/* A setting that was compared with a reference. */
typedef struct {
    int dial, reference, on_frontier;
    int priority; /* those with a small one are measured first */
    int state;    /* COST_PLANNED ... */
    int shot;     /* number in study->measured.shots; negative: not measured */
    cost_setting setting;
    /* Errors as fractions: of the flat field, and of the reference's pixel. */
    double max_flat, rms_flat, max_ref, rms_ref;
    /* Errors of path lengths, the root mean square over rays that meet a part. For breathing dials: errors of
     * the vertices' positions. NaN: not measured. */
    double max_mm, rms_mm;
    float *difference; /* as of a shot, from the point's own reference */
} cost_point;

/* Sources of the difference between today's image and the true one. */
enum {
    COST_SOURCE_TRIANGLES,
    COST_SOURCE_PRECISION,
    COST_SOURCE_BINS,
    COST_SOURCE_TOLERANCE,
    COST_SOURCE_SAMPLES,
    COST_SOURCE_SUPERSAMPLING,
    COST_SOURCE_REPAIR,
    COST_SOURCE_SURFACE,
    COST_SOURCE_SCATTER,
    COST_SOURCES
};

enum {
    COST_ABSENT,       /* the scene has no such error */
    COST_NOT_KNOWN,    /* no run can measure it */
    COST_NOT_MEASURED, /* for want of time, double precision or memory */
    COST_COARSE,       /* against a setting that is somewhat better, or of another mesh */
    COST_FINE          /* against the reference of the dial */
};

/* A source of error in the coarse pass, which measures no times. */
typedef struct {
    int state;         /* COST_NOT_MEASURED or COST_COARSE */
    double error, max; /* as of a source */
    float *difference; /* as of a shot */
    char compared[96]; /* with what: "84000 triangles" */
    char reason[192];  /* why it is not measured */
} cost_coarse;

typedef struct {
    int state;         /* COST_ABSENT ... */
    double error, max; /* root mean square and largest, as fractions of the flat field; NaN: not measured */
    int own, halving;  /* points: of today's setting and of the fastest with half of its error; -1: none */
    /* what `halving` adds to the price of an image; NaN: nothing halves it */
    double halving_ms, halving_uncertainty_ms;
    char buys[96];    /* the dial's value that halves it: "84000 triangles" */
    char reason[320]; /* why something is not known or not measured, or why the error is 0 */
    char *command;    /* NULL: none */
} cost_source;

enum { COST_WHOLE_IS_RAYS, COST_WHOLE_MEASURED, COST_WHOLE_TOO_LONG };

/* The advice for one tolerance. */
typedef struct {
    double tolerance;
    double bar; /* the larger of the tolerance and a tenth of the noise */
    int rays;   /* the fastest whose largest error is within the bar, otherwise the most accurate */
    /* Of samples, supersampling, repair and triangles: the point with the least work whose error is within the bar, otherwise the
     * most accurate; -1: the scene has no such dial. The error is the largest one of a repair, otherwise the root mean square. */
    int chosen[COST_DIALS];
    int rays_met, sampling_met; /* 1 or 0 */
    int whole_state;            /* COST_WHOLE_... */
    cost_point whole;           /* all of these together, against the best rays of the same number */
    char *rays_command, *whole_command;
    char reason[512]; /* why the tolerance is not reached; empty: it is */
} cost_advice;

enum { COST_SCATTER_PRICES = 3 };

/* seconds: NaN: not known; is_measured: 0: estimated from a coarser one. */
typedef struct {
    double tolerance, seconds;
    int is_measured;
} cost_scatter_price;

/* Error of images without scatter, and prices of images with it. */
typedef struct {
    cli_prediction prediction;
    cost_scatter_price prices[COST_SCATTER_PRICES];
    char refusal[320]; /* why the scene's images cannot have scatter; empty: they can */
} cost_scattering;

/* Images with linear values between the cells of volumes, beside those with one value a cell: how they differ, as fractions of the flat
 * field, and their prices. */
typedef struct {
    int is_known;
    double max, rms, ms[2], uncertainty_ms[2]; /* of cells, of linear values */
} cost_between;

/* Facts of the scene, its dials, and its own setting. */
typedef struct {
    int noisy;         /* 1: images have the scene's noise */
    double noise;      /* its root mean square, as a fraction of the flat field; 0: the scene has none */
    double flat_field; /* keV per pixel */
    cost_setting own;  /* the scene's own setting */
    int64_t finest;    /* bins of the reference: 0 or COST_FINEST_BINS */
    int has_tube, has_energies, has_spot, has_leaky, has_shells, has_breath, has_volume;
    const skg_scatter *own_scatter; /* of the scene, whose images are computed without; NULL: it has none */
    int64_t triangles;              /* of the scene */
    skg_body_options body;          /* if has_breath */
    int is_thorax;    /* 1: the scene is the generated thorax; -1: the time did not suffice to find out */
    int has_round;    /* 1: it is, may be, or has a sphere or a cylinder */
    double thorax_ms; /* that generating one with this number of triangles took */
    int64_t thorax_made;
    int thorax_is_simple; /* 1: the thorax of the scene is that of `thorax --simple` */
} cost_subject;

/* Images, their prices and their errors: what runs gave. */
typedef struct {
    cost_scattering scattering;
    cost_between between;        /* if the scene has volumes */
    cli_sensitivity sensitivity; /* if it is wanted */
    double pass_ms;              /* of one ray per pixel at the scene's setting */
    double best_pass_ms;         /* the same with the best precision and every energy */
    double plan_ms;              /* of the scene's setting */
    cost_coarse coarse[COST_SOURCES];
    cost_reference references[COST_REFERENCES];
    cost_point points[COST_POINTS_MAX];
    int count;
    cost_shot shots[COST_SHOTS_MAX];
    int shot_count;
    int here;           /* the shot of the scene as its file has it */
    int64_t kept_bytes; /* of the plans that are kept */
    double *pulse_ms;   /* [pulse_count] prices of the scene's own image, taken between visits */
    int64_t pulse_count, pulse_capacity;
} cost_measured;

/* Findings: sources of error, advice, and how far the numbers are to be trusted. */
typedef struct {
    double unrest; /* interquartile range of the pulses over their median; NaN: fewer than 4 */
    /* Of the reference COST_OF_ALL, root mean square, estimated from its neighbours; NaN: not known. */
    double reference_error;
    double grey_levels; /* of 256 in a PNG of transmission, for a whole flat field; 0: not known */
    cost_source sources[COST_SOURCES];
    int largest;     /* the source with the largest error; -1: none is known */
    int buy, saving; /* shots that are worth changing to; -1: none */
    char summary[1024];
    cost_advice advice[COST_TOLERANCES];
} cost_judged;

typedef struct {
    const cli_arguments *arguments;
    cli_session session;
    int quick;
    int sensitive; /* 1: sensitivity is wanted */
    /* On the clock of cli_now_ms, the time that was given, and the clock at the end. */
    double begun_ms, within_ms, ended_ms;
    int has_processor_clock; /* 1: prices are processor times (clock.h) */
    int stopped;             /* 1: by a signal */
    int64_t left_out;        /* settings that the time did not suffice for */
    int64_t planned;         /* settings that were to be measured */
    int64_t frames;          /* of a batch; 1: single images */
    double *batch;           /* [frames][pixels], for timing batches */
    int64_t pixels, thumb_columns, thumb_rows, thumb_block;
    struct {
        int64_t bins;
        skg_spectrum *spectrum;
    } spectra[COST_SPECTRA_MAX]; /* of the tube, each made when it was first needed */
    int spectrum_count;
    cost_meshing meshings[COST_MESHINGS_MAX]; /* rising in triangles; the last one is the reference */
    int meshing_count;
    char triangles_reason
        [192]; /* why no finer mesh was made; empty: there are finer ones, or no round parts */
    char notes[COST_NOTES_MAX][512];
    int note_count;
    cost_subject subject;
    cost_measured measured;
    cost_judged judged;
} cost_study;

extern const char *const cost_repair_names[2 * COST_UNITE]; /* by the repair of a setting */
extern const double cost_tolerances[COST_TOLERANCES];

/* The name of a setting's precision. */
const char *cost_precision_name(const cost_setting *setting);

/* Milliseconds until the share of the given time has passed; 0 or less: it has, or a signal asked to stop. */
double cost_left_ms(const cost_study *study, double share);

/* Time left for the coarse pass, which must leave time for the reference that everything needs. */
double cost_coarse_left_ms(const cost_study *study);

/* Why something was not measured, if the time or a signal is the reason. */
const char *cost_time_reason(void);

/* Whether two settings mean the same image. */
int cost_is_same(const cost_study *study, const cost_setting *a, const cost_setting *b);

/* The dial in which a setting differs from the scene's own; COST_SCENE: none, COST_SEVERAL: more than one. */
int cost_changed_dial(const cost_study *study, const cost_setting *setting);

/* The name of a dial, or "several". */
const char *cost_dial_name(int dial);

/* The dial's value in words: "84000 triangles", "2 x 2 rays". */
void cost_describe_dial(const cost_study *study, const cost_setting *setting, int dial, char *text,
                        size_t size);

/* A setting's repair, which may be the scene's; and its name. */
int32_t cost_repair(const cost_study *study, const cost_setting *setting);

/* Whether a setting is priced and never recommended: components add where the scene unites them, which is another body. */
int cost_is_other_body(const cost_study *study, const cost_setting *setting);
const char *cost_repair_of(const cost_study *study, const cost_setting *setting);

/* Triangles of a setting. */
int64_t cost_triangles(const cost_study *study, const cost_setting *setting);

/* Keeps a sentence for the report, up to COST_NOTES_MAX of them. */
void cost_note(cost_study *study, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Appends to text, as far as it fits. */
void cost_append(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));

/* "single, tolerance 0.0001, 32 bins, 16 samples, 2 x 2 rays" */
void cost_describe(const cost_study *study, const cost_setting *setting, char *text, size_t size);

/* Reads the scene again with `count` more settings, KEY=VALUE. The caller releases the set-up. */
skg_status cost_load(const cost_study *study, int64_t count, const char *const *settings, skg_setup **setup);

/* A setting of a part: "Samples.bone." and the words of the format. A part without a label, which has its mesh's name instead, is named by
 * its number. The caller frees it; NULL if memory is exhausted. */
char *cost_part_setting(const skg_part *part, int64_t number, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The scene's spectrum with at most `bins` bins (0: as the scene has it). It belongs to the study. */
skg_status cost_spectrum(cost_study *study, int64_t bins, skg_spectrum **spectrum);

/* Whether the scene's tube can have that few bins. */
int cost_has_bins(cost_study *study, int64_t bins);

/* Triangles of all parts. */
skg_status cost_count_triangles(const skg_scene *scene, int64_t *triangles);

void cost_meshing_free(cost_meshing *meshing);

#endif
