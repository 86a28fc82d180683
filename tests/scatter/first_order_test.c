/* Photons that a small sphere scatters once, against quadrature of the cross sections over its volume. */
#include "material/scattering.h"
#include "subject.h"
#include "suite.h"
#include "sums.h"
#include "support/named.h"

#include <float.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

/* SIDE x SIDE places of PITCH mm at z = AWAY mm; the sphere is at the origin, the source at z = -FAR mm. */
enum { SIDE = 32, PLACES = SIDE * SIDE, ANGLES = 8192, SUBPOINTS = 4, DEPTHS = 10 };
static const double PITCH = 2, AWAY = 100, FAR = 500, KEV = 60;

/* Per sr and mm: cross sections of the material by the angle, even in its root; [0] Rayleigh, [1] Compton, the latter times the
 * share of energy that is left. */
typedef struct {
    skg_material *material;
    double per_angle[2][ANGLES + 1], attenuation[ANGLES + 1]; /* of the energy that is left, 1/mm */
} atoms;

static double per_mm(skg_material *material, double kev) {
    double per_cm = 0;
    ck_skg(skg_material_attenuation_get(material, kev, &per_cm));
    return per_cm / 10;
}

/* Ratio of F^2 of invented molecules to that of free atoms, by their order: little straight on, and more than 1 on a ring at .15/Angstrom. */
static double order_of(double x) {
    return 1 - exp(-pow(x / 0.08, 2)) + 2 * exp(-pow((x - 0.15) / 0.02, 2));
}

/* Water whose molecules are so. */
static skg_material *ordered_water(void) {
    enum { ROWS = 601 };
    skg_material *water = named("Water, Liquid"), *bound = NULL;
    static double x[ROWS], squares[ROWS];
    for (int i = 0; i < ROWS; i++) {
        double incoherent = 0;
        x[i] = 0.6 * i / (ROWS - 1);
        ck_skg(skg_scattering_free(water, x[i], &squares[i], &incoherent));
        squares[i] = fmax(squares[i] * order_of(x[i]), 1);
    }
    ck_skg(skg_material_create_form_factor(water, ROWS, x, squares, &bound));
    skg_material_release(&water);
    return bound;
}

static void tabulate(atoms *a, int ordered) {
    double sums[2] = {0};
    skg_coefficients c;
    skg_coefficients_init(&c);
    a->material = named("Water, Liquid");
    ck_skg(skg_material_coefficients_get(a->material, KEV, &c));
    const double density = per_mm(a->material, KEV) / c.total;
    for (int i = 0; i <= ANGLES; i++) {
        const double root = (double)i / ANGLES, theta = PI * root * root, width = 2 * PI * root / ANGLES;
        const double x = KEV / SKG_HC_KEV_ANGSTROM * sin(theta / 2), sphere = 2 * PI * sin(theta) * width;
        const double left = KEV / (1 + KEV / SKG_ELECTRON_KEV * (1 - cos(theta)));
        double coherent = 0, incoherent = 0;
        ck_skg(skg_scattering_free(a->material, x, &coherent, &incoherent));
        if (ordered) coherent *= order_of(x);
        a->per_angle[0][i] = (1 + cos(theta) * cos(theta)) / 2 * coherent;
        /* Klein and Nishina 1929 */
        a->per_angle[1][i] =
            left / KEV * (left / KEV) * (left / KEV + KEV / left - sin(theta) * sin(theta)) / 2 * incoherent;
        for (int k = 0; k < 2; k++) sums[k] += sphere * a->per_angle[k][i];
        a->per_angle[1][i] *= left / KEV;
        a->attenuation[i] = per_mm(a->material, left);
    }
    for (int i = 0; i <= ANGLES; i++) {
        a->per_angle[0][i] *= density * c.rayleigh / sums[0];
        a->per_angle[1][i] *= density * c.compton / sums[1];
    }
}

static double read_angle(const double *table, double theta) {
    const double place = sqrt(theta / PI) * ANGLES;
    const int i = place < ANGLES - 1 ? (int)place : ANGLES - 1;
    return table[i] + (place - i) * (table[i + 1] - table[i]);
}

/* mm from a point in a sphere along a direction to its surface. */
static double way_out(double radius, const double at[3], const double way[3]) {
    double along = 0, square = 0;
    for (int k = 0; k < 3; k++) along += at[k] * way[k], square += at[k] * at[k];
    return -along + sqrt(along * along + radius * radius - square);
}

/* Adds what scatters at a point of the sphere to a point of the detector. amount: photons per sr from the source, times mm3 and mm2
 * of the detector. */
static void add_ray(const atoms *a, double radius, const double at[3], const double to[3], double amount,
                    double sums[2]) {
    double in[3] = {at[0], at[1], at[2] + FAR}, out[3], back[3], r = 0, d = 0, cosine = 0;
    for (int k = 0; k < 3; k++) out[k] = to[k] - at[k], r += in[k] * in[k], d += out[k] * out[k];
    r = sqrt(r), d = sqrt(d);
    for (int k = 0; k < 3; k++) in[k] /= r, out[k] /= d, back[k] = -in[k], cosine += in[k] * out[k];
    const double theta = acos(fmin(fmax(cosine, -1), 1)), mu = a->attenuation[0];
    const double arrives = amount / (r * r) * out[2] / (d * d) * exp(-mu * way_out(radius, at, back));
    const double leaves = way_out(radius, at, out);
    sums[0] += KEV * arrives * read_angle(a->per_angle[0], theta) * exp(-mu * leaves);
    sums[1] +=
        KEV * arrives * read_angle(a->per_angle[1], theta) * exp(-read_angle(a->attenuation, theta) * leaves);
}

/* keV in each place, by kind. x0: of the detector's middle */
static void integrate(const atoms *a, double radius, double photons_per_sr, double x0, double (*kev)[2]) {
    double points[DEPTHS * DEPTHS * DEPTHS][3];
    int count = 0;
    for (int i = 0; i < DEPTHS * DEPTHS * DEPTHS; i++) {
        const int index[3] = {i % DEPTHS, i / DEPTHS % DEPTHS, i / DEPTHS / DEPTHS};
        double square = 0;
        for (int k = 0; k < 3; k++) {
            points[count][k] = radius * (2 * (index[k] + 0.5) / DEPTHS - 1);
            square += points[count][k] * points[count][k];
        }
        count += square < radius * radius;
    }
    const double piece = PITCH / SUBPOINTS, each = 4 * PI / 3 * pow(radius, 3) / count * piece * piece;
    for (int64_t p = 0; p < PLACES; p++) {
        kev[p][0] = kev[p][1] = 0;
        for (int s = 0; s < SUBPOINTS * SUBPOINTS; s++) {
            const double to[3] = {
                x0 + ((double)(p % SIDE) - SIDE / 2.0) * PITCH + (s % SUBPOINTS + 0.5) * piece,
                ((double)(p / SIDE) - SIDE / 2.0) * PITCH + (s / SUBPOINTS + 0.5) * piece, AWAY};
            for (int i = 0; i < count; i++) add_ray(a, radius, points[i], to, photons_per_sr * each, kev[p]);
        }
    }
}

/* A sphere of 2 mm in a narrow beam, as polyhedron. Returns the radius of a sphere of the same volume. */
static double prepare(subject *s, double x0, int64_t histories, skg_material *material) {
    solid ball = solid_sphere(1, 96, 48);
    const double radius = cbrt(solid_volume(&ball) * 3 / (4 * PI));
    subject_open(s);
    skg_part part;
    skg_part_init(&part);
    part.mesh = run_mesh(&ball), part.material = material;
    ck_skg(skg_scene_part_add(s->scene, &part, NULL));
    skg_mesh_release(&part.mesh);
    skg_material_release(&material);
    s->kev = KEV;
    s->view.source[2] = -FAR;
    s->view.centre[0] = x0, s->view.centre[2] = AWAY;
    s->view.columns = s->view.rows = SIDE;
    s->view.column_step[0] = s->view.row_step[1] = PITCH;
    s->jaws.kind = SKG_COLLIMATION_RECTANGLE;
    s->jaws.distance_mm = FAR;
    for (int k = 0; k < 2; k++) {
        const double aside = k ? 0 : x0 * FAR / (FAR + AWAY);
        s->jaws.low[k] = -aside - 1.05, s->jaws.high[k] = -aside + 1.05;
    }
    s->scatter.histories = histories;
    solid_free(&ball);
    return radius;
}

/* Sums by place of the kinds of order 1, of one batch, or of all if batch is -1. */
static double sum_of(const int64_t *sums, int64_t batch, int plane, int64_t place) {
    double sum = 0;
    for (int64_t b = batch < 0 ? 0 : batch; b < (batch < 0 ? SUMS_BATCHES : batch + 1); b++)
        sum += (double)sums[(b * SUMS_PLANES + plane) * PLACES + place];
    return sum;
}

/* The worst (result - expected) of blocks of 8 x 8 places, over the standard error of the batches and 1e-3 of what is expected, for
 * cells and tables. */
static double worst_block(const int64_t *sums, int plane, double unit, const double (*expected)[2],
                          int kind) {
    enum { BLOCK = 8, ROW = SIDE / BLOCK, BLOCKS = ROW * ROW };
    double found[BLOCKS][SUMS_BATCHES] = {{0}}, exact[BLOCKS] = {0}, worst = 0;
    for (int64_t p = 0; p < PLACES; p++) {
        const int64_t block = p / SIDE / BLOCK * ROW + p % SIDE / BLOCK;
        exact[block] += expected[p][kind];
        for (int64_t b = 0; b < SUMS_BATCHES; b++)
            found[block][b] += sum_of(sums, b, plane, p) * unit * SUMS_BATCHES;
    }
    for (int i = 0; i < BLOCKS; i++) {
        double mean = 0, variance = pow(1e-3 * exact[i], 2);
        for (int b = 0; b < SUMS_BATCHES; b++) mean += found[i][b] / SUMS_BATCHES;
        for (int b = 0; b < SUMS_BATCHES; b++)
            variance += pow(found[i][b] - mean, 2) / (SUMS_BATCHES * (SUMS_BATCHES - 1.0));
        worst = fmax(worst, fabs(mean - exact[i]) / sqrt(variance));
    }
    return worst;
}

/* Compares what a detector around x0 receives, in total and by places. */
static void compare(double x0, int64_t histories, double error, int ordered) {
    static double expected[PLACES][2];
    static int64_t sums[SUMS_BATCHES * SUMS_PLANES * PLACES];
    static const int planes[2] = {0, 3};
    subject s;
    atoms a;
    const double radius = prepare(&s, x0, histories, ordered ? ordered_water() : named("Water, Liquid"));
    tabulate(&a, ordered);
    integrate(&a, radius, s.photons * pow(FAR + AWAY, 2) / (PITCH * PITCH), x0, expected);
    subject_plan(&s);
    pictures p = subject_pictures(&s, NULL);
    ck_skg(sums_read(run_context, s.plan, sums));
    double all = 0, order[2] = {0}, exact[2] = {0};
    for (int plane = 0; plane < SUMS_KINDS; plane++)
        for (int64_t i = 0; i < PLACES; i++) all += sum_of(sums, -1, plane, i);
    const double unit = subject_sum(&s, p.scatter) / all;
    for (int k = 0; k < 2; k++) {
        for (int64_t i = 0; i < PLACES; i++)
            order[k] += unit * sum_of(sums, -1, planes[k], i), exact[k] += expected[i][k];
        const double worst = worst_block(sums, planes[k], unit, (const double(*)[2])expected, k);
        printf("detector at %g mm, %s: %.5f of the quadrature, worst block %.2f sigma\n", x0,
               k ? "Compton" : "Rayleigh", order[k] / exact[k], worst);
        fflush(stdout); /* before an assertion ends the process */
        ck_assert_msg(fabs(order[k] / exact[k] - 1) <= error, "at %g mm, kind %d: %g, not %g", x0, k,
                      order[k], exact[k]);
        /* The worst of 64 normal errors is 2.5; few photons bring much, so that 32 batches may show too small a spread. */
        ck_assert_double_le(worst, 5);
    }
    pictures_free(&p);
    skg_material_release(&a.material);
    subject_close(&s);
}

/* 1e-2 is several times the error of so many histories and of 64 x 64 x 64 cells of a sphere. */
START_TEST(a_small_sphere_scatters_forward) {
    compare(0, 1 << 17, 1e-2, 0);
}
END_TEST

START_TEST(a_small_sphere_scatters_aside) {
    compare(120, 1 << 17, 1e-2, 0);
}
END_TEST

/* Likewise with form factors of molecules; photons of .15/Angstrom arrive 7 mm beside those that go straight on. */
START_TEST(molecules_scatter_as_their_form_factors_say) {
    compare(0, 1 << 17, 1e-2, 1);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, run_open, run_close);
    tcase_add_test(tests, a_small_sphere_scatters_forward);
    tcase_add_test(tests, a_small_sphere_scatters_aside);
    tcase_add_test(tests, molecules_scatter_as_their_form_factors_say);
}

SKG_SUITE_MAIN("scatter/first_order", add_tests)
