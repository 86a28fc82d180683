/* No pixel wraps wherever the source is: on, at or inside faces, edges and corners, and at the end of a part; likewise the
 * detector. Each scene has another part in the beam, whose pixels have to stay right. */
#include "suite.h"
#include "support/faces.h"
#include "support/run.h"

#include <math.h>

static double worst_of(const face_scene *s, int32_t precision, uint64_t number) {
    static const char *const labels[FACE_PARTS] = {"part", "sphere", "around"};
    skg_scene *scene = NULL;
    ck_skg(skg_scene_create(run_context, &scene));
    for (int p = 0; p < FACE_PARTS; p++) {
        if (!(s->mu[p] > 0)) continue;
        skg_mesh *mesh = run_mesh(&s->parts[p]);
        run_part(scene, labels[p], mesh, s->mu[p], NULL, -1);
        skg_mesh_release(&mesh);
    }
    skg_plan *plan =
        run_plan(scene, &s->view, (run_choice){.precision = precision, .quantity = SKG_QUANTITY_ATTENUATION});
    double *image = run_image(plan, &s->view);
    const double worst = face_scene_judge(s, image, precision == SKG_PRECISION_DOUBLE, 24, number);
    free(image);
    skg_plan_release(&plan);
    skg_scene_release(&scene);
    return worst;
}

/* SKG_FACES=FIRST,COUNT: other scenes than these. */
START_TEST(no_place_of_the_source_wraps) {
    const char *wanted = getenv("SKG_FACES");
    unsigned long long first = 0, count = 300;
    double most = 0;
    if (wanted) ck_assert_int_eq(sscanf(wanted, "%llu,%llu", &first, &count), 2);
    for (unsigned long long number = first; number < first + count; number++) {
        face_scene s = face_scene_make(number);
        for (int32_t precision = 0; precision <= run_has_double(); precision++) {
            const double worst = worst_of(&s, precision, number);
            if (worst > 1) printf("%s, precision %d: %g bars\n", s.name, (int)precision, worst);
            most = fmax(most, worst);
        }
        face_scene_free(&s);
    }
    ck_assert_msg(most <= 1, "%g bars from the caster", most);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, no_place_of_the_source_wraps);
}

SKG_SUITE_MAIN("faces", add_tests)
