/* Scenes that scatter, and their frames. */
#include "subject.h"

#include "suite.h"

void subject_open(subject *s) {
    *s = (subject){.kev = 60, .photons = 1e5};
    skg_view_init(&s->view);
    s->view.source[2] = -500;
    s->view.centre[2] = 200;
    s->view.columns = 40, s->view.rows = 30;
    s->view.column_step[0] = s->view.row_step[1] = 5;
    skg_plan_options_init(&s->options);
    skg_scatter_init(&s->scatter);
    skg_collimation_init(&s->jaws);
    s->scatter.histories = 4096;
    s->options.falloff = SKG_FALLOFF_ON;
    ck_skg(skg_scene_create(run_context, &s->scene));
}

void subject_close(subject *s) {
    skg_plan_release(&s->plan);
    skg_scene_release(&s->scene);
}

int64_t subject_add(subject *s, skg_mesh *mesh, const char *material, double x, double y, double z,
                    int64_t inside) {
    skg_part part;
    int64_t id = -1;
    char label[32];
    skg_part_init(&part);
    ck_skg(skg_scene_part_count(s->scene, &id));
    snprintf(label, sizeof label, "part %d", (int)id);
    part.mesh = mesh;
    part.label = label;
    part.inside = inside;
    part.pose[3] = x, part.pose[7] = y, part.pose[11] = z;
    ck_skg(skg_material_create_named(material, &part.material));
    ck_skg(skg_scene_part_add(s->scene, &part, &id));
    skg_material_release(&part.material);
    skg_mesh_release(&mesh);
    return id;
}

int64_t subject_add_box(subject *s, double x, double y, double z, const char *material) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_create_cuboid(x, y, z, &mesh));
    return subject_add(s, mesh, material, 0, 0, 0, -1);
}

void subject_fill(subject *s) {
    skg_mesh *bone = NULL;
    const int64_t around = subject_add_box(s, 80, 60, 40, "Water, Liquid");
    ck_skg(skg_mesh_create_cuboid(20, 10, 10, &bone));
    subject_add(s, bone, "Bone, Cortical (ICRU-44)", 10, 5, 0, around);
}

skg_status subject_try(subject *s) {
    skg_spectrum *beam = NULL;
    s->options.scatter = &s->scatter;
    s->options.collimation = s->jaws.kind == SKG_COLLIMATION_OPEN ? NULL : &s->jaws;
    skg_plan_release(&s->plan);
    ck_skg(skg_spectrum_create_mono(s->kev, s->photons, &beam));
    const skg_status status =
        skg_plan_create(run_context, s->scene, &s->view, s->beam ? s->beam : beam, &s->options, &s->plan);
    skg_spectrum_release(&beam);
    return status;
}

void subject_plan(subject *s) {
    ck_skg(subject_try(s));
}

pictures subject_pictures(subject *s, const skg_frame *frame) {
    pictures p = {.count = s->view.rows * s->view.columns};
    float **const to[] = {&p.image, &p.scatter, &p.sigma};
    static const int32_t kinds[] = {SKG_OUTPUT_IMAGE, SKG_OUTPUT_SCATTER, SKG_OUTPUT_SCATTER_SIGMA};
    skg_output outputs[3];
    skg_job *job = NULL;
    for (int k = 0; k < 3; k++) {
        skg_output_init(&outputs[k]);
        outputs[k].data = *to[k] = calloc((size_t)p.count, sizeof(float));
        outputs[k].kind = kinds[k];
    }
    ck_skg(skg_plan_submit(s->plan, 1, frame, 3, outputs, &job));
    ck_skg(skg_job_wait(&job));
    return p;
}

void pictures_free(pictures *p) {
    free(p->image);
    free(p->scatter);
    free(p->sigma);
    *p = (pictures){0};
}

double subject_sum(const subject *s, const float *image) {
    double sum = 0;
    for (int64_t i = 0; i < s->view.rows * s->view.columns; i++) sum += (double)image[i];
    return sum;
}

skg_scatter_report subject_report(const subject *s) {
    skg_scatter_report report;
    skg_scatter_report_init(&report);
    ck_skg(skg_plan_scatter_report_get(s->plan, &report));
    return report;
}
