/* Drawn scenes for derivatives: 1 to 9 parts, nested, touching, at one place, of any priority, in any view. */
#include "hard/gradients_drawn.h"

#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A part as it was drawn: others are put within it, beside it, or at its place. */
typedef struct {
    double size[3], pose[16];
    int64_t inside;
    int is_box, is_hollow; /* is_hollow: its middle is not in it */
} drawn_part;

enum { FREE, WITHIN, BESIDE, AT_ITS_PLACE, HOWS };

static const char *const materials[] = {"Water", "Al", "Bone, Cortical (ICRU-44)", "PMMA"};
static const double thin[] = {2e-4, 0.05}; /* 1/cm: air, lung */

/* Any turn, by a quaternion, and a place. */
static void draw_pose(uint64_t *seed, double reach, double pose[16]) {
    double q[4], length = 0;
    for (int k = 0; k < 4; k++) q[k] = draw(seed, -1, 1), length += q[k] * q[k];
    for (int k = 0; k < 4; k++) q[k] /= sqrt(length);
    for (int r = 0; r < 3; r++) {
        const int s = (r + 1) % 3, t = (r + 2) % 3;
        pose[4 * r + r] = 1 - 2 * (q[s] * q[s] + q[t] * q[t]);
        pose[4 * r + s] = 2 * (q[r] * q[s] - q[3] * q[t]);
        pose[4 * r + t] = 2 * (q[r] * q[t] + q[3] * q[s]);
        pose[4 * r + 3] = draw(seed, -reach, reach);
    }
    for (int c = 0; c < 4; c++) pose[12 + c] = c == 3;
}

/* A box at a face of another one, turned as it is. */
static void put_beside(uint64_t *seed, const drawn_part *other, drawn_part *own) {
    const int axis = (int)draw_below(seed, 3);
    const double side = draw_below(seed, 2) ? 0.5 : -0.5;
    memcpy(own->pose, other->pose, sizeof own->pose);
    for (int k = 0; k < 3; k++)
        own->pose[4 * k + 3] += side * (own->size[axis] + other->size[axis]) * other->pose[4 * k + axis];
    own->inside = other->inside;
}

/* A shape of about this radius. */
static solid draw_shape(uint64_t *seed, double radius, drawn_part *own) {
    const double reach[3] = {radius, radius, radius};
    const int64_t which = own->is_box ? 0 : draw_below(seed, 6);
    own->is_box = which == 0, own->is_hollow = which > 2;
    for (int k = 0; k < 3 && which == 0 && own->size[k] == 0; k++) own->size[k] = radius * draw(seed, 0.5, 2);
    if (which == 0) return solid_box(own->size[0], own->size[1], own->size[2]);
    if (which == 1) return solid_blob(radius, 12, 8, draw_bits(seed));
    if (which == 2) return solid_sphere(radius, 14, 9);
    if (which == 3) return solid_torus(radius, radius / 3, 16, 8);
    if (which == 4) return solid_shell(radius, 0.6 * radius, 12, 8);
    return solid_tetrahedra(6, radius / 2, reach, draw_bits(seed));
}

static void draw_material(uint64_t *seed, skg_material **material) {
    const int64_t which = draw_below(seed, 6);
    if (which < 4)
        ck_skg(skg_material_create_named(materials[which], material));
    else
        ck_skg(skg_material_create_mu(which == 4 ? "air" : "lung", thin[which - 4], material));
}

static void draw_part(uint64_t *seed, const setting *set, drawn_part *all) {
    drawn_part *own = &all[parts];
    const drawn_part *other = parts > 0 ? &all[draw_below(seed, parts)] : own;
    int64_t how = parts > 0 ? draw_below(seed, HOWS) : FREE;
    double radius = draw(seed, 4, 14);
    char label[16];
    skg_part part;
    *own = (drawn_part){.inside = -1};
    if (how == BESIDE && !other->is_box) how = FREE;
    if (how == WITHIN && (other->is_hollow || (other->is_box && other->size[0] == 0))) how = FREE;
    own->is_box = how == BESIDE || (how == AT_ITS_PLACE && other->is_box);
    draw_pose(seed, how == WITHIN ? 0 : 14, own->pose);
    if (how == WITHIN) {
        radius = 3; /* the least box has 4 to each side, dents leave as much */
        own->inside = other - all;
        for (int k = 0; k < 3; k++) own->pose[4 * k + 3] = other->pose[4 * k + 3];
    } else if (how == AT_ITS_PLACE) {
        memcpy(own->pose, other->pose, sizeof own->pose);
        own->inside = other->inside;
        if (other->is_box) memcpy(own->size, other->size, sizeof own->size);
    }
    solid s = draw_shape(seed, radius, own);
    if (how == BESIDE) put_beside(seed, other, own);
    skg_part_init(&part);
    part.mesh = meshes[parts] = run_mesh(&s);
    snprintf(label, sizeof label, "part %d", (int)parts);
    part.label = label, part.inside = own->inside;
    part.priority = set->priority ? (int32_t)draw_below(seed, 3) : 0;
    memcpy(part.pose, own->pose, sizeof part.pose);
    draw_material(seed, &part.material);
    ck_skg(skg_scene_part_add(scene, &part, NULL));
    skg_material_release(&part.material);
    solid_free(&s);
    parts++;
}

setting drawn_make(uint64_t *seed) {
    static const int32_t quantities[] = {SKG_QUANTITY_ATTENUATION, SKG_QUANTITY_ENERGY, SKG_QUANTITY_PHOTONS,
                                         SKG_QUANTITY_TRANSMISSION};
    setting set = {.name = "drawn", .quantity = quantities[draw_below(seed, 4)]};
    drawn_part all[PARTS];
    set.colours = draw_below(seed, 2) == 0, set.priority = draw_below(seed, 2) == 0;
    set.parallel = draw_below(seed, 3) == 0, set.infinity = set.parallel && draw_below(seed, 2) == 0;
    set.world = !set.infinity && draw_below(seed, 4) == 0;
    set.falloff = draw_below(seed, 4) == 0, set.spot = !set.parallel && draw_below(seed, 4) == 0;
    set.supersampling = draw_below(seed, 4) == 0 ? 2 : 0, set.blur = draw_below(seed, 4) == 0;
    set.parts_only = set.world;
    const int64_t count = 1 + draw_below(seed, PARTS);
    parts = 0;
    ck_skg(skg_scene_create(run_context, &scene));
    while (parts < count) draw_part(seed, &set, all);
    return set;
}

direction drawn_direction(const setting *set, uint64_t *seed) {
    direction d = {.source = {0}};
    const int one = draw_below(seed, 3) == 0 ? (int)draw_below(seed, parts) : -1; /* this part alone */
    for (int p = 0; p < parts; p++) {
        if (one >= 0 && p != one) continue;
        for (int k = 0; k < 6; k++) d.poses[p][k] = draw(seed, -1, 1) * (k < 3 ? 1 : 0.02);
        d.vertices[p] = draw_below(seed, 2) ? draw(seed, -1, 1) : 0;
        d.densities[p] = draw_below(seed, 2) ? draw(seed, -1, 1) : 0;
    }
    if (set->parts_only || draw_below(seed, 2)) return d;
    for (int k = 0; k < 3; k++) d.source[k] = draw(seed, -1, 1) * (set->infinity ? 1e-3 : 1);
    for (int k = 0; k < 6; k++) d.detector[k] = draw(seed, -1, 1) * (k < 3 ? 1 : 0.01);
    return d;
}

/* --- faces that are seen as lines */

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Where a place is seen: column, row. */
static void see(const skg_view *view, const double at[3], double pixel[2]) {
    double normal[3], across[3], down[3], way[3], from[3];
    for (int k = 0; k < 3; k++) {
        way[k] = view->projection == SKG_PROJECTION_POINT      ? at[k] - view->source[k]
                 : view->projection == SKG_PROJECTION_PARALLEL ? view->centre[k] - view->source[k]
                                                               : view->source[k];
        from[k] = at[k] - view->centre[k];
    }
    cross(view->column_step, view->row_step, normal);
    const double t = -dot(normal, from) / dot(normal, way);
    for (int k = 0; k < 3; k++) from[k] += t * way[k];
    cross(view->row_step, normal, across);
    cross(view->column_step, normal, down);
    pixel[0] = dot(across, from) / dot(across, view->column_step) + (SIDE - 1) / 2.0;
    pixel[1] = dot(down, from) / dot(down, view->row_step) + (SIDE - 1) / 2.0;
}

/* Whether a face is, from the source or from anywhere in the spot. */
static int is_line(const setting *set, const skg_view *view, double at[3][3], double seen[3][2]) {
    double sides[2][3], normal[3], from[3], longest = 0;
    const double area = (seen[1][0] - seen[0][0]) * (seen[2][1] - seen[0][1]) -
                        (seen[2][0] - seen[0][0]) * (seen[1][1] - seen[0][1]);
    for (int k = 0; k < 3; k++) {
        sides[0][k] = at[1][k] - at[0][k], sides[1][k] = at[2][k] - at[0][k];
        from[k] = at[0][k] - view->source[k];
        for (int c = 0; c < 2; c++) longest = fmax(longest, fabs(seen[k][c] - seen[(k + 1) % 3][c]));
    }
    cross(sides[0], sides[1], normal);
    const double near = set->spot ? 2 : 0; /* mm: half the diagonal of the spot */
    return fabs(area) <= 1e-3 * longest || fabs(dot(normal, from)) <= near * sqrt(dot(normal, normal));
}

/* Marks the pixels of a triangle, and those that rays of its ends, a blur, or a step of the differences may reach. */
static void mark_box(double seen[3][2], uint8_t *marked) {
    enum { RIM = 2 };
    double low[2] = {SIDE, SIDE}, high[2] = {0, 0};
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 2; c++) {
            low[c] = fmin(low[c], seen[k][c] - RIM);
            high[c] = fmax(high[c], seen[k][c] + RIM);
        }
    for (int row = 0; row < SIDE; row++)
        for (int column = 0; column < SIDE; column++)
            if (column >= low[0] && column <= high[0] && row >= low[1] && row <= high[1])
                marked[row * SIDE + column] = 1;
}

void drawn_mark_lines(const setting *set, const skg_view *view, uint8_t *marked) {
    memset(marked, 0, PIXELS);
    for (int64_t p = 0; p < parts; p++) {
        int64_t vertices, triangles;
        skg_part part;
        skg_part_init(&part);
        ck_skg(skg_scene_part_get(scene, p, &part));
        ck_skg(skg_mesh_count(meshes[p], &vertices, &triangles));
        double *positions = calloc((size_t)(3 * vertices), sizeof *positions);
        int32_t *corners = calloc((size_t)(3 * triangles), sizeof *corners);
        ck_skg(skg_mesh_positions_get(meshes[p], positions, 3));
        ck_skg(skg_mesh_triangles_get(meshes[p], corners, 3));
        for (int64_t f = 0; f < triangles; f++) {
            double at[3][3], seen[3][2];
            for (int k = 0; k < 3; k++) {
                const double *local = positions + 3 * corners[3 * f + k];
                for (int r = 0; r < 3; r++) at[k][r] = dot(part.pose + 4 * r, local) + part.pose[4 * r + 3];
                see(view, at[k], seen[k]);
            }
            if (is_line(set, view, at, seen)) mark_box(seen, marked);
        }
        free(corners);
        free(positions);
    }
}
