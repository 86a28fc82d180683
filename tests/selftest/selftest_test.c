/* The tests that a device is put to: they pass on a device that computes rightly, and kernels that were made wrong do
 * not pass. Each of these is compiled, so all of them make a test of their own: SKG_WRONG_KERNELS 1. */
#include "device/cache_folder.h"
#include "device/choice.h"
#include "device/self_tests.h"
#include "frame/plans.h"
#include "selftest/selftest.h"
#include "skg_shared.h"
#include "stage/kernels.h"
#include "suite.h"

#include <skiagraph/frame.h>
#include <skiagraph/gradient.h>
#include <skiagraph/material.h>
#include <skiagraph/opencl.h>
#include <skiagraph/plan.h>
#include <skiagraph/scene_picture.h>

#include <math.h>
#include <sys/wait.h>

static skg_context *open_first(const char *more) {
    char config[256];
    skg_context *context = NULL;
    int32_t index = -1;
    snprintf(config, sizeof config, "device=0:0 %s", more);
    ck_skg(skg_context_open(config, 0, &context, &index));
    ck_assert_int_eq(index, 0);
    return context;
}

START_TEST(boxes_have_known_lengths) {
    const double centre[3] = {1, 2, 3}, half[3] = {2, 3, 4}, none[3] = {0, 0, 0},
                 turned[3] = {0.4, -1.1, 2.5};
    const double from[3] = {1, 2, -100}, to[3] = {1, 2, 100}, past[3] = {4, 2, -100}, beyond[3] = {4, 2, 100};
    double enters = 0, leaves = 0;
    const skg_box straight = skg_box_turned(centre, half, none);
    ck_assert_int_eq(skg_box_crossed(&straight, from, to, &enters, &leaves), 1);
    ck_assert_double_eq_tol(enters * 200, 99, 1e-12);  /* doubles of this size have steps of 1.4e-14 */
    ck_assert_double_eq_tol(leaves * 200, 107, 1e-12); /* the same */
    ck_assert_int_eq(skg_box_crossed(&straight, past, beyond, &enters, &leaves), 0);
    ck_assert_int_eq(skg_box_crossed(&straight, centre, to, &enters, &leaves), 1);
    ck_assert_double_eq(enters, 0); /* the way begins inside */
    const skg_box box = skg_box_turned(centre, half, turned);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double product = 0;
            for (int k = 0; k < 3; k++) product += box.axes[3 * a + k] * box.axes[3 * b + k];
            ck_assert_double_eq_tol(product, a == b, 1e-15 * 4); /* four roundings of numbers up to 1 */
        }
}
END_TEST

/* The volume of what a mesh encloses: a sixth of the sum of its triangles' determinants. */
static double volume_of(const skg_mesh *mesh) {
    int64_t vertices = 0, triangles = 0;
    double volume = 0, *positions = NULL;
    int32_t *corners = NULL;
    ck_skg(skg_mesh_count(mesh, &vertices, &triangles));
    ck_skg(skg_alloc(3 * vertices, sizeof *positions, "test", &positions));
    ck_skg(skg_alloc(3 * triangles, sizeof *corners, "test", &corners));
    ck_skg(skg_mesh_positions_get(mesh, positions, 0));
    ck_skg(skg_mesh_triangles_get(mesh, corners, 0));
    for (int64_t t = 0; t < triangles; t++) {
        const double *a = positions + 3 * corners[3 * t], *b = positions + 3 * corners[3 * t + 1],
                     *c = positions + 3 * corners[3 * t + 2];
        volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                   a[2] * (b[0] * c[1] - b[1] * c[0])) /
                  6;
    }
    skg_free(&positions);
    skg_free(&corners);
    return volume;
}

START_TEST(meshes_of_boxes_are_closed_unless_split) {
    const double centre[3] = {1, 2, 3}, half[3] = {2, 3, 4}, angles[3] = {0.4, -1.1, 2.5};
    skg_context *context = open_first("");
    const skg_box boxes[2] = {skg_box_turned(centre, half, angles), skg_box_turned(half, centre, angles)};
    for (int split = 0; split < 2; split++) {
        skg_mesh *mesh = NULL;
        skg_mesh_health health;
        skg_mesh_health_init(&health);
        ck_skg(skg_boxes_mesh(context, boxes, 2, split, &mesh));
        ck_skg(skg_mesh_health_get(mesh, &health));
        ck_assert_int_eq(health.closed, !split);
        ck_assert_double_eq_tol(volume_of(mesh), 8 * (2 * 3 * 4 + 1 * 2 * 3),
                                1e-3); /* 100 float steps of 10 mm, times the area */
        skg_mesh_release(&mesh);
    }
    skg_context_release(&context);
}
END_TEST

/* Warnings that name parts: whoever reads them knows nothing of our scenes. */
static void keep_warning(int32_t level, const char *sentence, void *last) {
    if (level == SKG_LOG_WARNING && strstr(sentence, "boxes")) snprintf(last, 512, "%s", sentence);
}

START_TEST(a_right_device_passes) {
    char warning[512] = "";
    skg_context *context = open_first("");
    ck_skg(skg_context_log_set(context, keep_warning, warning));
    for (int test = 0; test < SKG_SELF_TESTS; test++) {
        skg_verdict verdict;
        if (test == SKG_SELF_TEST_DOUBLE && !context->device->info.double_precision) continue;
        ck_skg(skg_self_test_repeat(context, (skg_self_test)test, &verdict));
        ck_assert_msg(verdict.good, "%s: %s", skg_self_test_name((skg_self_test)test), verdict.reason);
        ck_assert_int_eq(context->device->self_testing, 0); /* calls of the caller are tested again */
        ck_assert(test == SKG_SELF_TEST_CORE ? verdict.score > 0 : verdict.score == 0);
        ck_assert_msg(!warning[0], "%s warns: %s", skg_self_test_name((skg_self_test)test), warning);
        if (test != SKG_SELF_TEST_TILES && test != SKG_SELF_TEST_DENSITIES) continue;
        context->device->info.gpu = 1;
        ck_skg(skg_self_test_repeat(context, (skg_self_test)test, &verdict));
        ck_assert_msg(verdict.good, "%s of GPUs: %s", skg_self_test_name((skg_self_test)test),
                      verdict.reason);
        context->device->info.gpu = 0;
    }
    skg_context_release(&context);
}
END_TEST

static char kernels[64];

/* A folder with the kernels, in one file of which this text is replaced. */
static void copy_kernels(const char *name, const char *old, const char *new) {
    static char text[1 << 16];
    char line[512];
    snprintf(kernels, sizeof kernels, "/tmp/skg-kernels-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(kernels));
    snprintf(line, sizeof line, "cp %s/kernels/*/* %s", SKG_SOURCE, kernels);
    ck_assert_int_eq(system(line), 0);
    snprintf(line, sizeof line, "%s/%s", kernels, name);
    FILE *file = fopen(line, "r");
    ck_assert_ptr_nonnull(file);
    const size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[length] = '\0';
    char *at = strstr(text, old);
    ck_assert_msg(at != NULL, "%s no longer has \"%s\"", name, old);
    file = fopen(line, "w");
    ck_assert_ptr_nonnull(file);
    fprintf(file, "%.*s%s%s", (int)(at - text), text, new, at + strlen(old));
    fclose(file);
}

static void remove_kernels(void) {
    char line[128];
    snprintf(line, sizeof line, "rm -r %s", kernels);
    ck_assert_int_eq(system(line), 0);
}

/* Errors that a compiler might make: each has to be found by the test of these kernels. */
static const struct {
    const char *file, *old, *new;
    skg_self_test test;
} errors[] = {
    {"sums.clh", "SKG_TO_REAL_V(SKG_AS_TERM_V(sum))", "SKG_TO_REAL_V(SKG_AS_TERM_V(sum) * 0)",
     SKG_SELF_TEST_CORE},
    {"project.cl", "p->anchor_x + across / t", "p->anchor_x + across / t + 0.01f", SKG_SELF_TEST_CORE},
    {"attenuate.cl", "passed, pixels->shown[c][r])", "passed * 1.001f, pixels->shown[c][r])",
     SKG_SELF_TEST_CORE},
    {"planes.clh", "strip->used, plane, strip->row, at)", "strip->used, plane, strip->row, strip->column)",
     SKG_SELF_TEST_CORE},
    {"attenuate.cl", "SKG_WIDE); k++, place++)", "SKG_WIDE - 1); k++, place++)", SKG_SELF_TEST_CORE},
    {"attenuate.cl", "strip.column += SKG_RUNS", "strip.column += 2 * SKG_RUNS", SKG_SELF_TEST_CORE},
    {"attenuate.cl", "strip->weights[n * SKG_CHANNELS + c]), passed", "strip->weights[c]), passed",
     SKG_SELF_TEST_ENERGIES},
    {"source_plane.cl", "part < 1 ? part : 1", "part < 1 ? 0 : 1", SKG_SELF_TEST_SOURCE_PLANE},
    {"leaky.cl", "place += sums & valid", "place += sums & 0", SKG_SELF_TEST_LEAKY},
    {"hits.cl", "hits[k + 1].depth - hits[k].depth", "hits[k].depth - hits[k + 1].depth",
     SKG_SELF_TEST_PRIORITY},
    {"volume.cl", "in[1] ? two - one : none", "none", SKG_SELF_TEST_VOLUME},
    {"volume.cl", "cells - (place < side->step)", "cells", SKG_SELF_TEST_VOLUME},
    {"cell_rays.clh", "(active[w] & (uint)displacing[w]) != 0", "1", SKG_SELF_TEST_VOLUME},
    {"cell_values.clh", "half_cell & 1 ? 0.0f : 0.5f", "0.5f", SKG_SELF_TEST_LINEAR},
    {"cell_values.clh", "fma(b - a, (skg_cell_weight)(share), a)", "a", SKG_SELF_TEST_LINEAR},
    {"cell_values.clh", "fma(at, ray->step[0], ray->place[0])", "ray->place[0]", SKG_SELF_TEST_LINEAR},
    {"cell_values.clh", "clamp(lower + 1, 0, grid->size[k] - 1)", "clamp(lower, 0, grid->size[k] - 1)",
     SKG_SELF_TEST_LINEAR},
    {"cell_values.clh", "point ? 0.788675135f : 0.211324865f", "point ? 0.9f : 0.1f", SKG_SELF_TEST_LINEAR},
    {"volume.cl", "if (share[piece][l] > 0)", "if (piece != 1 && share[piece][l] > 0)", SKG_SELF_TEST_LINEAR},
    {"volume_slopes.cl", "(displaced - before)", "(before - displaced)", SKG_SELF_TEST_CELLS},
    {"volume_slopes.cl", "at * args->cells[k] + cell", "at + cell", SKG_SELF_TEST_CELLS},
    {"volume_slopes.cl", ">> args->bits", ">> (args->bits + 1)", SKG_SELF_TEST_CELLS},
    {"volume_slopes.cl", "(long)row * of.stride + column", "column", SKG_SELF_TEST_CELLS},
    {"noise.clh", "(uint)pixel", "(uint)0", SKG_SELF_TEST_NOISE},
    {"blur.cl", "weights[j * args.across + i]", "weights[j * args.across]", SKG_SELF_TEST_BLUR},
    {"project.cl", "(p->anchor_x + across, p->anchor_y + down, r, t)",
     "(p->anchor_x + across, p->anchor_y + down, r * 1.0000001f, t)", SKG_SELF_TEST_PARALLEL},
    /* Strategies; the loops of draw.clh: tiny, narrow, rows, tall, spans, steep; what only large triangles take. */
    {"raster_copies.cl", "blocks, triangle, last);", "blocks, triangle, last - 1);", SKG_SELF_TEST_COPIES},
    {"raster_passes.cl", "blocks, 0, layout->triangles);", "blocks, 0, layout->triangles - 1);",
     SKG_SELF_TEST_PASSES},
    {"raster_passes.cl", "(p.y, q.y, r.y, s.y)", "(p.y, q.y, r.y, r.y)", SKG_SELF_TEST_SIDE},
    {"collect.clh", "pass * target->image_size", "0", SKG_SELF_TEST_SIDE},
    {"sums.clh", "(size_t)(layout->first_plane + plane)", "(size_t)plane", SKG_SELF_TEST_PASSES},
    {"draw.clh", "skg_hit_v(&line, i) & (i < right) & inside",
     "skg_hit_v(&line, i) & (i < right - 1) & inside", SKG_SELF_TEST_COPIES},
    {"draw.clh", "SKG_DRAW_BLOCK(1, SKG_BLOCK_1)", "SKG_DRAW_BLOCK(1, SKG_BLOCK_0)", SKG_SELF_TEST_COPIES},
    {"draw.clh", "skg_hit_v(&lower, i), 0)", "skg_hit_v(&upper, i), 0)", SKG_SELF_TEST_COPIES},
    {"draw.clh", "skg_depth_v(&f, &line, more)", "skg_depth_v(&f, &line, i)", SKG_SELF_TEST_COPIES},
    {"draw.clh", "SKG_IN_SPAN(&line, i, end), 0)", "SKG_IN_SPAN(&line, i, end - 1), 0)",
     SKG_SELF_TEST_COPIES},
    {"draw.clh", "skg_between_v(&span, x), x)", "skg_between_v(&span, x + 1), x)", SKG_SELF_TEST_COPIES},
    {"bands.cl", "if (to - from >= SKG_TILES_MAX) {", "if (to - from >= 1) {\n                    continue;",
     SKG_SELF_TEST_TILES},
    {"raster_bands.cl", "skg_draw_list(&target, &batch, blocks, for_all, counters[2], &range)", "",
     SKG_SELF_TEST_TILES},
    {"raster_atomics.cl", "queue[2 * (first + s) + 3] = s;", "queue[2 * (first + s) + 3] = 0;",
     SKG_SELF_TEST_ATOMICS},
    {"raster_atomics.cl", "box.j1 = min(box.j1, box.j0 + rows);", "box.j1 = min(box.j1, box.j0 + rows - 1);",
     SKG_SELF_TEST_ATOMICS},
    {"pixel.clh", "skg_depth(f, &line, (skg_real)column), factor);",
     "skg_depth(f, &line, (skg_real)column), -factor);", SKG_SELF_TEST_ATOMICS},
    {"exponential.clh", "0.24022650695910156204", "0.24", SKG_SELF_TEST_DOUBLE},
    {"raster_half.cl", "* 1e-3f);", "* 1.2e-3f);", SKG_SELF_TEST_HALF},
    {"counts.cl", "verdict[0] = total;", "verdict[0] = total + 100;", SKG_SELF_TEST_LEAKY},
    {"random.clh", "(F)(0x1.0fc8bep+1f)", "(F)(0x1.3fc8bep+1f)", SKG_SELF_TEST_NOISE},
    {"attenuate.cl", "pixels.shown[0][r] = pixels.highest[r]",
     "pixels.shown[0][r] = 1.001f * pixels.highest[r]", SKG_SELF_TEST_LENGTHS},
    {"raster_squares.cl", "k < own + all; k += 64", "k < own; k += 64", SKG_SELF_TEST_TILES},
    {"raster_squares.cl", "own = starts[tile + 1] - starts[tile]",
     "own = starts[tile + 1] - starts[tile] - 1", SKG_SELF_TEST_TILES},
    {"raster_squares.cl", "k / columns * layout.tile_columns + k % columns]",
     "k / columns * layout.tile_columns]", SKG_SELF_TEST_TILES},
    {"tiles.cl", "tiles->z = (box.i1 - 1 + range.pixel_i) / layout->tile_columns + 1",
     "tiles->z = tiles->x + 1", SKG_SELF_TEST_TILES},
    {"detect.cl", "rint(value / args.spacing) * args.spacing", "value", SKG_SELF_TEST_DETECTOR},
    {"detect.cl", "SKG_TO_REAL_V(skg_normal_v(draw[0]))", "2 * SKG_TO_REAL_V(skg_normal_v(draw[0]))",
     SKG_SELF_TEST_DETECTOR},
    {"detect.cl", "row * columns + column, SKG_DRAW", "column, SKG_DRAW", SKG_SELF_TEST_DETECTOR},
    {"detect.cl", "((long)channel * rows + row) * columns + column", "column", SKG_SELF_TEST_DETECTOR},
    {"attenuate.cl", "sums[k] += rays[k * SKG_FINE + a]", "sums[k] += rays[k * SKG_FINE]",
     SKG_SELF_TEST_RAYS},
    {"attenuate.cl", "(storing.add || row > 0)", "storing.add", SKG_SELF_TEST_RAYS},
    {"shades.clh", "fma(share, (skg_realv)(tangents[rows + row + 1] - first), (skg_realv)(first))",
     "(skg_realv)(first)", SKG_SELF_TEST_SHADES},
    {"shades.clh", "* (*length / sqrt(fma(x, x, y * y)))", "", SKG_SELF_TEST_SHADES},
    {"shades.clh", "value = fma(value, z, (skg_realv)(terms[t]))",
     "value = fma(value, z, (skg_realv)(terms[0]))", SKG_SELF_TEST_SHADES},
    {"shades.clh", "fma(at - row, next[g] - here[g], here[g])", "2 * here[g]", SKG_SELF_TEST_SHADES},
    {"attenuate.cl", "(column >= from) & (column < to)", "column >= from", SKG_SELF_TEST_SHADES},
    {"attenuate.cl", "strip->row < strip->args.window[3]", "1", SKG_SELF_TEST_SHADES},
    {"shades.clh", "polynomials + s * SKG_TERMS, s < heels", "polynomials, s < heels", SKG_SELF_TEST_HEEL},
    {"shades.clh", "i, j) / *length + args->heel[3]", "i, j) / *length", SKG_SELF_TEST_HEEL},
    {"blur.cl", "add ? SKG_LOAD_GLOBAL_V(realv, place) + sum[v] : sum[v]", "sum[v]", SKG_SELF_TEST_DEPTHS},
    {"blur.cl", "add ? place[k] + rest[k] : rest[k]", "rest[k]", SKG_SELF_TEST_DEPTHS},
    {"blur.cl", "weights[j * args.across + i]", "weights[i]", SKG_SELF_TEST_DEPTHS},
    {"blur.cl", "k < pixels; k++) place[k] = add", "k < pixels - 1; k++) place[k] = add", SKG_SELF_TEST_BLUR},
    {"detect.cl", "k < pixels; k++) image[k] = rest[k]", "k < pixels - 1; k++) image[k] = rest[k]",
     SKG_SELF_TEST_DETECTOR},
    {"attenuate.cl", "= noisy - pixels->shown[c][r]", "= noisy", SKG_SELF_TEST_APART},
    {"attenuate.cl", "pixels.spread[c], SKG_CHANNELS + c)", "pixels.spread[c], c)", SKG_SELF_TEST_APART},
    {"blur.cl", "add ? SKG_LOAD_GLOBAL_V(realv, place) + sum[v] : sum[v]", "sum[v]", SKG_SELF_TEST_APART},
    {"place.cl", "(long)taken[v]", "(long)taken[0]", SKG_SELF_TEST_PLACE},
    {"place.cl", "to[k] = finite ? at : x;", "to[k] = x;", SKG_SELF_TEST_PLACE},
    {"show.cl", "((depth < strip->depth[r]) | (", "((depth > strip->depth[r]) | (", SKG_SELF_TEST_PICTURE},
    {"show.cl", "face->box[2] / SKG_SHOW_TILE + 1", "face->box[2] / SKG_SHOW_TILE", SKG_SELF_TEST_PICTURE},
    {"show.cl", "skg_show_outside(rows, 1, r) | skg_show_outside(rows, 2, r)", "skg_show_outside(rows, 1, r)",
     SKG_SELF_TEST_PICTURE},
    {"show.cl", "strip->through[r] -= share;", "", SKG_SELF_TEST_PICTURE},
    {"scatter.cl", "p->weight *= fall / ", "p->weight *= ", SKG_SELF_TEST_SCATTER},
    {"tally.clh", "*left = kev * ratio", "*left = kev", SKG_SELF_TEST_SCATTER},
    {"scatter.cl", "p->changed |= changes | emits;", "p->weight *= (skg_fv)(0.8f);", SKG_SELF_TEST_SCATTER},
    {"sight.clh", "s->sr = g0 + g1 - s->k", "s->sr = g0 + g1", SKG_SELF_TEST_SCATTER},
    {"gather.clh", "fma(value, (skg_realv)((skg_real)row), own->rows)", "own->rows", SKG_SELF_TEST_GRADIENT},
    {"gather.clh", "skg_real scale = batch->scale[k]", "skg_real scale = batch->scale[k] * 2",
     SKG_SELF_TEST_GRADIENT},
    {"worth.clh", "value *= deep * deep", "value *= deep", SKG_SELF_TEST_GRADIENT},
    {"spread.clh", "* (skg_realv)(batch->scale[k]) * slope", "* (skg_realv)(batch->scale[k])",
     SKG_SELF_TEST_GRADIENT},
    {"tiny.clh", "(step >> 1) * target->stride", "(step >> 1)", SKG_SELF_TEST_GRADIENT},
    {"weights.cl", "values[r] * unit[r]", "values[r]", SKG_SELF_TEST_GRADIENT},
    {"weights.cl", "(skg_real)(strip->column + r * SKG_WIDE) + SKG_LANES, found",
     "(skg_real)(0) * SKG_LANES, found", SKG_SELF_TEST_GRADIENT},
    {"weights.cl", "of_rays[step] = ", "of_rays[step] = 0 * ", SKG_SELF_TEST_GRADIENT},
    {"slopes.cl", "off - before", "off", SKG_SELF_TEST_GRADIENT},
    {"gradient.cl", "(weight + lost) * deep", "weight * deep", SKG_SELF_TEST_GRADIENT},
    {"gather.clh", "around * factor * q", "around * factor", SKG_SELF_TEST_DENSITIES},
    {"gradient.cl", "skg_around_of(g, range,", "0 * skg_around_of(g, range,", SKG_SELF_TEST_DENSITIES},
    {"blur_variance.cl", "weight += weights[y * args.across + x]", "weight = weights[y * args.across + x]",
     SKG_SELF_TEST_VARIANCE},
    {"blur_variance.cl", "weights += args.first;", "", SKG_SELF_TEST_VARIANCE},
    {"detect_variance.cl", "args.spacing * args.spacing / (skg_real)(12)", "(skg_real)(0)",
     SKG_SELF_TEST_VARIANCE},
    {"detect_variance.cl", "scale /= flat_field[pixel];", "", SKG_SELF_TEST_VARIANCE},
    {"detect_variance.cl", "mean[pixel]", "mean[row * columns]", SKG_SELF_TEST_VARIANCE},
    {"pulses.cl", "clamp(row - j, 0, args->to.rows - 1)", "clamp(row + j, 0, args->to.rows - 1)",
     SKG_SELF_TEST_PULSES},
    {"pulses.cl", "own + k * square, column, row)", "own, column, row)", SKG_SELF_TEST_PULSES},
    {"pulses.cl", "off[c] - part * moved)", "off[c])", SKG_SELF_TEST_PULSES},
    {"pile_up.clh", "weighted *= n / (real)(j);", "weighted *= n;", SKG_SELF_TEST_PULSES},
    {"pile_up.clh", "lone * (single + after[c + 1])", "lone * single", SKG_SELF_TEST_PULSES},
    {"pulses.cl", "shorter * shorter", "shorter", SKG_SELF_TEST_PULSES},
    {"pulses.cl", "pile_up == SKG_PILE_UP_PULSES_END ? longer", "pile_up == 7 ? longer",
     SKG_SELF_TEST_PULSES},
    {"pulses.cl", "sum = fma(weight * weight, ", "sum = fma(weight, ", SKG_SELF_TEST_PULSES},
    {"scattered.cl", "args->add ? image[k] : (skg_real)(0)", "(skg_real)(0)", SKG_SELF_TEST_SCATTER},
    {"show.cl", "colour >> (uint)shift & 0xffu", "colour & 0xffu", SKG_SELF_TEST_PICTURE},
};

/* Extents end at multiples of SKG_EXTENT_COLUMNS, so that a device whose vectors read together are not wider never calls the
 * function that reads at their edge. */
static int is_reached(int number, const skg_device_info *device) {
    return strcmp(errors[number].file, "planes.clh") != 0 ||
           SKG_CPU_RUNS * device->float_width > SKG_EXTENT_COLUMNS;
}

/* Squares are the tiles of GPUs, and these gather faces one by one. */
static int is_of_gpus(int number) {
    const int gathers =
        strcmp(errors[number].file, "gradient.cl") == 0 && errors[number].test == SKG_SELF_TEST_DENSITIES;
    return gathers || strstr("raster_squares.cl tiles.cl", errors[number].file) != NULL;
}

/* The self-test of energies has the planes of the plan that asks, and so its program; a general program is tested elsewhere. */
START_TEST(energies_with_the_planes_of_a_plan) {
    static const int32_t asked[] = {0, 5, SKG_FEW_PLANES, SKG_FEW_PLANES + 1},
                         tested[] = {2, 5, SKG_FEW_PLANES, 2};
    skg_context *context = open_first("");
    for (int k = 0; k < 4; k++) {
        skg_self_test_scene scene;
        skg_plan *plan = NULL;
        skg_verdict verdict;
        context->device->planes = asked[k];
        context->device->self_testing = 1; /* the plan below does not ask */
        ck_skg(skg_self_test_scene_create(context, SKG_SELF_TEST_ENERGIES, 16, &scene));
        ck_skg(skg_plan_create(context, scene.scene, &scene.view, scene.beam, &scene.options, &plan));
        ck_assert_int_eq(plan->recipe->model.planes, tested[k]);
        context->device->self_testing = 0;
        skg_plan_release(&plan);
        skg_self_test_scene_release(&scene);
        ck_skg(skg_self_test_repeat(context, SKG_SELF_TEST_ENERGIES, &verdict));
        ck_assert_msg(verdict.good, "%d planes: %s", tested[k], verdict.reason);
    }
    skg_context_release(&context);
}
END_TEST

START_TEST(wrong_kernels_are_found) {
    char more[96];
    skg_verdict verdict;
    copy_kernels(errors[_i].file, errors[_i].old, errors[_i].new);
    snprintf(more, sizeof more, "kernels=%s", kernels);
    skg_context *context = open_first(more);
    context->device->info.gpu |= is_of_gpus(_i);
    ck_skg(skg_self_test_repeat(context, errors[_i].test, &verdict));
    if (is_reached(_i, &context->device->info)) {
        ck_assert_int_eq(verdict.good, 0);
        ck_assert_msg(strstr(verdict.reason, "pixel") != NULL, "%s", verdict.reason);
    }
    skg_context_release(&context);
    remove_kernels();
}
END_TEST

/* Else the list would grow old unseen between two nights. */
START_TEST(errors_are_of_the_kernels_as_they_are) {
    for (size_t e = 0; e < sizeof errors / sizeof *errors; e++) {
        copy_kernels(errors[e].file, errors[e].old, errors[e].new);
        remove_kernels();
    }
}
END_TEST

static void keep_verdict(const skg_context *context, const char *test, int good, double score) {
    skg_verdict verdict = {.good = good, .score = score};
    snprintf(verdict.reason, sizeof verdict.reason, "pixel (1, 2) is black");
    skg_verdict_keep(context->device->store, &context->device->identity, test, &verdict);
}

START_TEST(a_verdict_is_found_once_and_kept) {
    skg_context *context = NULL;
    skg_verdict verdict;
    ck_skg(skg_context_create("device=0:0", &context));
    ck_assert_int_eq(count_kept(".verdict", NULL), 1);
    ck_assert_int_eq(skg_verdict_known(context->device->store, &context->device->identity,
                                       skg_self_test_name(SKG_SELF_TEST_CORE), &verdict),
                     1);
    ck_assert_int_eq(verdict.good, 1);
    ck_assert_double_gt(verdict.score, 0);
    skg_context_release(&context);
    ck_skg(skg_context_create("device=0:0", &context));
    ck_assert_int_eq(context->device->builds + context->device->loads, 0); /* it was not tested again */
    skg_context_release(&context);
}
END_TEST

START_TEST(a_device_that_failed_is_refused) {
    skg_context *context = open_first("");
    skg_device_test result;
    keep_verdict(context, skg_self_test_name(SKG_SELF_TEST_CORE), 0, 0);
    skg_context_release(&context);
    ck_skg_fails(skg_context_create("device=0:0", &context), SKG_ERR_DEVICE, "computes wrongly");
    ck_skg_fails(skg_context_create("device=0:0", &context), SKG_ERR_DEVICE, "pixel (1, 2) is black");
    ck_assert_ptr_null(context);
    skg_device_test_init(&result);
    ck_skg(skg_device_test_run(0, 0, &result)); /* tests again, and finds it right */
    ck_assert_int_eq(result.verdict, SKG_TEST_RIGHT);
    ck_assert_str_eq(result.name, skg_self_test_name(SKG_SELF_TEST_CORE));
    ck_skg(skg_context_create("device=0:0", &context));
    skg_context_release(&context);
}
END_TEST

#ifdef SKG_COMMAND
/* Output of the command about devices, if the only one that it may choose is refused. */
static void list_devices(const char *flags, char *said, size_t size) {
    char line[512];
    snprintf(line, sizeof line, "%s devices --device 0:0 %s 2>/dev/null", SKG_COMMAND, flags);
    FILE *pipe = popen(line, "r");
    ck_assert_ptr_nonnull(pipe);
    said[fread(said, 1, size - 1, pipe)] = '\0';
    const int status = pclose(pipe);
    ck_assert(WIFEXITED(status));
    ck_assert_int_eq(WEXITSTATUS(status), 4); /* as any call that lacks a device */
}

START_TEST(a_refused_device_is_listed_with_the_reason) {
    char said[16384];
    skg_context *context = open_first("");
    keep_verdict(context, skg_self_test_name(SKG_SELF_TEST_CORE), 0, 0);
    list_devices("", said, sizeof said);
    ck_assert_msg(strstr(said, context->device->info.name) != NULL, "%s", said);
    ck_assert_msg(strstr(said, "\n       refused: ") != NULL, "%s", said);
    ck_assert_msg(strstr(said, "pixel (1, 2) is black") != NULL, "%s", said);
    ck_assert_msg(strchr(said, '*') == NULL, "a device is chosen: %s", said);
    list_devices("--json", said, sizeof said);
    ck_assert_msg(strstr(said, "\"refused\": \"") != NULL, "%s", said);
    ck_assert_msg(strstr(said, "\"chosen\": true") == NULL, "%s", said);
    skg_context_release(&context);
}
END_TEST
#endif

/* A plan of the scene of a self-test, with a gradient of it, or without. */
static skg_status plan_of(skg_context *context, skg_self_test number, int noise, int gradient) {
    skg_self_test_scene scene;
    skg_plan *plan = NULL;
    skg_gradient wanted;
    skg_adjoint adjoint;
    double ones[16 * 16], poses[12];
    ck_skg(skg_self_test_scene_create(context, number, 16, &scene));
    scene.options.noise = noise;
    skg_status status = skg_plan_create(context, scene.scene, &scene.view, scene.beam, &scene.options, &plan);
    if (gradient) {
        ck_skg(status);
        skg_gradient_init(&wanted);
        skg_adjoint_init(&adjoint);
        for (int p = 0; p < 16 * 16; p++) ones[p] = 1;
        adjoint.channels = 1, adjoint.rows = adjoint.columns = 16, adjoint.data = ones;
        wanted.poses = poses;
        status = skg_plan_gradient(plan, NULL, &adjoint, &wanted);
    }
    skg_plan_release(&plan);
    skg_self_test_scene_release(&scene);
    return status;
}

static skg_status plan_with(skg_context *context, int noise) {
    return plan_of(context, SKG_SELF_TEST_CORE, noise, 0);
}

/* Kernels that not every plan needs: only plans that need them are refused. */
START_TEST(wrong_kernels_are_refused_when_they_are_needed) {
    skg_context *context = NULL;
    ck_skg(skg_context_create("device=0:0", &context));
    ck_skg(plan_with(context, 0));
    keep_verdict(context, "noise", 0, 0);
    ck_skg(plan_with(context, 0));
    ck_skg_fails(plan_with(context, 1), SKG_ERR_DEVICE, "with the kernels of noise");
    keep_verdict(context, "noise", 1, 0);
    ck_skg(plan_with(context, 1));
    skg_context_release(&context);
}
END_TEST

/* Linear values between cells have a program of their own, and so have derivatives beside cells: plans without do not wait for their
 * tests. */
START_TEST(kernels_of_volumes_are_refused_when_they_are_needed) {
    skg_context *context = NULL;
    ck_skg(skg_context_create("device=0:0", &context));
    keep_verdict(context, "priority", 1, 0);
    keep_verdict(context, "gradients", 1, 0);
    keep_verdict(context, "volumes", 0, 0);
    keep_verdict(context, "linear volumes", 1, 0);
    ck_skg(plan_of(context, SKG_SELF_TEST_LINEAR, 0, 0));
    ck_skg_fails(plan_of(context, SKG_SELF_TEST_VOLUME, 0, 0), SKG_ERR_DEVICE, "with the kernels of volumes");
    skg_context_release(&context);
    ck_skg(skg_context_create("device=0:0", &context));
    keep_verdict(context, "volumes", 1, 0);
    keep_verdict(context, "linear volumes", 0, 0);
    keep_verdict(context, "volume gradients", 0, 0);
    ck_skg(plan_of(context, SKG_SELF_TEST_VOLUME, 0, 0));
    ck_skg_fails(plan_of(context, SKG_SELF_TEST_LINEAR, 0, 0), SKG_ERR_DEVICE,
                 "with the kernels of linear volumes");
    ck_skg_fails(plan_of(context, SKG_SELF_TEST_CELLS, 0, 1), SKG_ERR_DEVICE,
                 "with the kernels of volume gradients");
    ck_skg(plan_of(context, SKG_SELF_TEST_GRADIENT, 0, 1));
    skg_context_release(&context);
}
END_TEST

/* Kernels that no plan needs by itself: the calls that need them are refused. */
START_TEST(calls_are_refused_whose_kernels_are_wrong) {
    skg_context *context = NULL;
    skg_self_test_scene scene;
    skg_plan *plan = NULL;
    skg_job *job = NULL;
    skg_output output;
    const float bound[3] = {0};
    float lengths[256];
    uint8_t rgba[4];
    skg_output_init(&output);
    output.data = lengths;
    output.type = SKG_TYPE_FLOAT32;
    ck_skg(skg_context_create("device=0:0", &context));
    ck_skg(skg_self_test_scene_create(context, SKG_SELF_TEST_CORE, 16, &scene));
    ck_skg(skg_plan_create(context, scene.scene, &scene.view, scene.beam, &scene.options, &plan));
    keep_verdict(context, "path lengths", 0, 0);
    keep_verdict(context, "positions on the device", 0, 0);
    keep_verdict(context, "3D view", 0, 0);
    output.kind = SKG_OUTPUT_LENGTHS;
    ck_skg_fails(skg_plan_submit(plan, 1, NULL, 1, &output, &job), SKG_ERR_DEVICE,
                 "with the kernels of path lengths");
    ck_skg_fails(skg_plan_positions_set_cl(plan, 0, NULL, 0, bound, bound, 0, NULL, NULL), SKG_ERR_DEVICE,
                 "with the kernels of positions on the device");
    ck_skg_fails(skg_scene_picture(context, scene.scene, &scene.view, NULL, rgba), SKG_ERR_DEVICE,
                 "with the kernels of 3D view");
    keep_verdict(context, "path lengths", 1, 0);
    ck_skg(skg_plan_submit(plan, 1, NULL, 1, &output, &job));
    ck_skg(skg_job_wait(&job));
    skg_plan_release(&plan);
    skg_self_test_scene_release(&scene);
    skg_context_release(&context);
}
END_TEST

START_TEST(where_nothing_is_kept_every_context_tests) {
    skg_context *context = NULL;
    setenv("SKG_CACHE_DIR", "none", 1);
    ck_skg(skg_context_create("device=0:0", &context));
    ck_assert_int_gt(context->device->builds, 0);
    ck_assert_int_eq(context->device->passed & 1, 1);
    skg_context_release(&context);
    ck_assert_int_eq(count_kept("", NULL), 0);
}
END_TEST

START_TEST(bad_numbers_are_refused) {
    skg_device_test result;
    int64_t count = 0, devices = 0;
    skg_device_test_init(&result);
    ck_skg(skg_device_test_count(&count));
    ck_skg(skg_device_count(&devices));
    ck_assert_int_eq(count, SKG_SELF_TESTS);
    ck_skg_fails(skg_device_test_run(0, count, &result), SKG_ERR_ARGUMENT, "counted from 0");
    ck_skg_fails(skg_device_test_run(0, -1, &result), SKG_ERR_ARGUMENT, "counted from 0");
    ck_skg_fails(skg_device_test_run(devices, 0, &result), SKG_ERR_ARGUMENT, "counted from 0");
    ck_skg_fails(skg_device_test_run(0, 0, NULL), SKG_ERR_ARGUMENT, "result");
    ck_skg_fails(skg_device_test_count(NULL), SKG_ERR_ARGUMENT, "count");
}
END_TEST

static void add_tests(TCase *tests) {
    const int wrong = (int)(sizeof errors / sizeof *errors);
    tcase_add_checked_fixture(tests, make_cache_folder, remove_cache_folder);
    tcase_add_loop_test(tests, wrong_kernels_are_found, 0, SKG_WRONG_KERNELS ? wrong : 2);
    if (SKG_WRONG_KERNELS) return;
    tcase_add_test(tests, errors_are_of_the_kernels_as_they_are);
    tcase_add_test(tests, boxes_have_known_lengths);
    tcase_add_test(tests, meshes_of_boxes_are_closed_unless_split);
    tcase_add_test(tests, a_right_device_passes);
    tcase_add_test(tests, energies_with_the_planes_of_a_plan);
    tcase_add_test(tests, a_verdict_is_found_once_and_kept);
    tcase_add_test(tests, a_device_that_failed_is_refused);
#ifdef SKG_COMMAND
    tcase_add_test(tests, a_refused_device_is_listed_with_the_reason);
#endif
    tcase_add_test(tests, wrong_kernels_are_refused_when_they_are_needed);
    tcase_add_test(tests, kernels_of_volumes_are_refused_when_they_are_needed);
    tcase_add_test(tests, calls_are_refused_whose_kernels_are_wrong);
    tcase_add_test(tests, where_nothing_is_kept_every_context_tests);
    tcase_add_test(tests, bad_numbers_are_refused);
}

SKG_SUITE_MAIN("selftest", add_tests)
