/* A ball of water in a box of adipose tissue, seen from two sides: two scenes in one process, arrays of the
 * caller's.
 *
 *     cc first_image.c $(pkg-config --cflags --libs skiagraph) -o first_image && ./first_image */
#include <skiagraph/skiagraph.h>

#include <stdio.h>

enum { SIDE = 256 };

static int failed(skg_status status) {
    if (status == SKG_OK) return 0;
    fprintf(stderr, "%s: %s\n", skg_status_name(status), skg_last_error());
    return SKG_FAILED(status) || status == SKG_STALE; /* after SKG_RANGE the image is there */
}

/* A scene of its own: an envelope, and a ball inside it that displaces it. */
static int make_scene(skg_context *context, double radius_mm, skg_scene **scene) {
    skg_mesh *box = NULL, *ball = NULL;
    skg_material *adipose = NULL, *water = NULL;
    skg_part part;
    int64_t envelope = -1;
    int bad = failed(skg_mesh_create_cuboid(120, 120, 80, &box)) ||
              failed(skg_mesh_create_sphere(radius_mm, 64, &ball)) ||
              failed(skg_material_create_mu("adipose at 80 keV", 0.171, &adipose)) ||
              failed(skg_material_create_mu("water at 80 keV", 0.1837, &water)) ||
              failed(skg_scene_create(context, scene));
    if (!bad) {
        skg_part_init(&part);
        part.mesh = box, part.material = adipose, part.label = "envelope";
        bad = failed(skg_scene_part_add(*scene, &part, &envelope));
        skg_part_init(&part);
        part.mesh = ball, part.material = water, part.label = "ball", part.inside = envelope;
        bad = bad || failed(skg_scene_part_add(*scene, &part, NULL));
    }
    /* The scene has owners of its own now. */
    skg_mesh_release(&box);
    skg_mesh_release(&ball);
    skg_material_release(&adipose);
    skg_material_release(&water);
    return bad;
}

static int image_into(skg_context *context, skg_scene *scene, float *pixels) {
    skg_view view;
    skg_view_init(&view);
    view.columns = view.rows = SIDE;
    view.source[2] = -1000; /* mm */
    view.centre[2] = 200;
    view.column_step[0] = 0.6;
    view.row_step[1] = 0.6;
    skg_plan_options options;
    skg_plan_options_init(&options);
    options.quantity = SKG_QUANTITY_TRANSMISSION;
    skg_output output;
    skg_output_init(&output);
    output.data = pixels;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    int bad = failed(skg_spectrum_create_mono(80, 1000, &beam)) ||
              failed(skg_plan_create(context, scene, &view, beam, &options, &plan)) ||
              failed(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    return bad;
}

int main(void) {
    static float small[SIDE * SIDE], large[SIDE * SIDE];
    skg_context *context = NULL;
    skg_scene *first = NULL, *second = NULL;
    int bad = failed(skg_context_create(NULL, &context)) || make_scene(context, 20, &first) ||
              make_scene(context, 30, &second) || image_into(context, first, small) ||
              image_into(context, second, large);
    if (!bad) {
        const int middle = SIDE / 2 * SIDE + SIDE / 2;
        printf("transmission through the middle: %.6f with a ball of 20 mm, %.6f with one of 30 mm\n",
               (double)small[middle], (double)large[middle]);
        bad = !(large[middle] < small[middle] && large[middle] > 0);
    }
    skg_scene_release(&first);
    skg_scene_release(&second);
    skg_context_release(&context);
    return bad;
}
