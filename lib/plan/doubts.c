#include "beam/spectrum.h"
#include "core/maths.h"
#include "mesh/mesh.h"
#include "plan/decisions.h"
#include "scene/scene.h"

#include <inttypes.h>
#include <math.h>

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

/* A position of the mesh in the world, from the source. */
static void place(const double *pose, const double *source, const double *at, double *from_source) {
    for (int r = 0; r < 3; r++) from_source[r] = skg_dot(pose + 4 * r, at) + pose[4 * r + 3] - source[r];
}

/* Whether the box about the mesh holds the source, in the world's axes. */
static int box_holds(const skg_mesh *mesh, const double *pose, const double *source) {
    float lowest[3], highest[3];
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    int64_t bad = 0;
    skg_mesh_bounds(mesh, lowest, highest, &bad);
    for (int corner = 0; corner < 8; corner++) {
        double at[3], way[3];
        for (int k = 0; k < 3; k++)
            at[k] = mesh->origin[k] + (double)(corner >> k & 1 ? highest[k] : lowest[k]);
        place(pose, source, at, way);
        for (int k = 0; k < 3; k++) low[k] = fmin(low[k], way[k]), high[k] = fmax(high[k], way[k]);
    }
    return low[0] < 0 && low[1] < 0 && low[2] < 0 && high[0] > 0 && high[1] > 0 && high[2] > 0;
}

/* How many times the surface of the mesh winds about the source: the solid angles of its triangles over 4 pi. */
static double winding(const skg_mesh *mesh, const double *pose, const double *source) {
    double sum = 0;
    for (int64_t t = 0; t < mesh->triangles; t++) {
        double corner[3][3];
        for (int c = 0; c < 3; c++) {
            double at[3];
            skg_mesh_vertex(mesh, mesh->corners[3 * t + c], at);
            place(pose, source, at, corner[c]);
        }
        sum += skg_solid_angle(corner[0], corner[1], corner[2]);
    }
    return sum / (4 * SKG_PI);
}

static int holds_source(const skg_recipe *recipe, int64_t part) {
    /* 1 inside, 0 outside, 1/2 on a face. A leaky mesh lacks the angles of its holes. */
    static const double INSIDE = 0.75;
    const skg_scene_part_data *p = &recipe->scene->parts[part];
    const double *source = recipe->view.source;
    return box_holds(p->mesh, p->pose, source) && fabs(winding(p->mesh, p->pose, source)) > INSIDE;
}

static int64_t depth_of(const skg_scene *scene, int64_t part) {
    int64_t depth = 0;
    while ((part = scene->parts[part].inside) >= 0) depth++;
    return depth;
}

/* Of nested parts, the innermost is named. */
static void warn_of_source(const skg_recipe *recipe, const skg_context *context) {
    const skg_scene *scene = recipe->scene;
    int64_t found = -1;
    if (recipe->view.projection != SKG_PROJECTION_POINT) return;
    for (int64_t p = 0; p < scene->count; p++)
        if (holds_source(recipe, p) && (found < 0 || depth_of(scene, p) > depth_of(scene, found))) found = p;
    if (found < 0) return;
    skg_log(
        context, SKG_LOG_WARNING,
        "the source lies inside %s: rays begin there, and only what lies between it and the detector is seen; if that "
        "is not meant, move the source or the part",
        scene->parts[found].label);
}

void skg_plan_warn_doubts(const skg_recipe *recipe, const skg_context *context) {
    warn_of_bands(recipe, context);
    warn_of_source(recipe, context);
}
