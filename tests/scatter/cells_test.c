/* The object as cells: closed forms, and path lengths of images. */
#include "scatter/voxels.h"

#include "suite.h"
#include "support/run.h"

#include <float.h>
#include <math.h>

enum { SOLIDS = 3 };

typedef struct {
    int64_t count;
    solid of[SOLIDS];
    skg_solid solids[SOLIDS];
    int32_t sign[SOLIDS];
    double coefficients[SOLIDS][SKG_SCATTER_RANK]; /* less those of the solid around */
    const int32_t *priority;                       /* NULL: amounts add */
    int32_t clip;
} subject;

static void add(subject *s, solid of, const double coefficients[SKG_SCATTER_RANK]) {
    const int64_t i = s->count++;
    s->of[i] = of;
    s->solids[i] = (skg_solid){.vertices = of.vertices,
                               .triangles = of.triangles,
                               .positions = of.positions,
                               .corners = of.corners,
                               .inside = -1};
    s->sign[i] = 1;
    memcpy(s->coefficients[i], coefficients, sizeof s->coefficients[i]);
}

static skg_cells make(const subject *s, double voxel_mm) {
    skg_cells cells;
    const skg_cell_parts parts = {.count = s->count,
                                  .solids = s->solids,
                                  .sign = s->sign,
                                  .coefficients = (const double(*)[SKG_SCATTER_RANK])s->coefficients,
                                  .priority = s->priority,
                                  .clip = s->clip};
    ck_skg(skg_cells_make(&parts, voxel_mm, &cells));
    return cells;
}

static void drop(subject *s) {
    for (int64_t i = 0; i < s->count; i++) solid_free(&s->of[i]);
}

/* The integral of a coefficient over all cells. */
static double integral(const skg_cells *cells, int k) {
    const double cell = cells->size[0] * cells->size[1] * cells->size[2] /
                        (double)(cells->count[0] * cells->count[1] * cells->count[2]);
    double sum = 0;
    for (int64_t c = 0; c < cells->count[0] * cells->count[1] * cells->count[2]; c++)
        sum += (double)cells->mixtures[c][k] * cell;
    return sum;
}

/* Every coefficient, of all solids. error: relative */
static void compare_integrals(const subject *s, const skg_cells *cells, double error) {
    for (int k = 0; k < SKG_SCATTER_RANK; k++) {
        double exact = 0, size = 0;
        for (int64_t i = 0; i < s->count; i++) exact += s->coefficients[i][k] * solid_volume(&s->of[i]);
        for (int64_t i = 0; i < s->count; i++) size += fabs(s->coefficients[i][k]) * solid_volume(&s->of[i]);
        ck_assert_msg(fabs(integral(cells, k) - exact) <= error * size, "coefficient %d: %.9g, not %.9g", k,
                      integral(cells, k), exact);
    }
}

/* The cell that contains a place of the world. */
static const float *cell_at(const skg_cells *cells, double x, double y, double z) {
    const double at[3] = {x, y, z};
    int64_t index[3];
    for (int k = 0; k < 3; k++)
        index[k] = (int64_t)floor((at[k] - cells->low[k]) / cells->size[k] * (double)cells->count[k]);
    return cells->mixtures[(index[2] * cells->count[1] + index[1]) * cells->count[0] + index[0]];
}

static const double some[SKG_SCATTER_RANK] = {0.02, -0.7, 1, 0};

START_TEST(a_box_fills_its_cells) {
    subject s = {0};
    add(&s, solid_box(20, 30, 40), some);
    solid_shift(&s.of[0], 1.5, -7, 100);
    skg_cells cells = make(&s, 0);
    for (int k = 0; k < 3; k++) ck_assert_int_eq(cells.count[k], SKG_CELLS_DEFAULT);
    ck_assert_double_eq_tol(cells.low[2], 80, 64 * 100 * DBL_EPSILON);
    int wrong = 0; /* an assertion a cell would write a record each */
    for (int64_t c = 0; c < 64 * 64 * 64; c++)
        for (int k = 0; k < SKG_SCATTER_RANK; k++)
            wrong += fabs((double)cells.mixtures[c][k] - (double)some[k]) > (double)FLT_EPSILON;
    ck_assert_int_eq(wrong, 0);
    compare_integrals(&s, &cells, 1e-6); /* floats whose roundings are alike */
    for (int k = 0; k < SKG_SCATTER_RANK; k++) ck_assert_double_eq_tol(cells.mean[k], some[k], FLT_EPSILON);
    skg_cells_free(&cells);
    drop(&s);
}
END_TEST

START_TEST(an_inner_part_replaces_the_outer_one) {
    static const double less[SKG_SCATTER_RANK] = {-0.02, 0.7, -1,
                                                  2}; /* of the outer one's coefficients nothing is left */
    subject s = {0};
    add(&s, solid_box(30, 30, 30), some);
    add(&s, solid_box(10, 10, 10), less);
    skg_cells cells = make(&s, 0.5);
    for (int k = 0; k < 3; k++) ck_assert_int_eq(cells.count[k], 60);
    compare_integrals(&s, &cells, 1e-6); /* the faces lie between cells */
    for (int k = 0; k < SKG_SCATTER_RANK; k++) {
        const double inside = (double)cell_at(&cells, 4.9, -4.9, 4.9)[k];
        ck_assert_double_eq(inside, k == 3 ? 2 : 0);
        ck_assert_double_eq_tol((double)cell_at(&cells, 5.1, 0, 0)[k], some[k], FLT_EPSILON);
    }
    skg_cells_free(&cells);
    drop(&s);
}
END_TEST

START_TEST(a_sphere_has_its_volume_and_void_around) {
    subject s = {0};
    add(&s, solid_sphere(25, 96, 48), some);
    skg_cells cells = make(&s, 0);
    int wrong = 0;                       /* an assertion a cell would write a record each */
    compare_integrals(&s, &cells, 1e-3); /* 128 x 128 columns: their middles stand for the area around */
    for (int64_t z = 0; z < 64; z++)
        for (int64_t y = 0; y < 64; y++)
            for (int64_t x = 0; x < 64; x++) {
                const float *mixture = cells.mixtures[(z * 64 + y) * 64 + x];
                const double r =
                    25 / 32.0 *
                    sqrt(pow((double)x - 31.5, 2) + pow((double)y - 31.5, 2) + pow((double)z - 31.5, 2));
                const double corner = 25 / 32.0 * sqrt(0.75);
                for (int k = 0; k < SKG_SCATTER_RANK; k++) {
                    if (r > 25 + corner) wrong += (double)mixture[k] != 0;
                    /* The polyhedron lies .04 mm within the sphere at most. */
                    if (r < 25 - 0.04 - corner)
                        wrong += fabs((double)mixture[k] - (double)some[k]) > (double)FLT_EPSILON;
                }
            }
    ck_assert_int_eq(wrong, 0);
    skg_cells_free(&cells);
    drop(&s);
}
END_TEST

/* Void within a shell is exactly nothing, and so it is where an inner part takes all of the outer one away. */
START_TEST(void_is_nothing) {
    static const double all[SKG_SCATTER_RANK] = {1 / 3.0, 0.1, 0.7, 1e-3},
                        none[SKG_SCATTER_RANK] = {-1 / 3.0, -0.1, -0.7, -1e-3};
    for (int nested = 0; nested < 2; nested++) {
        subject s = {0};
        add(&s, nested ? solid_blob(30, 48, 24, 7) : solid_shell(30, 20, 48, 24), all);
        if (nested) add(&s, solid_sphere(20, 48, 24), none);
        skg_cells cells = make(&s, 0);
        int64_t empty = 0;
        for (int z = -9; z <= 9; z++)
            for (int y = -9; y <= 9; y++)
                for (int x = -9; x <= 9; x++, empty++)
                    for (int k = 0; k < SKG_SCATTER_RANK; k++)
                        ck_assert_double_eq((double)cell_at(&cells, x, y, z)[k], 0);
        ck_assert_int_eq(empty, 19 * 19 * 19);
        skg_cells_free(&cells);
        drop(&s);
    }
}
END_TEST

START_TEST(mirrored_parts_are_solid_too) {
    static const double mirror[12] = {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    subject s = {0}, m = {0};
    add(&s, solid_blob(20, 40, 20, 3), some);
    add(&m, solid_blob(20, 40, 20, 3), some);
    solid_move(&m.of[0], mirror);
    m.sign[0] = -1;
    skg_cells own = make(&s, 0), other = make(&m, 0);
    ck_assert_double_gt(integral(&own, 2), 0);
    /* Columns are not where those of the mirrored part are; each integral is right to 1e-3, see above. */
    for (int k = 0; k < 3; k++) ck_assert_double_eq_tol(integral(&other, k) / integral(&own, k), 1, 1e-3);
    for (int64_t x = -8; x <= 8; x++)
        for (int64_t z = -8; z <= 8; z++)
            ck_assert_mem_eq(cell_at(&own, (double)x, 0.1, (double)z),
                             cell_at(&other, -(double)x, 0.1, (double)z), sizeof(skg_mixture));
    skg_cells_free(&own);
    skg_cells_free(&other);
    drop(&s);
    drop(&m);
}
END_TEST

/* Two boxes that overlap from x = 0 to 10: with equal priorities both count there, else the higher one alone. A child inside
 * the lower one falls with it. */
START_TEST(priorities_decide_where_parts_overlap) {
    static const double a[SKG_SCATTER_RANK] = {1, 0, 0, 0}, b[SKG_SCATTER_RANK] = {0, 1, 0, 0};
    static const int32_t equal[] = {3, 3}, first[] = {4, 3}, second[] = {3, 4};
    subject s = {0};
    add(&s, solid_box(20, 20, 20), a); /* x from -10 to 10 */
    add(&s, solid_box(20, 20, 20), b);
    solid_shift(&s.of[1], 10, 0, 0); /* x from 0 to 20 */
    for (int n = 0; n < 3; n++) {
        s.priority = n == 0 ? equal : n == 1 ? first : second;
        skg_cells cells = make(&s, 0.5);
        const float *both = cell_at(&cells, 5, 1, 1), *left = cell_at(&cells, -5, 1, 1);
        ck_assert_double_eq((double)both[0], n != 2);
        ck_assert_double_eq((double)both[1], n != 1);
        ck_assert_double_eq((double)left[0], 1);
        ck_assert_double_eq((double)cell_at(&cells, 15, 1, 1)[1], 1);
        skg_cells_free(&cells);
    }
    s.solids[1].inside = 0; /* a child that leaves its parent */
    s.priority = equal;
    for (s.clip = 0; s.clip < 2; s.clip++) {
        skg_cells cells = make(&s, 0.5);
        ck_assert_double_eq((double)cell_at(&cells, 5, 1, 1)[1], 1);
        ck_assert_double_eq((double)cell_at(&cells, 15, 1, 1)[1], !s.clip);
        skg_cells_free(&cells);
    }
    drop(&s);
}
END_TEST

START_TEST(without_parts_there_are_no_cells) {
    skg_cells cells = {.count = {1, 1, 1}};
    const skg_cell_parts none = {0};
    ck_skg(skg_cells_make(&none, 0, &cells));
    ck_assert_ptr_null(cells.mixtures);
    ck_assert_int_eq(cells.count[0], 0);
    skg_cells_free(&cells);
}
END_TEST

/* Sums of cells along z are the path lengths of parallel rays where the columns are. */
START_TEST(columns_are_path_lengths_of_images) {
    enum { SIDE = 64 * SKG_CELL_COLUMNS };
    static const double one[SKG_SCATTER_RANK] = {1, 0, 0, 0};
    subject s = {0};
    add(&s, solid_blob(20, 60, 30, 5), one);
    skg_cells cells = make(&s, 0);
    skg_view view;
    skg_view_init(&view);
    view.projection = SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    view.source[2] = 1;
    view.columns = view.rows = SIDE;
    skg_columns grid = {.side = SIDE};
    for (int k = 0; k < 2; k++) {
        grid.low[k] = cells.low[k], grid.step[k] = cells.size[k] / SIDE;
        view.centre[k] = 0.5 * (skg_column_place(&grid, k, 0) + skg_column_place(&grid, k, SIDE - 1));
    }
    view.centre[2] = 100;
    view.column_step[0] = cells.size[0] / SIDE;
    view.row_step[1] = cells.size[1] / SIDE;
    double *lengths = run_solid(&s.of[0], NULL, &view, (run_choice){0}), worst = 0;
    for (int64_t y = 0; y < 64; y++)
        for (int64_t x = 0; x < 64; x++) {
            double sum = 0, expected = 0;
            for (int64_t z = 0; z < 64; z++)
                sum += (double)cells.mixtures[(z * 64 + y) * 64 + x][0] * cells.size[2] / 64;
            for (int64_t c = 0; c < SKG_CELL_COLUMNS * SKG_CELL_COLUMNS; c++)
                expected += lengths[(y * SKG_CELL_COLUMNS + c / SKG_CELL_COLUMNS) * SIDE +
                                    x * SKG_CELL_COLUMNS + c % SKG_CELL_COLUMNS];
            worst = fmax(worst, fabs(sum - expected / (SKG_CELL_COLUMNS * SKG_CELL_COLUMNS)));
        }
    /* The bar of docs/numerics.md for single precision: 3e-5 of the longest path of 40 mm, more at silhouettes. */
    ck_assert_double_le(worst, 10 * 3e-5 * 40);
    free(lengths);
    skg_cells_free(&cells);
    drop(&s);
}
END_TEST

/* The sum of coefficients times mm between places of the world, as photons read the cells. */
static void along(const skg_cells *cells, const double *from, const double *to, double mm[SKG_SCATTER_RANK]) {
    double ends[2][3];
    for (int k = 0; k < 3; k++) ends[0][k] = from[k] - cells->low[k], ends[1][k] = to[k] - cells->low[k];
    skg_cells_along(cells, ends[0], ends[1], mm);
}

static const double unit_mu[SKG_SCATTER_RANK] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};

static void trace_all(const subject *s, skg_cells *cells) {
    const skg_cell_parts parts = {.count = s->count,
                                  .solids = s->solids,
                                  .sign = s->sign,
                                  .coefficients = (const double(*)[SKG_SCATTER_RANK])s->coefficients};
    ck_skg(skg_cells_trace(&parts, unit_mu, 0, cells));
}

/* A foil of .05 mm and a box of a millimetre in a room of 2 m: photons meet their faces, in any direction, from within as from outside. */
START_TEST(thin_parts_in_a_room_have_their_lengths) {
    static const double dense[SKG_SCATTER_RANK] = {10, 0, 0, 0}, thin[SKG_SCATTER_RANK] = {0, 1, 0, 0};
    static const double turn[12] = {0.8, 0, 0.6, 100, 0, 1, 0, 0, -0.6, 0, 0.8, 30};
    subject s = {0};
    add(&s, solid_box(2000, 2000, 20), thin);
    add(&s, solid_box(300, 200, 0.05), dense);
    solid_move(&s.of[1], turn);
    solid_shift(&s.of[0], 0, 0, 900);
    skg_cells cells = make(&s, 0);
    trace_all(&s, &cells);
    ck_assert_int_eq(cells.smeared, 0);
    for (int i = 0; i < 200; i++) {
        /* Through a place of the foil, and on: from far away, and from a mm before it. */
        const double at[2] = {-140 + 280 * fmod(0.618 * i, 1), -90 + 180 * fmod(0.414 * i, 1)};
        const double way[3] = {0.3 * sin(i), 0.3 * cos(2 * i), 1};
        const double cosine = 0.6 * way[0] + 0.8 * way[2], far = i % 2 ? 1 : 800;
        double from[3], to[3], mm[SKG_SCATTER_RANK];
        for (int k = 0; k < 3; k++) {
            const double on = turn[4 * k] * at[0] + turn[4 * k + 1] * at[1] + turn[4 * k + 3];
            from[k] = on - far * way[k], to[k] = on + 700 * way[k];
        }
        const double length = sqrt(way[0] * way[0] + way[1] * way[1] + 1);
        along(&cells, from, to, mm);
        /* Faces are floats: 6e-5 mm in a metre, of a foil of .05 mm. */
        ck_assert_double_eq_tol(mm[0] / (10 * 0.05 * length / fabs(cosine)), 1, 5e-3);
        ck_assert_double_eq(mm[1], 0);
    }
    /* From the middle of the foil half of it is left. */
    const double from[3] = {100, 0, 30}, to[3] = {100 + 60, 0, 30 + 80};
    double mm[SKG_SCATTER_RANK];
    along(&cells, from, to, mm);
    /* Faces are floats, as above: 6e-5 mm in a metre, here of half the foil. */
    ck_assert_double_eq_tol(mm[0] / (10 * 0.025), 1, 5e-3);
    skg_cells_free(&cells);
    drop(&s);
}
END_TEST

/* Many faces in few cells: bricks. A sphere's chords, and what lies in it. */
START_TEST(many_faces_in_a_cell_make_a_brick) {
    static const double ball[SKG_SCATTER_RANK] = {1, 0, 0, 0}, inner[SKG_SCATTER_RANK] = {-1, 2, 0, 0},
                        far[SKG_SCATTER_RANK] = {0, 0, 1, 0};
    subject s = {0};
    add(&s, solid_sphere(6, 96, 48), ball);
    add(&s, solid_sphere(2, 96, 48), inner);
    skg_cells alone = make(&s, 0);
    trace_all(&s, &alone);
    solid box = solid_box(10, 10, 10);
    solid_shift(&box, 500, 600, 700);
    subject room = s;
    room.solids[room.count] = (skg_solid){.vertices = box.vertices,
                                          .triangles = box.triangles,
                                          .positions = box.positions,
                                          .corners = box.corners,
                                          .inside = -1};
    room.sign[room.count] = 1;
    memcpy(room.coefficients[room.count++], far, sizeof far);
    skg_cells cells = make(&room, 0);
    trace_all(&room, &cells);
    double most = 0;
    for (int i = 0; i < 500; i++) {
        const double from[3] = {-20, 12 * fmod(0.618 * i, 1) - 6, 12 * fmod(0.414 * i, 1) - 6};
        const double to[3] = {30, from[1] + 3 * sin(i), from[2] + 3 * cos(i)};
        double mm[SKG_SCATTER_RANK], own[SKG_SCATTER_RANK];
        along(&cells, from, to, mm);
        along(&alone, from, to, own);
        for (int k = 0; k < 2; k++) most = fmax(most, fabs(mm[k] - own[k]));
    }
    ck_assert_double_le(
        most, 1e-3); /* both are floats, one of them in a room of 700 mm: 6e-5 mm at slopes of up to 10 */
    /* Through the middle, where each way has the chord of the polyhedron. */
    const double from[3] = {-20, 0.01, 0.02}, to[3] = {20, 0.01, 0.02};
    double mm[SKG_SCATTER_RANK];
    along(&cells, from, to, mm);
    /* The chord of a polyhedron of this many faces is up to .01 mm below the diameter of its ball. */
    ck_assert_double_eq_tol(mm[0], 12 - 4, 0.02);
    /* Likewise, of twice the density */
    ck_assert_double_eq_tol(mm[1], 2 * 4, 0.02);
    skg_cells_free(&cells);
    skg_cells_free(&alone);
    solid_free(&box);
    drop(&s);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, a_box_fills_its_cells);
    tcase_add_test(tests, an_inner_part_replaces_the_outer_one);
    tcase_add_test(tests, a_sphere_has_its_volume_and_void_around);
    tcase_add_test(tests, void_is_nothing);
    tcase_add_test(tests, mirrored_parts_are_solid_too);
    tcase_add_test(tests, priorities_decide_where_parts_overlap);
    tcase_add_test(tests, thin_parts_in_a_room_have_their_lengths);
    tcase_add_test(tests, many_faces_in_a_cell_make_a_brick);
    tcase_add_test(tests, without_parts_there_are_no_cells);
    tcase_add_test(tests, columns_are_path_lengths_of_images);
}

SKG_SUITE_MAIN("scatter/cells", add_tests)
