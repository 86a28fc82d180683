/* The path lengths that a view can have, within which a model is verified. */
#include "spectral/verification.h"

#include "core/maths.h"
#include "core/threads.h"
#include "geometry/bounds.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Rays along each side of the detector of the view, of those of further views, and of a part's own rectangle. A
 * thin part (a duct, a needle) gets more rays of its own until it is hit ENOUGH_HITS times, because its longest
 * chord may be missed otherwise. */
enum { SIDE = SKG_TRACED_SIDE, MORE_SIDE = 24, OWN_SIDE = 16, ENOUGH_HITS = 128 };

/* Parts that are traced before their lengths are added up: as many as keep threads busy in little memory. */
enum { BATCH = 64 };

/* The factor on lengths that leaves a margin for later views, meshes and poses, which may differ a little. */
static const double MARGIN = SKG_TRACED_MARGIN;
/* The share of its range by which a plane may fall below it. A closed mesh that folds over itself has negative
 * lengths in a few pixels, which rays as coarse as these seldom meet. A rib of the generated thorax has -0.5 mm
 * where the range is 180 mm. */
static const double FOLDS = 0.02;

/* Ranges found for one part by its rays. */
typedef struct {
    double least, most; /* mm along its own rays, or 0 */
    double hits;        /* mean per ray over the detector */
    double low, high;   /* path parameter, from and to */
    int32_t met;        /* most hits of a ray */
    int32_t seen;       /* 1: it is on the detector, and has lengths there */
} traced_part;

/* One view of some parts. */
typedef struct {
    const skg_scene *scene;
    const skg_model *model;
    skg_camera camera;
    const unsigned char *wanted; /* [parts]; NULL: all */
    int64_t side, first;         /* rays along each side; the first part of the batch */
    double *lengths;             /* [BATCH][side][side] mm over the detector */
    traced_part parts[BATCH];
} looking;

static double longest_edge(const skg_scene_part_data *part) {
    double longest = 0;
    for (int k = 0; k < 3; k++) {
        const double edge = (double)part->mesh->highest[k] - (double)part->mesh->lowest[k];
        const double axis[3] = {part->pose[k], part->pose[4 + k], part->pose[8 + k]};
        longest = fmax(longest, edge * skg_length(axis));
    }
    return longest;
}

/* Traces rays over the part's own rectangle. */
static void trace_own(skg_tracer *tracer, const skg_scale_part *r, traced_part *traced) {
    const skg_camera *camera = tracer->camera;
    const double low[2] = {fmax(r->low_column, -0.5), fmax(r->low_row, -0.5)};
    const double high[2] = {fmin(r->high_column, (double)camera->columns - 0.5),
                            fmin(r->high_row, (double)camera->rows - 0.5)};
    for (int64_t side = OWN_SIDE; side <= SIDE && tracer->hits < ENOUGH_HITS; side *= 2) {
        skg_tracer_trace(tracer, side, low, high);
        for (int64_t k = 0; k < tracer->side * tracer->side; k++) {
            if (tracer->lengths[k] < traced->least) traced->least = tracer->lengths[k];
            if (tracer->lengths[k] > traced->most) traced->most = tracer->lengths[k];
            if (tracer->met[k] > traced->met) traced->met = tracer->met[k];
        }
        if (tracer->side == 0) return;
    }
}

static int contributes(const looking *look, int64_t part) {
    const int64_t *first = look->model->first_contribution;
    return first[part + 1] > first[part] && (!look->wanted || look->wanted[part]);
}

static skg_status trace_part(void *user, int64_t item) {
    looking *look = user;
    const skg_scene_part_data *part = &look->scene->parts[look->first + item];
    const int64_t rays = look->side * look->side;
    traced_part *traced = &look->parts[item];
    skg_extent extent;
    skg_tracer tracer = {0};
    skg_status status = SKG_OK;
    *traced = (traced_part){0};
    if (!contributes(look, look->first + item)) return SKG_OK;
    skg_extent_find(&look->camera, part->mesh, part->pose, DBL_EPSILON, &extent);
    if (!extent.on_detector) {
        traced->most = longest_edge(part);
        return SKG_OK;
    }
    traced->seen = 1;
    traced->low = extent.scale.low_depth, traced->high = extent.scale.high_depth;
    SKG_TRY_CLEANUP(skg_tracer_open(&look->camera, part, extent.near_source, &tracer));
    trace_own(&tracer, &extent.scale, traced);
    skg_tracer_trace_detector(&tracer, look->side);
    memcpy(look->lengths + item * rays, tracer.lengths, (size_t)rays * sizeof *look->lengths);
    traced->hits = (double)tracer.hits / (double)rays;
cleanup:
    skg_tracer_release(&tracer);
    return status;
}

/* Called after each batch, with the parts in their order. */
typedef void take_part(void *user, const looking *look, int64_t part, const traced_part *traced,
                       const double *lengths);

static skg_status trace_parts(looking *look, take_part *take, void *user) {
    const int64_t side = look->side, parts = look->scene->count;
    for (look->first = 0; look->first < parts; look->first += BATCH) {
        const int64_t left = parts - look->first, count = left < BATCH ? left : BATCH;
        SKG_TRY(skg_parallel(count, trace_part, look));
        for (int64_t k = 0; k < count; k++)
            if (contributes(look, look->first + k))
                take(user, look, look->first + k, &look->parts[k], look->lengths + k * side * side);
    }
    return SKG_OK;
}

/* --- ranges --- */

typedef struct {
    skg_ranges *ranges;
    double *lengths; /* [rays][planes] of this view */
    double *hits;    /* [parts] */
} adding;

static void widen(skg_ranges *ranges, int64_t plane, double length) {
    ranges->low[plane] = fmin(ranges->low[plane], MARGIN * length);
    ranges->high[plane] = fmax(ranges->high[plane], MARGIN * length);
}

static void add_part(void *user, const looking *look, int64_t part, const traced_part *traced,
                     const double *lengths) {
    const adding *a = user;
    const skg_model *model = look->model;
    const int64_t rays = look->side * look->side, planes = a->ranges->planes;
    for (int64_t w = model->first_contribution[part]; w < model->first_contribution[part + 1]; w++) {
        const skg_contribution *c = &model->contributions[w];
        if (c->weight > 0) {
            widen(a->ranges, c->plane, traced->least * c->weight);
            widen(a->ranges, c->plane, traced->most * c->weight);
        }
        for (int64_t r = 0; traced->seen && r < rays; r++)
            a->lengths[r * planes + c->plane] += c->weight * lengths[r];
    }
    if (traced->seen) a->hits[part] = traced->hits;
}

/* Adds what the cells of a volume add along the rays. Where parts displace it the range is too wide, which does no harm. */
typedef struct {
    const looking *look;
    const skg_volume *volume;
    const double *to_cells;
    double *amounts; /* [rays][curves] mm times amount */
} tracing_cells;

/* A beam from infinity is followed from so many steps of its direction, which are a millimetre or so, before the detector. */
static const double FROM_INFINITY = 1e7;

/* Where the ray to (i, j) starts, and its pixel. */
static void find_ends(const skg_camera *camera, double i, double j, double ends[2][3]) {
    const double start = camera->start[0] + camera->start[1] * i + camera->start[2] * j;
    const double back = fmin(1 - start, FROM_INFINITY);
    for (int k = 0; k < 3; k++) {
        const double across = i * camera->column[k] + j * camera->row[k];
        ends[1][k] = camera->origin[k] + across + (camera->parallel ? 0 : camera->first[k]);
        ends[0][k] = camera->parallel ? ends[1][k] - back * camera->first[k] : camera->origin[k];
    }
}

static skg_status trace_row(void *user, int64_t row) {
    const tracing_cells *t = user;
    const skg_camera *camera = &t->look->camera;
    const int64_t side = t->look->side;
    for (int64_t column = 0; column < side; column++) {
        const double i = ((double)column + 0.5) / (double)side * (double)camera->columns - 0.5,
                     j = ((double)row + 0.5) / (double)side * (double)camera->rows - 0.5;
        double ends[2][3], cells[2][3],
            *amounts = t->amounts + (row * side + column) * t->volume->curve_count;
        find_ends(camera, i, j, ends);
        for (int e = 0; e < 2; e++) skg_pose_point(t->to_cells, ends[e], cells[e]);
        skg_volume_trace(t->volume, cells[0], cells[1], amounts);
        const double mm = skg_length(
            (const double[3]){ends[1][0] - ends[0][0], ends[1][1] - ends[0][1], ends[1][2] - ends[0][2]});
        for (int64_t c = 0; c < t->volume->curve_count; c++) amounts[c] *= mm;
    }
    return SKG_OK;
}

static skg_status add_volume(const looking *look, int64_t part, adding *a) {
    const skg_model *model = look->model;
    const skg_volume *volume = look->scene->parts[part].volume;
    const int64_t rays = look->side * look->side, curves = volume->curve_count;
    const int64_t first = look->scene->count + skg_scene_curves(look->scene, part);
    double to_cells[16];
    tracing_cells t = {.look = look, .volume = volume, .to_cells = to_cells};
    skg_volume_to_cells(volume, look->scene->parts[part].pose, to_cells);
    SKG_TRY(skg_alloc(rays * curves, sizeof *t.amounts, "ranges of lengths", &t.amounts));
    const skg_status status = skg_parallel(look->side, trace_row, &t);
    for (int64_t c = 0; c < curves && status == SKG_OK; c++)
        for (int64_t w = model->first_contribution[first + c]; w < model->first_contribution[first + c + 1];
             w++)
            for (int64_t r = 0; r < rays; r++) {
                const double length = model->contributions[w].weight * t.amounts[r * curves + c];
                a->lengths[r * a->ranges->planes + model->contributions[w].plane] += length;
                widen(a->ranges, model->contributions[w].plane, length);
            }
    skg_free(&t.amounts);
    return status;
}

static void add_world(const looking *look, skg_ranges *ranges, double *lengths) {
    const skg_model *model = look->model;
    if (model->world_plane < 0) return;
    skg_ways_find(&look->camera, look->side, look->lengths);
    for (int64_t r = 0; r < look->side * look->side; r++) {
        lengths[r * ranges->planes + model->world_plane] += model->world_weight * look->lengths[r];
        ranges->way = fmax(ranges->way, model->world_weight * look->lengths[r]);
    }
}

static skg_status allocate(const skg_scene *scene, int64_t more, const skg_model *model, looking *look,
                           skg_ranges *ranges) {
    static const char what[] = "ranges of lengths";
    const int64_t rays = SIDE * SIDE + more * MORE_SIDE * MORE_SIDE, width = skg_model_width(model);
    SKG_TRY(skg_alloc(BATCH * SIDE * SIDE, sizeof *look->lengths, what, &look->lengths));
    SKG_TRY(skg_alloc(rays * width, sizeof *ranges->lengths, what, &ranges->lengths));
    SKG_TRY(skg_alloc(width, sizeof *ranges->low, what, &ranges->low));
    SKG_TRY(skg_alloc(width, sizeof *ranges->high, what, &ranges->high));
    return skg_alloc(2 * scene->count, sizeof *ranges->hits, what, &ranges->hits);
}

skg_status skg_ranges_find(const skg_scene *scene, const skg_view *view, int64_t more, const skg_view *views,
                           const skg_model *model, skg_ranges *ranges) {
    looking look = {.scene = scene, .model = model};
    skg_status status = SKG_OK;
    *ranges = (skg_ranges){.planes = skg_model_width(model)};
    SKG_TRY_CLEANUP(allocate(scene, more, model, &look, ranges));
    for (int64_t v = 0; v <= more; v++) {
        look.side = v ? MORE_SIDE : SIDE;
        adding a = {ranges, ranges->lengths + ranges->rays * ranges->planes,
                    ranges->hits + (v ? scene->count : 0)};
        SKG_TRY_CLEANUP(skg_camera_make(v ? &views[v - 1] : view, NULL, 0, 0, &look.camera));
        add_world(&look, ranges, a.lengths);
        SKG_TRY_CLEANUP(trace_parts(&look, add_part, &a));
        for (int64_t p = 0; p < scene->count; p++)
            if (scene->parts[p].volume) SKG_TRY_CLEANUP(add_volume(&look, p, &a));
        ranges->rays += look.side * look.side;
    }
    for (int64_t r = 0; r < ranges->rays * ranges->planes; r++)
        widen(ranges, r % ranges->planes, ranges->lengths[r]);
    for (int32_t k = 0; k < ranges->planes; k++) ranges->low[k] -= FOLDS * (ranges->high[k] - ranges->low[k]);
cleanup:
    skg_free(&look.lengths);
    if (status != SKG_OK) skg_ranges_release(ranges);
    return status;
}

typedef struct {
    skg_take_trace *take;
    void *user;
    double ray; /* mm, the longest for a path parameter of 1 */
} telling;

static void tell_part(void *user, const looking *look, int64_t part, const traced_part *traced,
                      const double *lengths) {
    const telling *t = user;
    double longest = traced->most;
    if (!traced->seen) return;
    for (int64_t r = 0; r < look->side * look->side; r++) longest = fmax(longest, lengths[r]);
    const skg_trace trace = {.part = part,
                             .lengths = lengths,
                             .longest = longest,
                             .deepest = t->ray * (traced->high - traced->low),
                             .farthest = t->ray * traced->high,
                             .met = traced->met};
    t->take(t->user, &trace);
}

skg_status skg_ranges_trace(const skg_scene *scene, const skg_view *view, const skg_model *model,
                            const unsigned char *wanted, skg_take_trace *take, void *user) {
    looking look = {.scene = scene, .model = model, .wanted = wanted, .side = SIDE};
    telling t = {.take = take, .user = user};
    skg_status status = SKG_OK;
    SKG_TRY(skg_camera_make(view, NULL, 0, 0, &look.camera));
    t.ray = skg_ray_longest(&look.camera);
    SKG_TRY_CLEANUP(skg_alloc(BATCH * SIDE * SIDE, sizeof *look.lengths, "rays", &look.lengths));
    SKG_TRY_CLEANUP(trace_parts(&look, tell_part, &t));
cleanup:
    skg_free(&look.lengths);
    return status;
}

void skg_ranges_release(skg_ranges *ranges) {
    skg_free(&ranges->lengths);
    skg_free(&ranges->low);
    skg_free(&ranges->high);
    skg_free(&ranges->hits);
}
