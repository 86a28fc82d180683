/* Lungs and airways. A lung is made straight, as rings between a flat base and its apex, and then warped so
 * that the base lies on the diaphragm: no ring can cross another. */
#include "phantom/thorax.h"

#include "core/vector.h"

static const double pi = 3.14159265358979323846;

enum { AIRWAYS = 3 };

/* Trachea and main bronchi: ends and radius, mm. */
static const struct {
    const char *label;
    double from[3], to[3], radius;
} airway[AIRWAYS] = {{"trachea", {0, -56, 200}, {0, -40, 102}, 8.5},
                     {"bronchus left", {10, -39, 88}, {21, -37, 77}, 5.5},
                     {"bronchus right", {-10, -39, 87}, {-19, -37, 75}, 6}};

double skg_airway_distance(const double point[3]) {
    double least = HUGE_VAL;
    for (int i = 0; i < AIRWAYS; i++) {
        double d[3], p[3];
        skg_add_scaled(airway[i].to, -1, airway[i].from, d);
        skg_add_scaled(point, -1, airway[i].from, p);
        double t = fmin(fmax(skg_dot(p, d) / skg_dot(d, d), 0), 1);
        skg_add_scaled(p, -t, d, p);
        least = fmin(least, skg_length(p) - airway[i].radius);
    }
    return least;
}

skg_status skg_thorax_airways(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    for (int i = 0; i < AIRWAYS; i++) {
        skg_mesh_arrays arrays = {0};
        double line[2][3], r = airway[i].radius;
        for (int k = 0; k < 3; k++) line[0][k] = airway[i].from[k], line[1][k] = airway[i].to[k];
        skg_status status = skg_shape_cord(airway[i].label, (const double(*)[3])line, 2, r, r, 1,
                                           skg_shape_count(plan->resolution, i == 0 ? 10 : 6, 3),
                                           skg_shape_count(plan->resolution, 12, 6), &arrays);
        if (status == SKG_OK) status = skg_thorax_add(thorax, airway[i].label, -1000, skin, &arrays);
        skg_mesh_arrays_free(&arrays);
        SKG_TRY(status);
    }
    return SKG_OK;
}

typedef struct {
    const skg_thorax_plan *plan;
    double side;                 /* 1: left */
    double gap;                  /* mm to everything else */
    int64_t base, sides, around; /* rings of the base, of the sides; points around the sides */
    const double *radius;        /* sides * around, mm from the axis */
} lung;

static const double apex = 160; /* mm */

/* How low the recess between diaphragm and wall reaches: lowest at the back, beside the spine. */
static double recess(double x, double y) {
    double azimuth = atan2(y - skg_dome_centre[1], x - skg_dome_centre[0]);
    double behind = (fabs(x) - 70) / 26, back = fmax(0, sin(azimuth));
    return skg_dome_rim_height(azimuth) + 70 - 26 * back * exp(-behind * behind);
}

/* Height of a ball's upper side that rolls under the diaphragm's middle: `radius` mm clear of it, also where
 * it is steep. */
static double clear_of_dome(const skg_thorax_plan *plan, double x, double y, double radius) {
    enum { CIRCLES = 3, AROUND = 12 };
    double most = skg_dome_height(plan, x, y) + radius;
    for (int c = 1; c <= CIRCLES; c++)
        for (int i = 0; i < AROUND; i++) {
            double angle = 2 * pi * (i + 0.5 * (c % 2)) / AROUND, d = (double)c / CIRCLES;
            double z = skg_dome_height(plan, x + d * radius * cos(angle), y + d * radius * sin(angle));
            most = fmax(most, z + radius * sqrt(1 - d * d));
        }
    return most;
}

/* z over a point of the base: above the diaphragm, and no lower than the recess reaches. */
static double base_height(const lung *l, double x, double y) {
    double over = clear_of_dome(l->plan, x, y, 1.5 + 3.4 * l->gap), floor = recess(x, y);
    double d = over - floor; /* the larger, rounded over 8 mm */
    return floor + 0.5 * (d + sqrt(d * d + 64));
}

static double height_of(const lung *l, double level, double x, double y) {
    double base = base_height(l, x, y);
    return base + level * (apex - base);
}

static void axis_at(const lung *l, double level, double axis[2]) {
    /* left, where the heart is, farther out: it sees the lung in front of the heart */
    axis[0] = l->side * ((l->side > 0 ? 84 : 72) * (1 - level) + 40 * level), axis[1] = -48 + 10 * level;
}

/* Where the lung may be. Level rides in z: the region is asked along rays at one level. */
typedef struct {
    const lung *l;
    double level;
} lung_level;

static double lung_region(const void *shape, const double flat[3]) {
    const lung_level *at = shape;
    const lung *l = at->l;
    const double p[3] = {flat[0], flat[1], height_of(l, at->level, flat[0], flat[1])};
    double most = skg_cage_inside(p, 9.5 + l->gap);
    /* apart from the other lung: vessels, thymus, oesophagus; and from the bronchus at its root */
    double up = (p[2] - 78) / 28, across = (p[1] + 37) / 28;
    most = fmax(most, 11 + 32 * exp(-up * up - across * across) - l->side * p[0]);
    /* beside the spine, the diaphragm's rim has a fold that the lung does not fill */
    double fold = 15 / (1 + exp((p[2] - 15) / 12));
    most = fmax(most, skg_spine_inside(p, l->gap + fold));
    most = fmax(most, -skg_ellipsoid_inside(&skg_heart, p, l->gap + 0.5));
    most = fmax(most, l->gap - skg_airway_distance(p));
    if (p[2] > 95) { /* the apex is a dome of its own */
        double u = (p[0] - l->side * 44) / 62, v = (p[1] + 36) / 66, w = (p[2] - 95) / (apex + 1 - 95);
        most = fmax(most, 30 * (u * u + v * v + w * w - 1));
    }
    if (p[1] > -30 && fabs(p[0]) < 80 && most <= 0) /* necks of the ribs; elsewhere the inset is enough */
        most = fmax(most, 7 + l->gap - skg_rib_distance(l->plan, p));
    return most;
}

static double radius_at(const lung *l, int64_t side_ring, double azimuth) {
    double at = azimuth * (double)l->around;
    int64_t i = (int64_t)at % l->around, j = (i + 1) % l->around;
    const double *row = l->radius + side_ring * l->around;
    double w = at - floor(at);
    return (1 - w) * row[i] + w * row[j];
}

/* Rings: pole of the base, `base` - 1 rings of it, `sides` rings, pole of the apex. */
static void lung_place(const void *shape, int64_t ring, double azimuth, double p[3]) {
    const lung *l = shape;
    int64_t side = ring < l->base ? 0 : ring - l->base < l->sides ? ring - l->base : l->sides - 1;
    double level = (double)side / (double)l->sides, r = radius_at(l, side, azimuth), axis[2];
    if (ring < l->base) { /* denser to the rim, where the diaphragm bends */
        double t = (double)ring / (double)l->base;
        r *= 1.45 * t - 0.45 * t * t;
    }
    if (ring == l->base + l->sides) r = 0, level += 0.5 / (double)l->sides;
    axis_at(l, level, axis);
    p[0] = axis[0] + r * cos(2 * pi * azimuth), p[1] = axis[1] + r * sin(2 * pi * azimuth);
    p[2] = height_of(l, level, p[0], p[1]);
}

static void find_radii(const lung *l, double *radius) {
#pragma omp parallel for schedule(dynamic, 1)
    for (int64_t s = 0; s < l->sides; s++) {
        lung_level at = {l, (double)s / (double)l->sides};
        double from[3] = {0};
        axis_at(l, at.level, from);
        for (int64_t i = 0; i < l->around; i++) {
            double angle = 2 * pi * (double)i / (double)l->around;
            const double direction[3] = {cos(angle), sin(angle), 0};
            radius[s * l->around + i] = skg_shape_exit(lung_region, &at, from, direction, 150);
        }
        skg_shape_limit(radius + s * l->around, l->around, 2.5);
        skg_shape_smooth(radius + s * l->around, l->around, 3);
    }
    /* and from level to level, by 2 mm a mm of height */
    double rise = 2 * 250 / (double)l->sides;
    for (int64_t i = 0; i < l->around; i++) {
        double *column = radius + i;
        for (int64_t s = 1; s < l->sides; s++)
            column[s * l->around] = fmin(column[s * l->around], rise + column[(s - 1) * l->around]);
        for (int64_t s = l->sides - 1; s > 0; s--)
            column[(s - 1) * l->around] = fmin(column[(s - 1) * l->around], rise + column[s * l->around]);
    }
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
cleanup:
    skg_mesh_arrays_free(&arrays);
    skg_free(&counts);
    skg_free(&radius);
    return status;
}

skg_status skg_thorax_lungs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    for (double side = 1; side >= -1; side -= 2) {
        lung l = {.plan = plan, .side = side, .gap = fmax(1.2, 1.5 / plan->resolution)};
        l.base = skg_shape_count(plan->resolution, 15, 4);
        l.sides = skg_shape_count(plan->resolution, 29, 8);
        l.around = skg_shape_count(plan->resolution, 46, 12);
        SKG_TRY(add_lung(side > 0 ? "lung left" : "lung right", skin, &l, thorax));
    }
    return SKG_OK;
}
