/* Ribs, costal cartilage, sternum, spine, clavicles. */
#include "core/maths.h"
#include "phantom/anatomy.h"
#include "phantom/makers.h"
#include "phantom/shapes.h"

#include <stdio.h>
#include <string.h>

static skg_status add_tube(skg_thorax *thorax, const char *label, double hounsfield, int64_t inside,
                           const double (*curve)[3], int64_t points, double height, double width, double side,
                           int64_t rings, int64_t around) {
    skg_mesh_arrays arrays = {0};
    skg_status status = skg_shape_cord(label, curve, points, height, width, side, rings, around, &arrays);
    if (status == SKG_OK) return skg_thorax_add(thorax, label, hounsfield, inside, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}

/* Inside a tube of the full thorax: the marrow, under cortex of `cortex` mm. The rings are those of the bone, or the
 * marrow would leave it where the bone bends. */
static skg_status add_marrow(skg_thorax *thorax, const char *bone, const double (*curve)[3], int64_t points,
                             double height, double width, double side, int64_t rings, int64_t around) {
    const double cortex = 0.9; /* mm; a rib's is 0.9 to 2.6 at its thickest */
    const int64_t inside = thorax->parts - 1;
    char label[40];
    double curves[2 * RIB_POINTS][3];
    const double cut = 1.0 / (double)(rings - 1); /* the end rings, narrower and round, stay solid */
    for (int64_t i = 0; i < points; i++) {
        const double at = (cut + (1 - 2 * cut) * (double)i / (double)(points - 1)) * (double)(points - 1);
        const int64_t low = (int64_t)at < points - 1 ? (int64_t)at : points - 2;
        for (int k = 0; k < 3; k++)
            curves[i][k] = curve[low][k] + (at - (double)low) * (curve[low + 1][k] - curve[low][k]);
    }
    snprintf(label, sizeof label, "marrow of %s", bone);
    return add_tube(thorax, label, 150, inside, (const double(*)[3])curves, points, height - cortex,
                    width - cortex, side, rings - 2, around);
}

static const double cortex_hounsfield = 1330;

enum { CARTILAGES = 10 };

static const char *const side_name[2] = {"left", "right"};
static const double side_sign[2] = {1, -1};

/* Half widths of the sternum by z, mm. */
static const double sternum_width[][2] = {{-42, 5}, {-25, 8}, {-22, 14}, {0, 18},  {40, 16},
                                          {86, 14}, {90, 20}, {115, 25}, {134, 24}};

static double sternum_edge(double z) {
    return skg_shape_curve(sternum_width, (int)(sizeof sternum_width / sizeof *sternum_width), z);
}

static skg_status sternum(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    static const struct {
        const char *label;
        double low, high;
    } piece[3] = {/* mm; gaps between the pieces are joints */
                  {"sternum xiphoid", -41, -26},
                  {"sternum body", -20, 85},
                  {"sternum manubrium", 91, 132}};
    int64_t around = skg_shape_count(plan->resolution, 14, 6);
    for (int i = 0; i < 3; i++) {
        int64_t rings = skg_shape_count(plan->resolution, 3 + (piece[i].high - piece[i].low) / 8, 3);
        skg_tube_ring *ring;
        SKG_TRY(skg_alloc(rings, sizeof *ring, piece[i].label, &ring));
        for (int64_t r = 0; r < rings; r++) {
            double z = piece[i].low + (piece[i].high - piece[i].low) * (double)r / (double)(rings - 1);
            ring[r] = (skg_tube_ring){{0, skg_cage_front(0, z), z}, 5, sternum_edge(z)};
            if (r == 0 || r == rings - 1) ring[r].height = 3.5, ring[r].width *= 0.9;
        }
        skg_mesh_arrays arrays = {0};
        skg_status status = skg_shape_tube(piece[i].label, rings, ring, 1.5, around, &arrays);
        skg_free(&ring);
        if (status == SKG_OK) status = skg_thorax_add(thorax, piece[i].label, 300, skin, &arrays);
        skg_mesh_arrays_free(&arrays);
        SKG_TRY(status);
    }
    return SKG_OK;
}

static skg_status ribs(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    int64_t around = skg_shape_count(plan->resolution, 10, 5);
    /* Left and right are mirror images only with an even number of points. */
    if (!plan->simple && around % 2 == 1) around += around > 6 ? -1 : 1;
    for (int k = 0; k < RIBS; k++)
        for (int side = 0; side < 2; side++) {
            const skg_rib *rib = plan->rib + k;
            double length = 0, d[3];
            for (int i = 1; i < RIB_POINTS; i++) {
                skg_add_scaled(rib->line[i], -1, rib->line[i - 1], d);
                length += skg_length(d);
            }
            char label[40];
            snprintf(label, sizeof label, "rib %d %s", k + 1, side_name[side]);
            const int64_t rings = skg_shape_count(plan->resolution, 4 + length / 11, 6);
            SKG_TRY(add_tube(thorax, label, plan->simple ? 600 : cortex_hounsfield, skin, rib->line,
                             RIB_POINTS, rib->height, rib->width, side_sign[side], rings, around));
            if (!plan->simple)
                SKG_TRY(add_marrow(thorax, label, rib->line, RIB_POINTS, rib->height, rib->width,
                                   side_sign[side], rings, around));
        }
    return SKG_OK;
}

/* From the end of a rib to the sternum; from ribs 8 to 10 to below the cartilage above. */
static skg_status cartilages(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    static const double joint[7] = {120, 95.5, 64, 42, 22, 4, -14}; /* z at the sternum */
    static const double radius[CARTILAGES] = {5, 5, 5, 5, 5, 5, 5, 4.5, 4, 3.5};
    double middle[3] = {0};
    for (int k = 0; k < CARTILAGES; k++) {
        const skg_rib *rib = plan->rib + k;
        const double *end = rib->line[RIB_POINTS - 1], *before = rib->line[RIB_POINTS - 3];
        double along[3], p[3][3], curve[17][3], r = radius[k];
        skg_add_scaled(end, -1, before, along);
        skg_scale_vector(1 / skg_length(along), along, along);
        skg_add_scaled(end, 0.5 * rib->width + 0.5 * r + 1.5, along, p[0]); /* 1.5 mm between their poles */
        if (k < 7) {
            p[2][2] = joint[k];
            p[2][0] = sternum_edge(joint[k]) + 0.5 * r + 2;
        } else {
            p[2][0] = middle[0] + 4;
            p[2][2] = middle[2] - radius[k - 1] - r - 7;
        }
        for (int i = 0; i < 3; i += 2) p[1][i] = 0.5 * (p[0][i] + p[2][i]);
        p[1][2] -= k >= 4 && k < 7 ? 0.1 * (p[2][2] - p[0][2]) : 0;
        for (int i = 1; i < 3; i++) p[i][1] = skg_cage_front(p[i][0], p[i][2]);
        SKG_TRY(skg_shape_spline((const double(*)[3])p, 3, 17, curve));
        for (int i = 1; i < 17; i++) skg_cage_project(curve[i]);
        memcpy(middle, curve[k < 7 ? 8 : 10], sizeof middle);
        for (int side = 0; side < 2; side++) {
            char label[40];
            snprintf(label, sizeof label, "cartilage %d %s", k + 1, side_name[side]);
            SKG_TRY(add_tube(thorax, label, 110, skin, (const double(*)[3])curve, 17, r, r, side_sign[side],
                             skg_shape_count(plan->resolution, k < 4 ? 5 : 8, 4),
                             skg_shape_count(plan->resolution, 8, 5)));
        }
    }
    return SKG_OK;
}

static skg_status clavicles(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    static const double points[2][4][3] = {
        {{20, -98, 140}, {56, -103, 148}, {98, -72, 156}, {147, -34, 158}},
        {{26, -100, 147}, {62, -103, 156}, {104, -78, 164}, {150, -44, 170}}};
    double curve[33][3];
    SKG_TRY(skg_shape_spline(points[plan->simple], 4, 33, curve));
    for (int side = 0; side < 2; side++) {
        char label[40];
        snprintf(label, sizeof label, "clavicle %s", side_name[side]);
        const int64_t rings = skg_shape_count(plan->resolution, 12, 5);
        const int64_t around = skg_shape_count(plan->resolution, 9, 5);
        SKG_TRY(add_tube(thorax, label, plan->simple ? 600 : cortex_hounsfield, skin,
                         (const double(*)[3])curve, 33, 5.5, 6, side_sign[side], rings, around));
        if (!plan->simple)
            SKG_TRY(add_marrow(thorax, label, (const double(*)[3])curve, 33, 4.8, 5.3, side_sign[side], rings,
                               around));
    }
    return SKG_OK;
}

/* A vertebra's arch with its spinous and transverse processes: three lobes about a centre. */
typedef struct {
    double centre[3], size;
} arch;

static double arch_region(const void *shape, const double point[3]) {
    static const double lobe[3][3] = {{0, 0.85, -0.5}, {0.93, 0.3, 0.2}, {-0.93, 0.3, 0.2}};
    static const double reach[3] = {24, 19, 19};
    const arch *a = shape;
    double p[3], length, radius = 7;
    skg_add_scaled(point, -1, a->centre, p);
    length = skg_length(p);
    if (length <= 0) return -radius;
    for (int i = 0; i < 3; i++) {
        double cosine = skg_dot(p, lobe[i]) / (length * skg_length(lobe[i]));
        radius += reach[i] * exp(-14 * (1 - cosine));
    }
    return length - a->size * radius;
}

static skg_status simple_spine(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    skg_mesh_arrays arrays = {0};
    skg_status status = SKG_OK;
    int64_t around = skg_shape_count(plan->resolution, 16, 6);
    for (int k = 0; k < SPINE_BODIES && status == SKG_OK; k++) {
        double z = skg_spine_body[k][0], height = skg_spine_body[k][1], y = skg_spine_depth(z);
        double w = k / (SPINE_BODIES - 1.0), width = 13 + 8 * w, depth = 9 + 7 * w;
        static const double level[6][2] = {{-0.5, 0.9}, {-0.42, 1}, {-0.15, 0.9}, {0.15, 0.9},
                                           {0.42, 1},   {0.5, 0.9}}; /* the waist between the end plates */
        skg_tube_ring ring[6];
        for (int i = 0; i < 6; i++)
            ring[i] =
                (skg_tube_ring){{0, y, z + level[i][0] * height}, level[i][1] * depth, level[i][1] * width};
        for (int i = 0; i < 6; i += 5) ring[i].centre[2] = z + level[i][0] * (height - 2);
        for (int i = 1; i < 5; i += 3) ring[i].centre[2] = z + level[i][0] * (height - 4);
        status = skg_shape_tube("spine", 6, ring, 0.5, around, &arrays);
        const arch a = {{0, y + depth + 18 + 3 * w, z - 2}, 0.8 + 0.25 * w};
        if (status == SKG_OK)
            status = skg_shape_star("spine", arch_region, &a, a.centre, 60,
                                    skg_shape_count(plan->resolution, 9, 6), &arrays);
    }
    if (status == SKG_OK) status = skg_thorax_add(thorax, "spine", 400, skin, &arrays);
    skg_mesh_arrays_free(&arrays);
    return status;
}

skg_status skg_thorax_bones(const skg_thorax_plan *plan, int64_t skin, skg_thorax *thorax) {
    SKG_TRY(ribs(plan, skin, thorax));
    SKG_TRY(cartilages(plan, skin, thorax));
    SKG_TRY(sternum(plan, skin, thorax));
    SKG_TRY(clavicles(plan, skin, thorax));
    if (plan->simple) return simple_spine(plan, skin, thorax);
    SKG_TRY(skg_thorax_spine(plan, skin, thorax));
    return skg_thorax_scapulae(plan, skin, thorax);
}
