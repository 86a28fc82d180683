/* Heart, and the organs under the diaphragm of the simple thorax. */
#include "phantom/makers.h"

#include "core/maths.h"
#include "phantom/anatomy.h"
#include "phantom/shapes.h"

static const skg_ellipsoid gallbladder = {{-54, -98, -128}, {11, 13, 23}, {1, 0, 0.3}};
static const skg_ellipsoid kidney_left = {{57, -26, -162}, {24, 21, 52}, {1, 0.3, 0.15}};
static const skg_ellipsoid kidney_right = {{-56, -26, -184}, {24, 21, 50}, {1, -0.3, -0.15}};
static const skg_ellipsoid spleen = {{80, -22, -72}, {24, 30, 42}, {1, -0.4, 0.2}};

double skg_belly_inside(const skg_thorax_plan *plan, double wall, const double p[3]) {
    double gap = plan->gap + wall;
    double within =
        2 * skg_dome_half_thickness + gap + 1 - skg_dome_rim_distance(&plan->diaphragm, p[0], p[1]);
    double steep = fmin(skg_dome_steepness(&plan->diaphragm, p[0], p[1]), 12);
    gap += 2.3; /* mm: between samples the dome bends towards what lies under it */
    double under =
        (p[2] - skg_dome_height(&plan->diaphragm, p[0], p[1])) / steep + skg_dome_half_thickness + gap;
    return fmax(fmax(within, under), skg_spine_inside(p, gap + 6));
}

/* Height over the liver's underside, which rises to the left, and a little to the front. */
static double over_liver_floor(const double p[3]) {
    return p[2] - (-159.5 + 0.80 * (p[0] + 95) - 0.10 * (p[1] + 60));
}

static double liver_region(const void *shape, const double p[3]) {
    const skg_thorax_plan *plan = shape;
    double most = fmax(skg_belly_inside(plan, 0, p), -over_liver_floor(p));
    most = fmax(most, -skg_ellipsoid_inside(&gallbladder, p, plan->gap));
    most = fmax(most, -skg_ellipsoid_inside(&kidney_right, p, plan->gap + 1));
    return fmax(most, p[0] - 72);
}

static double stomach_region(const void *shape, const double p[3]) {
    const skg_thorax_plan *plan = shape;
    const skg_ellipsoid body = {{56, -72, -74}, {52, 44, 62}, {1, 0, -0.5}};
    double most = fmax(skg_belly_inside(plan, 0, p), over_liver_floor(p) + 4 + plan->gap);
    most = fmax(most, skg_ellipsoid_inside(&body, p, 0));
    most = fmax(most, -skg_ellipsoid_inside(&spleen, p, plan->gap));
    return fmax(most, -skg_ellipsoid_inside(&kidney_left, p, plan->gap));
}

typedef struct {
    const skg_thorax_plan *plan;
    const skg_ellipsoid *ellipsoid;
} simple_organ;

static double below_diaphragm(const void *shape, const double p[3]) {
    const simple_organ *o = shape;
    return fmax(skg_belly_inside(o->plan, 0, p), skg_ellipsoid_inside(o->ellipsoid, p, 0));
}

static double spleen_region(const void *shape, const double p[3]) {
    const simple_organ *o = shape;
    return fmax(below_diaphragm(shape, p), -skg_ellipsoid_inside(&kidney_left, p, o->plan->gap));
}

static double heart_region(const void *shape, const double p[3]) {
    const skg_thorax_plan *plan = shape;
    double most = fmax(skg_heart_inside(plan, p, 0), skg_cage_inside(p, 10));
    double steep = skg_dome_steepness(&plan->diaphragm, p[0], p[1]);
    most = fmax(most, (skg_dome_height(&plan->diaphragm, p[0], p[1]) - p[2]) / steep +
                          skg_dome_half_thickness + plan->gap);
    if (!plan->simple) most = fmax(most, plan->gap - skg_vessel_distance(plan->vessel, p));
    return fmax(most, fmax(skg_spine_inside(p, plan->gap), plan->gap - skg_airway_distance(plan->simple, p)));
}

skg_status skg_thorax_star(const skg_thorax_plan *plan, const char *label, double hounsfield, int64_t inside,
                           skg_region region, const void *shape, const double centre[3],
                           double standard_rings, skg_thorax *thorax) {
    const int64_t rings = skg_shape_count(plan->resolution, standard_rings, plan->simple ? 8 : 14);
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_star(label, region, shape, centre, 250, rings, &arrays);
    if (status == SKG_OK) status = skg_thorax_fit(thorax, label, hounsfield, inside, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}

skg_status skg_thorax_organs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    static const double liver_centre[3] = {-58, -58, -72}, stomach_centre[3] = {62, -72, -80};
    static const double heart_centre[3] = {18, -79, 42};
    SKG_TRY(skg_thorax_star(plan, "heart", 45, skin, heart_region, plan, heart_centre, plan->simple ? 17 : 24,
                            thorax));
    if (!plan->simple) return SKG_OK;
    SKG_TRY(skg_thorax_star(plan, "liver", 60, skin, liver_region, plan, liver_centre, 30, thorax));
    SKG_TRY(skg_thorax_ducts(plan, thorax->parts - 1, skin, thorax));
    SKG_TRY(skg_thorax_star(plan, "stomach", 30, skin, stomach_region, plan, stomach_centre, 15, thorax));
    const struct {
        const char *label;
        const skg_ellipsoid *ellipsoid;
        double hounsfield;
        skg_region region;
    } simple[] = {{"gallbladder", &gallbladder, 10, below_diaphragm},
                  {"kidney left", &kidney_left, 35, below_diaphragm},
                  {"kidney right", &kidney_right, 35, below_diaphragm},
                  {"spleen", &spleen, 45, spleen_region}};
    for (size_t i = 0; i < sizeof simple / sizeof *simple; i++) {
        const simple_organ shape = {plan, simple[i].ellipsoid};
        SKG_TRY(skg_thorax_star(plan, simple[i].label, simple[i].hounsfield, skin, simple[i].region, &shape,
                                simple[i].ellipsoid->centre, 11, thorax));
    }
    return SKG_OK;
}
