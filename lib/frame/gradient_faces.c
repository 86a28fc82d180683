#include "frame/gradient_faces.h"

skg_status skg_gradient_place_faces(skg_job *job, const skg_pass *pass, int64_t part,
                                    skg_face_moments *faces) {
    skg_machine *machine = job->machine;
    const skg_geometry *geometry = &machine->geometry;
    const int64_t mesh = geometry->mesh_of_part[part];
    *faces = (skg_face_moments){.camera = &pass->camera,
                                .mesh = &job->then.meshes[mesh],
                                .pose = pass->parts[part].pose,
                                .source = geometry->layouts[mesh].source};
    return skg_gradient_find_corners(machine->context, geometry, mesh, &machine->gradient, &faces->corners);
}

/* --- weights on the host */

skg_status skg_pixel_weights_create(const skg_pass *pass, skg_pixel_weights *w) {
    *w = (skg_pixel_weights){.pass = pass,
                             .layout = skg_attenuate_weight_layout(pass->main.raster, pass->fine)};
    return skg_alloc(w->layout.planes, sizeof *w->planes, "gradient", &w->planes);
}

void skg_pixel_weights_clear(skg_pixel_weights *w) {
    for (int64_t k = 0; w->planes && k < w->layout.planes; k++) skg_free(&w->planes[k].memory);
}

void skg_pixel_weights_release(skg_pixel_weights *w) {
    skg_pixel_weights_clear(w);
    skg_free(&w->planes);
}

double skg_pixel_weigh(const void *user, int64_t column, int64_t row) {
    const skg_part_weights *of_part = user;
    const skg_pixel_weights *w = of_part->all;
    const skg_geometry_part *part = &w->pass->parts[of_part->part];
    double sum = 0;
    for (int32_t c = 0; c < part->contributions; c++)
        sum += part->contribution[c].weight *
               skg_reals_at(&w->planes[part->contribution[c].plane], row * w->layout.stride + column);
    return part->depth > 0 ? sum * w->pass->scale.scale : 0;
}

skg_status skg_pixel_weights_read(skg_job *job, int64_t number, skg_pixel_weights *w) {
    const skg_geometry_part *part = &w->pass->parts[number];
    for (int32_t c = 0; c < part->contributions; c++) {
        const int64_t plane = part->contribution[c].plane;
        if (w->planes[plane].memory) continue;
        SKG_TRY(skg_gradient_read_reals(w->pass, job->machine->gradient.weights.memory,
                                        plane * w->layout.plane, w->layout.plane, &w->planes[plane]));
    }
    return SKG_OK;
}

/* --- all faces */

/* Whether any face of a part is seen as a line. */
static int has_edges(const int64_t *moments, int64_t triangles) {
    for (int64_t t = 0; t < triangles; t++)
        if (moments[4 * t] == SKG_EDGE_ON) return 1;
    return 0;
}

/* The faces of the parts, with their moments. */
typedef struct {
    skg_face_moments *faces;   /* [parts] */
    skg_part_weights *weights; /* [parts] */
    skg_pixel_weights of_pixels;
} faces_work;

static skg_status list_faces(skg_job *job, const skg_pass *pass, const skg_gathered *gathered,
                             faces_work *w) {
    const skg_geometry *geometry = &job->machine->geometry;
    for (int64_t p = 0, first = 0; p < pass->scene->count; p++) {
        const skg_geometry_part *part = &pass->parts[p];
        const int64_t triangles = geometry->layouts[geometry->mesh_of_part[p]].triangles;
        skg_face_moments *faces = &w->faces[p];
        skg_part_double entry;
        const int64_t *moments = gathered->moments + 4 * first;
        first += triangles;
        if (gathered->units[p] == 0) continue;
        if (gathered->has_edges && has_edges(moments, triangles))
            SKG_TRY(skg_pixel_weights_read(job, p, &w->of_pixels));
        SKG_TRY(skg_gradient_place_faces(job, pass, p, faces));
        skg_camera_part(&pass->camera, part->pose, part->origin, part->reference, part->flipped, &entry);
        SKG_TRY(skg_gradient_find_planes(geometry, faces->mesh, geometry->mesh_of_part[p],
                                         &job->machine->gradient, &faces->planes));
        w->weights[p] = (skg_part_weights){.all = &w->of_pixels, .part = p};
        faces->moments = moments;
        faces->unit = gathered->units[p];
        faces->pixel[0] = entry.pixel_i, faces->pixel[1] = entry.pixel_j;
        faces->weight = skg_pixel_weigh;
        faces->weight_user = &w->weights[p];
    }
    return SKG_OK;
}

skg_status skg_gradient_add_faces(skg_job *job, const skg_pass *pass, const skg_gathered *gathered,
                                  double *const *vertices, skg_force_sums *sums) {
    const int64_t parts = pass->scene->count;
    faces_work w = {.faces = NULL};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.faces, "gradient", &w.faces));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.weights, "gradient", &w.weights));
    SKG_TRY_CLEANUP(skg_pixel_weights_create(pass, &w.of_pixels));
    SKG_TRY_CLEANUP(list_faces(job, pass, gathered, &w));
    status = skg_forces_find(parts, w.faces, vertices, sums);
cleanup:
    skg_pixel_weights_release(&w.of_pixels);
    skg_free(&w.faces);
    skg_free(&w.weights);
    return status;
}
