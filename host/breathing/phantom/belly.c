/* The organs under the diaphragm of the full thorax. */
#include "core/maths.h"
#include "phantom/anatomy.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

#include <math.h>

static const skg_ellipsoid gallbladder = {{-52, -104, -130}, {11, 13, 24}, {1, 0, 0.3}};
static const skg_ellipsoid kidneys[2] = {{{60, -27, -166}, {29, 27, 57}, {1, 0.35, 0.18}},
                                         {{-60, -27, -184}, {29, 27, 57}, {1, -0.35, -0.18}}};
static const skg_ellipsoid spleen = {{86, -33, -94}, {37, 48, 65}, {1, -0.5, 0.35}};
static const skg_ellipsoid stomach = {{56, -84, -104}, {62, 46, 94}, {1, 0.1, -0.55}};

/* Fat about a kidney, mm. */
static const double perirenal = 5;

static const double liver_centre[3] = {-62, -62, -78}, stomach_centre[3] = {64, -92, -68};

/* The common bile duct (ducts.c) runs in a notch of the liver. */
static double to_common_duct(const double p[3]) {
    static const double from[3] = {-30, -64, -109}, to[3] = {-14, -66, -186};
    double d[3], q[3];
    skg_add_scaled(to, -1, from, d);
    skg_add_scaled(p, -1, from, q);
    skg_add_scaled(q, -fmin(fmax(skg_dot(q, d) / skg_dot(d, d), 0), 1), d, q);
    return skg_length(q) - 3;
}

/* Height over the liver's underside: a rounded right lobe, the porta, and a left lobe that thins to the left and lies in
 * front of the stomach: its underside falls to the front, steeply on the left. */
static double over_liver_floor(const double p[3]) {
    static const double floor[][2] = {{-130, -212}, {-105, -248}, {-80, -258}, {-55, -250}, {-30, -228},
                                      {-5, -200},   {18, -158},   {38, -96},   {50, -40},   {60, 20}};
    const double slope = 0.12 + 0.28 / (1 + exp((-5 - p[0]) / 12));
    return p[2] - skg_shape_curve(floor, (int)(sizeof floor / sizeof *floor), p[0]) - slope * (p[1] + 60);
}

static double to_kidneys(const double p[3], double larger) {
    return fmin(skg_ellipsoid_inside(kidneys, p, perirenal + larger),
                skg_ellipsoid_inside(kidneys + 1, p, perirenal + larger));
}

/* Distance to the kidneys with a margin for organs that go down with the diaphragm by more, or by less, than the kidneys do. */
static double clear_of_kidneys(const double p[3], double larger) {
    const double way = 6; /* mm; 0.35 of 15 mm, and a little */
    const double lower[3] = {p[0], p[1], p[2] - way}, upper[3] = {p[0], p[1], p[2] + way};
    return fmin(to_kidneys(p, larger), fmin(to_kidneys(lower, larger), to_kidneys(upper, larger)));
}

static double liver_region(const void *shape, const double p[3]) {
    const skg_thorax_plan *plan = shape;
    double most = fmax(skg_belly_inside(plan, 0, p), -over_liver_floor(p));
    most = fmax(most, -skg_ellipsoid_inside(&gallbladder, p, plan->gap));
    most = fmax(most, -clear_of_kidneys(p, plan->gap));
    most = fmax(most, plan->gap + 2.6 - to_common_duct(p));
    return fmax(most, p[0] - 58);
}

/* The stomach less a wall. */
static double stomach_inside(const skg_thorax_plan *plan, double wall, const double p[3]) {
    const double gap = plan->gap + wall;
    double most = fmax(skg_belly_inside(plan, wall, p), over_liver_floor(p) + 4 + gap);
    most = fmax(most, skg_ellipsoid_inside(&stomach, p, -wall));
    most = fmax(most, -skg_ellipsoid_inside(&spleen, p, gap));
    return fmax(most, -clear_of_kidneys(p, gap));
}

static double stomach_region(const void *shape, const double p[3]) {
    return stomach_inside(shape, 0, p);
}

/* Gas under the left dome, over the level of what the stomach holds: the patient stands. */
static double stomach_gas_region(const void *shape, const double p[3]) {
    const double wall = 7, level = -58; /* mm */
    return fmax(stomach_inside(shape, wall, p), level - p[2]);
}

typedef struct {
    const skg_thorax_plan *plan;
    const skg_ellipsoid *ellipsoid;
    double larger, wall;
} ellipsoid_organ;

static double ellipsoid_region(const void *shape, const double p[3]) {
    const ellipsoid_organ *o = shape;
    return fmax(skg_belly_inside(o->plan, o->wall, p), skg_ellipsoid_inside(o->ellipsoid, p, o->larger));
}

static double spleen_region(const void *shape, const double p[3]) {
    const skg_thorax_plan *plan = shape;
    return fmax(fmax(skg_belly_inside(plan, 0, p), skg_ellipsoid_inside(&spleen, p, 0)),
                -clear_of_kidneys(p, plan->gap));
}

/* Bowel fills the belly in front of the kidneys, below liver, stomach and spleen. */
static double bowel_inside(const skg_thorax_plan *plan, double wall, const double p[3]) {
    const double gap = plan->gap + 2 + wall;
    double most = fmax(skg_belly_inside(plan, wall, p), skg_cage_inside(p, 18 + wall));
    most = fmax(most, fmax(over_liver_floor(p) + gap + 2, -288 + wall - p[2]));
    most = fmax(most, -skg_ellipsoid_inside(&stomach, p, gap));
    most = fmax(most, -skg_ellipsoid_inside(&spleen, p, gap));
    most = fmax(most, -skg_ellipsoid_inside(&gallbladder, p, gap));
    return fmax(fmax(most, -clear_of_kidneys(p, gap)), gap + 1 - to_common_duct(p));
}

static double bowel_region(const void *shape, const double p[3]) {
    return bowel_inside(shape, 0, p);
}

/* Gas in the colon: its bend under the spleen, and two loops. */
static const skg_ellipsoid gas[] = {{{70, -74, -200}, {17, 16, 22}, {1, 0, 0.5}},
                                    {{36, -94, -214}, {26, 12, 12}, {1, 0, 0.15}},
                                    {{-27, -88, -254}, {22, 15, 17}, {1, 0, 0.15}}};
enum { GASES = sizeof gas / sizeof *gas };

typedef struct {
    const skg_thorax_plan *plan;
    const skg_ellipsoid *ellipsoid;
} bubble;

static double gas_region(const void *shape, const double p[3]) {
    const bubble *b = shape;
    return fmax(bowel_inside(b->plan, 9, p), skg_ellipsoid_inside(b->ellipsoid, p, 0));
}

static skg_status bowel_gas(const skg_thorax_plan *plan, int64_t bowel, skg_thorax *thorax) {
    skg_mesh_arrays arrays = {0};
    skg_status status = SKG_OK;
    for (int i = 0; i < GASES && status == SKG_OK; i++) {
        const bubble shape = {plan, gas + i};
        status = skg_shape_star("bowel gas", gas_region, &shape, gas[i].centre, 60,
                                skg_shape_count(plan->resolution, 9, 6), &arrays);
    }
    if (status == SKG_OK) status = skg_thorax_fit(thorax, "bowel gas", -1000, bowel, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}

static skg_status kidneys_in_fat(const skg_thorax_plan *plan, int64_t outer, skg_thorax *thorax) {
    static const char *const label[2][2] = {{"perirenal fat left", "kidney left"},
                                            {"perirenal fat right", "kidney right"}};
    for (int side = 0; side < 2; side++) {
        const ellipsoid_organ around = {plan, kidneys + side, perirenal, 0};
        const ellipsoid_organ kidney = {plan, kidneys + side, 0, perirenal - 2};
        SKG_TRY(skg_thorax_star(plan, label[side][0], -100, outer, ellipsoid_region, &around,
                                kidneys[side].centre, 14, thorax));
        SKG_TRY(skg_thorax_star(plan, label[side][1], 35, thorax->parts - 1, ellipsoid_region, &kidney,
                                kidneys[side].centre, 13, thorax));
    }
    return SKG_OK;
}

skg_status skg_thorax_belly(const skg_thorax_plan *plan, int64_t outer, skg_thorax *thorax) {
    static const double gas_centre[3] = {68, -84, -42}, bowel_centre[3] = {10, -100, -220};
    const ellipsoid_organ bladder = {plan, &gallbladder, 0, 0};
    SKG_TRY(kidneys_in_fat(plan, outer, thorax));
    SKG_TRY(skg_thorax_star(plan, "liver", 60, outer, liver_region, plan, liver_centre, 44, thorax));
    SKG_TRY(skg_thorax_ducts(plan, thorax->parts - 1, outer, thorax));
    SKG_TRY(skg_thorax_star(plan, "spleen", 45, outer, spleen_region, plan, spleen.centre, 13, thorax));
    SKG_TRY(skg_thorax_star(plan, "stomach", 30, outer, stomach_region, plan, stomach_centre, 24, thorax));
    SKG_TRY(skg_thorax_star(plan, "stomach gas", -1000, thorax->parts - 1, stomach_gas_region, plan,
                            gas_centre, 12, thorax));
    SKG_TRY(skg_thorax_star(plan, "gallbladder", 10, outer, ellipsoid_region, &bladder, gallbladder.centre,
                            11, thorax));
    SKG_TRY(skg_thorax_star(plan, "bowel", 20, outer, bowel_region, plan, bowel_centre, 20, thorax));
    return bowel_gas(plan, thorax->parts - 1, thorax);
}
