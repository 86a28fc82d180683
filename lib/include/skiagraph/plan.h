/* Plans and frames: what a scene calls for, decided once; then images, as many as wanted.
 *
 * A plan looks at scene, view, spectrum and options, decides how the image is made, compiles it and
 * allocates. A frame is one view of the scene as it stands when it is submitted: skg_plan_submit copies
 * vertices and poses, so the caller may write the next frame at once; the work runs while the caller goes on;
 * skg_job_wait waits for it. */
#ifndef SKIAGRAPH_PLAN_H
#define SKIAGRAPH_PLAN_H

#include <skiagraph/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct skg_plan skg_plan;
typedef struct skg_job skg_job;

enum { SKG_PRECISION_SINGLE = 0, SKG_PRECISION_DOUBLE = 1, SKG_PRECISION_HALF = 2 };
enum { SKG_STRATEGY_AUTO = 0, SKG_STRATEGY_COPIES = 1, SKG_STRATEGY_TILES = 2, SKG_STRATEGY_ATOMICS = 3 };

/* What a pixel holds. I0 is the same chain without parts. */
enum {
    SKG_QUANTITY_ENERGY = 0,       /* keV per pixel: the paper's "energy fluence" */
    SKG_QUANTITY_FLUENCE = 1,      /* energy fluence proper, keV/mm2 (ICRU 85) */
    SKG_QUANTITY_PHOTONS = 2,      /* photons per pixel */
    SKG_QUANTITY_TRANSMISSION = 3, /* I/I0 */
    SKG_QUANTITY_ATTENUATION = 4   /* -ln(I/I0) */
};

enum { SKG_CHANNELS_MAX = 16 };

/* What a line or a point becomes on the detector, sampled one pixel apart, the middle sample in place; scaled
 * to sum 1. Either two line spread functions, whose product is the point spread function, or the latter.
 * Sample k of n is what of a pixel's value is found k - n/2 pixels further on. Beyond its border the image
 * goes on as at the border. Numbers of samples are odd, 1 to 4095. */
typedef struct {
    int32_t size;
    int32_t reserved;           /* 0 */
    int64_t columns, rows;      /* samples along a row and along a column */
    const double *along_row;    /* [columns] line spread function */
    const double *along_column; /* [rows] line spread function */
    const double *point;        /* [rows][columns] point spread function; NULL: the two above */
} skg_detector_blur;

SKG_API void skg_detector_blur_init(skg_detector_blur *blur);

/* What becomes of an open mesh's bad pixels, where a ray does not leave it as often as it enters it. A ray
 * that goes in by one hole and out by another is not found out by this, and stays without the part but with
 * EXACT. NONE: the part is left out there. NEIGHBOURS: the mean of the part's path parameters over the
 * pixel's neighbourhood, which is grown until it holds valid pixels (Vidal and Villard 2016, 3.2.7); left out
 * where there is no valid one at all. EXACT: cast anew on the host, in double, through the mesh with each
 * loop of open edges capped by a fan about its mean; so are rays that pass a cap, which go in through one
 * hole and out through another where their hits cancel. Exact where loops are plane: any missing triangle,
 * plane holes, cracks at T-junctions, single flipped triangles; one of many surfaces where not. Submitting
 * waits for the raster of open parts. */
enum { SKG_REPAIR_NONE = 0, SKG_REPAIR_NEIGHBOURS = 1, SKG_REPAIR_EXACT = 2 };

/* Shapes of a source that is no point. Flat ones lie across the line from the source to the detector's
 * centre, their width along the projected column step. */
enum {
    SKG_SPOT_POINT = 0,
    SKG_SPOT_LINE = 1,      /* extent[0] along the width */
    SKG_SPOT_RECTANGLE = 2, /* extent[0] x extent[1] */
    SKG_SPOT_CUBE = 3,      /* extent[0] x extent[1] x extent[2], the last along the line to the detector */
    SKG_SPOT_DISC = 4,      /* diameter extent[0] */
    SKG_SPOT_SPHERE = 5,    /* filled, diameter extent[0] */
    SKG_SPOT_GAUSSIAN =
        6 /* full widths at half maximum extent[0] x extent[1] (IEC 60336's effective sizes) */
};

/* The focal spot. Prepare with skg_spot_init. Samples have equal weights, so that the open field does not
 * depend on shape or number; they follow Sobol's sequence, of which more samples continue fewer. */
typedef struct {
    int32_t size;
    int32_t shape;    /* SKG_SPOT_... */
    double extent[3]; /* mm, full widths */
    double axis[3];   /* what flat spots lie across; all 0: the line to the detector's centre */
    int64_t samples;  /* 1 to 65536; 0: doubled until two doublings in a row change 99.9 % of the pixels by
                         less than `tolerance` of the open beam, when the plan is made for its view */
    int64_t grid; /* n > 0: instead, the middles of n (line), n x n (rectangle) or n^3 (cube) equal pieces, as
                     Vidal and Villard 2016 */
    double tolerance; /* default 5e-3 */
    int64_t most;     /* samples at which doubling stops; default 1024 */
} skg_spot;

SKG_API void skg_spot_init(skg_spot *spot);

typedef struct {
    int32_t size;
    int32_t
        precision; /* SKG_PRECISION_SINGLE: float terms, exact integer sums; SKG_PRECISION_DOUBLE: fp64, refused where absent;
                             SKG_PRECISION_HALF: distances and images in 16 bits as Vidal and Villard 2016, to compare
                          with: a point source or samples of one, closed meshes */
    int32_t strategy; /* SKG_STRATEGY_...; every one gives the same bits */
    int32_t quantity; /* SKG_QUANTITY_ENERGY, ... */
    int32_t tile;     /* rows of a band or side of a square tile, in pixels; 0: the plan chooses */
    int32_t overlaps; /* 1 (default): parts that overlap or leave their parent are found and told; 0: not
                          looked for */
    int32_t profile;  /* 1: stages are timed (a little slower); 0: not */
    int32_t falloff;  /* 1: intensities fall with the cube of the distance from the source (inverse square and
                    obliquity); photon counts are meant at the pixel nearest the foot of the perpendicular */
    skg_response *response; /* of the detector; NULL: ideal. Retained by the plan */
    skg_material *world;    /* around the parts; NULL: vacuum. Retained by the plan */
    int64_t bands;          /* photon-counting bands, 0 to SKG_CHANNELS_MAX: a channel each; 0: one channel of
                              everything */
    const skg_spot *spot;   /* the source's; NULL: a point. Copied; of no effect with a parallel beam */
    int32_t supersampling;  /* n x n rays a pixel, at the middles of its pieces; 1 (default) to 16 */
    int32_t noise; /* 1: quantum noise of the photons detected in each pixel, exact where they are few */
    const double
        *band_kev;    /* [bands + 1] rising edges: band c has energies from edge c to below edge c + 1 */
    double tolerance; /* 0 (default): every energy of the spectrum, a plane per material; above, to below 1:
                         error that fewer energies and planes may make, relative where more than 1e-6 of the
                         open beam arrives, a share of 1e-6 of the open beam where less does, over the lengths
                         that the plan's view meets, and a quarter more. With noise the same
                         holds of its variance; few photons are then drawn at these energies */
    const skg_detector_blur *blur; /* copied; NULL: none */
    double swank;       /* Swank factor of the scintillator, above 0 to 1: its pulse heights widen the noise's
                           variance by 1 / swank; 1 (default): every photon gives what the response says */
    int64_t noise_seed; /* added to that of each frame */
    double electronic_kev;   /* standard deviation of the electronic noise, keV per pixel; 0: none */
    double quantum_step_kev; /* values are whole multiples of it, keV per pixel; 0: any */
    int32_t repair;          /* of open meshes: SKG_REPAIR_NEIGHBOURS (default), ... */
    int32_t clip; /* 1: a part counts only where its parent is; 0 (default): what leaves the parent subtracts
                     it */
    int64_t view_count;    /* 0 to 1024 further views that frames are to have, a sample of them: */
    const skg_view *views; /* [view_count] the error bound of a tolerance holds for the lengths that these
                              meet, too. Copied; of no effect where tolerance is 0 */
} skg_plan_options;

SKG_API void skg_plan_options_init(skg_plan_options *options);

/* Makes a plan. The scene and spectrum are retained. options may be NULL. The size of the detector (rows,
 * columns) is fixed by view; poses of source, detector and parts are free in every frame. Errors:
 * SKG_ERR_SCENE (no parts, bad view), SKG_ERR_UNSUPPORTED (double without fp64), SKG_ERR_DEVICE_MEMORY,
 * SKG_ERR_BUILD and others, with the reason. */
SKG_API skg_status skg_plan_create(skg_context *context, skg_scene *scene, const skg_view *view,
                                   skg_spectrum *spectrum, const skg_plan_options *options, skg_plan **plan);
SKG_API skg_status skg_plan_retain(skg_plan *plan);
SKG_API void skg_plan_release(skg_plan **plan);

/* From now on frames without a view of their own use this one. Same rows and columns, else SKG_STALE. */
SKG_API skg_status skg_plan_move(skg_plan *plan, const skg_view *view);

/* One frame. Prepare with skg_frame_init; all zero means: the plan's view, the scene's poses and matter. */
typedef struct {
    int32_t size;
    int32_t reserved;          /* 0 */
    const skg_view *view;      /* NULL: the plan's */
    int64_t pose_count;        /* how many parts have a pose of their own in this frame */
    const int64_t *pose_parts; /* [pose_count] numbers of parts */
    const double *poses;       /* [pose_count][16] */
    int64_t noise_seed;        /* with index: the key of the noise, where there is noise: frames of another
                                  key are independent, those of the same have the same noise */
    int64_t index;
    int64_t override_count;        /* how many parts are of other matter than their material in this frame */
    const int64_t *override_parts; /* [override_count] numbers of parts */
    const double *density_ratios;  /* [override_count] of the part over its material's, 0 to 1000; NULL: 1 */
    const double
        *fill_fractions; /* [override_count] of the part that is there, 0 to 1; the rest is of what it lies
                                     in. NULL: 1. Below 1 for parts only that no other part lies in */
} skg_frame;

SKG_API void skg_frame_init(skg_frame *frame);

enum { SKG_TYPE_FLOAT32 = 0, SKG_TYPE_FLOAT64 = 1 };

/* Where images go, as [frame][channel][row][column]. Prepare with skg_output_init: float, dense strides.
 * Strides are in elements; 0 means dense. The memory is the caller's and must stay until the job is waited
 * for. */
typedef struct {
    int32_t size;
    int32_t type; /* SKG_TYPE_FLOAT32 or SKG_TYPE_FLOAT64 */
    void *data;
    int64_t row_stride, channel_stride, frame_stride;
} skg_output;

SKG_API void skg_output_init(skg_output *output);

/* Starts `count` >= 1 frames (frames NULL: each as plan and scene stand); everything they need from meshes,
 * poses and views is copied before the call returns. The plan splits batches to fit the device's memory. *job
 * is waited for, and released, by skg_job_wait. SKG_STALE: the scene has changed in a way that the plan
 * cannot absorb (parts added, triangles); nothing was started. SKG_ERR_MESH: a vertex is not finite; part and
 * vertex are named. */
SKG_API skg_status skg_plan_submit(skg_plan *plan, int64_t count, const skg_frame *frames,
                                   const skg_output *output, skg_job **job);

/* Waits until the job's images are in their place, releases the job and sets *job to NULL. SKG_RANGE: the
 * images are there, but some pixels meet lengths outside the range that the plan's error bound was verified
 * for. */
SKG_API skg_status skg_job_wait(skg_job **job);

/* Submit and wait of one frame as the scene stands. */
SKG_API skg_status skg_plan_image(skg_plan *plan, const skg_output *output);

enum { SKG_LENGTHS_NET = 0, SKG_LENGTHS_SURFACE = 1 };

/* The path lengths of one part in mm (the L-buffer), `count` frames as in skg_plan_submit. SKG_LENGTHS_NET: minus its
 * children (the paper's Eq. 9); SKG_LENGTHS_SURFACE: the mesh's own. */
SKG_API skg_status skg_plan_lengths(skg_plan *plan, int64_t part, int32_t kind, int64_t count,
                                    const skg_frame *frames, const skg_output *output, skg_job **job);

/* A channel of this plan's images. Text valid as long as the plan. */
typedef struct {
    int32_t size;
    int32_t reserved;
    const char *name; /* "energy", "photons from 20 to 40 keV" */
    const char *unit; /* "keV per pixel" */
    double
        flat_field; /* in this unit: what the beam gives without parts (and world), where it is not weakened by
                    falloff; 1 for transmission, 0 for attenuation */
} skg_channel;

SKG_API void skg_channel_init(skg_channel *channel);
SKG_API skg_status skg_plan_channel_count(const skg_plan *plan, int64_t *channels);
SKG_API skg_status skg_plan_channel_get(const skg_plan *plan, int64_t index, skg_channel *channel);

/* What was decided. */
typedef struct {
    int32_t size;
    int32_t precision, strategy, quantity;
    int64_t parts, triangles, vertices; /* vertices: those of meshes, each mesh once */
    int64_t leaky_parts;                /* with planes of their own */
    int64_t planes, plane_bits;         /* that exponents are made of; width of an accumulator: 32 or 64 */
    int64_t tile_columns,
        tile_rows; /* shape of a tile in pixels; the whole detector for copies and atomics */
    int64_t tiles;
    double triangles_per_tile; /* mean, of the last frame; 0 before the first */
    int64_t device_bytes;      /* allocated on the device by this plan */
    int64_t samples;           /* passes a frame: of the source times those of a pixel */
    double sample_error; /* what the last doubling of source samples changed, of the open beam; 0: not found
                            out */
    int64_t bad_pixels;  /* of the last frame: signed hits of an open mesh do not cancel there */
    int64_t negative_pixels; /* of the last frame: negative exponent */
    int64_t nodes, bins;     /* energies that are used, and that the spectrum has photons at */
    double bound; /* of the error that fewer nodes and planes make, in the words of the tolerance: twice the
                     worst that was found; 0 where every bin is used */
    int64_t verified;        /* number of points (lengths of all materials) on which it was looked for */
    int64_t repaired_pixels; /* of the last frame: of the bad ones; the others are without their part */
    int64_t outside_pixels;  /* of the last job: lengths outside the range that the bound was verified for */
    int64_t accumulators; /* that parts add to, and the planes are made of: the planes themselves, or one for
                             all parts of like matter in like matter, where that is fewer additions */
} skg_plan_report;

SKG_API void skg_plan_report_init(skg_plan_report *report);
SKG_API skg_status skg_plan_report_get(const skg_plan *plan, skg_plan_report *report);

/* An energy that is used: keV; photons per pixel of an open beam that count for as much (those of the
 * spectrum where every bin is used; 0 where the detector records none of that energy); and weights[channels]:
 * photons or keV per pixel, shares of the open beam for ratios. Each may be NULL. With one channel and no
 * noise these energies and photons are a beam (skg_spectrum_create_bins) that a plan of tolerance 0 makes the same
 * image of, but for what fewer planes err: so a numerical code may keep its nodes whatever is planned later.
 */
SKG_API skg_status skg_plan_node_get(const skg_plan *plan, int64_t index, double *energy_kev, double *photons,
                                     double *weights);

/* Each effect that a plan knows: on or off, and why. Text valid as long as the plan. */
typedef struct {
    int32_t size;
    int32_t on; /* 1 or 0 */
    const char *name, *reason;
    double cost; /* estimated: what it adds to a frame, in frames of the same scene without any effect (one
                    energy, a point source, ...); below 0 what it saves. Rough: from counts of operations; 0
                    also where it costs nothing, or nothing in a frame */
} skg_effect;

SKG_API void skg_effect_init(skg_effect *effect);
SKG_API skg_status skg_plan_effect_count(const skg_plan *plan, int64_t *count);
SKG_API skg_status skg_plan_effect_get(const skg_plan *plan, int64_t index, skg_effect *effect);

/* Parts that overlap, or leave their parent, as found when the plan was made; worst volume first. Method: a
 * grid of 256 x 256 columns along z over the scene; volumes carry its resolution. */
typedef struct {
    int32_t size;
    int32_t protrudes;   /* 1: part leaves its parent `other`; 0: they overlap */
    int64_t part, other; /* numbers in the scene */
    double volume;       /* mm3 */
    double longest;      /* mm, longest chord along z */
    double place[3];     /* mm, its middle */
} skg_overlap;

SKG_API void skg_overlap_init(skg_overlap *overlap);
SKG_API skg_status skg_plan_overlap_count(const skg_plan *plan, int64_t *count);
SKG_API skg_status skg_plan_overlap_get(const skg_plan *plan, int64_t index, skg_overlap *overlap);

/* Time per stage of the last job that was waited for, where the plan was made with profile = 1. */
typedef struct {
    int32_t size;
    int32_t reserved;
    const char *name;
    double ns; /* device time, summed over the job's frames */
} skg_stage;

SKG_API void skg_stage_init(skg_stage *stage);
SKG_API skg_status skg_plan_stage_count(const skg_plan *plan, int64_t *count);
SKG_API skg_status skg_plan_stage_get(const skg_plan *plan, int64_t index, skg_stage *stage);

#ifdef __cplusplus
}
#endif
#endif
