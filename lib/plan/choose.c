/* Which strategy, tile and passes a plan draws with, by what they would take. */
#include "geometry/bounds.h"
#include "plan/decisions.h"

#include <float.h>
#include <math.h>

/* clang-format off */
/* Time of project, raster and resolve for spheres on two cores (Zen 3, AVX2, PoCL 3.1), the least of 3 x 21 frames, ms:
 *
 *     triangles  detector   copies   bands   atomics
 *        41,616   512^2       0.86    1.16      3.44
 *        41,616  1024^2       1.94    2.21
 *       168,100  2048^2      10.4     9.42
 *     1,000,000  2048^2      21.1    24.4
 *
 * Copies cost two passes over the image for each worker. Bands cost about 10 ns for each triangle and worker, so they win
 * if the image is large and the triangles are not small. The limit for many workers is an estimate by the same costs. The
 * best strategy of a GPU has not been measured. */
/* clang-format on */
enum {
    FEW_WORKERS = 4,
    LARGE_IMAGE = 8 << 20, /* bytes of a private copy */
    LARGE_TRIANGLE = 32    /* pixels of a box: 168,100 triangles at 2048^2 have some 80, a million some 14 */
};

int32_t skg_strategy_choose(const skg_strategy_facts *facts, const char **why) {
    if (facts->gpu) {
        *why = "a GPU adds integers in global memory without sorting first";
        return SKG_STRATEGY_ATOMICS;
    }
    if (facts->workers > FEW_WORKERS && facts->image_bytes > LARGE_IMAGE / facts->workers) {
        *why = "a private image for each of so many workers costs more than sorting triangles into bands";
        return SKG_STRATEGY_TILES;
    }
    if (facts->image_bytes > LARGE_IMAGE && facts->triangle_pixels >= LARGE_TRIANGLE) {
        *why = "the image is large and its triangles are not small: bands stay in the cache";
        return SKG_STRATEGY_TILES;
    }
    *why = "few workers, a small image or small triangles: a private image each needs no sorting";
    return SKG_STRATEGY_COPIES;
}

/* Mean number of pixels of a triangle's box. A closed part covers its rectangle about twice, and a box has twice the
 * area of its triangle. */
static double mean_box(const skg_scene *scene, const skg_camera *camera, double last_bit) {
    double pixels = 0, triangles = 0;
    for (int64_t p = 0; p < scene->count; p++) {
        const skg_scene_part_data *part = &scene->parts[p];
        skg_extent extent;
        skg_extent_find(camera, part->mesh, part->pose, last_bit, &extent);
        if (!extent.on_detector) continue;
        const skg_scale_part *r = &extent.scale;
        const double width = fmin(r->high_column, (double)camera->columns) - fmax(r->low_column, 0);
        const double height = fmin(r->high_row, (double)camera->rows) - fmax(r->low_row, 0);
        pixels += 4 * width * height;
        triangles += (double)part->mesh->triangles;
    }
    return triangles > 0 ? pixels / triangles : 0;
}

/* Pixels in the extents of all accumulators. */
static skg_status reached_pixels(const skg_strategy_request *request, const skg_camera *camera,
                                 double last_bit, int64_t *pixels) {
    const skg_scene *scene = request->scene;
    int32_t *extents = NULL; /* [accumulators][4] */
    SKG_TRY(skg_alloc(4 * request->accumulators, sizeof *extents, "extents", &extents));
    for (int64_t p = 0; p < scene->count; p++) {
        skg_extent extent;
        int32_t own[4];
        skg_extent_find(camera, scene->parts[p].mesh, scene->parts[p].pose, last_bit, &extent);
        skg_extent_pixels(camera, &extent, own);
        for (int64_t c = request->first_contribution[p]; c < request->first_contribution[p + 1]; c++)
            skg_extent_join(extents + 4 * request->contributions[c].plane, own);
    }
    *pixels = 0;
    for (int64_t a = 0; a < request->accumulators; a++) {
        const int32_t *e = extents + 4 * a;
        *pixels += (int64_t)(e[1] - e[0]) * (e[3] - e[2]);
    }
    skg_free(&extents);
    return SKG_OK;
}

int64_t skg_scene_triangles(const skg_scene *scene) {
    int64_t triangles = 0;
    for (int64_t p = 0; p < scene->count; p++) triangles += scene->parts[p].mesh->triangles;
    return triangles;
}

skg_status skg_strategy_decide(const skg_strategy_request *request, int32_t *strategy, const char **why) {
    const double last_bit = request->precision == SKG_PRECISION_DOUBLE ? DBL_EPSILON : (double)FLT_EPSILON;
    skg_camera camera;
    int64_t pixels = 0;
    SKG_TRY(skg_camera_make(request->view, NULL, 0, 0, &camera));
    *strategy = request->wanted;
    *why = "asked for";
    if (request->precision == SKG_PRECISION_HALF) {
        *strategy = SKG_STRATEGY_ATOMICS;
        *why = "precision half has no other";
    }
    if (*strategy != SKG_STRATEGY_AUTO) return SKG_OK;
    SKG_TRY(reached_pixels(request, &camera, last_bit, &pixels));
    const skg_strategy_facts facts = {
        .gpu = request->device->gpu,
        .workers = request->device->compute_units,
        .image_bytes = pixels * (request->precision == SKG_PRECISION_DOUBLE ? 8 : 4),
        .triangles = skg_scene_triangles(request->scene),
        .triangle_pixels = mean_box(request->scene, &camera, last_bit),
    };
    *strategy = skg_strategy_choose(&facts, why);
    return SKG_OK;
}

/* clang-format off */
/* One pass on a finer detector sets up each triangle once instead of n^2 times, but its sums leave the caches earlier. A
 * frame of the generated thorax (41,896 triangles, 3 planes) on two cores (EPYC, AVX-512, PoCL 3.1), one pass over n^2 passes:
 *
 *     image     n = 2    n = 3    n = 4    n = 8
 *      512^2     0.84     0.77     0.73     0.61
 *     1024^2     1.06     0.94
 *     2048^2     1.10 */
/* clang-format on */
static const double SMALL_BYTES = 32 << 20, BYTES_MAX = 256 << 20; /* of the sums */
static const double PIXELS_SAVED =
    6; /* a set-up that is saved makes up for the misses of these pixels of the image */

/* Bytes of an accumulator that has all rays of the pixels. */
static double accumulator_bytes(const skg_fine_request *request) {
    const double rays = (double)(request->shifts * request->shifts);
    return (double)request->columns * (double)request->rows * rays *
           (request->precision == SKG_PRECISION_DOUBLE ? 8 : 4);
}

int64_t skg_fine_choose(const skg_fine_request *request, const char **why) {
    const double pixels = (double)request->columns * (double)request->rows;
    const double rays = (double)(request->shifts * request->shifts);
    const double bytes = accumulator_bytes(request) * (double)request->accumulators;
    const double saved = (rays - 1) * (double)request->triangles;
    *why = "one ray a pixel";
    if (request->shifts == 1) return 1;
    *why = "each in a pass of its own: leaky meshes are judged and repaired in pixels of the image";
    if (request->leaky) return 1;
    *why = "each in a pass of its own: the detector is curved";
    if (request->curved) return 1;
    *why = "each in a pass of its own: the sums of all at once would take more than 256 MiB";
    if (bytes > BYTES_MAX) return 1;
    *why = "each in a pass of its own: the image is large and its triangles are not small";
    if (bytes > SMALL_BYTES && pixels > PIXELS_SAVED * saved) return 1;
    *why = "all in one pass on finer pixels";
    return request->shifts;
}

/* clang-format off */
/* Mixing planes takes one addition for each hit instead of one for each plane of its part, but each pixel reads what may be more
 * accumulators. A frame of the generated thorax (as above; 17 accumulators), copies and bands, mixed over not mixed:
 *
 *     image     5 planes     16 planes
 *      512^2    0.66 0.90    0.91 0.95
 *     1024^2    0.57 0.90    0.75 0.93
 *     2048^2    0.59 0.93    0.89 1.06 */
/* clang-format on */
enum { MIXED_MAX = 32, MIXED_BYTES = 128 << 20 }; /* accumulators; bytes of all of them */

int32_t skg_max_mixed(const skg_fine_request *request, int32_t planes) {
    const double fit = MIXED_BYTES / accumulator_bytes(request);
    const int32_t most = fit < MIXED_MAX ? (int32_t)fit : MIXED_MAX;
    const int32_t few = planes + planes / 2;
    return most > few ? most : few;
}

/* clang-format off */
/* A frame of 16 samples of the source on two cores (EPYC, AVX-512, PoCL 3.1), in ms: with all workers at each pass; a worker for
 * each; and four passes side by side for each, which share the indices and the layout of a triangle but need four images:
 *
 *     triangles  detector  planes   all    one   four
 *        42,000     512^2       1   7.72   7.31   7.19
 *        42,000    1024^2       1  16.6   15.4   19.3
 *     1,000,000    1024^2       1  61.7   51.5   45.7   (8 samples)
 *        42,000     512^2       5  44.4   44.7   45.8 */
/* clang-format on */
enum {
    SIDE = SKG_SIDE_MAX,    /* SKG_SIDE of the kernels */
    SIDE_IMAGE = 1 << 20,   /* bytes of an image of which four stay in the caches, */
    OWN_IMAGE = 4 << 20,    /* and of one that a worker may have for itself */
    SIDE_TRIANGLE = 4,      /* bytes of an image whose misses a shared triangle makes up for */
    TRIANGLES_MAX = 2 << 20 /* whose vertices are projected side by side, for each worker */
};

/* Whether workers that take `each` passes at a time have something to do nearly always. */
static int even(int64_t passes, int64_t workers, int64_t each) {
    const int64_t turn = workers * each, turns = (passes + turn - 1) / turn;
    return 10 * passes >= 9 * turns * turn;
}

int32_t skg_passes_choose(const skg_passes_request *request, int32_t *side) {
    const int64_t workers = request->workers;
    *side = 1;
    if (request->strategy != SKG_STRATEGY_COPIES || request->passes < 2) return 1;
    const int64_t left = request->image_bytes - SIDE_TRIANGLE * request->triangles;
    if (left > OWN_IMAGE) return 1;
    const int pays = left <= SIDE_IMAGE && request->triangles <= TRIANGLES_MAX;
    if (pays && even(request->passes, workers, SIDE)) *side = SIDE;
    return *side > 1 || even(request->passes, workers, 1) ? (int32_t)(*side * workers) : 1;
}

/* Frames are drawn together if launches and waiting are a large share of them. Of larger ones (a sphere of 41,472 triangles at 512^2, two
 * workers) a batch took 0.90 to 1.00 of the time at best, but 1.2 to 1.6 of it while other programs took the cores, because workers
 * wait for whole frames. */
enum { FRAMES_LEAST = 8, FRAME_IMAGE = 512 << 10 /* bytes of all accumulators of a frame */ };

int32_t skg_frames_most(int32_t workers) {
    return SIDE * workers + FRAMES_LEAST;
}

int32_t skg_frames_choose(const skg_passes_request *request, int32_t *side) {
    skg_passes_request turn = *request;
    turn.passes = (int64_t)SIDE * request->workers;
    const int32_t each = request->image_bytes <= FRAME_IMAGE ? skg_passes_choose(&turn, side) : 1;
    const int32_t together = each > 1 ? (FRAMES_LEAST + each - 1) / each * each : 1;
    if (together > 1 && together <= request->passes) return together;
    *side = 1;
    return 1;
}
