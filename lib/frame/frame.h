/* One frame: everything from vertices to pixels, enqueued. Private to lib/plan. */
#ifndef SKG_FRAME_H
#define SKG_FRAME_H

#include "frame/plan.h"
#include "geometry/extent.h"

/* What a frame is to show. */
typedef struct {
    const skg_view *view;
    const double *const *poses; /* [parts] each NULL for the scene's; NULL: all the scene's */
    const skg_frame *frame;     /* the caller's, for its matter; NULL: as planned */
    int64_t lengths_of;         /* a part whose lengths are wanted, or -1: an image */
    int32_t kind;               /* of lengths: SKG_LENGTHS_NET or SKG_LENGTHS_SURFACE */
    int32_t reserved;
    skg_noise_args noise; /* its key */
    skg_image_place place;
} skg_frame_work;

/* A frame's parts with what each adds, and how they lie. */
typedef struct {
    skg_camera camera;
    skg_kernel_options kernels;
    int64_t planes;                     /* of the raster: accumulators where they are mixed */
    skg_mix mix;                        /* of an image's planes; none: accumulators are planes */
    skg_geometry_part *parts;           /* [parts], room of the plan's: closed ones with their writes */
    skg_contribution *writes;           /* of lengths */
    int64_t *first_write;               /* [parts + 1] of lengths */
    const skg_contribution *all_writes; /* what every part adds, open ones too: */
    const int64_t *firsts;              /* [parts + 1] all_writes[firsts[p]] ... */
    skg_extent *extents;                /* [parts], in the plan's room */
    skg_scale scale;
    skg_priority priority; /* closed parts that compete for intervals */
} skg_frame_parts;

/* Compiles and allocates for images of the plan's view. */
skg_status skg_frame_prepare(skg_plan *plan);

/* Enqueues the frame; when it is done the result is in its place. */
skg_status skg_frame_enqueue(skg_plan *plan, skg_job *job, const skg_frame_work *work);

/* Fills what parts add where some are of other matter in this frame (matter.c). */
skg_status skg_frame_list_matter(const skg_plan *plan, const skg_frame *given, skg_frame_parts *frame);

/* Enqueues the open parts of a frame after the raster of the closed ones, whose sums they join (open.c). */
skg_status skg_open_parts_add(skg_plan *plan, skg_job *job, const skg_frame_parts *frame, skg_raster *shared);

/* Open parts that are rastered together. */
typedef struct {
    int64_t parts;
    const int64_t *open;      /* [parts] numbers in plan->open */
    skg_raster *raster;       /* of their planes: each part's sums in the order of its writes, its count */
    const skg_raster *shared; /* that their sums join */
} skg_open_batch;

/* Enqueues the repair of their bad pixels, as the plan's options have it, after verdicts and sums (repair.c).
 * Exact: waits for the raster. */
skg_status skg_open_repair(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                           const skg_open_batch *batch);

/* A kernel of leaky.cl with its first arguments set: frame, sums, fields, parts, table. */
skg_status skg_open_kernel(skg_plan *plan, const skg_open_batch *batch, const char *name, cl_kernel *kernel);

/* Enqueues what priorities and clipping take off the sums of the closed parts, whose tables the device has;
 * waits for the number of hits (priority_hits.c). */
skg_status skg_priority_run(skg_plan *plan, skg_job *job, const skg_frame_parts *frame,
                            const skg_raster *raster);

/* Warns once that nothing falls on the detector: which way, how far (unseen.c). */
void skg_warn_unseen(skg_plan *plan, const skg_frame_parts *frame);

/* Enqueues the open field of the frame's view into plan->field, where it is wanted and not known (field.c).
 */
skg_status skg_field_find(skg_plan *plan, skg_job *job, const skg_frame_work *work);

/* Enqueues what the detector makes of a frame's intensities: blur, electronic noise, steps (detect.c). */
skg_status skg_plan_detect(skg_plan *plan, skg_job *job, const skg_frame_work *work);

#endif
