/* Scatter of volumes of cells: what the same bodies scatter as meshes. */
#include "subject.h"
#include "suite.h"

#include <skiagraph/volume.h>

#include <float.h>
#include <math.h>

static const char *const NAMES[2] = {"Water, Liquid", "Bone, Cortical (ICRU-44)"};
static const double FROM[2] = {0, 1.25}; /* g/cm3 */

enum { SIDE_MM = 80 };

/* Cubes as cells, of water and from 1.25 g/cm3 on bone. */
typedef struct {
    int64_t count[3];      /* along x, y and z */
    double low[3], mm;     /* the lowest corner; the side of a cube */
    const uint16_t *cells; /* densities in units of `scale` */
    double scale;
    const double *pose; /* NULL: none */
    int64_t inside;
    int32_t priority, values;
} block;

static void add_block(subject *s, const char *label, const block *b) {
    const int64_t count = b->count[0] * b->count[1] * b->count[2];
    skg_volume_source source;
    skg_material *materials[2] = {NULL};
    skg_part part;
    double *numbers = calloc((size_t)count, sizeof *numbers);
    for (int64_t c = 0; c < count; c++) numbers[c] = b->scale * b->cells[c];
    skg_volume_source_init(&source);
    source.columns = b->count[0], source.rows = b->count[1], source.slices = b->count[2];
    source.cells = numbers, source.type = SKG_VOLUME_FLOAT64, source.values = b->values;
    for (int k = 0; k < 3; k++)
        source.affine[5 * k] = b->mm, source.affine[4 * k + 3] = b->low[k] + 0.5 * b->mm;
    for (int m = 0; m < 2; m++) ck_skg(skg_material_create_named(NAMES[m], &materials[m]));
    if (b->values == SKG_VOLUME_DENSITY)
        source.class_count = 2, source.class_from = FROM, source.class_materials = materials;
    skg_part_init(&part);
    ck_skg(skg_volume_create(&source, &part.volume));
    part.label = label, part.inside = b->inside, part.priority = b->priority;
    if (b->pose) memcpy(part.pose, b->pose, sizeof part.pose);
    ck_skg(skg_scene_part_add(s->scene, &part, NULL));
    skg_volume_release(&part.volume);
    for (int m = 0; m < 2; m++) skg_material_release(&materials[m]);
    free(numbers);
}

/* A cube of 80 mm of so many cells along each side. */
static block cube_of(int64_t side, const uint16_t *cells, double scale) {
    const double low = -SIDE_MM / 2.0;
    return (block){.count = {side, side, side},
                   .low = {low, low, low},
                   .mm = (double)SIDE_MM / (double)side,
                   .cells = cells,
                   .scale = scale,
                   .inside = -1,
                   .values = SKG_VOLUME_DENSITY};
}

static void add_volume(subject *s, const char *label, const double *pose, int64_t side, const uint16_t *cells,
                       int32_t values, double scale) {
    block b = cube_of(side, cells, scale);
    b.pose = pose, b.values = values;
    add_block(s, label, &b);
}

/* A mesh of a material at a density; releases the mesh. */
static void add_mesh(subject *s, skg_mesh *mesh, const char *material, double density, const double *pose,
                     const double at[3], int64_t inside, int32_t priority) {
    skg_material *nominal = NULL;
    skg_part part;
    char label[32];
    int64_t count = 0;
    ck_skg(skg_scene_part_count(s->scene, &count));
    snprintf(label, sizeof label, "part %d", (int)count);
    skg_part_init(&part);
    ck_skg(skg_material_create_named(material, &nominal));
    ck_skg(skg_material_create_at_density(nominal, density, &part.material));
    part.label = label, part.mesh = mesh, part.inside = inside, part.priority = priority;
    if (pose) memcpy(part.pose, pose, sizeof part.pose);
    for (int r = 0; r < 3; r++)
        for (int k = 0; k < 3; k++) part.pose[4 * r + 3] += part.pose[4 * r + k] * at[k];
    ck_skg(skg_scene_part_add(s->scene, &part, NULL));
    skg_mesh_release(&mesh);
    skg_material_release(&part.material);
    skg_material_release(&nominal);
}

static void add_box(subject *s, const double *pose, const double size[3], const double at[3],
                    double density) {
    skg_mesh *box = NULL;
    ck_skg(skg_mesh_create_cuboid(size[0], size[1], size[2], &box));
    add_mesh(s, box, NAMES[density >= FROM[1]], density, pose, at, -1, 0);
}

static void add_ball(subject *s, double radius, double density, double x, int64_t inside) {
    const double at[3] = {x, 0, 0};
    skg_mesh *ball = NULL;
    ck_skg(skg_mesh_create_sphere(radius, 48, &ball));
    add_mesh(s, ball, "Al", density, NULL, at, inside, inside < 0);
}

typedef struct {
    pictures of;
    skg_scatter_report report;
} found;

static found finish(subject *s) {
    found f;
    s->scatter.voxel_mm = 2.5; /* 32 along each side: an eighth of the work */
    subject_plan(s);
    f.of = subject_pictures(s, NULL);
    f.report = subject_report(s);
    subject_close(s);
    return f;
}

/* Both are as near to each other as their stated errors say, pixel by pixel in the root mean square, which is told. */
static void compare(found *cells, found *meshes, double most) {
    double off = 0, error = 0, sums[2] = {0};
    for (int64_t i = 0; i < cells->of.count; i++) {
        off += pow((double)cells->of.scatter[i] - (double)meshes->of.scatter[i], 2);
        error += pow((double)cells->of.sigma[i], 2) + pow((double)meshes->of.sigma[i], 2);
        sums[0] += (double)cells->of.scatter[i], sums[1] += (double)meshes->of.scatter[i];
    }
    off = sqrt(off / (double)cells->of.count), error = sqrt(error / (double)cells->of.count);
    const double mean = sums[1] / (double)cells->of.count;
    printf("sums differ by %.2g %%, pixels by %.2g %%, stated %.2g %% (systematic: %.2g and %.2g %%)\n",
           100 * fabs(sums[0] / sums[1] - 1), 100 * off / mean, 100 * error / mean,
           100 * cells->report.cells_error, 100 * meshes->report.cells_error);
    fflush(stdout); /* before an assertion ends the process */
    ck_assert_double_gt(mean, 0);
    ck_assert_double_le(off, most * error);
    pictures_free(&cells->of);
    pictures_free(&meshes->of);
}

static const double whole[3] = {SIDE_MM, SIDE_MM, SIDE_MM}, middle[3] = {0, 0, 0};
static const uint16_t one[1] = {1};
static const double tilted[16] = {0.8, 0, 0.6, 3, 0.36, 0.8, -0.48, 4, -0.48, 0.6, 0.64, -10, 0, 0, 0, 1};

/* The cells of a volume that fills the object are the object's: the same histories come back to the rounding of floats. */
START_TEST(a_cube_of_cells_scatters_as_a_mesh) {
    subject s;
    found f[2];
    for (int k = 0; k < 2; k++) {
        subject_open(&s);
        if (k == 0)
            add_volume(&s, "volume", _i ? tilted : NULL, 1, one, SKG_VOLUME_DENSITY, 1);
        else
            add_box(&s, _i ? tilted : NULL, whole, middle, 1);
        f[k] = finish(&s);
    }
    for (int64_t i = 0; i < f[0].of.count && !_i; i++)
        ck_assert_double_eq_tol((double)f[0].of.scatter[i], (double)f[1].of.scatter[i],
                                64 * (double)FLT_EPSILON * f[1].report.mean);
    compare(&f[0], &f[1], 0.1);
}
END_TEST

/* Cells that differ, as as many boxes; their planes are those of the object's cells, and then between them. */
START_TEST(cells_that_differ_scatter_as_boxes) {
    enum { SIDE = 4, CELLS = SIDE * SIDE * SIDE };
    static const int64_t sides[2] = {4, 3};
    const int64_t side = sides[_i];
    const double mm = (double)SIDE_MM / (double)side, size[3] = {mm, mm, mm};
    uint16_t cells[CELLS];
    subject s;
    found f[2];
    for (int c = 0; c < CELLS; c++) cells[c] = (uint16_t)(c * 7 % 5);
    subject_open(&s);
    add_volume(&s, "volume", NULL, side, cells, SKG_VOLUME_DENSITY, 0.5);
    f[0] = finish(&s);
    subject_open(&s);
    for (int64_t c = 0; c < side * side * side; c++) {
        const double at[3] = {((double)(c % side) + 0.5) * mm - SIDE_MM / 2.0,
                              ((double)(c / side % side) + 0.5) * mm - SIDE_MM / 2.0,
                              ((double)(c / side / side) + 0.5) * mm - SIDE_MM / 2.0};
        if (cells[c]) add_box(&s, NULL, size, at, 0.5 * cells[c]);
    }
    f[1] = finish(&s);
    compare(&f[0], &f[1], _i == 0 ? 0.1 : 0.4); /* cells that planes cross hold mixtures */
}
END_TEST

/* A ball of aluminium in water: within; across the face of the box, as a mesh of higher priority is; with another one in it, whose length
 * adds; and before a detector whose columns run the other way. */
START_TEST(meshes_displace_the_cells) {
    subject s;
    found f[2];
    for (int k = 0; k < 2; k++) {
        subject_open(&s);
        if (_i == 3) s.view.column_step[0] *= -1;
        if (k == 0)
            add_volume(&s, "volume", NULL, 1, one, SKG_VOLUME_DENSITY, 1);
        else
            add_box(&s, NULL, whole, middle, 1);
        add_ball(&s, 20, 2.7, _i == 1 ? 38 : 5, _i == 1 && k ? -1 : 0);
        if (_i == 2)
            add_ball(&s, 12, k == 0 ? 2.7 : 5.4, 5, k); /* the cells are cut out once, and the balls add */
        f[k] = finish(&s);
    }
    compare(&f[0], &f[1], _i == 1 ? 0.5 : 0.1); /* a mesh that competes is smeared over cells */
}
END_TEST

/* Two volumes that are the halves of one along an axis. */
static void add_halves(subject *s, const double *pose, int axis, int64_t side, const uint16_t *cells,
                       double scale) {
    enum { CELLS_MAX = 64 };
    uint16_t own[CELLS_MAX];
    for (int half = 0; half < 2; half++) {
        block b = cube_of(side, own, scale);
        int64_t from[3] = {0}, at = 0;
        from[axis] = half * (side / 2);
        b.count[axis] = side / 2;
        b.low[axis] += half * SIDE_MM / 2.0;
        b.pose = pose;
        for (int64_t z = 0; z < b.count[2]; z++)
            for (int64_t y = 0; y < b.count[1]; y++)
                for (int64_t x = 0; x < b.count[0]; x++)
                    own[at++] = cells[((from[2] + z) * side + from[1] + y) * side + from[0] + x];
        add_block(s, half ? "upper half" : "lower half", &b);
    }
}

/* Each cell of the object holds the same, but where the plane between the halves crosses one: there a face is met instead of a mean. */
START_TEST(halves_of_a_volume_scatter_as_the_whole) {
    enum { SIDE = 4, CELLS = SIDE * SIDE * SIDE };
    const double *const pose = _i / 3 ? tilted : NULL;
    uint16_t cells[CELLS];
    subject s;
    found f[2];
    for (int c = 0; c < CELLS; c++) cells[c] = (uint16_t)(c * 7 % 5);
    subject_open(&s);
    add_halves(&s, pose, _i % 3, SIDE, cells, 0.5);
    f[0] = finish(&s);
    subject_open(&s);
    add_volume(&s, "whole", pose, SIDE, cells, SKG_VOLUME_DENSITY, 0.5);
    f[1] = finish(&s);
    compare(&f[0], &f[1], 0.1);
}
END_TEST

START_TEST(halves_of_water_scatter_as_a_mesh) {
    const double *const pose = _i / 3 ? tilted : NULL;
    static const uint16_t ones[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    subject s;
    found f[2];
    subject_open(&s);
    add_halves(&s, pose, _i % 3, 2, ones, 1);
    f[0] = finish(&s);
    subject_open(&s);
    add_box(&s, pose, whole, middle, 1);
    f[1] = finish(&s);
    compare(&f[0], &f[1], 0.1); /* faces that cancel are met, or smeared over cells */
}
END_TEST

/* Water, and in a corner of it a block of bone, as volumes and as meshes: of one priority, so that both are there; of a higher one; of a
 * lower one, so that the block counts outside of the water only; within the water, with a ball of aluminium. */
START_TEST(volumes_that_overlap_scatter_as_meshes) {
    enum { ADD, OVER, UNDER, WITHIN };
    static const int32_t priority[] = {0, 1, -1, 0};
    static const double size[3] = {40, 40, 40}, corner[3] = {30, 10, 5}, inner[3] = {5, 10, 5};
    const double *at = _i == WITHIN ? inner : corner;
    subject s;
    found f[2];
    for (int k = 0; k < 2; k++) {
        const int64_t inside = _i == WITHIN ? 0 : -1;
        subject_open(&s);
        if (k == 0) {
            block b = cube_of(1, one, 1.5);
            for (int a = 0; a < 3; a++) b.low[a] = at[a] - size[a] / 2;
            b.mm = size[0], b.inside = inside, b.priority = priority[_i];
            add_volume(&s, "water", NULL, 1, one, SKG_VOLUME_DENSITY, 1);
            add_block(&s, "bone", &b);
        } else {
            skg_mesh *box = NULL;
            add_box(&s, NULL, whole, middle, 1);
            ck_skg(skg_mesh_create_cuboid(size[0], size[1], size[2], &box));
            add_mesh(&s, box, NAMES[1], 1.5, NULL, at, inside, priority[_i]);
        }
        if (_i == WITHIN) add_ball(&s, 12, 2.7, at[0], 1);
        f[k] = finish(&s);
    }
    compare(&f[0], &f[1], 0.1); /* parts that compete are smeared over the same cells */
}
END_TEST

START_TEST(what_does_not_scatter_is_refused) {
    subject s;
    subject_open(&s);
    add_volume(&s, "volume", NULL, 1, one, SKG_VOLUME_MU, 1);
    ck_skg_fails(subject_try(&s), SKG_ERR_UNSUPPORTED,
                 "attenuation coefficients, which do not say how it scatters");
    subject_close(&s);
    subject_open(&s);
    for (int k = 0; k < 5; k++)
        add_volume(&s, (const char *const[]){"a", "b", "c", "d", "e"}[k], NULL, 1, one, SKG_VOLUME_DENSITY,
                   1);
    ck_skg_fails(subject_try(&s), SKG_ERR_UNSUPPORTED,
                 "one of 5 volumes of cells, and photons are followed through 4");
    subject_close(&s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_loop_test(tests, a_cube_of_cells_scatters_as_a_mesh, 0, 2);
    tcase_add_loop_test(tests, cells_that_differ_scatter_as_boxes, 0, 2);
    tcase_add_loop_test(tests, meshes_displace_the_cells, 0, 4);
    tcase_add_loop_test(tests, halves_of_a_volume_scatter_as_the_whole, 0, 6);
    tcase_add_loop_test(tests, halves_of_water_scatter_as_a_mesh, 0, 6);
    tcase_add_loop_test(tests, volumes_that_overlap_scatter_as_meshes, 0, 4);
    tcase_add_test(tests, what_does_not_scatter_is_refused);
}

SKG_SUITE_MAIN("scatter/volume", add_tests)
