/* Gradients by attenuation coefficients at the energies of a plan, against differences in double precision. The materials are tables
 * that have the energies of the beam among theirs. */
#include "gradients.h"
#include "support/doubles.h"

#include <skiagraph/material.h>
#include <skiagraph/report.h>

#include <math.h>

enum { ENERGIES = 3 };

static const setting settings[] = {
    {.name = "one energy"},
    {.name = "attenuation of one energy", .quantity = SKG_QUANTITY_ATTENUATION, .nested = 1},
    {.name = "energies", .colours = 1, .nested = 1},
    {.name = "attenuation", .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1, .nested = 1},
    {.name = "attenuation, blur", .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1, .blur = 1},
    {.name = "transmission, priority", .quantity = SKG_QUANTITY_TRANSMISSION, .colours = 1, .priority = 1},
    {.name = "attenuation, bands", .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1, .bands = 2},
    {.name = "parallel", .parallel = 1, .colours = 1},
    {.name = "supersampling, falloff", .colours = 1, .supersampling = 2, .falloff = 1},
    {.name = "attenuation, spot", .quantity = SKG_QUANTITY_ATTENUATION, .colours = 1, .spot = 1},
    {.name = "world", .world = 1, .colours = 1},
};

/* 1/cm of a part at an energy */
static double mu_of(int64_t part, int energy) {
    return 0.12 * (double)(1 + part) / (1 + 0.4 * energy);
}

/* Gives every part its table, with one coefficient larger by a step. */
static void set_materials(int64_t part, int energy, double step) {
    const double kev[ENERGIES + 2] = {30, 40, 60, 90, 120};
    for (int64_t p = 0; p < parts; p++) {
        double per_cm[ENERGIES + 2] = {mu_of(p, 0), 0, 0, 0, mu_of(p, ENERGIES - 1)};
        skg_material *material = NULL;
        for (int e = 0; e < ENERGIES; e++)
            per_cm[e + 1] = mu_of(p, e) + (p == part && e == energy ? step : 0);
        ck_skg(skg_material_create_table("table", ENERGIES + 2, kev, per_cm, &material));
        ck_skg(skg_scene_part_material_set(scene, p, material));
        skg_material_release(&material);
    }
}

static void make_image(const setting *set, const skg_view *view, double *image) {
    skg_output output;
    skg_plan *plan = make_plan(set, view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64, output.data = image;
    ck_skg(skg_plan_image(plan, &output));
    skg_plan_release(&plan);
}

/* The sum over values of the adjoint times the derivative of the image by one coefficient; the image is smooth in it. */
static double slope_of(const setting *set, const skg_view *view, int64_t part, int energy, int64_t count,
                       const double *adjoint, double *size) {
    static double ahead[CHANNELS_MAX * PIXELS], behind[CHANNELS_MAX * PIXELS];
    double slopes[2] = {0, 0};
    *size = 0;
    for (int s = 0; s < 2; s++) {
        const double step = s ? 5e-3 : 1e-2;
        set_materials(part, energy, step);
        make_image(set, view, ahead);
        set_materials(part, energy, -step);
        make_image(set, view, behind);
        for (int64_t p = 0; p < count; p++) {
            const double slope = adjoint[p] * (ahead[p] - behind[p]) / (2 * step);
            slopes[s] += slope;
            *size += s ? fabs(slope) : 0;
        }
    }
    set_materials(-1, 0, 0);
    return (4 * slopes[1] - slopes[0]) / 3;
}

static void make_mu_gradient(skg_plan *plan, const setting *set, const double *adjoint, double *found,
                             double *densities) {
    skg_gradient gradient;
    skg_adjoint given = adjoint_of(adjoint);
    skg_gradient_init(&gradient);
    given.channels = set->bands ? set->bands : 1;
    gradient.attenuations = found, gradient.densities = densities;
    ck_skg(skg_plan_node_count(plan, &gradient.nodes));
    ck_skg(skg_plan_gradient(plan, NULL, &given, &gradient));
}

/* Along the direction of one coefficient the image changes so that its sum with the adjoint is the gradient; both go the same way
 * through the same lengths, forward and back. */
static void check_direction(skg_plan *plan, const double *adjoint, int64_t count, int64_t number,
                            double gradient, double size) {
    static double derivative[CHANNELS_MAX * PIXELS];
    double changes[PARTS * ENERGIES] = {0}, sum = 0;
    skg_direction along_one;
    skg_direction_init(&along_one);
    changes[number] = 1;
    along_one.attenuations = changes;
    ck_skg(skg_plan_node_count(plan, &along_one.nodes));
    ck_skg(skg_plan_derivatives(plan, NULL, 1, &along_one, DOUBLES(derivative), NULL));
    for (int64_t p = 0; p < count; p++) sum += adjoint[p] * derivative[p];
    /* Sums in double, in another order. */
    ck_assert_msg(fabs(sum - gradient) <= 1e-9 * size, "coefficient %d: %.12g, gradient %.12g", (int)number,
                  sum, gradient);
}

START_TEST(coefficients_are_those_of_differences) {
    const setting *set = &settings[_i];
    static double adjoint[CHANNELS_MAX * PIXELS];
    double found[PARTS * ENERGIES], again[PARTS * ENERGIES], densities[PARTS];
    const int64_t count = (set->bands ? set->bands : 1) * PIXELS, energies = set->colours ? ENERGIES : 1;
    int64_t nodes = 0;
    result r;
    if (!run_has_double()) return;
    make_scene(set);
    allocate(&r);
    set_materials(-1, 0, 0);
    fill_adjoint(count, adjoint);
    const skg_view view = make_view(set);
    skg_plan *plan = make_plan(set, &view, SKG_PRECISION_DOUBLE, SKG_STRATEGY_AUTO);
    ck_skg(skg_plan_node_count(plan, &nodes));
    ck_assert_int_eq(nodes, energies);
    make_mu_gradient(plan, set, adjoint, found, densities);
    make_mu_gradient(plan, set, adjoint, again, NULL);
    for (int64_t p = 0; p < parts; p++) {
        double sum = 0, size = 0, of_all = 0;
        for (int e = 0; e < energies; e++) {
            const double *of_node = &found[p * energies + e];
            const double expected = slope_of(set, &view, p, e, count, adjoint, &size);
            ck_assert(*of_node == again[p * energies + e]); /* whatever else is wanted */
            /* The tables' coefficients and logarithms in double, and h^4 of Richardson's step */
            ck_assert_msg(fabs(*of_node - expected) <= 1e-6 * size,
                          "%s, part %d, energy %d: %.12g, not %.12g of %.3g", set->name, (int)p, e, *of_node,
                          expected, size);
            ck_assert_double_gt(size, 0);
            check_direction(plan, adjoint, count, p * energies + e, *of_node, size);
            sum += mu_of(p, e) * *of_node;
            of_all += mu_of(p, e) * size;
        }
        /* A density scales the coefficients of all energies: the same sums in another order */
        ck_assert_msg(fabs(sum - densities[p]) <= 1e-9 * of_all, "%s, part %d: %.12g, density %.12g",
                      set->name, (int)p, sum, densities[p]);
    }
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* Ratios in a world divide by the flat field of every ray, which the weights of a single energy do not have. */
START_TEST(ratios_in_a_world_are_refused) {
    static double adjoint[PIXELS];
    double found[PARTS * ENERGIES];
    const setting set = {.world = 1, .colours = 1, .quantity = SKG_QUANTITY_TRANSMISSION};
    skg_gradient gradient;
    const skg_adjoint given = adjoint_of(adjoint);
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    skg_gradient_init(&gradient);
    gradient.attenuations = found, gradient.nodes = ENERGIES;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &given, &gradient), SKG_ERR_UNSUPPORTED,
                 "under attenuation coefficients, has no gradient; make the plan of energies or photons");
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

/* A plan that finds out in the call that materials were changed may then have other energies than the memory is for. */
START_TEST(memory_for_other_energies_is_refused) {
    static double adjoint[PIXELS];
    double found[PARTS * ENERGIES];
    const setting set = {.colours = 1};
    skg_gradient gradient;
    const skg_adjoint given = adjoint_of(adjoint);
    result r;
    make_scene(&set);
    allocate(&r);
    const skg_view view = make_view(&set);
    skg_plan *plan = make_plan(&set, &view, SKG_PRECISION_SINGLE, SKG_STRATEGY_AUTO);
    skg_gradient_init(&gradient);
    gradient.attenuations = found, gradient.nodes = ENERGIES - 1;
    ck_skg_fails(skg_plan_gradient(plan, NULL, &given, &gradient), SKG_ERR_ARGUMENT,
                 "the attenuations have memory for 2 energies, and the plan has 3; set `nodes`");
    skg_plan_release(&plan);
    release(&r);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, coefficients_are_those_of_differences, 0, sizeof settings / sizeof *settings);
    tcase_add_test(tests, ratios_in_a_world_are_refused);
    tcase_add_test(tests, memory_for_other_energies_is_refused);
}

SKG_SUITE_MAIN("gradient_mu", add_tests)
