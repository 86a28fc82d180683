/* The generated thorax: closed, outward, in its place, disjoint; as files too. */
#include "body/inside.h"
#include "geometry/overlaps.h"
#include "phantom/anatomy.h"
#include "suite.h"

#include <skiagraph/breathing.h>
#include <skiagraph/skiagraph.h>

#include <float.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { PARTS_MAX = 160 };

static skg_thorax *thorax;
static skg_thorax_part part[PARTS_MAX];
static int64_t parts;

static void make(int simple, int64_t triangles) {
    skg_thorax_options options;
    skg_thorax_options_init(&options);
    options.simple = simple;
    options.triangles = triangles;
    ck_skg(skg_thorax_create(&options, &thorax));
    ck_skg(skg_thorax_part_count(thorax, &parts));
    ck_assert_int_le(parts, PARTS_MAX);
    for (int64_t i = 0; i < parts; i++) {
        skg_thorax_part_init(part + i);
        ck_skg(skg_thorax_part_get(thorax, i, part + i));
    }
}

static int64_t find(const char *label) {
    for (int64_t i = 0; i < parts; i++)
        if (!strcmp(part[i].label, label)) return i;
    ck_abort_msg("no part %s", label);
    return -1;
}

static skg_mesh_health health_of(int64_t i) {
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    ck_skg(skg_mesh_health_get(part[i].mesh, &health));
    return health;
}

/* The pieces that a part is made of; 0: any number. */
static int pieces_of(const char *label, int simple) {
    static const struct {
        const char *label;
        int pieces[2]; /* full, simple */
    } known[] = {{"spine", {98, 28}},
                 {"bile ducts", {8, 8}},
                 {"discs", {13, 0}},
                 {"bowel gas", {3, 0}},
                 {"scapula left", {4, 0}},
                 {"scapula right", {4, 0}},
                 {"pulmonary vessels left", {0, 0}},
                 {"pulmonary vessels right", {0, 0}}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (!strcmp(label, known[i].label)) return known[i].pieces[simple];
    return 1;
}

START_TEST(every_mesh_is_closed) { /* at three sizes; genus 0: vertices - edges + faces = 2 per component */
    const int64_t sizes[] = {10000, 42000, 200000};
    const int simple = _i / 3;
    make(simple, sizes[_i % 3]);
    int64_t total = 0;
    for (int64_t i = 0; i < parts; i++) {
        skg_mesh_health h = health_of(i);
        ck_assert_msg(h.closed && h.consistent && h.outward && !h.flipped && h.degenerate_triangles == 0 &&
                          h.nonmanifold_edges == 0 && h.duplicate_triangles == 0,
                      "%s: closed %d, consistent %d, flipped %d, degenerate %d", part[i].label, h.closed,
                      h.consistent, h.flipped, (int)h.degenerate_triangles);
        ck_assert_int_eq(h.welded_vertices, h.vertices);
        ck_assert_int_eq(2 * h.vertices - h.triangles, 4 * h.components);
        const int pieces = pieces_of(part[i].label, simple);
        ck_assert_msg(pieces == 0 || h.components == pieces, "%s: %d components", part[i].label,
                      (int)h.components);
        total += h.triangles;
    }
    /* Parts have whole numbers of quads around and along: 3 %. */
    if (_i % 3 > 0) ck_assert_double_le(fabs((double)total / (double)sizes[_i % 3] - 1), 0.03);
    skg_thorax_release(&thorax);
    ck_assert_ptr_null(thorax);
}
END_TEST

START_TEST(parts_are_where_and_as_large_as_they_should_be) {
    make(_i, 42000);
    static const struct {
        const char *label;
        double least, most; /* ml */
    } volume[] = {{"lung left", 1000, 2000},  {"lung right", 1200, 2300}, {"heart", 400, 750},
                  {"liver", 800, 1800},       {"gallbladder", 8, 30},     {"trachea", 15, 35},
                  {"rib 6 left", 20, 40},     {"sternum body", 15, 70},   {"diaphragm", 150, 600},
                  {"common bile duct", 1, 5}, {"needle", 0.05, 0.1}};
    for (size_t v = 0; v < sizeof volume / sizeof *volume; v++) {
        double ml = health_of(find(volume[v].label)).volume / 1000;
        ck_assert_msg(ml >= volume[v].least && ml <= volume[v].most, "%s: %g ml", volume[v].label, ml);
    }
    /* the liver is on the right, the heart to the left, the right dome is the higher one */
    const double *liver = health_of(find("liver")).bounds, *heart = health_of(find("heart")).bounds;
    ck_assert_double_lt(liver[0] + liver[3], -40);
    ck_assert_double_gt(heart[0] + heart[3], 20);
    /* the cage: width to depth 1.62 +- 0.14 at T6 of the living; ours within twice that */
    skg_mesh_health left = health_of(find("rib 6 left")), right = health_of(find("rib 6 right"));
    double ratio = (left.bounds[3] - right.bounds[0]) / (left.bounds[4] - left.bounds[1]);
    /* Twice the standard deviation of 0.14, see above. */
    ck_assert_double_le(fabs(ratio - 1.62), 0.28);
    for (int k = 0; k < 2; k++)
        ck_assert_double_eq_tol(left.bounds[3 * k], -right.bounds[3 - 3 * k], 16 * DBL_EPSILON * 150);
    ck_assert_str_eq(part[find("liver")].material, "Liver");
    ck_assert_ptr_null(part[find("spine")].material); /* by its Hounsfield number */
    ck_assert_str_eq(part[find("needle")].material, "Needle steel");
    ck_assert_int_eq(part[find("bile ducts")].inside, find("liver"));
    ck_assert_int_eq(part[find("liver")].inside, find(_i ? "skin" : "muscle"));
    skg_thorax_release(&thorax);
}
END_TEST

START_TEST(organs_are_those_of_a_chest) { /* volumes of adults as in the literature, to about a fifth */
    make(0, 42000);
    static const struct {
        const char *label;
        double least, most; /* ml */
    } volume[] = {{"heart", 480, 800},
                  {"liver", 1500, 1800},
                  {"kidney left", 120, 190},
                  {"kidney right", 120, 190},
                  {"spleen", 125, 240},
                  {"stomach", 150, 600},
                  {"aorta", 60, 120},
                  {"scapula left", 25, 90},
                  {"pulmonary vessels left", 12, 120},
                  {"spine", 150, 350},
                  {"marrow of rib 6 left", 12, 26}};
    for (size_t v = 0; v < sizeof volume / sizeof *volume; v++) {
        double ml = health_of(find(volume[v].label)).volume / 1000;
        ck_assert_msg(ml >= volume[v].least && ml <= volume[v].most, "%s: %g ml", volume[v].label, ml);
    }
    /* The right border of the heart is 35 to 50 mm from the midline, its apex 75 to 95 mm. */
    const skg_mesh_health heart = health_of(find("heart"));
    ck_assert_msg(heart.bounds[0] <= -35 && heart.bounds[0] >= -50 && heart.bounds[3] >= 75 &&
                      heart.bounds[3] <= 95,
                  "heart from %g to %g", heart.bounds[0], heart.bounds[3]);
    skg_thorax_release(&thorax);
}
END_TEST

/* Beside the left border of the heart there is lung, in front of it and behind it: the border is a line in the image. */
START_TEST(lung_lies_along_the_left_border_of_the_heart) {
    solid heart, lung;
    make(0, 42000);
    solid_make(part[find("heart")].mesh, &heart);
    solid_make(part[find("lung left")].mesh, &lung);
    for (double z = 15; z <= 45; z += 5) {
        double p[3] = {0, 0, z}, border = 0;
        int deep = 0,
            covered = 0; /* mm of the heart 6 mm within the border, and of the lung 10 mm outside it */
        for (p[1] = -130; p[1] <= -20; p[1]++)
            for (p[0] = 40; p[0] < 120; p[0]++)
                if (p[0] > border && solid_holds(&heart, p)) border = p[0];
        for (p[1] = -130; p[1] <= -20; p[1]++) {
            p[0] = border - 6;
            if (!solid_holds(&heart, p)) continue;
            p[0] = border + 10;
            deep++, covered += solid_holds(&lung, p);
        }
        if (getenv("SKG_LIST")) printf("z %g mm: border at %g mm, %d of %d mm\n", z, border, covered, deep);
        /* Half of the depth: the wall of the chest is in front of the rest. */
        ck_assert_msg(deep >= 20 && covered >= 0.5 * deep, "z %g mm: %d of %d mm", z, covered, deep);
    }
    solid_free(&heart);
    solid_free(&lung);
    skg_thorax_release(&thorax);
}
END_TEST

START_TEST(fat_is_10_to_25_mm_thick) {
    static solid skin, muscle;
    make(0, 200000); /* so that facets hardly matter */
    solid_make(part[find("skin")].mesh, &skin);
    solid_make(part[find("muscle")].mesh, &muscle);
    for (int64_t v = 0; v < muscle.vertices; v += 7) {
        const double *p = muscle.position + 3 * v;
        if (p[2] < -290 || p[2] > 230) continue; /* the cut ends of the body */
        const double fat = solid_distance(&skin, p);
        /* mm: given along the axes; where the surface slopes, the layer is thinner */
        ck_assert_msg(fat >= 9.5 && fat <= 25, "%g mm at (%g, %g, %g)", fat, p[0], p[1], p[2]);
    }
    solid_free(&skin);
    solid_free(&muscle);
    skg_thorax_release(&thorax);
}
END_TEST

static int within(int64_t inner, int64_t outer) {
    for (int64_t i = part[inner].inside; i >= 0; i = part[i].inside)
        if (i == outer) return 1;
    return 0;
}

START_TEST(disjoint_or_nested) {
    static solid s[PARTS_MAX];
    make(_i, 42000);
    int64_t needle = find("needle");
    for (int64_t i = 0; i < parts; i++) solid_make(part[i].mesh, s + i);
    for (int64_t i = 0; i < parts; i++)
        for (int64_t j = 0; j < parts; j++) {
            if (i == j || i == needle || j == needle || within(j, i)) continue;
            if (within(i, j)) {
                for (int64_t v = 0; v < s[i].vertices; v++)
                    ck_assert_msg(solid_holds(s + j, s[i].position + 3 * v), "%s leaves %s", part[i].label,
                                  part[j].label);
                for (int64_t v = 0; v < s[j].vertices; v++)
                    ck_assert_msg(!solid_holds(s + i, s[j].position + 3 * v), "%s enters %s", part[j].label,
                                  part[i].label);
                continue;
            }
            double depth = solid_overlap(s + i, s + j, 1);
            ck_assert_msg(depth <= 0.5, "%s lies %g mm deep in %s", part[i].label, depth, part[j].label);
        }
    const double tip[3] = {-54, -60, -81.5}; /* in the liver, 2 mm from a duct */
    ck_assert(solid_holds(s + find("liver"), tip));
    ck_assert_double_le(solid_distance(s + find("bile ducts"), tip), 2.5);
    for (int64_t v = 0; v < s[needle].vertices; v++) /* and on its way it meets no bone */
        for (int t = 0; t <= 100; t++) {
            double p[3];
            for (int k = 0; k < 3; k++) p[k] = tip[k] + 0.01 * t * (s[needle].position[3 * v + k] - tip[k]);
            for (int64_t i = 0; i < parts; i++)
                if (!strncmp(part[i].label, "rib", 3) || !strncmp(part[i].label, "lung", 4))
                    ck_assert_msg(!solid_holds(s + i, p), "the needle meets %s", part[i].label);
        }
    for (int64_t i = 0; i < parts; i++) solid_free(s + i);
    skg_thorax_release(&thorax);
}
END_TEST

/* By the method of plans, whose columns cross the whole scene: nothing but the needle, which passes through.
 */
START_TEST(plans_find_no_overlap) {
    const int64_t sizes[] = {42000, 80000};
    skg_solid s[PARTS_MAX];
    skg_overlap_pair *pairs = NULL;
    int64_t side = 0, found = 0;
    make(_i / 2, sizes[_i % 2]);
    for (int64_t i = 0; i < parts; i++) {
        s[i] = (skg_solid){.inside = part[i].inside};
        ck_skg(skg_mesh_count(part[i].mesh, &s[i].vertices, &s[i].triangles));
        double *positions = malloc((size_t)s[i].vertices * 3 * sizeof *positions);
        int32_t *corners = malloc((size_t)s[i].triangles * 3 * sizeof *corners);
        ck_skg(skg_mesh_positions_get(part[i].mesh, positions, 0));
        ck_skg(skg_mesh_triangles_get(part[i].mesh, corners, 0));
        s[i].positions = positions, s[i].corners = corners;
    }
    ck_skg(skg_overlaps_find(parts, s, &side, &found, &pairs));
    for (int64_t p = 0; p < found; p++)
        ck_assert_msg(pairs[p].part == find("needle") || pairs[p].other == find("needle"),
                      "%s and %s: %g mm3", part[pairs[p].part].label, part[pairs[p].other].label,
                      pairs[p].volume);
    for (int64_t i = 0; i < parts; i++) {
        free((void *)(uintptr_t)s[i].positions);
        free((void *)(uintptr_t)s[i].corners);
    }
    skg_free(&pairs);
    skg_thorax_release(&thorax);
}
END_TEST

START_TEST(
    the_sternum_is_not_twisted) { /* 11 of at least 13 mm to each side of its middle line, all the way */
    solid s;
    make(_i, 42000);
    solid_make(part[find("sternum body")].mesh, &s);
    for (double z = -15; z <= 80; z += 0.5)
        for (int side = -1; side <= 1; side += 2) {
            const double p[3] = {side * 11, skg_cage_front(0, z), z};
            ck_assert_msg(solid_holds(&s, p), "not at z %g mm, side %d", z, side);
        }
    solid_free(&s);
    skg_thorax_release(&thorax);
}
END_TEST

START_TEST(saved_files_hold_the_same) {
    char folder[] = "/tmp/skg-thorax-XXXXXX", path[256];
    ck_assert_ptr_nonnull(mkdtemp(folder));
    make(_i, 10000);
    ck_skg(skg_thorax_save(thorax, folder));
    snprintf(path, sizeof path, "%s/thorax.json", folder);
    json_t *scene = json_load_file(path, 0, NULL), *samples = json_object_get(scene, "Samples");
    ck_assert_int_eq((int64_t)json_array_size(samples), parts);
    unlink(path);
    for (int64_t i = 0; i < parts; i++) {
        json_t *sample = json_array_get(samples, (size_t)i);
        ck_assert_str_eq(json_string_value(json_object_get(sample, "Label")), part[i].label);
        snprintf(path, sizeof path, "%s/%s", folder, json_string_value(json_object_get(sample, "Path")));
        skg_mesh *mesh;
        ck_skg(skg_mesh_load(NULL, path, 1, &mesh));
        skg_mesh_health h, ours = health_of(i);
        skg_mesh_health_init(&h);
        ck_skg(skg_mesh_health_get(mesh, &h));
        ck_assert_int_eq(h.closed, 1);
        ck_assert_int_eq(h.vertices, ours.vertices);
        ck_assert_double_eq(h.volume, ours.volume);
        skg_mesh_release(&mesh);
        unlink(path);
    }
    json_decref(scene);
    ck_assert_int_eq(rmdir(folder), 0);
    ck_skg_fails(skg_thorax_save(thorax, folder), SKG_ERR_OUTPUT, folder);
    skg_thorax_release(&thorax);
}
END_TEST

START_TEST(bad_arguments) {
    skg_thorax_options options;
    skg_thorax_options_init(&options);
    options.triangles = 9999;
    ck_skg_fails(skg_thorax_create(&options, &thorax), SKG_ERR_ARGUMENT, "10000");
    ck_skg_fails(skg_thorax_create(&options, NULL), SKG_ERR_ARGUMENT, "result is NULL");
    options.triangles = 42000, options.simple = 2;
    ck_skg_fails(skg_thorax_create(&options, &thorax), SKG_ERR_ARGUMENT, "simple is 2");
    make(0, 10000);
    ck_skg_fails(skg_thorax_part_get(thorax, parts, part), SKG_ERR_ARGUMENT, "no part");
    skg_thorax_release(&thorax);
    skg_thorax_release(&thorax);
    skg_thorax_release(NULL);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_loop_test(tests, every_mesh_is_closed, 0, 6);
    tcase_add_loop_test(tests, parts_are_where_and_as_large_as_they_should_be, 0, 2);
    tcase_add_test(tests, organs_are_those_of_a_chest);
    tcase_add_test(tests, lung_lies_along_the_left_border_of_the_heart);
    tcase_add_test(tests, fat_is_10_to_25_mm_thick);
    tcase_add_loop_test(tests, disjoint_or_nested, 0, 2);
    tcase_add_loop_test(tests, the_sternum_is_not_twisted, 0, 2);
    tcase_add_loop_test(tests, plans_find_no_overlap, 0, 4);
    tcase_add_loop_test(tests, saved_files_hold_the_same, 0, 2);
    tcase_add_test(tests, bad_arguments);
}

SKG_SUITE_MAIN("thorax", add_tests)
