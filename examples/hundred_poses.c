/* One plan, a hundred poses of a part in batches of ten, images written into the caller's own array: the loop
 * of a registration.
 *
 *     cc hundred_poses.c $(pkg-config --cflags --libs skiagraph) -lm -o hundred_poses && ./hundred_poses */
#include <skiagraph/skiagraph.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIDE = 128, POSES = 100, BATCH = 10 };

static int failed(skg_status status) {
    if (status == SKG_OK) return 0;
    fprintf(stderr, "%s: %s\n", skg_status_name(status), skg_last_error());
    return SKG_FAILED(status) || status == SKG_STALE; /* after SKG_RANGE the image is there */
}

/* Turned about y by angle (radians), row by row. */
static void turned(double angle, double pose[16]) {
    const double c = cos(angle), s = sin(angle);
    const double rows[16] = {c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, 0, 0, 0, 1};
    memcpy(pose, rows, sizeof rows);
}

static int run(skg_plan *plan, int64_t part, float *images) {
    for (int first = 0; first < POSES; first += BATCH) {
        static double poses[BATCH][16];
        skg_frame frames[BATCH];
        for (int i = 0; i < BATCH; i++) {
            turned(3.14159265358979 / 2 * (first + i) / (POSES - 1), poses[i]);
            skg_frame_init(&frames[i]);
            frames[i].pose_count = 1;
            frames[i].pose_parts = &part;
            frames[i].poses = poses[i];
        }
        skg_output output;
        skg_output_init(&output);
        output.data = images + (size_t)first * SIDE * SIDE;
        skg_job *job = NULL;
        if (failed(skg_plan_submit(plan, BATCH, frames, 1, &output, &job)) || failed(skg_job_wait(&job)))
            return 1;
    }
    return 0;
}

int main(void) {
    static float images[POSES * SIDE * SIDE];
    skg_context *context = NULL;
    skg_mesh *bar = NULL;
    skg_material *bone = NULL;
    skg_scene *scene = NULL;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    int64_t part = -1;
    skg_view view;
    skg_view_init(&view);
    view.projection = SKG_PROJECTION_PARALLEL;
    view.columns = view.rows = SIDE;
    view.source[2] = -500;
    view.centre[2] = 100;
    view.column_step[0] = view.row_step[1] = 0.5;
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_ATTENUATION;
    skg_part one;
    skg_part_init(&one);
    int bad = failed(skg_context_create(NULL, &context)) ||
              failed(skg_mesh_create_cuboid(10, 10, 40, &bar)) ||
              failed(skg_material_create_mu("bone at 80 keV", 0.428, &bone)) ||
              failed(skg_scene_create(context, &scene));
    one.mesh = bar, one.material = bone, one.label = "bar";
    bad = bad || failed(skg_scene_part_add(scene, &one, &part)) ||
          failed(skg_spectrum_create_mono(80, 1, &beam)) ||
          failed(skg_plan_create(context, scene, &view, beam, &options, &plan)) || run(plan, part, images);
    if (!bad) {
        const int middle = SIDE / 2 * SIDE + SIDE / 2;
        const double first = (double)images[middle],
                     last = (double)images[(POSES - 1) * SIDE * SIDE + middle];
        printf("attenuation along the bar %.5f (4 cm), across it %.5f (1 cm)\n", first, last);
        bad = fabs(first - 4 * 0.428) > 1e-5 || fabs(last - 0.428) > 1e-5;
    }
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    skg_scene_release(&scene);
    skg_material_release(&bone);
    skg_mesh_release(&bar);
    skg_context_release(&context);
    return bad;
}
