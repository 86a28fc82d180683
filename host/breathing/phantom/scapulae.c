/* The shoulder blades. */
#include "core/maths.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

enum { CORNERS = 12 };

/* Outline of the left blade in the frontal plane, x and z, counter-clockwise as seen from behind; it lies in a plane
 * that comes forward to the side. Aggregates of the surfaces of BodyParts3D. */
static const double corner[CORNERS][2] = {{84, 8},    {70, 22},   {61, 55},  {58, 95},
                                          {63, 125},  {74, 138},  {98, 135}, {126, 127},
                                          {138, 116}, {138, 100}, {127, 80}, {106, 36}};
static const double middle[2] = {92, 88};

/* y of the blade's plane, and its normal. */
static double blade_depth(double x, double z) {
    return 56 - 0.62 * (x - 60) - 0.10 * fmax(0, z - 70);
}

/* Distance from the middle to the outline. */
static double outline_radius(double angle) {
    const double c = cos(angle), s = sin(angle);
    for (int i = 0; i < CORNERS; i++) {
        const double *a = corner[i], *b = corner[(i + 1) % CORNERS];
        const double ax = a[0] - middle[0], az = a[1] - middle[1], ex = b[0] - a[0], ez = b[1] - a[1];
        const double all = ex * s - ez * c;
        if (all == 0) continue;
        const double radius = (ex * az - ez * ax) / all, along = (c * az - s * ax) / all;
        if (radius > 0 && along >= 0 && along <= 1) return radius;
    }
    return 0;
}

typedef struct {
    int64_t rings; /* from the middle to the border */
    double side;
} blade;

/* Rings run on the front from the middle to the border, then on the back to the middle. */
static void blade_place(const void *shape, int64_t ring, double azimuth, double p[3]) {
    const blade *b = shape;
    const int64_t out = ring <= b->rings ? ring : 2 * b->rings - ring;
    const double t = skg_shape_towards_rim((double)out / (double)b->rings);
    const double angle = -b->side * 2 * SKG_PI * azimuth; /* a mirror image turns the other way */
    const double r = t * outline_radius(angle), normal[3] = {0.62, 1, 0.10};
    /* 2.4 mm thick in the middle, 5 mm at the border */
    const double half = ring == b->rings ? 0 : 1.2 + 1.4 * t * t * t * t;
    p[0] = middle[0] + r * cos(angle), p[2] = middle[1] + r * sin(angle);
    p[1] = blade_depth(p[0], p[2]);
    skg_add_scaled(p, (ring < b->rings ? -half : half) / skg_length(normal), normal, p);
    p[0] *= b->side;
}

/* Spine with acromion, glenoid, coracoid process: points, half axes, rings. */
static const struct {
    double point[4][3], height, width, rings;
} limb[3] = {{{{66, 60, 108}, {104, 40, 124}, {140, 20, 140}, {163, -14, 147}}, 3.6, 3.2, 12},
             {{{150, -3, 92}, {151, -4, 100}, {151, -5, 109}, {150, -5, 117}}, 5.5, 5.5, 6},
             {{{133, -8, 127}, {134, -18, 134}, {139, -28, 134}, {146, -36, 127}}, 3.5, 3.5, 7}};

static skg_status scapula(const skg_thorax_plan *plan, const char *label, double side, int64_t outer,
                          skg_thorax *thorax) {
    blade b = {skg_shape_count(plan->resolution, 6, 3), side};
    int64_t *counts, rings = 2 * b.rings + 1, around = skg_shape_count(plan->resolution, 34, 16);
    SKG_TRY(skg_alloc(rings, sizeof *counts, label, &counts));
    for (int64_t r = 0; r < rings; r++) {
        const int64_t out = r <= b.rings ? r : 2 * b.rings - r, part = around * 3 * out / (2 * b.rings);
        counts[r] = out == 0 ? 1 : part < 6 ? 6 : part < around ? part : around;
    }
    skg_mesh_arrays arrays = {0};
    double curve[33][3];
    skg_status status = skg_shape_rings(label, rings, counts, blade_place, &b, &arrays);
    for (int i = 0; i < 3 && status == SKG_OK; i++) {
        status = skg_shape_spline(limb[i].point, 4, 33, curve);
        if (status == SKG_OK)
            status = skg_shape_cord(label, (const double(*)[3])curve, 33, limb[i].height, limb[i].width, side,
                                    skg_shape_count(plan->resolution, limb[i].rings, 4),
                                    skg_shape_count(plan->resolution, 9, 5), &arrays);
    }
    if (status == SKG_OK) status = skg_thorax_fit(thorax, label, 1000, outer, &arrays);
    skg_free(&counts);
    skg_mesh_arrays_free(&arrays);
    return status;
}

skg_status skg_thorax_scapulae(const skg_thorax_plan *plan, int64_t outer, skg_thorax *thorax) {
    SKG_TRY(scapula(plan, "scapula left", 1, outer, thorax));
    return scapula(plan, "scapula right", -1, outer, thorax);
}
