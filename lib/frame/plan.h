/* The inside of a plan. Private to lib/plan. */
#ifndef SKG_PLAN_PRIVATE_H
#define SKG_PLAN_PRIVATE_H

#include "frame/job.h"
#include "geometry/caps.h"
#include "geometry/overlap.h"
#include "geometry/samples.h"
#include "geometry/scale.h"
#include "plan/meshes.h"
#include "spectral/mix.h"
#include "spectral/model.h"
#include "spectral/quantity.h"
#include "stage/attenuate.h"
#include "stage/blur.h"
#include "stage/hits.h"
#include "stage/noise.h"

/* Effects that a plan knows, in the order in which they are reported. */
#define SKG_EFFECT_LIST(X)                                                                                   \
    X(SKG_EFFECT_ENERGIES, "several energies")                                                               \
    X(SKG_EFFECT_SOURCE, "extended source")                                                                  \
    X(SKG_EFFECT_SUPERSAMPLING, "supersampling")                                                             \
    X(SKG_EFFECT_WORLD, "world material")                                                                    \
    X(SKG_EFFECT_RESPONSE, "energy response")                                                                \
    X(SKG_EFFECT_FALLOFF, "falloff")                                                                         \
    X(SKG_EFFECT_COMPRESSION, "spectral compression")                                                        \
    X(SKG_EFFECT_NESTING, "nesting")                                                                         \
    X(SKG_EFFECT_OPEN, "open meshes")                                                                        \
    X(SKG_EFFECT_REPAIR, "repair")                                                                           \
    X(SKG_EFFECT_SOURCE_PLANE, "source plane")                                                               \
    X(SKG_EFFECT_OVERLAPS, "overlap check")                                                                  \
    X(SKG_EFFECT_NOISE, "quantum noise")                                                                     \
    X(SKG_EFFECT_BLUR, "blur")                                                                               \
    X(SKG_EFFECT_ELECTRONIC, "electronic noise")                                                             \
    X(SKG_EFFECT_QUANTISATION, "quantisation")                                                               \
    X(SKG_EFFECT_PRIORITY, "priority")

enum {
#define SKG_EFFECT_ENUM(name, text) name,
    SKG_EFFECT_LIST(SKG_EFFECT_ENUM)
#undef SKG_EFFECT_ENUM
        SKG_EFFECTS
};

typedef struct {
    int32_t on;
    double cost; /* estimated, in frames without any effect */
    char reason[256];
} skg_effect_state;

/* Time of a stage in the last job. */
typedef struct {
    const char *name; /* static storage */
    double ns;
} skg_stage_time;
enum { SKG_MOST_STAGES = 32 };

/* What the beam gives without parts and noise, where noisy images are shown over it and it differs from pixel
 * to pixel (field.c). */
typedef struct {
    int32_t wanted;
    int32_t known; /* for this view and type */
    int32_t is_double, reserved;
    skg_view view;
    skg_buffer image; /* [channels][rows][columns] */
} skg_open_field;

/* Rasterisers compiled so far, by what they can do: sums of 32 or 64 bits, point or parallel beam, ... */
enum { SKG_MOST_RASTERS = 16 };

/* Memory for what a frame knows of its parts: a million of them take as long to allocate as to fill
 * (frame.c). */
typedef struct skg_frame_room skg_frame_room;
void skg_frame_room_release(skg_frame_room **room);

struct skg_plan {
    skg_refs refs;
    skg_context *context;   /* retained */
    skg_scene *scene;       /* retained */
    skg_spectrum *spectrum; /* retained */
    skg_plan_options options;
    skg_view view;
    int64_t structure; /* of the scene when the plan was made: another one is stale */
    int64_t materials; /* of the scene that the model is of */
    double *band_kev;  /* [bands + 1] */
    skg_view *views;   /* [view_count] further ones */

    skg_plan_meshes meshes;
    skg_geometry geometry;
    skg_model model;
    struct {
        char text[64];
    } * channel_names; /* [channels] */
    skg_samples samples;
    int32_t mixed;               /* accumulators that the planes of images are mixed from; 0: they are not */
    skg_buffer mix_lists;        /* as the last image's frame had them; on the host: */
    double *mix_sent;            /* [mixed][planes] NULL: nothing was sent so far */
    skg_attenuation attenuation; /* of images */
    skg_attenuation lengths;     /* of path lengths: the plane itself */
    skg_attenuator *attenuator;
    skg_blur *blur;         /* NULL: none */
    skg_detector *detector; /* NULL: what is attenuated and blurred is shown */
    skg_open_field field;
    int64_t open_count;
    int64_t *open;  /* [open_count] parts that are not closed */
    skg_caps *caps; /* [open_count] what closes them; NULL: not needed so far */
    int32_t *told;  /* [open_count] digits of the most bad pixels that were warned of; NULL: of none so far */
    skg_scale_grid grid;
    skg_frame_room *room; /* what frames use one after the other; NULL before the first */
    int32_t strategy;     /* decided */
    const char *strategy_reason;
    int32_t raster_count, next_raster;
    skg_raster *rasters[SKG_MOST_RASTERS];
    skg_raster_options raster_options[SKG_MOST_RASTERS];
    skg_raster *main; /* of the last frame: that of the closed parts */
    skg_buffer image, negative;
    skg_buffer bad;        /* [open_count][1 + SKG_FIRST_BAD] verdicts */
    skg_buffer open_table; /* of the batch of open parts at hand, as skg_open_add takes it */
    skg_buffer gaps;       /* and as skg_open_gaps leaves them */

    int32_t priority_possible; /* priorities differ, or children are clipped */
    skg_priority_memory priority_memory;

    int64_t overlap_count;
    skg_overlap_pair *overlaps;
    skg_effect_state effects[SKG_EFFECTS];
    skg_plan_report report;
    int64_t stage_count;
    skg_stage_time stages[SKG_MOST_STAGES];
    int32_t told_unseen; /* that nothing falls on the detector has been told */
};

/* Names the channels of the model, by the caller's bands (channel.c). */
skg_status skg_plan_name_channels(skg_plan *plan);

/* Whether images are means over several passes: of samples of the source or of pixels. */
int skg_plan_averages(const skg_plan *plan);

/* Doubles the samples of the source until its tolerance is met at the plan's view, where they are not given
 * (doubling.c). */
skg_status skg_plan_find_samples(skg_plan *plan);

/* Takes over materials that have changed since; SKG_STALE where the model cannot. */
skg_status skg_plan_renew_model(skg_plan *plan);

/* SKG_STALE where a view has another size than the plan's. */
skg_status skg_plan_check_size(const skg_plan *plan, const skg_view *view);

/* Decides whether planes are mixed; depends on the model alone, so that frames of a renewed plan have the
 * bits of a new one's. */
skg_status skg_plan_choose_mix(skg_plan *plan);

/* Decides the strategy for the plan's view (rasters.c). */
skg_status skg_plan_choose_strategy(skg_plan *plan);

/* Refuses options of noise and blur that cannot be, and makes the stages that they call for. */
skg_status skg_plan_check_detector(const skg_plan_options *options);
skg_status skg_plan_make_detector(skg_plan *plan);

/* Whether logarithms are taken of finished means, after noise and blur. */
int skg_plan_is_late(const skg_plan *plan);

/* The rasteriser with these abilities, made on demand. more_sums: as in its options. */
skg_status skg_plan_raster(skg_plan *plan, const skg_kernel_options *kernels, int32_t strategy,
                           int64_t planes, int32_t more_sums, skg_raster **raster);

#endif
