/* Warns of scenes that are probably not meant: sizes, places, units. */
#include "beam/spectrum.h"
#include "core/maths.h"
#include "mesh/mesh.h"
#include "plan/decisions.h"
#include "scene/scene.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* Photons only lose energy when they scatter. */
static int gets_scatter(const skg_recipe *recipe, int64_t band) {
    const skg_spectrum *beam = recipe->spectrum;
    return recipe->options.scatter && recipe->options.band_kev[band] < beam->energy_kev[beam->count - 1];
}

static void warn_of_bands(const skg_recipe *recipe, const skg_context *context) {
    const skg_plan_options *options = &recipe->options;
    const skg_spectrum *beam = recipe->spectrum;
    for (int64_t c = 0; c < options->bands; c++)
        if (!(recipe->model.flat_field[c] > 0) && !gets_scatter(recipe, c))
            skg_log(
                context, SKG_LOG_WARNING,
                "the band from %g to %g keV records nothing of the beam, whose energies go from %g to %g keV; its "
                "image is 0 everywhere",
                options->band_kev[c], options->band_kev[c + 1], beam->energy_kev[0],
                beam->energy_kev[beam->count - 1]);
}

/* A position of the mesh in the world, from a point. */
static void place(const double *pose, const double *point, const double *at, double *from_point) {
    for (int r = 0; r < 3; r++) from_point[r] = skg_dot(pose + 4 * r, at) + pose[4 * r + 3] - point[r];
}

/* Whether the box about the mesh holds a point, in the world's axes. */
static int box_holds(const skg_mesh *mesh, const double *pose, const double *point) {
    float lowest[3], highest[3];
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    int64_t bad = 0;
    skg_mesh_bounds(mesh, lowest, highest, &bad);
    for (int corner = 0; corner < 8; corner++) {
        double at[3], way[3];
        for (int k = 0; k < 3; k++)
            at[k] = mesh->origin[k] + (double)(corner >> k & 1 ? highest[k] : lowest[k]);
        place(pose, point, at, way);
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], way[k]), high[k] = fmax(high[k], way[k]);
    }
    return low[0] < 0 && low[1] < 0 && low[2] < 0 && high[0] > 0 && high[1] > 0 && high[2] > 0;
}

/* How many times the surface of the mesh winds about a point: the solid angles of its triangles over 4 pi. */
static double winding(const skg_mesh *mesh, const double *pose, const double *point) {
    double sum = 0;
    for (int64_t t = 0; t < mesh->triangles; t++) {
        double corner[3][3];
        for (int c = 0; c < 3; c++) {
            double at[3];
            skg_mesh_vertex(mesh, mesh->corners[3 * t + c], at);
            place(pose, point, at, corner[c]);
        }
        sum += skg_solid_angle(corner[0], corner[1], corner[2]);
    }
    return sum / (4 * SKG_PI);
}

static int holds(const skg_recipe *recipe, int64_t part, const double *point) {
    /* 1 inside, 0 outside, 1/2 on a face. A leaky mesh lacks the angles of its holes. */
    static const double INSIDE = 0.75;
    const skg_scene_part_data *p = &recipe->scene->parts[part];
    return box_holds(p->mesh, p->pose, point) && fabs(winding(p->mesh, p->pose, point)) > INSIDE;
}

static int64_t depth_of(const skg_scene *scene, int64_t part) {
    int64_t depth = 0;
    while ((part = scene->parts[part].inside) >= 0) depth++;
    return depth;
}

/* The innermost part that holds a point; -1: none. */
static int64_t innermost(const skg_recipe *recipe, const double *point) {
    const skg_scene *scene = recipe->scene;
    int64_t found = -1;
    for (int64_t p = 0; p < scene->count; p++)
        if (holds(recipe, p, point) && (found < 0 || depth_of(scene, p) > depth_of(scene, found))) found = p;
    return found;
}

static void warn_of_source(const skg_recipe *recipe, const skg_context *context) {
    const skg_scene *scene = recipe->scene;
    if (recipe->view.projection != SKG_PROJECTION_POINT) return;
    const int64_t found = innermost(recipe, recipe->view.source);
    if (found < 0) return;
    skg_log(
        context, SKG_LOG_WARNING,
        "the source lies inside %s: rays begin there, and only what lies between it and the detector is seen; if that "
        "is not meant, move the source or the part",
        scene->parts[found].label);
}

/* A room about source and detector is meant, and of it the source is told. */
static void warn_of_detector(const skg_recipe *recipe, const skg_context *context) {
    const skg_view *view = &recipe->view;
    const int64_t found = innermost(recipe, view->centre);
    if (found < 0 || holds(recipe, found, view->source)) return;
    skg_log(
        context, SKG_LOG_WARNING,
        "the middle of the detector lies inside %s: rays end there, and what of it lies behind the detector is not seen; if that "
        "is not meant, move the detector or the part",
        recipe->scene->parts[found].label);
}

/* The larger side of the detector, seen from the source at the depth of a part, mm; 0: the part is behind the source. Of a part that
 * reaches further than the detector, or from behind the source, that at the detector. reach: from its middle */
static double field_at(const skg_view *view, const double *centre, double reach) {
    const double columns = (double)view->columns * skg_length(view->column_step),
                 rows = (double)view->rows * skg_length(view->row_step), side = fmax(columns, rows);
    double normal[3], to_detector[3], to_part[3];
    if (view->projection != SKG_PROJECTION_POINT) return side;
    skg_cross(view->column_step, view->row_step, normal);
    skg_add_scaled(view->centre, -1, view->source, to_detector);
    skg_add_scaled(centre, -1, view->source, to_part);
    const double whole = skg_dot(normal, to_detector), part = skg_dot(normal, to_part);
    if (whole == 0 || part / whole <= -reach * skg_length(normal) / fabs(whole)) return 0;
    return part / whole > 0 && part / whole < 1 ? side * part / whole : side;
}

/* The unit of a part and where it is from; of a volume the size of its cells, which alone has a unit in its file. Returns 0 if there is
 * none. */
static int describe_unit(const skg_scene_part_data *part, char *text, size_t size) {
    static const char *const from[] = {[SKG_UNIT_ASSUMED] = ", since nobody named one",
                                       [SKG_UNIT_FILE] = ", from the file",
                                       [SKG_UNIT_NAMED] = ", as named"};
    skg_mesh_unit unit;
    if (part->volume) {
        double side[3];
        for (int k = 0; k < 3; k++) {
            const double *a = part->volume->affine;
            side[k] = skg_length((const double[3]){a[k], a[4 + k], a[8 + k]});
        }
        snprintf(text, size, "the size of its cells is %.3g x %.3g x %.3g mm", side[0], side[1], side[2]);
        return 1;
    }
    skg_mesh_unit_init(&unit);
    if (skg_mesh_unit_get(part->mesh, &unit) != SKG_OK) return 0;
    snprintf(text, size, "its unit is %s%s", unit.name, from[unit.from]);
    return 1;
}

/* Warns of the part whose size fits the field of view least: a unit may be wrong, and the picture of a wrong size looks alike. */
static void warn_of_sizes(const skg_recipe *recipe, const skg_context *context) {
    static const double MOST = 500;
    const skg_scene *scene = recipe->scene;
    double worst = MOST, worst_side = 0, worst_field = 0;
    int64_t found = -1, count = 0;
    for (int64_t p = 0; p < scene->count; p++) {
        const skg_scene_part_data *part = &scene->parts[p];
        double side = 0, middle[3];
        float lowest[3], highest[3];
        int64_t bad = 0;
        skg_mesh_bounds(part->mesh, lowest, highest, &bad);
        for (int k = 0; k < 3; k++) {
            side = fmax(side, (double)highest[k] - (double)lowest[k]);
            middle[k] = part->mesh->origin[k] + 0.5 * ((double)lowest[k] + (double)highest[k]);
        }
        skg_pose_point(part->pose, middle, middle);
        side *= cbrt(fabs(skg_pose_determinant(part->pose)));
        const double field = field_at(&recipe->view, middle, 0.5 * side);
        const double factor = side > 0 && field > 0 ? fmax(side / field, field / side) : 1;
        count += factor > MOST;
        if (factor <= worst) continue;
        worst = factor, worst_side = side, worst_field = field, found = p;
    }
    if (found < 0) return;
    char unit[128];
    if (!describe_unit(&scene->parts[found], unit, sizeof unit)) return;
    skg_log(
        context, SKG_LOG_WARNING,
        "%s: its box is %.3g mm long, %s of the field of view at its place (%.3g mm); %s: is it the right one?%s",
        scene->parts[found].label, worst_side, worst_side < worst_field ? "under 1/500" : "over 500 times",
        worst_field, unit, count > 1 ? " Other parts are as far from it" : "");
}

void skg_plan_warn_doubts(const skg_recipe *recipe, const skg_context *context) {
    warn_of_bands(recipe, context);
    warn_of_source(recipe, context);
    warn_of_detector(recipe, context);
    warn_of_sizes(recipe, context);
}
