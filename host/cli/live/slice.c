/* A slice through the scene, from a few projections with few pixels, by the library's own reconstruction. */
#include "live/slice.h"

#include "common/values.h"
#include "core/maths.h"
#include "session/explain.h"

#include <math.h>
#include <skiagraph/scanning.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Maximum projections of a scan, projections of a turn, maximum columns; views for which the tolerance is verified; photons of a projection's
 * scatter, of which the thorax takes 0.2 s. */
enum { VIEWS_MAX = 180, TURN_VIEWS = 120, COLUMNS_MAX = 128, SAMPLE = 8, HISTORIES = 4096 };

/* s: of a turn where the scene has no times: what a cone-beam CT at a linear accelerator takes. */
static const double TURN_S = 60;

/* The slice shows the box of the parts and so much of its radius more. */
static const double MARGIN = 1.05;

/* Data of a slice under way. */
typedef struct {
    live_scene scene;
    double box[6]; /* of the parts, mm */
    const skg_live_asked *switches;
    double axis[3], centre[3];
    int64_t factor;  /* pixels of the detector for each that is computed, along a side */
    double share;    /* pixels of the detector for each that is computed */
    int64_t stride;  /* each so many projections of the scene's scan, one is computed */
    skg_scan *whole; /* the scene's, or one turn */
    skg_scan *scan;  /* what is computed of it */
    skg_view views[SAMPLE];
    skg_spectrum *spectrum;
    skg_plan *plan;
    skg_fdk *fdk;
    skg_fdk_report seen;
    double *moving; /* [projections][parts that move][16] their poses; NULL: none moves */
    float *image;   /* [pixels] */
    int64_t pixels;
} work;

static int has_moving_parts(const live_scene *scene, skg_scan_record *record) {
    skg_scan_record_init(record);
    return scene->projections > 1 && skg_setup_record_get(scene->setup, record) == SKG_OK &&
           record->moving_count > 0;
}

const char *live_slice_without_spectrum(const live_scene *scene) {
    int64_t bins = 0;
    if (skg_spectrum_bin_count(scene->session.spectrum, &bins) == SKG_OK && bins > 1) return NULL;
    return "the beam has one energy";
}

const char *live_slice_without_motion(const live_scene *scene) {
    skg_scan_record record;
    return scene->motion || has_moving_parts(scene, &record)
               ? NULL
               : "the scene does not breathe, and no sample has Poses";
}

/* One turn about an axis along the detector's columns, which meets the ray to the detector's middle where that is nearest to the middle of the
 * parts. */
static skg_status make_turn(work *w) {
    const skg_view *view = &w->scene.session.view;
    const int is_infinite = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    const double *box = w->box;
    double ray[3], to[3];
    skg_scan_options options;
    skg_scan_options_init(&options);
    for (int k = 0; k < 3; k++) {
        ray[k] = is_infinite ? view->source[k] : view->centre[k] - view->source[k];
        to[k] = (box[k] + box[k + 3]) / 2 - view->centre[k];
    }
    skg_add_scaled(view->centre, skg_dot(to, ray) / skg_dot(ray, ray), ray, options.centre);
    memcpy(options.axis, view->row_step, sizeof options.axis);
    options.projections = TURN_VIEWS;
    options.step_rad = 2 * SKG_PI / TURN_VIEWS;
    return skg_scan_create(view, &options, &w->whole);
}

/* The poses of some projections of the whole scan, with larger pixels, and their times. */
static skg_status make_scan(work *w, live_slice *slice) {
    double *poses = NULL, last_s = 0;
    int64_t count = 0;
    skg_scan_options options;
    skg_scan_options_init(&options);
    skg_status status = skg_scan_projection_count(w->whole, &count);
    if (status != SKG_OK) return status;
    w->stride = (count + VIEWS_MAX - 1) / VIEWS_MAX;
    const int64_t views = (count - 1) / w->stride + 1;
    poses = calloc((size_t)views * 12, sizeof *poses);
    if (!poses) return SKG_ERR_MEMORY;
    for (int64_t k = 0; k < views && status == SKG_OK; k++) {
        skg_view view;
        skg_view_init(&view);
        status = skg_scan_view_get(w->whole, k * w->stride, &view);
        if (status == SKG_OK) status = skg_live_view_coarsen(w->factor, &view);
        memcpy(poses + 12 * k, view.source, sizeof view.source);
        memcpy(poses + 12 * k + 3, view.centre, sizeof view.centre);
        memcpy(poses + 12 * k + 6, view.column_step, sizeof view.column_step);
        memcpy(poses + 12 * k + 9, view.row_step, sizeof view.row_step);
        w->views[views < SAMPLE ? k : k * SAMPLE / views] = view;
    }
    if (status == SKG_OK) status = skg_scan_time_get(w->whole, 0, &options.start_s, NULL);
    if (status == SKG_OK) status = skg_scan_time_get(w->whole, (views - 1) * w->stride, &last_s, NULL);
    options.interval_s = last_s > options.start_s && views > 1
                             ? (last_s - options.start_s) / (double)(views - 1)
                             : TURN_S / (double)views;
    slice->projections = views;
    slice->turn_s = options.interval_s * (double)(views - 1);
    if (status == SKG_OK) status = skg_scan_create_table(&w->views[0], &options, views, poses, &w->scan);
    free(poses);
    return status;
}

static skg_status find_scan(work *w, live_slice *slice) {
    const skg_view *view = &w->scene.session.view;
    skg_status status = SKG_OK;
    if (w->scene.projections > 0) {
        status = skg_setup_scan_get(w->scene.setup, &w->whole);
        if (status == SKG_OK) status = skg_scan_retain(w->whole);
    } else {
        status = make_turn(w);
    }
    if (status == SKG_OK) status = skg_scan_axis_get(w->whole, w->axis, w->centre);
    w->factor = (view->columns + COLUMNS_MAX - 1) / COLUMNS_MAX;
    if (status == SKG_OK) status = make_scan(w, slice);
    if (status != SKG_OK) return status;
    slice->columns = w->views[0].columns, slice->rows = w->views[0].rows;
    w->pixels = slice->columns * slice->rows;
    w->share = (double)(view->columns * view->rows) / (double)w->pixels;
    return SKG_OK;
}

/* The farthest corner of the box of the parts from the axis, mm. */
static double find_reach(const work *w) {
    double reach = 0, to[3];
    for (int corner = 0; corner < 8; corner++) {
        for (int k = 0; k < 3; k++) to[k] = w->box[k + (corner >> k & 1 ? 3 : 0)] - w->centre[k];
        skg_add_scaled(to, -skg_dot(to, w->axis), w->axis, to);
        reach = fmax(reach, skg_length(to));
    }
    return reach;
}

/* The slice shows the parts, or what the detector covers if that is less. One voxel tells how much that is, and whether the scan can be
 * reconstructed. */
static skg_status begin_slice(work *w, live_slice *slice) {
    skg_fdk_options options;
    skg_fdk_options_init(&options);
    skg_fdk_report_init(&w->seen);
    memcpy(options.axis, w->axis, sizeof options.axis);
    memcpy(options.centre, w->centre, sizeof options.centre);
    memcpy(options.middle, w->centre, sizeof options.middle);
    for (int k = 0; k < 3; k++) {
        options.voxels[k] = 1;
        if (fabs(w->axis[k]) > fabs(w->axis[slice->across])) slice->across = k;
    }
    skg_status status = skg_fdk_create(w->scan, &options, &w->fdk);
    if (status == SKG_OK) status = skg_fdk_report_get(w->fdk, &w->seen);
    skg_fdk_release(&w->fdk);
    const double half = fmin(w->seen.covered_mm, MARGIN * find_reach(w));
    options.voxel_mm = slice->voxel_mm = 2 * half / LIVE_SLICE_SIZE;
    for (int k = 0; k < 3; k++) options.voxels[k] = k == slice->across ? 1 : LIVE_SLICE_SIZE;
    options.middle[slice->across] += w->switches->at_mm;
    slice->at_mm = options.middle[slice->across];
    return status == SKG_OK ? skg_fdk_create(w->scan, &options, &w->fdk) : status;
}

/* Returns 0 with a sentence where the slice lies beyond the rows of the detector, whose voxels would hold 0 or too little. */
static int is_seen(const work *w, const live_slice *slice, char *sentence) {
    const double along = w->axis[slice->across] / skg_length(w->axis), *seen = w->seen.along_mm;
    const double at = w->switches->at_mm / along;
    if (at >= seen[0] && at <= seen[1]) return 1;
    const double ends[2] = {seen[0] * along, seen[1] * along};
    snprintf(sentence, LIVE_SENTENCE,
             "at %.4g mm there are no rows of the detector; it sees slices from %.4g to %.4g mm",
             w->switches->at_mm, fmin(ends[0], ends[1]), fmax(ends[0], ends[1]));
    return 0;
}

/* The beam of the larger pixels, with all energies or as many photons of their mean. */
static skg_status make_beam(work *w, live_slice *slice) {
    const cli_session *session = &w->scene.session;
    const int has_spectrum = w->switches->spectrum && !live_slice_without_spectrum(&w->scene);
    int32_t is_absolute = 0;
    skg_quality quality;
    skg_quality_init(&quality);
    skg_status status = skg_flat_field_quality_get(session->spectrum, &session->view, &quality);
    if (status == SKG_OK) status = skg_spectrum_absolute_get(session->spectrum, &is_absolute);
    if (status != SKG_OK) return status;
    slice->mean_kev = quality.mean_kev;
    if (!has_spectrum)
        return skg_spectrum_create_mono(quality.mean_kev, w->share * quality.photons, &w->spectrum);
    return skg_spectrum_create_scaled(session->spectrum, is_absolute ? 1 : w->share, &w->spectrum);
}

/* Of effects of single pixels the larger ones have less than a pixel, as a rule. */
static skg_status make_plan(work *w, live_slice *slice) {
    const cli_session *session = &w->scene.session;
    skg_plan_options options = session->options;
    skg_scatter scatter;
    skg_scatter_init(&scatter);
    if (options.scatter) scatter = *options.scatter;
    scatter.tolerance = 0;
    scatter.histories = HISTORIES;
    options.scatter = w->switches->scatter ? &scatter : NULL;
    options.noise = w->switches->noise;
    options.electronic_kev = options.noise ? sqrt(w->share) * options.electronic_kev : 0;
    options.quantity = SKG_QUANTITY_ATTENUATION;
    options.bands = 0;
    options.band_kev = NULL;
    options.counter = NULL;
    options.profile = 0;
    options.view_count = slice->projections < SAMPLE ? slice->projections : SAMPLE;
    options.views = w->views;
    if (!options.noise) options.dqe = NULL;
    if (w->factor > 1) options.blur = NULL, options.depth_blur = NULL, options.dqe = NULL;
    const skg_status status = make_beam(w, slice);
    return status == SKG_OK ? skg_plan_create(session->context, session->scene, &w->views[0], w->spectrum,
                                              &options, &w->plan)
                            : status;
}

/* The poses of the parts that move from one projection to the next. */
static int find_moving(work *w, const live_wish *wish, const live_slice *slice, const skg_scan_record *record,
                       char *sentence) {
    double *all = calloc((size_t)w->scene.parts * 16, sizeof *all);
    w->moving = calloc((size_t)(slice->projections * record->moving_count) * 16, sizeof *w->moving);
    int is_made = all && w->moving;
    if (!is_made) snprintf(sentence, LIVE_SENTENCE, "out of host memory");
    for (int64_t k = 0; is_made && k < slice->projections; k++) {
        live_wish its = live_wish_copy(wish);
        is_made =
            live_wish_change(&its, json_pack("{s:I}", "projection", (json_int_t)(k * w->stride)), sentence) &&
            (skg_live_poses_get(&w->scene.subject, its.message, all) == SKG_OK || live_fail(sentence));
        live_wish_free(&its);
        for (int64_t i = 0; is_made && i < record->moving_count; i++)
            memcpy(w->moving + 16 * (k * record->moving_count + i), all + 16 * record->moving_parts[i],
                   16 * sizeof *all);
    }
    free(all);
    return is_made;
}

/* Adds projections to the slice. */
static skg_status add_batch(const skg_scan_batch *batch, void *user) {
    const float darkest = (float)-log(CLI_LEAST_TRANSMISSION);
    work *w = user;
    for (int64_t i = 0; i < batch->count; i++) {
        const float *image = (const float *)batch->images + i * w->pixels;
        for (int64_t p = 0; p < w->pixels; p++) w->image[p] = image[p] < darkest ? image[p] : darkest;
        const skg_status status = skg_fdk_add(w->fdk, batch->indices[i], w->image);
        if (status != SKG_OK) return status;
    }
    return SKG_OK;
}

static skg_status add_projections(work *w, const skg_scan_record *record, skg_progress *progress) {
    skg_scan_run_options options;
    skg_scan_run_options_init(&options);
    options.progress = progress;
    options.batch = w->switches->scatter ? 1 : 4; /* few, so that it is soon heard that they are not wanted */
    if (w->moving) {
        options.moving_count = record->moving_count;
        options.moving_parts = record->moving_parts;
        options.moving_poses = w->moving;
    } else if (w->switches->motion) {
        options.motion = w->scene.motion;
    }
    const skg_status status = skg_scan_run_each(w->plan, w->scan, &options, add_batch, w);
    return status == SKG_RANGE ? SKG_OK : status;
}

/* The voxels, with the larger of the two coordinates at the top. */
static skg_status take_values(const work *w, live_slice *slice) {
    const float *volume = NULL;
    skg_fdk_report report;
    skg_fdk_report_init(&report);
    skg_status status = skg_fdk_report_get(w->fdk, &report);
    if (status == SKG_OK) status = skg_fdk_volume_get(w->fdk, &volume);
    slice->truncated = report.truncated;
    for (int row = 0; status == SKG_OK && row < LIVE_SLICE_SIZE; row++)
        memcpy(slice->values + row * LIVE_SLICE_SIZE, volume + (LIVE_SLICE_SIZE - 1 - row) * LIVE_SLICE_SIZE,
               LIVE_SLICE_SIZE * sizeof *volume);
    return status;
}

static int make(work *w, const live_wish *wish, skg_progress *progress, live_slice *slice, char *sentence) {
    skg_scan_record record;
    skg_status status = skg_live_box_get(&w->scene.subject, w->box);
    if (status == SKG_OK) status = find_scan(w, slice);
    if (status == SKG_OK) status = begin_slice(w, slice);
    if (status == SKG_OK && !is_seen(w, slice, sentence)) return 0;
    if (status == SKG_OK && has_moving_parts(&w->scene, &record) && w->switches->motion &&
        !find_moving(w, wish, slice, &record, sentence))
        return 0;
    if (!w->moving && !(w->switches->motion && w->scene.motion)) slice->turn_s = 0;
    if (status == SKG_OK) status = make_plan(w, slice);
    w->image = calloc((size_t)w->pixels + 1, sizeof *w->image);
    if (status == SKG_OK && !w->image) status = SKG_ERR_MEMORY;
    if (status == SKG_OK) status = add_projections(w, &record, progress);
    if (status == SKG_OK) status = take_values(w, slice);
    slice->is_cancelled = status == SKG_ERR_CANCELLED;
    if (status != SKG_OK)
        snprintf(sentence, LIVE_SENTENCE, "%s",
                 status == SKG_ERR_MEMORY ? "out of host memory for the slice" : skg_last_error());
    return status == SKG_OK;
}

int live_slice_make(const live_base *base, const live_wish *wish, const skg_live_asked *switches,
                    skg_progress *progress, live_slice *slice, char *sentence) {
    work w = {.switches = switches};
    *slice = (live_slice){.at_mm = switches->at_mm};
    const int is_made = live_scene_load(base, wish, &w.scene, sentence) &&
                        (skg_live_place(&w.scene.subject, wish->message) == SKG_OK || live_fail(sentence)) &&
                        make(&w, wish, progress, slice, sentence);
    skg_fdk_release(&w.fdk);
    skg_plan_release(&w.plan);
    skg_spectrum_release(&w.spectrum);
    skg_scan_release(&w.scan);
    skg_scan_release(&w.whole);
    live_scene_free(&w.scene);
    free(w.moving);
    free(w.image);
    return is_made;
}
