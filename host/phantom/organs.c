/* Diaphragm, heart, and what lies under the diaphragm. */
#include "phantom/thorax.h"

#include "core/vector.h"

#include <string.h>

static const double pi = 3.14159265358979323846;

const skg_ellipsoid skg_heart = {{20, -78, 40}, {66, 45, 45}, {0.76, -0.25, -0.60}};

static const skg_ellipsoid gallbladder = {{-54, -98, -128}, {11, 13, 23}, {1, 0, 0.3}};
static const skg_ellipsoid kidney_left = {{57, -26, -162}, {24, 21, 52}, {1, 0.3, 0.15}};
static const skg_ellipsoid kidney_right = {{-56, -26, -184}, {24, 21, 50}, {1, -0.3, -0.15}};
static const skg_ellipsoid spleen = {{80, -22, -72}, {24, 30, 42}, {1, -0.4, 0.2}};

/* Half thickness of the diaphragm, mm. */
static const double half_thickness = 1.5;

typedef struct {
    const skg_thorax_plan *plan;
    int64_t rings; /* from the centre to the rim */
} sheet;

/* Below from the middle to the rim, then above back to the middle. */
static void sheet_place(const void *shape, int64_t ring, double azimuth, double p[3]) {
    const sheet *s = shape;
    double angle = 2 * pi * azimuth, h = 0.5, normal[3];
    int64_t out = ring <= s->rings ? ring : 2 * s->rings - ring;
    /* denser to the rim, where it is steep */
    double t = (double)out / (double)s->rings,
           r = (1.45 * t - 0.45 * t * t) * skg_dome_rim_radius(s->plan, angle);
    double x = skg_dome_centre[0] + r * cos(angle), y = skg_dome_centre[1] + r * sin(angle);
    normal[0] = skg_dome_height(s->plan, x - h, y) - skg_dome_height(s->plan, x + h, y);
    normal[1] = skg_dome_height(s->plan, x, y - h) - skg_dome_height(s->plan, x, y + h);
    normal[2] = 1;
    double side = ring == s->rings ? 0 : ring < s->rings ? -half_thickness : half_thickness;
    p[0] = x, p[1] = y, p[2] = skg_dome_height(s->plan, x, y);
    skg_add_scaled(p, side / skg_length(normal), normal, p);
}

static skg_status diaphragm(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    sheet s = {plan, skg_shape_count(plan->resolution, 20, 6)};
    int64_t *counts, rings = 2 * s.rings + 1, around = skg_shape_count(plan->resolution, 78, 24);
    SKG_TRY(skg_alloc(rings, sizeof *counts, "diaphragm", &counts));
    for (int64_t r = 0; r < rings; r++) {
        int64_t out = r <= s.rings ? r : 2 * s.rings - r, part = around * 3 * out / (2 * s.rings);
        counts[r] = out == 0 ? 1 : part < 6 ? 6 : part < around ? part : around;
    }
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_rings("diaphragm", rings, counts, sheet_place, &s, &arrays);
    if (status == SKG_OK) status = skg_shape_unfold("diaphragm", &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, "diaphragm", 50, skin, &arrays);
    skg_free(&counts);
    skg_mesh_arrays_free(&arrays);
    return status;
}

/* What every organ of the belly keeps: under the diaphragm by a gap, within its rim. */
static double belly(const skg_thorax_plan *plan, const double p[3], double gap) {
    double within = 2 * half_thickness + gap + 1 - skg_dome_rim_distance(plan, p[0], p[1]);
    double steep = fmin(skg_dome_steepness(plan, p[0], p[1]), 12);
    gap += 2.3; /* the dome bends towards what lies under it */
    double under = (p[2] - skg_dome_height(plan, p[0], p[1])) / steep + half_thickness + gap;
    return fmax(fmax(within, under), skg_spine_inside(p, gap + 6));
}

typedef struct {
    const skg_thorax_plan *plan;
    double gap;
} organ;

/* Height over the liver's underside: it rises to the left, and to the front a little. */
static double over_liver_floor(const double p[3]) {
    return p[2] - (-159.5 + 0.80 * (p[0] + 95) - 0.10 * (p[1] + 60));
}

static double liver_region(const void *shape, const double p[3]) {
    const organ *o = shape;
    double most = fmax(belly(o->plan, p, o->gap), -over_liver_floor(p));
    most = fmax(most, -skg_ellipsoid_inside(&gallbladder, p, o->gap));
    most = fmax(most, -skg_ellipsoid_inside(&kidney_right, p, o->gap + 1));
    return fmax(most, p[0] - 72);
}

static double stomach_region(const void *shape, const double p[3]) {
    const organ *o = shape;
    const skg_ellipsoid body = {{56, -72, -74}, {52, 44, 62}, {1, 0, -0.5}};
    double most = fmax(belly(o->plan, p, o->gap), over_liver_floor(p) + 4 + o->gap);
    most = fmax(most, skg_ellipsoid_inside(&body, p, 0));
    most = fmax(most, -skg_ellipsoid_inside(&spleen, p, o->gap));
    return fmax(most, -skg_ellipsoid_inside(&kidney_left, p, o->gap));
}

typedef struct {
    organ common;
    const skg_ellipsoid *ellipsoid;
} simple_organ;

static double below_diaphragm(const void *shape, const double p[3]) {
    const simple_organ *o = shape;
    return fmax(belly(o->common.plan, p, o->common.gap), skg_ellipsoid_inside(o->ellipsoid, p, 0));
}

static double spleen_region(const void *shape, const double p[3]) {
    const simple_organ *o = shape;
    return fmax(below_diaphragm(shape, p), -skg_ellipsoid_inside(&kidney_left, p, o->common.gap));
}

static double heart_region(const void *shape, const double p[3]) {
    const organ *o = shape;
    double most = fmax(skg_ellipsoid_inside(&skg_heart, p, 0), skg_cage_inside(p, 10));
    double steep = skg_dome_steepness(o->plan, p[0], p[1]);
    most = fmax(most, (skg_dome_height(o->plan, p[0], p[1]) - p[2]) / steep + half_thickness + o->gap);
    return fmax(most, fmax(skg_spine_inside(p, o->gap), o->gap - skg_airway_distance(p)));
}

/* A star about a centre; shape begins with an organ. */
static skg_status add_star(const char *label, double hounsfield, int64_t inside, skg_region region,
                           const void *shape, const double centre[3], double standard_rings,
                           skg_thorax *thorax) {
    const organ *o = shape;
    const int64_t rings = skg_shape_count(o->plan->resolution, standard_rings, 8);
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_star(label, region, shape, centre, 250, rings, &arrays);
    if (status == SKG_OK) status = skg_thorax_fit(thorax, label, hounsfield, inside, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}

enum { DUCTS = 8 };

/* Bile ducts within the liver: three points and the radius, mm; joints leave a gap. */
static const struct {
    double line[3][3], radius;
} duct[DUCTS] = {
    {{{-34, -62, -93}, {-48, -60, -86}, {-60, -60, -78}}, 2.0},  /* right hepatic duct */
    {{{-66, -64, -75}, {-76, -74, -72}, {-86, -84, -75}}, 1.5},  /* right anterior */
    {{{-65, -54, -76}, {-73, -44, -77}, {-78, -34, -84}}, 1.5},  /* right posterior */
    {{{-62, -62, -70}, {-68, -66, -52}, {-70, -66, -34}}, 1.3},  /* upward */
    {{{-90, -84, -79}, {-93, -80, -92}, {-92, -74, -106}}, 1.1}, /* anterior, downward */
    {{{-26, -64, -88}, {-10, -72, -74}, {4, -80, -62}}, 1.8},    /* left hepatic duct */
    {{{8, -81, -60}, {19, -82, -55}, {29, -82, -49}}, 1.3},      /* left lateral */
    {{{2, -85, -66}, {0, -93, -66}, {-4, -104, -68}}, 1.2},      /* left medial */
};

static skg_status ducts(const skg_thorax_plan *plan, int64_t liver, int64_t skin, skg_thorax *thorax) {
    static const double common[4][3] = {
        {-30, -64, -111}, {-26, -64, -126}, {-21, -66, -150}, {-14, -66, -184}};
    skg_mesh_arrays arrays = {0};
    skg_status status = SKG_OK;
    int64_t around = skg_shape_count(plan->resolution, 8, 5), rings = skg_shape_count(plan->resolution, 9, 4);
    double curve[17][3];
    for (int i = 0; i < DUCTS && status == SKG_OK; i++) {
        status = skg_shape_spline(duct[i].line, 3, 17, curve);
        if (status == SKG_OK)
            status = skg_shape_cord("bile ducts", (const double(*)[3])curve, 17, duct[i].radius,
                                    duct[i].radius, 1, rings, around, &arrays);
    }
    if (status == SKG_OK) status = skg_thorax_add(thorax, "bile ducts", 1000, liver, &arrays);
    if (status == SKG_OK) status = skg_shape_spline(common, 4, 17, curve);
    if (status == SKG_OK)
        status = skg_shape_cord("common bile duct", (const double(*)[3])curve, 17, 3, 3, 1,
                                skg_shape_count(plan->resolution, 12, 5), around, &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, "common bile duct", 1000, skin, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}

skg_status skg_thorax_organs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    static const double liver_centre[3] = {-58, -58, -72}, stomach_centre[3] = {62, -72, -80};
    static const double heart_centre[3] = {18, -79, 42};
    const organ common = {plan, fmax(1.2, 1.5 / plan->resolution)};
    organ heart = common, liver_shape = common, stomach = common;
    SKG_TRY(diaphragm(plan, skin, thorax));
    SKG_TRY(add_star("heart", 45, skin, heart_region, &heart, heart_centre, 17, thorax));
    SKG_TRY(add_star("liver", 60, skin, liver_region, &liver_shape, liver_centre, 30, thorax));
    int64_t liver = thorax->parts - 1;
    SKG_TRY(ducts(plan, liver, skin, thorax));
    SKG_TRY(add_star("stomach", 30, skin, stomach_region, &stomach, stomach_centre, 15, thorax));
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
        simple_organ shape = {common, simple[i].ellipsoid};
        SKG_TRY(add_star(simple[i].label, simple[i].hounsfield, skin, simple[i].region, &shape,
                         simple[i].ellipsoid->centre, 11, thorax));
    }
    return SKG_OK;
}

/* Skin by z: half width, y of the front, y of the back. */
static const double outline[][4] = {{-300, 158, -150, 62}, {-200, 158, -156, 64}, {-100, 160, -166, 70},
                                    {0, 164, -168, 76},    {60, 168, -156, 78},   {110, 178, -140, 74},
                                    {145, 186, -126, 64},  {168, 178, -112, 50},  {184, 140, -104, 36},
                                    {198, 84, -98, 26},    {212, 64, -94, 20},    {240, 60, -92, 18}};
enum { OUTLINE = sizeof outline / sizeof *outline };

typedef struct {
    int64_t caps, sides;
} skin_rings;

static void skin_place(const void *shape, int64_t ring, double azimuth, double p[3]) {
    const skin_rings *s = shape;
    int64_t last = 2 * s->caps + s->sides - 1, from_end = ring < last - ring ? ring : last - ring;
    double level = (double)(ring - s->caps) / (double)(s->sides - 1), edge = 1;
    if (from_end < s->caps) level = ring < s->caps ? 0 : 1, edge = (double)from_end / (double)s->caps;
    double z = -300 + 540 * level, column[OUTLINE][2], value[3];
    for (int c = 1; c < 4; c++) {
        for (int i = 0; i < OUTLINE; i++) column[i][0] = outline[i][0], column[i][1] = outline[i][c];
        value[c - 1] = skg_shape_curve((const double(*)[2])column, OUTLINE, z);
    }
    double c = cos(2 * pi * azimuth), d = sin(2 * pi * azimuth);
    double r = edge / pow(pow(fabs(c), 2.4) + pow(fabs(d), 2.4), 1 / 2.4); /* a rounded rectangle */
    p[0] = r * value[0] * c;
    p[1] = 0.5 * (value[1] + value[2]) + r * 0.5 * (value[2] - value[1]) * d;
    p[2] = z;
}

skg_status skg_thorax_skin(const skg_thorax_plan *plan, skg_thorax *thorax) {
    skin_rings s = {skg_shape_count(plan->resolution, 6, 2), skg_shape_count(plan->resolution, 36, 16)};
    int64_t rings = 2 * s.caps + s.sides, around = skg_shape_count(plan->resolution, 52, 24), *counts;
    SKG_TRY(skg_alloc(rings, sizeof *counts, "skin", &counts));
    for (int64_t r = 0; r < rings; r++) {
        int64_t from_end = r < rings - 1 - r ? r : rings - 1 - r, part = around * from_end / s.caps;
        counts[r] = from_end == 0 ? 1 : from_end >= s.caps ? around : part > 6 ? part : 6;
    }
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_rings("skin", rings, counts, skin_place, &s, &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, "skin", -60, -1, &arrays);
    skg_free(&counts);
    skg_mesh_arrays_free(&arrays);
    return status;
}

/* Chiba needle, 22 G: 0.72 mm across, 200 mm long, tip in the right hepatic duct, 110 mm deep, through the
 * space below rib 8 in the right mid-axillary line. */
skg_status skg_thorax_needle(const skg_thorax_plan *plan, skg_thorax *thorax) {
    (void)plan;
    static const double tip[3] = {-54, -60, -81.5}, toward[3] = {-1, 0.02, -0.36};
    skg_tube_ring ring[2] = {{{0}, 0.36, 0.36}, {{0}, 0.36, 0.36}};
    memcpy(ring[0].centre, tip, sizeof tip);
    skg_add_scaled(tip, 200 / skg_length(toward), toward, ring[1].centre);
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_tube("needle", 2, ring, 0.36, 8, &arrays);
    if (status == SKG_OK) status = skg_thorax_add(thorax, "needle", 0, -1, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}
