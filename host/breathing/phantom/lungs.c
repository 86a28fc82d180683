/* Lungs. A lung is made straight, as rings between a flat base and its apex, and then warped so that the base
 * lies on the diaphragm: no ring can cross another. */
#include "core/maths.h"
#include "phantom/anatomy.h"
#include "phantom/contacts.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

#include <string.h>

typedef struct {
    const skg_thorax_plan *plan;
    double side;                 /* 1: left */
    int64_t base, sides, around; /* rings of the base, of the sides; points around the sides */
    const double *radius;        /* sides * around, mm from the axis */
} lung;

static const double apex = 160; /* mm */

/* g/cm3 of the lung between its vessels, which weigh about 0.022 g for each cm3 of the whole; see builder.c. */
static const double between_vessels = 0.222;

/* z down to which the lung fills the recess between diaphragm and wall: lowest at the back, beside the spine. At
 * end-expiration most of the recess is empty (mm, a choice). */
static double recess(double x, double y) {
    double azimuth = atan2(y - skg_dome_centre[1], x - skg_dome_centre[0]);
    double behind = (fabs(x) - 70) / 26, back = fmax(0, sin(azimuth));
    return skg_dome_rim_height(azimuth) + 70 - 26 * back * exp(-behind * behind);
}

/* Height that is `radius` mm clear of the diaphragm's middle, also where it is steep: that of the top of a ball about
 * (x, y) that rests on the surface. Tested on three circles of 12 points. */
static double clear_of_dome(const skg_thorax_plan *plan, double x, double y, double radius) {
    enum { CIRCLES = 3, AROUND = 12 };
    double most = skg_dome_height(&plan->diaphragm, x, y) + radius;
    for (int c = 1; c <= CIRCLES; c++)
        for (int i = 0; i < AROUND; i++) {
            double angle = 2 * SKG_PI * (i + 0.5 * (c % 2)) / AROUND, d = (double)c / CIRCLES;
            double z =
                skg_dome_height(&plan->diaphragm, x + d * radius * cos(angle), y + d * radius * sin(angle));
            most = fmax(most, z + radius * sqrt(1 - d * d));
        }
    return most;
}

/* z of the base: above the diaphragm, and not below the recess. The ball is half the diaphragm's thickness and a gap
 * that allows for the facets of both surfaces. */
static double base_height(const lung *l, double x, double y) {
    double over = clear_of_dome(l->plan, x, y, skg_dome_half_thickness + 3.4 * l->plan->gap),
           floor = recess(x, y);
    double d = over - floor; /* the larger of both, rounded over 8 mm */
    return floor + 0.5 * (d + sqrt(d * d + 64));
}

static double height_of(const lung *l, double level, double x, double y) {
    double base = base_height(l, x, y);
    return base + level * (apex - base);
}

/* The level of a ring of the sides, which may lie between two: 0 is the base, 1 the apex. The full thorax has them closer
 * towards the apex, so that it is round. */
static double level_of(const lung *l, double ring) {
    const double t = ring / (double)l->sides;
    return l->plan->simple ? t : t + 0.6 * (sin(0.5 * SKG_PI * t) - t);
}

static void axis_at(const lung *l, double level, double axis[2]) {
    if (!l->plan->simple && l->side > 0) {
        /* Beside the heart's left border: from there the lung is seen in front of the heart and behind it. */
        axis[0] = 42 + 64 * (1 - pow(level, 2.2)), axis[1] = -53 + 15 * level;
        return;
    }
    axis[0] = l->side * ((l->side > 0 ? 84 : 72) * (1 - level) + 40 * level), axis[1] = -48 + 10 * level;
}

/* Region of the lung at one level: 0 is the base, 1 the apex. z of the points is ignored. */
typedef struct {
    const lung *l;
    double level;
} lung_level;

static double lung_region(const void *shape, const double flat[3]) {
    const lung_level *at = shape;
    const lung *l = at->l;
    const double p[3] = {flat[0], flat[1], height_of(l, at->level, flat[0], flat[1])};
    double most = skg_cage_inside(p, (l->plan->simple ? 9.5 : 7.5) + l->plan->gap);
    /* the mediastinum: vessels, thymus and oesophagus between the lungs, widest at the root with its bronchus */
    double up = (p[2] - 78) / 28, across = (p[1] + 37) / 28;
    double wide = 11, root = 32;
    if (!l->plan->simple) { /* the great vessels, and above them the vessels of the neck */
        most = fmax(most, l->plan->gap + 1 - skg_vessel_distance(l->plan->vessel, p));
        root = 22;
        wide += 9 / (1 + exp((122 - p[2]) / 6));
    }
    most = fmax(most, wide + root * exp(-up * up - across * across) - l->side * p[0]);
    /* beside the spine the diaphragm's rim has a fold, which the lung does not fill */
    double fold = 15 / (1 + exp((p[2] - 15) / 12));
    most = fmax(most, skg_spine_inside(p, l->plan->gap + fold));
    most = fmax(most, -skg_heart_inside(l->plan, p, l->plan->gap + 0.5));
    most = fmax(most, l->plan->gap - skg_airway_distance(l->plan->simple, p));
    if (!l->plan->simple) { /* no wedge of lung between the heart and the diaphragm on which it lies */
        const double above[3] = {p[0], p[1], p[2] + 12};
        most = fmax(most, -skg_heart_inside(l->plan, above, 0));
    }
    if (p[2] > 95) { /* the apex is a dome: the upper half of an ellipsoid */
        double u = (p[0] - l->side * 44) / 62, v = (p[1] + 36) / 66, w = (p[2] - 95) / (apex + 1 - 95);
        most = fmax(most, 30 * (u * u + v * v + w * w - 1));
    }
    if (p[1] > -30 && fabs(p[0]) < 80 && most <= 0) /* only the necks of the ribs lie inside the cage */
        most = fmax(most, 7 + l->plan->gap - skg_rib_distance(l->plan->rib, p));
    return most;
}

static double radius_at(const lung *l, int64_t side_ring, double azimuth) {
    double at = azimuth * (double)l->around;
    int64_t i = (int64_t)at % l->around, j = (i + 1) % l->around;
    const double *row = l->radius + side_ring * l->around;
    double w = at - floor(at);
    return (1 - w) * row[i] + w * row[j];
}

/* Rings are the pole of the base, `base` - 1 rings of it, `sides` rings, and the pole of the apex. */
static void lung_place(const void *shape, int64_t ring, double azimuth, double p[3]) {
    const lung *l = shape;
    int64_t side = ring < l->base ? 0 : ring - l->base < l->sides ? ring - l->base : l->sides - 1;
    double level = level_of(l, (double)side), r = radius_at(l, side, azimuth), axis[2];
    if (ring < l->base) r *= skg_shape_towards_rim((double)ring / (double)l->base);
    if (ring == l->base + l->sides) r = 0, level = l->plan->simple ? level + 0.5 / (double)l->sides : 1;
    axis_at(l, level, axis);
    p[0] = axis[0] + r * cos(2 * SKG_PI * azimuth), p[1] = axis[1] + r * sin(2 * SKG_PI * azimuth);
    p[2] = height_of(l, level, p[0], p[1]);
}

/* How far a point lies outside the wall that the radii found make; < 0 inside. */
static double outside_wall(const lung *l, const double p[3]) {
    const double base = base_height(l, p[0], p[1]), level = (p[2] - base) / (apex - base);
    if (level < 0 || level >= 1) return 30;
    int64_t low = 0;
    while (low + 1 < l->sides && level_of(l, (double)low + 1) <= level) low++;
    const int64_t high = low + 1 < l->sides ? low + 1 : low;
    const double at = level_of(l, (double)low);
    double axis[2], w = (level - at) / (level_of(l, (double)low + 1) - at);
    axis_at(l, level, axis);
    const double x = p[0] - axis[0], y = p[1] - axis[1], turn = atan2(y, x) / (2 * SKG_PI);
    const double azimuth = turn - floor(turn);
    const double radius = (1 - w) * radius_at(l, low, azimuth) + w * radius_at(l, high, azimuth);
    return fmax(hypot(x, y) - radius, 0.7 * (base - p[2])); /* 0.7: the base is oblique */
}

/* The lung that holds the vessels, and its surface as it became. */
typedef struct {
    lung wall;
    skg_triangle_grid grid;
} vessel_room;

static int meets_wall(const void *unused, const double *triangle, const double *other, int64_t number) {
    (void)unused, (void)number;
    return skg_triangles_meet(triangle, other);
}

/* Whether a ball, 2 mm larger than given, lies in the lung: its middle does, and no triangle about it in the three
 * planes of the axes meets the wall. */
static int has_room(const void *shape, const double p[3], double radius) {
    const vessel_room *room = shape;
    const double clear = radius + 2;
    if (outside_wall(&room->wall, p) > -clear) return 0;
    for (int axis = 0; axis < 3; axis++) {
        double triangle[9];
        for (int c = 0; c < 3; c++) { /* the inner circle has the radius `clear` */
            memcpy(triangle + 3 * c, p, 3 * sizeof *triangle);
            triangle[3 * c + axis] += 2 * clear * cos(2 * SKG_PI * c / 3);
            triangle[3 * c + (axis + 1) % 3] += 2 * clear * sin(2 * SKG_PI * c / 3);
        }
        if (skg_grid_any(&room->grid, triangle, meets_wall, NULL)) return 0;
    }
    return 1;
}

static void find_radii(const lung *l, double *radius) {
#pragma omp parallel for schedule(dynamic, 1)
    for (int64_t s = 0; s < l->sides; s++) {
        lung_level at = {l, level_of(l, (double)s)};
        double from[3] = {0};
        axis_at(l, at.level, from);
        for (int64_t i = 0; i < l->around; i++) {
            double angle = 2 * SKG_PI * (double)i / (double)l->around;
            const double direction[3] = {cos(angle), sin(angle), 0};
            radius[s * l->around + i] = skg_shape_exit(lung_region, &at, from, direction, 150);
        }
        /* The full thorax has sharper edges, because the left lung wraps the heart. */
        skg_shape_limit(radius + s * l->around, l->around, l->plan->simple ? 2.5 : 5);
        skg_shape_smooth(radius + s * l->around, l->around, l->plan->simple ? 3 : 2);
    }
    /* From level to level a radius may change by 2 mm for each mm of height; a lung is 250 mm high. */
    double rise = 2 * 250 / (double)l->sides;
    for (int64_t i = 0; i < l->around; i++) {
        double *column = radius + i;
        for (int64_t s = 1; s < l->sides; s++)
            column[s * l->around] = fmin(column[s * l->around], rise + column[(s - 1) * l->around]);
        for (int64_t s = l->sides - 1; s > 0; s--)
            column[(s - 1) * l->around] = fmin(column[(s - 1) * l->around], rise + column[s * l->around]);
    }
}

/* The vessels of the lung that was added last. */
static skg_status add_vessels(const char *label, const lung *l, skg_thorax *thorax) {
    const skg_mesh *mesh = thorax->part[thorax->parts - 1].mesh;
    const double *bounds = mesh->health.bounds;
    vessel_room room = {.wall = *l};
    skg_mesh_arrays arrays = {0};
    double *radius = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(l->sides * l->around, sizeof *radius, label, &radius));
    find_radii(l, radius);
    room.wall.radius = radius;
    SKG_TRY_CLEANUP(skg_grid_add_mesh(mesh, bounds, bounds + 3, &room.grid));
    SKG_TRY_CLEANUP(skg_grid_sort(bounds, bounds + 3, &room.grid));
    SKG_TRY_CLEANUP(skg_shape_tree(label, has_room, &room, l->side, l->plan->resolution, &arrays));
    SKG_TRY_CLEANUP(skg_thorax_add(thorax, label, 45, thorax->parts - 1, &arrays));
cleanup:
    skg_grid_free(&room.grid);
    skg_mesh_arrays_free(&arrays);
    skg_free(&radius);
    return status;
}

static skg_status add_lung(const char *label, int64_t skin, lung *l, skg_thorax *thorax) {
    skg_mesh_arrays arrays = {0};
    double *radius = NULL;
    int64_t *counts = NULL, rings = l->base + l->sides + 1;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(l->sides * l->around, sizeof *radius, label, &radius));
    SKG_TRY_CLEANUP(skg_alloc(rings, sizeof *counts, label, &counts));
    l->radius = radius;
    find_radii(l, radius);
    for (int64_t r = 0; r < rings; r++) {
        int64_t part = l->around * r / l->base;
        counts[r] = r == 0 || r == rings - 1 ? 1 : r >= l->base ? l->around : part > 5 ? part : 5;
    }
    SKG_TRY_CLEANUP(skg_shape_rings(label, rings, counts, lung_place, l, &arrays));
    SKG_TRY_CLEANUP(skg_shape_unfold(label, &arrays));
    SKG_TRY_CLEANUP(skg_thorax_fit(thorax, label, -790, skin, &arrays));
    if (!l->plan->simple) thorax->part[thorax->parts - 1].density = between_vessels;
cleanup:
    skg_mesh_arrays_free(&arrays);
    skg_free(&counts);
    skg_free(&radius);
    return status;
}

skg_status skg_thorax_lungs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    for (double side = 1; side >= -1; side -= 2) {
        lung l = {.plan = plan, .side = side};
        l.base = skg_shape_count(plan->resolution, 15, 4);
        l.sides = skg_shape_count(plan->resolution, plan->simple ? 29 : 32, 8);
        l.around = skg_shape_count(plan->resolution, plan->simple ? 46 : 60, 12);
        SKG_TRY(add_lung(side > 0 ? "lung left" : "lung right", skin, &l, thorax));
        if (!plan->simple)
            SKG_TRY(add_vessels(side > 0 ? "pulmonary vessels left" : "pulmonary vessels right", &l, thorax));
    }
    return SKG_OK;
}
