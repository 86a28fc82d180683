/* The faces of a pass's parts, from the moments that the device has gathered to sums for each part. */
#include "gradient/faces.h"

#include "gradient/edges.h"

skg_status skg_gradient_place_faces(skg_job *job, const skg_pass *pass, int64_t part,
                                    skg_face_moments *faces) {
    skg_machine *machine = job->machine;
    const skg_geometry *geometry = &machine->geometry;
    SKG_ASSERT(0 <= part && part < geometry->parts);
    const int64_t mesh = geometry->mesh_of_part[part];
    *faces = (skg_face_moments){.camera = &pass->camera,
                                .mesh = &job->then.meshes[mesh],
                                .pose = pass->parts[part].pose,
                                .source = geometry->layouts[mesh].source};
    return skg_gradient_find_corners(machine->context, geometry, mesh, skg_gradient_of(job)->memory,
                                     &faces->corners);
}

skg_status skg_gradient_draw_competitors(skg_job *job, const skg_pass *pass, skg_geometry_part **drawn) {
    static const skg_contribution nothing = {.plane = 0, .weight = 0};
    const int64_t parts = pass->scene->count;
    for (int64_t s = 0; s < pass->priority.count; s++) {
        const int64_t p = pass->priority.parts[s];
        if (pass->parts[p].contributions > 0) continue;
        if (*drawn == pass->parts) {
            SKG_TRY(skg_staging_take(&job->staging, parts, sizeof **drawn, "gradient", drawn));
            for (int64_t k = 0; k < parts; k++) (*drawn)[k] = pass->parts[k];
        }
        (*drawn)[p].contributions = 1;
        (*drawn)[p].contribution = &nothing;
    }
    return SKG_OK;
}

/* Whether any face of a part is seen as a line. */
static int has_edges(const int64_t *moments, int64_t triangles) {
    for (int64_t t = 0; t < triangles; t++)
        if (moments[4 * t] == SKG_EDGE_ON) return 1;
    return 0;
}

/* The faces of the parts, with their moments. */
typedef struct {
    skg_face_moments *faces; /* [parts] */
    skg_part_edges *edges;   /* [parts] */
    skg_edge_weights of_edges;
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
            SKG_TRY(skg_edge_weights_read(job, p, &w->of_edges));
        SKG_TRY(skg_gradient_place_faces(job, pass, p, faces));
        const skg_camera_place place = skg_geometry_place(part, 0);
        skg_camera_part(&pass->camera, &place, &entry);
        SKG_TRY(skg_gradient_find_planes(geometry, faces->mesh, geometry->mesh_of_part[p],
                                         skg_gradient_of(job)->memory, &faces->planes));
        w->edges[p] = (skg_part_edges){.all = &w->of_edges, .part = p};
        faces->moments = moments;
        faces->unit = gathered->units[p];
        faces->pixel[0] = entry.pixel_i, faces->pixel[1] = entry.pixel_j;
        faces->weigh = skg_edge_weigh;
        faces->weigh_user = &w->edges[p];
    }
    return SKG_OK;
}

skg_status skg_gradient_add_faces(skg_job *job, const skg_pass *pass, const skg_gathered *gathered,
                                  double *const *vertices, skg_force_sums *sums) {
    const int64_t parts = pass->scene->count;
    faces_work w = {.faces = NULL};
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.faces, "gradient", &w.faces));
    SKG_TRY_CLEANUP(skg_alloc(parts, sizeof *w.edges, "gradient", &w.edges));
    SKG_TRY_CLEANUP(skg_edge_weights_create(pass, &w.of_edges));
    SKG_TRY_CLEANUP(list_faces(job, pass, gathered, &w));
    status = skg_forces_find(parts, w.faces, vertices, sums);
cleanup:
    skg_edge_weights_release(&w.of_edges);
    skg_free(&w.faces);
    skg_free(&w.edges);
    return status;
}
