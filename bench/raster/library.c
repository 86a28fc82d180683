/* Path lengths by the library, the subject of the race. */
#include "contenders.h"

#include <stdlib.h>

struct library {
    skg_plan *plan;
    skg_frame frame;
    skg_output output;
};

library *library_create(skg_context *context, const bench_shape *shape, const skg_view *view,
                        float *lengths) {
    library *self = bench_alloc(1, sizeof *self);
    skg_mesh *mesh = NULL;
    skg_material *water = NULL;
    skg_scene *scene = NULL;
    skg_spectrum *beam = NULL;
    bench_try(skg_mesh_create(context, "shape",
                              &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                 .vertices = shape->vertices,
                                                 .floats = shape->positions,
                                                 .triangles = shape->triangles,
                                                 .corners = shape->corners,
                                                 .unit_mm = 1},
                              &mesh),
              "mesh");
    bench_try(skg_material_create_mu("water", 0.18, &water), "material"); /* 1/cm, about 80 keV */
    bench_try(skg_scene_create(context, &scene), "scene");
    skg_part part;
    skg_part_init(&part);
    part.mesh = mesh, part.material = water;
    bench_try(skg_scene_part_add(scene, &part, NULL), "part");
    bench_try(skg_spectrum_create_mono(80, 1, &beam), "beam");
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.overlaps = 0;
    bench_try(skg_plan_create(context, scene, view, beam, &options, &self->plan), "plan");
    skg_frame_init(&self->frame);
    skg_output_init(&self->output);
    self->output.data = lengths;
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
    skg_material_release(&water);
    skg_mesh_release(&mesh);
    return self;
}

void library_frame(void *contender) {
    library *self = contender;
    skg_job *job = NULL;
    self->output.kind = SKG_OUTPUT_LENGTHS;
    self->output.lengths = SKG_LENGTHS_SURFACE;
    bench_try(skg_plan_submit(self->plan, 1, &self->frame, 1, &self->output, &job), "lengths");
    bench_try(skg_job_wait(&job), "lengths");
}

void library_free(library *self) {
    if (!self) return;
    skg_plan_release(&self->plan);
    free(self);
}
