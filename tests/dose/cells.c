/* Dose in volumes of cells, beside the same bodies as meshes. */
#include "dose/exposed.h"

#include <skiagraph/volume.h>

/* Water and aluminium in turn, 30 x 25 x 20 mm each. */
enum { SIDE = 2, CELLS = SIDE * SIDE * SIDE };
static const double edge[3] = {30, 25, 20};
static const char *const materials[2] = {"Water, Liquid", "Al"};
static const float densities[2] = {1, 2.6989F};

static int kind_of(int x, int y, int z) {
    return (x + y + z) % 2;
}

static double middle(int axis, int cell) {
    return ((double)cell - 0.5) * edge[axis];
}

static void add_meshes(subject *s) {
    skg_mesh *mesh = NULL;
    for (int c = 0; c < CELLS; c++) {
        const int x = c % SIDE, y = c / SIDE % SIDE, z = c / SIDE / SIDE;
        ck_skg(skg_mesh_create_cuboid(edge[0], edge[1], edge[2], &mesh));
        subject_add(s, mesh, materials[kind_of(x, y, z)], middle(0, x), middle(1, y), middle(2, z), -1);
    }
}

/* A volume whose columns go along z, and whose rows go against x. values: enum skg_volume_values */
static void add_cells(subject *s, int32_t values, int32_t interpolation) {
    float cells[CELLS];
    const double from[2] = {0, 2};
    skg_material *classes[2] = {NULL, NULL};
    skg_volume_source source;
    skg_part part;
    skg_volume_source_init(&source);
    skg_part_init(&part);
    for (int k = 0; k < 2; k++) ck_skg(skg_material_create_named(materials[k], &classes[k]));
    for (int c = 0; c < CELLS; c++)
        cells[c] = densities[kind_of(SIDE - 1 - c / SIDE % SIDE, c / SIDE / SIDE, c % SIDE)];
    source.values = values, source.type = SKG_VOLUME_FLOAT32, source.cells = cells;
    source.interpolation = interpolation;
    source.columns = source.rows = source.slices = SIDE;
    for (int k = 0; k < 12; k++) source.affine[k] = 0;
    source.affine[8] = edge[2], source.affine[1] = -edge[0], source.affine[6] = edge[1];
    source.affine[3] = middle(0, 1), source.affine[7] = middle(1, 0), source.affine[11] = middle(2, 0);
    if (values == SKG_VOLUME_DENSITY)
        source.class_count = 2, source.class_from = from, source.class_materials = classes;
    ck_skg(skg_volume_create(&source, &part.volume));
    part.label = "cells";
    ck_skg(skg_scene_part_add(s->scene, &part, NULL));
    skg_volume_release(&part.volume);
    for (int k = 0; k < 2; k++) skg_material_release(&classes[k]);
}

typedef struct {
    skg_dose_report report;
    skg_dose_part inner;
    double energy, mass, sigma, backscatter, backscatter_sigma;
} figures;

/* The first `count` parts together, and copper inside the one that is said. */
static figures figures_of(subject *s, int64_t count, int64_t inside) {
    const double place[3] = {7, 5, -20};
    skg_dose_options options = options_of(20000);
    skg_mesh *mesh = NULL;
    figures found = {0};
    double squares = 0;
    options.point_count = 1, options.points = place;
    if (inside >= 0) {
        ck_skg(skg_mesh_create_cuboid(10, 8, 6, &mesh));
        subject_add(s, mesh, "Cu", 16, 13, -9, inside);
    }
    skg_dose *dose = dose_of(s, &options);
    found.report = report_of(dose);
    for (int64_t p = 0; p < count; p++) {
        const skg_dose_part part = part_of(dose, p);
        found.energy += part.energy_kev, found.mass += part.mass_g;
        squares += pow(part.sigma_ugy / part.dose_ugy * part.energy_kev, 2);
    }
    if (inside >= 0) found.inner = part_of(dose, count);
    found.sigma = sqrt(squares);
    found.backscatter = point_of(dose, 0).backscatter;
    found.backscatter_sigma = point_of(dose, 0).backscatter_sigma;
    skg_dose_release(&dose);
    return found;
}

/* Alone, and around a part that displaces cells. */
START_TEST(cells_keep_what_meshes_do) {
    figures of[2];
    for (int k = 0; k < 2; k++) {
        subject s;
        subject_open(&s);
        if (k)
            add_cells(&s, SKG_VOLUME_DENSITY, SKG_VOLUME_CELLS);
        else
            add_meshes(&s);
        of[k] = figures_of(&s, k ? 1 : CELLS, _i ? (k ? 0 : 3) : -1);
        subject_close(&s);
    }
    printf("keV %.6g, of meshes %.6g +- %.2g; g %.8g, of meshes %.8g; backscatter %.5f, %.5f +- %.5f\n",
           of[1].energy, of[0].energy, of[0].sigma, of[1].mass, of[0].mass, of[1].backscatter,
           of[0].backscatter, of[0].backscatter_sigma);
    fflush(stdout); /* before an assertion ends the process */
    ck_assert_int_eq(of[0].report.followed, 1);
    ck_assert_int_eq(of[1].report.followed, 1);
    ck_assert_double_gt(of[1].sigma, 0);
    /* Four standard errors of both, and the same photons, but for roundings that send some elsewhere. */
    ck_assert_double_eq_tol(of[1].energy, of[0].energy, 4 * (of[0].sigma + of[1].sigma));
    ck_assert_double_eq_tol(of[1].energy / of[0].energy, 1, 3e-3);
    /* Tables of a curve at 1 g/cm3 are those of the material but for rounding to floats. */
    ck_assert_double_eq_tol(of[1].mass / of[0].mass, 1, 1e-6);
    ck_assert_double_eq_tol(of[1].backscatter, of[0].backscatter,
                            4 * (of[0].backscatter_sigma + of[1].backscatter_sigma));
    /* Four standard errors. */
    ck_assert_double_le(fabs(of[1].report.incident_kev - of[1].report.escaped_kev - of[1].energy -
                             (_i ? of[1].inner.energy_kev : 0)),
                        4 * of[1].report.balance_sigma_kev);
    if (!_i) return;
    /* Rounding; four standard errors. */
    ck_assert_double_eq_tol(of[1].inner.mass_g, of[0].inner.mass_g, 1e-9);
    ck_assert_double_eq_tol(of[1].inner.dose_ugy, of[0].inner.dose_ugy,
                            4 * (of[0].inner.sigma_ugy + of[1].inner.sigma_ugy));
}
END_TEST

/* Linear values weigh what the cells do; coefficients of attenuation do not say what stays. */
START_TEST(cells_are_followed_by_their_densities) {
    const double grams = 1e-3 * CELLS * edge[0] * edge[1] * edge[2] * (1 + 2.6989) / 2;
    for (int k = 0; k < 2; k++) {
        subject s;
        subject_open(&s);
        add_cells(&s, k ? SKG_VOLUME_MU : SKG_VOLUME_DENSITY, k ? SKG_VOLUME_CELLS : SKG_VOLUME_LINEAR);
        const figures found = figures_of(&s, 1, -1);
        ck_assert_int_eq(found.report.followed, !k);
        ck_assert(k ? isnan(found.energy) && isnan(found.mass)
                    : found.energy > 0 && fabs(found.mass / grams - 1) < 1e-6); /* float cells and hull */
        subject_close(&s);
    }
}
END_TEST

void add_cells_tests(TCase *tests) {
    tcase_add_loop_test(tests, cells_keep_what_meshes_do, 0, 2);
    tcase_add_test(tests, cells_are_followed_by_their_densities);
}
