/* Derivatives that are known in closed form: of pixels behind much, and of parts that touch. */
#include "gradient_closed.h"

#include "gradients.h"

#include <math.h>
#include <string.h>

/* A plan of one energy. */
static skg_plan *plan_of(const skg_view *view, int is_double, int32_t supersampling,
                         const skg_detector_blur *blur) {
    skg_plan_options options;
    skg_spectrum *beam = NULL;
    skg_plan *plan = NULL;
    skg_plan_options_init(&options);
    options.precision = is_double && run_has_double() ? SKG_PRECISION_DOUBLE : SKG_PRECISION_SINGLE;
    options.quantity = SKG_QUANTITY_ATTENUATION, options.overlaps = 0;
    options.supersampling = supersampling, options.blur = blur;
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(run_context, scene, view, beam, &options, &plan));
    skg_spectrum_release(&beam);
    return plan;
}

/* The derivative of the image by a twist of a part, and the gradient by it where the loss is the sum of the pixels that are chosen. */
static double find_both(skg_plan *plan, int64_t part, const double twist[6], const double *chosen,
                        double *found) {
    static double poses[PARTS][6], twists[PARTS][6];
    double sum = 0;
    skg_direction moving;
    skg_gradient gradient;
    const skg_adjoint given = adjoint_of(chosen);
    memset(twists, 0, sizeof twists);
    memcpy(twists[part], twist, sizeof twists[part]);
    skg_direction_init(&moving);
    moving.poses = twists[0];
    ck_skg(skg_plan_derivative(plan, NULL, &moving, found, NULL));
    skg_gradient_init(&gradient);
    gradient.poses = poses[0];
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
    for (int k = 0; k < 6; k++) sum += poses[part][k] * twist[k];
    return sum;
}

/* --- much matter */

typedef struct {
    const char *name;
    int32_t supersampling;
    int is_blurred, from; /* from: the first column of pixels behind the wedge */
} deep_case;

static const deep_case deep_cases[] = {
    {.name = "one sample", .supersampling = 1},
    {.name = "samples", .supersampling = 2},
    {.name = "a blur", .supersampling = 1, .is_blurred = 1},
    {.name = "a blur over the edge of the matter", .supersampling = 1, .is_blurred = 1, .from = SIDE / 2},
};

/* In a parallel beam along z, a wedge whose attenuation grows from 4 to 78, by 1 a mm of x. If it moves by a mm, the intensities of all rays
 * behind it grow by a factor of e, whatever a pixel's mean is of. */
START_TEST(deep_pixels_have_their_derivatives) {
    static const double line[3] = {0.25, 0.5, 0.25}, alone = 1, twist[6] = {1}, step = 3.2;
    static double chosen[PIXELS], found[PIXELS];
    const deep_case *c = &deep_cases[_i / 2];
    const int first = c->from ? c->from + 1 : 0;
    const double low = c->from ? -1 : -60; /* within the pixel before */
    skg_detector_blur blur;
    solid wedge = solid_box(1, 200, 1);
    skg_view view = run_view(SIDE, step);
    view.projection = SKG_PROJECTION_PARALLEL;
    for (int64_t v = 0; v < wedge.vertices; v++) {
        double *at = wedge.positions + 3 * v;
        at[0] = at[0] < 0 ? low : 40;
        at[2] = at[2] < 0 ? -1 : at[0] + 40;
    }
    skg_mesh *mesh = run_mesh(&wedge);
    ck_skg(skg_scene_create(run_context, &scene));
    run_part(scene, "wedge", mesh, 10, NULL, -1);
    skg_detector_blur_init(&blur);
    blur.columns = 3, blur.rows = 1, blur.along_row = line, blur.along_column = &alone;
    skg_plan *plan = plan_of(&view, _i % 2, c->supersampling, c->is_blurred ? &blur : NULL);
    for (int p = 0; p < PIXELS; p++) chosen[p] = p % SIDE >= first;
    const double sum = find_both(plan, 0, twist, chosen, found);
    /* Single: the attenuation that the image has is rounded, 2^-24 of 78. */
    const double bar = _i % 2 ? 1e-6 : 2e-5, right = -SIDE * (SIDE - first);
    ck_assert_msg(fabs(sum - right) <= bar * fabs(right), "%s: gradient %.9g, not %g", c->name, sum, right);
    for (int p = 0; p < PIXELS; p++)
        if (chosen[p] > 0)
            ck_assert_msg(fabs(found[p] + 1) <= bar, "%s, column %d: %.9g", c->name, p % SIDE, found[p]);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    skg_mesh_release(&mesh);
    solid_free(&wedge);
}
END_TEST

void add_closed_tests(TCase *tests) {
    tcase_add_loop_test(tests, deep_pixels_have_their_derivatives, 0,
                        2 * sizeof deep_cases / sizeof *deep_cases);
}
