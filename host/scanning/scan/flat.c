/* Flat fields, which are images of the beam without parts, and dark fields, which are images without the beam. */
#include "core/core.h"
#include "core/maths.h"
#include "core/text.h"
#include "frame/quiet.h"
#include "scan/slot.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Far beyond the edge of any detector, and below the largest coordinate. */
static const double far_mm = 1e7;

typedef struct {
    int64_t *parts;
    double *poses;
} absence;

/* Moves every part sideways, out of the beam. */
static skg_status remove_parts(const skg_scene *scene, const skg_view *view, int64_t count, absence *gone) {
    double away[16];
    const double shift = far_mm / skg_length(view->column_step);
    SKG_TRY(skg_alloc(count, sizeof *gone->parts, "flat field", &gone->parts));
    SKG_TRY(skg_alloc(count, 16 * sizeof *gone->poses, "flat field", &gone->poses));
    skg_pose_translation(shift * view->column_step[0], shift * view->column_step[1],
                         shift * view->column_step[2], away);
    for (int64_t p = 0; p < count; p++) {
        skg_part part;
        skg_part_init(&part);
        SKG_TRY(skg_scene_part_get(scene, p, &part));
        skg_pose_multiply(away, part.pose, gone->poses + 16 * p);
        gone->parts[p] = p;
    }
    return SKG_OK;
}

static skg_status render(skg_plan *plan, const skg_frame *frame, int32_t type, void *image) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.type = type;
    output.data = image;
    SKG_TRY(skg_plan_submit(plan, 1, frame, 1, &output, &job));
    return skg_job_wait(&job);
}

static skg_status flat_fields(skg_plan *plan, const skg_scene *scene, skg_scan *scan,
                              const skg_scan_run_options *options, int64_t count, void *images) {
    SKG_PLAIN;
    absence gone = {0};
    skg_view view;
    skg_frame frame;
    skg_status status = SKG_OK, range = SKG_OK;
    skg_scan_work work = {.plan = plan, .scan = scan};
    int64_t parts = 0;
    SKG_NEEDS_OF("skg_scan_flat_fields_render", plan);
    SKG_NEEDS_OF("skg_scan_flat_fields_render", scan);
    SKG_NEEDS_OF("skg_scan_flat_fields_render", images);
    skg_scan_run_options_init(&work.options);
    if (options)
        SKG_TRY(skg_struct_read(options, "skg_scan_run_options", &work.options, sizeof work.options));
    if (count < 1) return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " flat fields; give 1 or more", count);
    skg_view_init(&view);
    SKG_TRY(skg_scan_view_get(scan, 0, &view));
    SKG_TRY(skg_scan_work_init(&work));
    SKG_TRY(skg_scene_part_count(scene, &parts));
    SKG_TRY_CLEANUP(remove_parts(scene, &view, parts, &gone));
    skg_frame_init(&frame);
    frame.view = &view;
    frame.pose_count = parts;
    frame.pose_parts = gone.parts;
    frame.poses = gone.poses;
    frame.noise_seed = work.options.noise_seed;
    const int32_t warned = skg_plan_warned_unseen_set(plan, 1);
    for (int64_t f = 0; f < count && status == SKG_OK; f++) {
        frame.index = work.projections + f;
        const int64_t at = f * work.image_elements * skg_element_bytes(work.options.type);
        status = render(plan, &frame, work.options.type, (char *)images + at);
        if (status != SKG_RANGE) continue;
        range = status;
        status = SKG_OK;
    }
    skg_plan_warned_unseen_set(plan, warned);
cleanup:
    skg_free(&gone.parts);
    skg_free(&gone.poses);
    return status == SKG_OK ? range : status;
}

skg_status skg_scan_flat_fields_render(skg_plan *plan, const skg_scene *scene, skg_scan *scan,
                                       const skg_scan_run_options *options, int64_t count, void *images) {
    const skg_call begun = skg_plan_call_begin(plan);
    return skg_call_end(begun, flat_fields(plan, scene, scan, options, count, images));
}

static skg_status dark_fields(const skg_plan *plan, const skg_scan *scan, const skg_scan_run_options *options,
                              int64_t count, void *images) {
    SKG_PLAIN;
    skg_view view;
    skg_scan_run_options run;
    SKG_NEEDS_OF("skg_scan_dark_fields_render", plan);
    SKG_NEEDS_OF("skg_scan_dark_fields_render", scan);
    SKG_NEEDS_OF("skg_scan_dark_fields_render", images);
    skg_scan_run_options_init(&run);
    if (options) SKG_TRY(skg_struct_read(options, "skg_scan_run_options", &run, sizeof run));
    if (count < 1) return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " dark fields; give 1 or more", count);
    skg_view_init(&view);
    SKG_TRY(skg_scan_view_get(scan, 0, &view));
    const skg_darkness dark = skg_plan_darkness(plan);
    const uint64_t seed = (uint64_t)dark.noise_seed + (uint64_t)run.noise_seed;
    const int64_t pixels = view.columns * view.rows;
    for (int64_t i = 0; i < count * pixels; i++) {
        /* The numbers of flat fields are those after the projections; those of dark fields are below 0. */
        double value = 0;
        if (dark.sigma > 0) value = dark.sigma * skg_deviate((int64_t)seed, -1 - i / pixels, i % pixels);
        if (dark.step > 0) value = rint(value / dark.step) * dark.step;
        if (run.type == SKG_TYPE_FLOAT64)
            ((double *)images)[i] = value;
        else
            ((float *)images)[i] = (float)value;
    }
    return SKG_OK;
}

skg_status skg_scan_dark_fields_render(const skg_plan *plan, const skg_scan *scan,
                                       const skg_scan_run_options *options, int64_t count, void *images) {
    const skg_call begun = skg_plan_call_begin(plan);
    return skg_call_end(begun, dark_fields(plan, scan, options, count, images));
}
