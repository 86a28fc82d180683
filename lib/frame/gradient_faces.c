#include "frame/gradient_faces.h"

skg_status skg_gradient_place_faces(skg_job *job, const skg_pass *pass, int64_t part,
                                    skg_face_moments *faces) {
    skg_machine *machine = job->machine;
    const skg_geometry *geometry = &machine->geometry;
    const int64_t mesh = geometry->mesh_of_part[part];
    *faces = (skg_face_moments){.camera = &pass->camera,
                                .mesh = job->recipe->meshes.meshes[mesh],
                                .pose = pass->parts[part].pose,
                                .source = geometry->layouts[mesh].source};
    return skg_gradient_find_corners(machine->context, geometry, mesh, &machine->gradient, &faces->corners);
}

/* The weights of a pass on the host, for faces that are seen as lines. */
typedef struct {
    const skg_pass *pass;
    skg_weight_layout layout;
    double **planes; /* [layout.planes] NULL: not read */
} pixel_weights;

/* The same for one part. */
typedef struct {
    const pixel_weights *all;
    int64_t part;
} part_weights;

/* d loss / d t of a ray: what parts that compete take off is left out. */
static double weigh_pixel(const void *user, int64_t column, int64_t row) {
    const part_weights *of_part = user;
    const pixel_weights *w = of_part->all;
    const skg_geometry_part *part = &w->pass->parts[of_part->part];
    double sum = 0;
    for (int32_t c = 0; c < part->contributions; c++)
        sum += part->contribution[c].weight *
               w->planes[part->contribution[c].plane][row * w->layout.stride + column];
    return part->depth > 0 ? sum * w->pass->scale.scale : 0;
}

/* Reads the weights of a part if any of its faces is seen as a line. */
static skg_status read_weights(skg_job *job, const int64_t *moments, int64_t triangles, int64_t number,
                               pixel_weights *w) {
    const skg_gradient_memory *memory = &job->machine->gradient;
    const skg_geometry_part *part = &w->pass->parts[number];
    int64_t count = 0;
    for (int64_t t = 0; t < triangles; t++) count += moments[3 * t] == SKG_EDGE_ON;
    for (int32_t c = 0; c < part->contributions && count > 0; c++) {
        const int64_t plane = part->contribution[c].plane;
        if (w->planes[plane]) continue;
        SKG_TRY(skg_alloc(w->layout.plane, sizeof **w->planes, "gradient", &w->planes[plane]));
        SKG_TRY(skg_gradient_read(w->pass, memory->weights.memory, plane * w->layout.plane, w->layout.plane,
                                  w->planes[plane]));
    }
    return SKG_OK;
}

/* The faces of the parts, with their moments. */
typedef struct {
    skg_face_moments *faces; /* [parts] */
    part_weights *weights;   /* [parts] */
    pixel_weights of_pixels;
} faces_work;

static skg_status list_faces(skg_job *job, const skg_pass *pass, const skg_gathered *gathered,
                             faces_work *w) {
    const skg_geometry *geometry = &job->machine->geometry;
    for (int64_t p = 0, first = 0; p < pass->scene->count; p++) {
        const skg_geometry_part *part = &pass->parts[p];
        const int64_t triangles = geometry->layouts[geometry->mesh_of_part[p]].triangles;
        skg_face_moments *faces = &w->faces[p];
        skg_part_double entry;
        const int64_t *moments = gathered->moments + 3 * first;
        first += triangles;
        if (gathered->units[p] == 0) continue;
        SKG_TRY(read_weights(job, moments, triangles, p, &w->of_pixels));
        SKG_TRY(skg_gradient_place_faces(job, pass, p, faces));
        skg_camera_part(&pass->camera, part->pose, part->origin, part->reference, part->flipped, &entry);
        w->weights[p] = (part_weights){.all = &w->of_pixels, .part = p};
        faces->moments = moments;
        faces->unit = gathered->units[p];
        faces->pixel[0] = entry.pixel_i, faces->pixel[1] = entry.pixel_j;
        faces->weight = weigh_pixel;
        faces->weight_user = &w->weights[p];
    }
    return SKG_OK;
}

skg_status skg_gradient_add_faces(skg_job *job, const skg_pass *pass, const skg_gathered *gathered,
                                  double *const *vertices, skg_force_sums *sums) {
    const int64_t parts = pass->scene->count;
    faces_work w = {.of_pixels = {.pass = pass, .layout = gathered->layout}};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.faces, "gradient", &w.faces));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.weights, "gradient", &w.weights));
    SKG_TRY_CLEANUP(
        skg_alloc(gathered->layout.planes, sizeof *w.of_pixels.planes, "gradient", &w.of_pixels.planes));
    SKG_TRY_CLEANUP(list_faces(job, pass, gathered, &w));
    status = skg_forces_find(parts, w.faces, vertices, sums);
cleanup:
    for (int64_t k = 0; w.of_pixels.planes && k < gathered->layout.planes; k++)
        skg_free(&w.of_pixels.planes[k]);
    skg_free(&w.of_pixels.planes);
    skg_free(&w.faces);
    skg_free(&w.weights);
    return status;
}
