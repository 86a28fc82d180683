/* The generated thorax in front of a detector, as a scene and as a body. */
#include "thorax.h"

#include "holes.h"

#include <stdlib.h>
#include <string.h>

enum { MATERIALS = 5, ENERGIES = 10, HOLES = 100 };

static void get_part(const bench_thorax *thorax, int64_t number, skg_thorax_part *part) {
    skg_thorax_part_init(part);
    bench_try(skg_thorax_part_get(thorax->thorax, number, part), "thorax");
}

void thorax_make(long triangles, int leaky, bench_thorax *out) {
    skg_thorax_options options;
    skg_thorax_options_init(&options);
    options.triangles = triangles;
    options.simple = 1; /* so that figures can be compared with those of earlier versions and of the paper */
    *out = (bench_thorax){0};
    bench_try(skg_thorax_create(&options, &out->thorax), "thorax");
    bench_try(skg_thorax_part_count(out->thorax, &out->parts), "thorax");
    out->meshes = bench_alloc((size_t)out->parts, sizeof *out->meshes);
    for (int64_t i = 0; i < out->parts; i++) {
        skg_thorax_part part;
        int64_t vertices, its;
        get_part(out, i, &part);
        if (leaky == THORAX_ALL_LEAKY || (leaky == THORAX_LEAKY_LIVER && !strcmp(part.label, "liver")))
            out->meshes[i] = bench_mesh_with_holes(NULL, part.mesh, HOLES, part.label);
        else
            bench_try(skg_mesh_retain(out->meshes[i] = part.mesh), part.label);
        bench_try(skg_mesh_count(out->meshes[i], &vertices, &its), part.label);
        out->triangles += its;
    }
}

void thorax_free(bench_thorax *thorax) {
    for (int64_t i = 0; i < thorax->parts; i++) skg_mesh_release(&thorax->meshes[i]);
    free(thorax->meshes);
    skg_thorax_release(&thorax->thorax);
    *thorax = (bench_thorax){0};
}

skg_body *thorax_body(const bench_thorax *thorax) {
    skg_body *body = NULL;
    bench_try(skg_body_create(NULL, NULL, &body), "body");
    for (int64_t i = 0; i < thorax->parts; i++) {
        skg_thorax_part part;
        skg_organ organ;
        get_part(thorax, i, &part);
        skg_organ_init(&organ);
        organ.mesh = thorax->meshes[i], organ.label = part.label, organ.inside = part.inside;
        bench_try(skg_body_add(body, &organ, NULL), part.label);
    }
    bench_try(skg_body_link(body), "body");
    return body;
}

/* An index of the materials of thorax_scene. */
static int material_of(const skg_thorax_part *part) {
    if (!strcmp(part->label, "skin")) return 0;
    if (!strncmp(part->label, "lung", 4)) return 1;
    if (!strcmp(part->label, "needle")) return 4;
    return part->material ? 2 : 3;
}

skg_scene *thorax_scene(skg_context *context, const bench_thorax *thorax) {
    static const char *const names[MATERIALS] = {"Adipose", "Lung", "Muscle", "HU:300", "Needle steel"};
    skg_material *materials[MATERIALS];
    skg_scene *scene = NULL;
    bench_try(skg_scene_create(context, &scene), "scene");
    for (int m = 0; m < MATERIALS; m++)
        bench_try(skg_material_create_named(names[m], &materials[m]), names[m]);
    for (int64_t i = 0; i < thorax->parts; i++) {
        skg_thorax_part from;
        skg_part part;
        get_part(thorax, i, &from);
        skg_part_init(&part);
        part.mesh = thorax->meshes[i], part.label = from.label, part.inside = from.inside;
        part.material = materials[material_of(&from)];
        bench_try(skg_scene_part_add(scene, &part, NULL), from.label);
    }
    for (int m = 0; m < MATERIALS; m++) skg_material_release(&materials[m]);
    return scene;
}

skg_spectrum *thorax_beam(void) {
    double kev[ENERGIES], photons[ENERGIES];
    skg_spectrum *spectrum = NULL;
    for (int n = 0; n < ENERGIES; n++) kev[n] = 30 + 5 * n, photons[n] = 1000;
    bench_try(skg_spectrum_create_bins(ENERGIES, kev, photons, &spectrum), "spectrum");
    return spectrum;
}

void thorax_view(long size, skg_view *view) {
    const double pitch = 480.0 / (double)size;
    skg_view_init(view);
    view->columns = view->rows = size;
    view->source[1] = -860, view->centre[1] = 140, view->source[2] = view->centre[2] = -20;
    view->column_step[0] = pitch, view->row_step[2] = -pitch;
}
