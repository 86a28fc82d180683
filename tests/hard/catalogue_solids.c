/* Solids under views that scenes.c lacks. */
#include "hard/catalogue.h"
#include "support/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A wall seen from n pixels of `pitch`, the source at z = -distance. */
static void wall(hard_solid *s, double distance) {
    s->body = solid_box(90, 80, 0.01);
    s->view = run_view(64, 2);
    s->view.source[2] = -distance;
    s->wobble = 1e-4;
    s->double_bar = 1e-10 / 0.01; /* its corners are doubles too, and depths have ulps of 1e-13 mm a metre */
}

/* A prism of height z over a square of `side` whose one edge is cut into pieces of `step` mm: its caps are
 * fans from the opposite corner. */
static solid fan_prism(double side, double height, int pieces, double step) {
    const int n = pieces + 4;
    solid s = {2 * n, 4 * n - 4, calloc((size_t)(6 * n), sizeof(double)),
               calloc((size_t)(12 * n), sizeof(int32_t))};
    for (int k = 0; k < n; k++) { /* corner 0 opposite to the cut edge; counter-clockwise */
        double x = -side / 2, y = -side / 2;
        if (k == 1) x = side / 2;
        if (k >= 2) x = side / 2, y = step * (k - 2 - pieces / 2);
        if (k == n - 2) y = side / 2;
        if (k == n - 1) x = -side / 2, y = side / 2;
        for (int top = 0; top < 2; top++) {
            double *at = s.positions + 3 * (top * n + k);
            at[0] = x, at[1] = y, at[2] = (top ? 0.5 : -0.5) * height;
        }
    }
    int32_t *c = s.corners;
    for (int k = 1; k + 1 < n; k++) {
        *c++ = 0, *c++ = k + 1, *c++ = k;
        *c++ = n, *c++ = n + k, *c++ = n + k + 1;
    }
    for (int k = 0; k < n; k++) {
        const int next = (k + 1) % n;
        *c++ = k, *c++ = next, *c++ = n + next;
        *c++ = k, *c++ = n + next, *c++ = n + k;
    }
    return s;
}

/* Boxes that share an edge: four triangles meet there. */
static solid edge_sharers(void) {
    solid s = solid_box(30, 30, 40), other = solid_box(30, 30, 40);
    solid_shift(&other, 30, 30, 0);
    solid_add(&s, &other);
    solid_free(&other);
    return s;
}

static solid unwelded_blob(void) {
    solid blob = solid_blob(60, 60, 30, 6), apart = solid_unwelded(&blob);
    solid_free(&blob);
    return apart;
}

static void shift_all(hard_solid *s, double by) {
    solid_shift(&s->body, by, by, by);
    for (int k = 0; k < 3; k++) {
        s->view.source[k] += by;
        s->view.centre[k] += by;
    }
}

static void shrink_all(hard_solid *s, double by) {
    solid_move(&s->body, (const double[12]){by, 0, 0, 0, 0, by, 0, 0, 0, 0, by, 0});
    for (int k = 0; k < 3; k++) {
        s->view.source[k] *= by;
        s->view.centre[k] *= by;
        s->view.column_step[k] *= by;
        s->view.row_step[k] *= by;
    }
}

static void place_source(hard_solid *s, double x, double y, double z) {
    s->body = solid_box(80, 60, 50);
    s->view = run_view(96, 2.3);
    s->view.source[0] = x, s->view.source[1] = y, s->view.source[2] = z;
}

static void make_walls(int which, hard_solid *s) {
    static const char *const names[] = {"a wall of 0.01 mm, 1 m from the source",
                                        "a wall of 0.01 mm, 1 km from the source"};
    s->name = names[which];
    s->danger = "depths are 1e5 to 1e8 times the wall: their difference is lost";
    wall(s, which ? 1e6 : 1e3);
}

static void make_places(int which, hard_solid *s) {
    static const double big = 1e7;
    if (which == 0) {
        s->name = "a mesh at 1e7 mm from the origin";
        s->danger = "floats there are 1 mm apart";
        s->body = solid_blob(60, 60, 30, 7);
        s->view = run_view(96, 1.5);
        shift_all(s, big);
        s->double_bar = 1e-9; /* places are doubles, 1.9e-9 mm apart there */
    } else {
        s->name = "a part of a micrometre";
        s->danger = "limits in mm that are no limits of the part";
        s->body = solid_blob(60, 60, 30, 7);
        s->view = run_view(96, 1.5);
        shrink_all(s, 1e-5);
    }
}

static void make_sources(int which, hard_solid *s) {
    static const char *const names[] = {"source on a vertex", "source on a face", "source on an edge"};
    s->name = names[which];
    s->danger = "the path begins at depth 0: is that hit counted?";
    s->wobble = 1e-3;
    if (which == 0) place_source(s, 40, 30, -25);
    if (which == 1) place_source(s, 7.3, 3.1, -25);
    if (which == 2) place_source(s, 40, 11, -25);
}

static void make_beams(int which, hard_solid *s) {
    s->name = which ? "source at 1e9 mm: nearly parallel" : "edge-on slab: faces in the planes of rays";
    s->danger = which ? "depths of 1e9 mm against paths of 100 mm" : "the depth is undefined along a face";
    s->view = run_view(128, 1);
    if (which) {
        s->view.source[2] = -1e9;
        s->body = solid_blob(50, 60, 30, 8);
        s->double_bar = 1e-8; /* depth has ulps of 1.2e-7 mm there */
    } else {
        s->body = solid_box(0.8, 90, 200);
        solid_shift(&s->body, 0.4 + 0.5 * 1000 / 1200, 0, 0);
        s->wobble = 1e-3;
    }
}

void hard_solid_make(int which, hard_solid *s) {
    *s = (hard_solid){.pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    if (which < 2) make_walls(which, s);
    if (which >= 2 && which < 4) make_places(which - 2, s);
    if (which >= 4 && which < 7) make_sources(which - 4, s);
    if (which >= 7 && which < 9) make_beams(which - 7, s);
    if (which < 9) return;
    s->view = run_view(128, 1.5);
    switch (which) {
    case 9:
        s->name = "slivers of aspect 1e6";
        s->danger = "triangles 200 mm long and 0.0002 mm wide";
        s->body = fan_prism(150, 20, 400, 2e-4);
        s->sliver = 1;
        break;
    case 10:
        s->name = "a shell of a micrometre";
        s->danger = "the wall is the difference of two spheres' depths";
        s->body = solid_shell(50, 49.999, 60, 30);
        s->size = 100;
        break;
    case 11:
        s->name = "duplicated vertices";
        s->danger = "equal places get unequal numbers: cracks";
        s->body = unwelded_blob();
        break;
    case 12:
        s->name = "self-intersections";
        s->danger = "depths in the order of no surface";
        s->body = solid_tetrahedra(400, 40, (const double[3]){50, 50, 50}, 4);
        break;
    case 13:
        s->name = "non-manifold edges";
        s->danger = "four triangles at an edge: which ones are a pair?";
        s->body = edge_sharers();
        s->sliver = 1; /* its sides are nearly along the rays, as those of slivers */
        break;
    case 14:
        s->name = "a hundred plates that touch";
        s->danger = "each face lies on its neighbour's";
        s->body = solid_plates(100, 100, 90, 1, 0);
        s->wobble = 1e-4;
        break;
    default:
        s->name = "grazing: a disc of 1000 to 1, nearly edge-on";
        s->danger = "every ray grazes: depth changes by the whole disc within a pixel";
        s->body = solid_sphere(60, 80, 40);
        solid_move(&s->body,
                   (const double[12]){0.001, 0, 0.002, 0.5 * 1000 / 1200, 0, 1, 0, 0, 0.002, 0, 1, 0});
        s->view = run_view(128, 1);
        s->sliver = 1;
        break;
    }
}
