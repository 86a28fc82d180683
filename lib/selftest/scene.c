/* The scenes of the self-tests. */
#include "selftest/selftest.h"

#include <math.h>
#include <stdio.h>

/* Attenuation of the parts in 1/cm at the energies of the beam, in keV: numbers of which no part's follow from those of others. A scene
 * has as many energies as parts, but at least LEAST. */
enum { ENERGIES = SKG_SELF_TEST_ENERGIES_MAX, PARTS = SKG_SELF_TEST_PARTS, LEAST = 3 };
static const double energies[ENERGIES] = {40, 60, 90, 110, 130, 150},
                    photons[ENERGIES] = {1000, 2000, 500, 700, 300, 400};
static const double attenuation[PARTS][ENERGIES] = {
    {0.27, 0.2, 0.17, 0.16, 0.15, 0.14}, {1.28, 0.6, 0.34, 0.28, 0.24, 0.22}, {0.9, 0.8, 0.3, 0.9, 0.2, 0.4},
    {0.3, 0.9, 0.8, 0.2, 0.7, 0.1},      {0.8, 0.1, 0.9, 0.3, 0.1, 0.9},      {0.2, 0.7, 0.1, 0.8, 0.9, 0.3}};

/* Lengths in single precision: numerics.md has 3e-5 of the longest path; three times that for the corners of the boxes,
 * which a mesh keeps as floats. In double precision the latter alone. In half precision depths have 11 bits over the
 * 1,200 mm from the source. Intensities change by at most mu L exp(-mu L) < 0.4 times the relative error of a length,
 * and by the rounding of floats. */
skg_tolerance skg_self_test_tolerance(skg_self_test number) {
    switch (number) {
    case SKG_SELF_TEST_DOUBLE:
        return (skg_tolerance){2e-6, 2e-6};
    case SKG_SELF_TEST_HALF:
        return (skg_tolerance){0.1, 0.1};
    case SKG_SELF_TEST_SHADES:
        return (skg_tolerance){1e-4, 1e-3}; /* the tables of a grid are linear between points */
    default:
        return (skg_tolerance){1e-4, 1e-4};
    }
}

static int has_priority(const skg_self_test_scene *scene) {
    return scene->number == SKG_SELF_TEST_PRIORITY || scene->number == SKG_SELF_TEST_GRADIENT;
}

/* Whether part 1 is a volume of cells, which part 0 displaces. */
static int has_volume(const skg_self_test_scene *scene) {
    return scene->number == SKG_SELF_TEST_VOLUME || scene->number == SKG_SELF_TEST_LINEAR ||
           scene->number == SKG_SELF_TEST_CELLS;
}

/* Whether part 1 is inside part 0. */
static int is_nested(const skg_self_test_scene *scene) {
    return scene->number == SKG_SELF_TEST_DENSITIES;
}

/* As many parts as the plan that asks has planes, if a program for them has no more than these. */
static int32_t count_parts(const skg_self_test_scene *scene, int32_t planes) {
    if (scene->number == SKG_SELF_TEST_ENERGIES) return planes < 2 || planes > PARTS ? 2 : planes;
    return 1 + (has_priority(scene) || is_nested(scene) || has_volume(scene));
}

/* The boxes of part 0, before those that are parts of their own. */
static int boxes_of_first(const skg_self_test_scene *scene) {
    return scene->parts > 2 ? SKG_SELF_TEST_BOXES + 2 - scene->parts : SKG_SELF_TEST_BOXES;
}

/* The part of a box: the last one is part 1. */
static int part_of(const skg_self_test_scene *scene, int box) {
    return box < boxes_of_first(scene) ? 0 : SKG_SELF_TEST_BOXES + 1 - box;
}

static int count_energies(const skg_self_test_scene *scene) {
    const int several = scene->number == SKG_SELF_TEST_ENERGIES || scene->number == SKG_SELF_TEST_HEEL;
    return !several ? 1 : scene->parts > LEAST ? scene->parts : LEAST;
}

/* The last pixels of a row that fill no vector, and vectors that end before those that are read with them, have code paths of
 * their own. A row of 83 pixels has both, with vectors of 1, 4, 8 and 16 of which four are read together. */
static int has_odd_rows(skg_self_test number) {
    return number == SKG_SELF_TEST_CORE || number == SKG_SELF_TEST_BLUR || number == SKG_SELF_TEST_DETECTOR ||
           number == SKG_SELF_TEST_DEPTHS;
}

/* One large box, smaller ones of all sizes on a spiral around it, and one that pierces the large one. Their places and
 * angles are arbitrary. The large one's triangles cross the whole detector, so that they are drawn by the loops, lists and
 * queues that are made for large triangles. */
static void place_boxes(skg_self_test_scene *scene) {
    for (int b = 0; b < SKG_SELF_TEST_BOXES; b++) {
        const double turn = 2.4 * b, far = 14 + 1.1 * b, size = 0.15 * exp(0.13 * b);
        const double centre[3] = {far * cos(turn), far * sin(turn), 10 * sin(1.7 * b)};
        const double half[3] = {size, 1.3 * size, 0.7 * size};
        const double angles[3] = {0.3 + b, 0.7 + 0.5 * b, 1.1 + 0.3 * b};
        scene->boxes[b] = skg_box_turned(centre, half, angles);
    }
    /* The large one, or a narrow one around the source, whose sides the outer rays cross beside the source. */
    const double middle[3] = {1, -2, 3}, half[3] = {30, 42, 15}, angles[3] = {0.31, 0.52, 0.23};
    const double source[3] = {0.2, -0.1, -990}, narrow[3] = {1, 0.8, 30}, upright[3] = {0.01, 0.02, 0.23};
    scene->boxes[0] = scene->number == SKG_SELF_TEST_SOURCE_PLANE ? skg_box_turned(source, narrow, upright)
                                                                  : skg_box_turned(middle, half, angles);
    const double beside[3] = {9, 3, 1}, other[3] = {8, 5, 6}, others[3] = {0.71, 0.13, 0.4};
    scene->boxes[SKG_SELF_TEST_BOXES] = skg_box_turned(beside, other, others);
    /* Cells that the large box displaces in part. */
    const double above[3] = {4, 3, 19}, cells[3] = {6, 5, 7};
    if (has_volume(scene)) scene->boxes[SKG_SELF_TEST_BOXES] = skg_box_turned(above, cells, others);
}

/* Boxes elsewhere, of which the mesh of SKG_SELF_TEST_PLACE is made. */
static void misplace(const skg_self_test_scene *scene, skg_box *boxes) {
    for (int b = 0; b < SKG_SELF_TEST_BOXES; b++) {
        boxes[b] = scene->boxes[b];
        boxes[b].centre[0] += 5, boxes[b].centre[1] -= 3, boxes[b].centre[2] += 2;
    }
}

static skg_status add_volume(skg_self_test_scene *scene, skg_part *given) {
    skg_status status = skg_self_test_volume(scene, &given->volume);
    if (status == SKG_OK) status = skg_scene_part_add(scene->scene, given, NULL);
    skg_volume_release(&given->volume);
    return status;
}

static skg_status add_part(skg_context *context, skg_self_test_scene *scene, int part) {
    const skg_box *first = part == 0 ? scene->boxes : scene->boxes + SKG_SELF_TEST_BOXES + 1 - part;
    char label[16] = "boxes";
    skg_box elsewhere[SKG_SELF_TEST_BOXES];
    skg_part given;
    skg_part_init(&given);
    if (scene->number == SKG_SELF_TEST_PLACE) {
        misplace(scene, elsewhere);
        first = elsewhere;
    }
    if (part > 0) snprintf(label, sizeof label, "box %d", part);
    given.label = label;
    given.priority = has_priority(scene) ? part : has_volume(scene) ? 1 - part : 0;
    if (part == 1 && is_nested(scene)) given.inside = 0;
    if (part == 1 && has_volume(scene)) return add_volume(scene, &given);
    skg_status status = skg_boxes_mesh(context, first, part == 0 ? boxes_of_first(scene) : 1,
                                       part == 0 && scene->number == SKG_SELF_TEST_LEAKY, &given.mesh);
    if (status == SKG_OK)
        status =
            skg_material_create_table(given.label, ENERGIES, energies, attenuation[part], &given.material);
    if (status == SKG_OK) status = skg_scene_part_add(scene->scene, &given, NULL);
    skg_material_release(&given.material);
    skg_mesh_release(&given.mesh);
    return status;
}

static void choose_options(skg_self_test_scene *scene) {
    skg_plan_options *options = &scene->options;
    skg_plan_options_init(options);
    options->overlaps = 0;
    switch (scene->number) {
    case SKG_SELF_TEST_COPIES:
        options->strategy = SKG_STRATEGY_COPIES;
        break;
    case SKG_SELF_TEST_TILES:
        options->strategy = SKG_STRATEGY_TILES;
        break;
    case SKG_SELF_TEST_ATOMICS:
        options->strategy = SKG_STRATEGY_ATOMICS;
        break;
    case SKG_SELF_TEST_DOUBLE:
        options->precision = SKG_PRECISION_DOUBLE;
        break;
    case SKG_SELF_TEST_HALF:
        options->precision = SKG_PRECISION_HALF;
        break;
    case SKG_SELF_TEST_LEAKY:
        options->repair = SKG_REPAIR_NEIGHBOURS;
        break;
    case SKG_SELF_TEST_GRADIENT:
    case SKG_SELF_TEST_DENSITIES:
    case SKG_SELF_TEST_CELLS:
        options->quantity = SKG_QUANTITY_ATTENUATION;
        break;
    case SKG_SELF_TEST_NOISE:
        options->noise = 1;
        break;
    case SKG_SELF_TEST_RAYS:
        options->supersampling = 2;
        break;
    case SKG_SELF_TEST_PASSES:
    case SKG_SELF_TEST_SIDE:
        options->strategy = SKG_STRATEGY_COPIES;
        options->spot = &scene->spot;
        break;
    default:
        break;
    }
}

/* As many samples as are drawn together (plan/decisions.h); on a single worker PASSES draws each by itself. */
static void choose_spot(const skg_context *context, skg_self_test_scene *scene) {
    const int32_t workers = context->device->info.compute_units;
    skg_spot_init(&scene->spot);
    scene->spot.shape = SKG_SPOT_RECTANGLE;
    scene->spot.extent[0] = scene->spot.extent[1] = 2;
    scene->spot.samples = scene->number == SKG_SELF_TEST_SIDE ? 4 * workers : workers;
}

skg_status skg_self_test_scene_create(skg_context *context, skg_self_test number, int64_t pixels,
                                      skg_self_test_scene *scene) {
    *scene = (skg_self_test_scene){.number = number};
    skg_view *view = &scene->view;
    skg_view_init(view);
    view->columns = has_odd_rows(number) ? pixels - 13 : pixels;
    view->rows = pixels;
    view->source[2] = -1000;
    view->centre[2] = 200;
    view->column_step[0] = view->row_step[1] = 100.0 / (double)pixels;
    scene->parts = count_parts(scene, context->device->planes);
    place_boxes(scene);
    choose_spot(context, scene);
    choose_options(scene);
    SKG_TRY(skg_scene_create(context, &scene->scene));
    for (int p = 0; p < scene->parts; p++) SKG_TRY(add_part(context, scene, p));
    const int bins = count_energies(scene);
    if (bins > 1) return skg_spectrum_create_bins(bins, energies, photons, &scene->beam);
    return skg_spectrum_create_mono(energies[0], photons[0], &scene->beam);
}

void skg_self_test_scene_release(skg_self_test_scene *scene) {
    skg_scene_release(&scene->scene);
    skg_spectrum_release(&scene->beam);
    skg_response_release(&scene->response);
    skg_material_release(&scene->crystal);
    skg_material_release(&scene->filter);
}

void skg_self_test_lengths(const skg_self_test_scene *scene, double row, double column, double *surface,
                           double *net) {
    const skg_view *view = &scene->view;
    double pixel[3], enters = 0, leaves = 0, distance = 0, from = 0, to = 0;
    const double i = column - (double)(view->columns - 1) / 2, j = row - (double)(view->rows - 1) / 2;
    for (int k = 0; k < 3; k++) {
        pixel[k] = view->centre[k] + i * view->column_step[k] + j * view->row_step[k];
        distance += (pixel[k] - view->source[k]) * (pixel[k] - view->source[k]);
    }
    distance = sqrt(distance);
    const int other = scene->parts > 1 &&
                      skg_box_crossed(&scene->boxes[SKG_SELF_TEST_BOXES], view->source, pixel, &from, &to);
    *surface = net[0] = net[1] = 0;
    for (int p = 2; p < scene->parts; p++) net[p] = 0;
    if (other) net[1] = (to - from) * distance;
    for (int b = 0; b < SKG_SELF_TEST_BOXES; b++) {
        if (!skg_box_crossed(&scene->boxes[b], view->source, pixel, &enters, &leaves)) continue;
        const int part = part_of(scene, b);
        if (part == 0) *surface += (leaves - enters) * distance;
        net[part] += (leaves - enters) * distance;
        if (other && has_priority(scene)) /* part 1 displaces part 0 */
            net[0] -= fmax(0, fmin(leaves, to) - fmax(enters, from)) * distance;
    }
    if (is_nested(scene)) net[0] -= net[1]; /* part 1 is in place of part 0 */
    if (has_volume(scene))
        net[1] = skg_self_test_cells(scene, view->source, pixel) * distance / attenuation[1][0];
}

double skg_self_test_intensity(const skg_self_test_scene *scene, const double *shares, const double *net,
                               double *open) {
    const int bins = count_energies(scene);
    double shown = 0;
    *open = 0;
    for (int e = 0; e < bins; e++) {
        double exponent = 0.1 * (attenuation[0][e] * net[0] + attenuation[1][e] * net[1]);
        for (int p = 2; p < scene->parts; p++) exponent += 0.1 * attenuation[p][e] * net[p];
        *open += photons[e] * energies[e];
        shown += shares[e] * photons[e] * energies[e] * exp(-exponent);
    }
    return shown;
}
