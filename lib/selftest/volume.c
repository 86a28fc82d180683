/* The self-tests of volumes: cells of different attenuation in a turned box, constant or linear between their centres, which boxes of a
 * higher priority displace. */
#include "selftest/selftest.h"

#include <math.h>

/* Cells along the axes of the box. */
enum { ACROSS = 4, DOWN = 3, DEEP = 5, CELLS = ACROSS * DOWN * DEEP };
static const int counts[3] = {ACROSS, DOWN, DEEP};

/* 1/cm of a cell: whole numbers, so that cells are codes of 16 bits. */
static uint16_t attenuation_of(int cell) {
    return (uint16_t)(cell * 7 % 3);
}

/* Pieces of a cell along each axis: within one, the attenuation is one polynomial. */
static int pieces_of(const skg_self_test_scene *scene) {
    return scene->number == SKG_SELF_TEST_LINEAR ? 2 : 1;
}

static void split(int number, int pieces, int place[3]) {
    const int across = pieces * ACROSS, down = pieces * DOWN;
    place[0] = number % across, place[1] = number / across % down, place[2] = number / across / down;
}

/* A piece of a cell as a box. */
static skg_box box_of(const skg_box *whole, int number, int pieces) {
    skg_box box = *whole;
    int place[3];
    split(number, pieces, place);
    for (int a = 0; a < 3; a++) {
        box.half[a] = whole->half[a] / (pieces * counts[a]);
        for (int k = 0; k < 3; k++)
            box.centre[k] += (2 * place[a] + 1 - pieces * counts[a]) * box.half[a] * whole->axes[3 * a + k];
    }
    return box;
}

skg_status skg_self_test_volume(const skg_self_test_scene *scene, skg_volume **volume) {
    const skg_box *box = &scene->boxes[SKG_SELF_TEST_BOXES];
    uint16_t cells[CELLS];
    skg_volume_source source;
    const skg_box first = box_of(box, 0, 1);
    for (int c = 0; c < CELLS; c++) cells[c] = attenuation_of(c);
    skg_volume_source_init(&source);
    source.values = SKG_VOLUME_MU, source.type = SKG_VOLUME_UINT16, source.cells = cells;
    source.columns = ACROSS, source.rows = DOWN, source.slices = DEEP;
    if (scene->number == SKG_SELF_TEST_LINEAR) source.interpolation = SKG_VOLUME_LINEAR;
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 3; a++) source.affine[4 * k + a] = 2 * first.half[a] * box->axes[3 * a + k];
        source.affine[4 * k + 3] = first.centre[k];
    }
    return skg_volume_create(&source, volume);
}

/* The attenuation between the centres of the cells around a place; beyond the outer centres it is that of the nearest. */
static double linear_at(const skg_box *whole, const double place[3]) {
    int lower[3];
    double share[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        double along = 0;
        for (int k = 0; k < 3; k++) along += (place[k] - whole->centre[k]) * whole->axes[3 * a + k];
        const double last = counts[a] - 1;
        const double at = fmin(fmax((along / whole->half[a] + 1) * counts[a] / 2 - 0.5, 0), last);
        lower[a] = (int)fmin(at, last - 1), share[a] = at - lower[a];
    }
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1;
        int cell = 0;
        for (int a = 2; a >= 0; a--) {
            const int upper = corner >> a & 1;
            weight *= upper ? share[a] : 1 - share[a];
            cell = cell * counts[a] + lower[a] + upper;
        }
        sum += weight * attenuation_of(cell);
    }
    return sum;
}

/* A way through the volume of a test. */
typedef struct {
    const skg_self_test_scene *scene;
    const double *source, *pixel;
} volume_way;

/* The attenuation of a piece between two fractions of the way. Linear values are polynomials of degree 3 along it, for which Simpson's rule
 * is exact. */
static double integral(const volume_way *way, int number, double from, double to) {
    double sum = 0;
    if (!(to > from)) return 0;
    if (way->scene->number != SKG_SELF_TEST_LINEAR) return (to - from) * attenuation_of(number);
    for (int i = 0; i < 3; i++) {
        const double at = from + 0.5 * i * (to - from);
        double place[3];
        for (int k = 0; k < 3; k++) place[k] = way->source[k] + at * (way->pixel[k] - way->source[k]);
        sum += (i == 1 ? 4 : 1) * linear_at(&way->scene->boxes[SKG_SELF_TEST_BOXES], place);
    }
    return sum / 6 * (to - from);
}

double skg_self_test_cells(const skg_self_test_scene *scene, const double *source, const double *pixel) {
    const skg_box *whole = &scene->boxes[SKG_SELF_TEST_BOXES];
    const volume_way way = {scene, source, pixel};
    const int pieces = pieces_of(scene);
    double sum = 0, enters, leaves, from, to;
    if (!skg_box_crossed(whole, source, pixel, &enters, &leaves)) return 0;
    for (int c = 0; c < CELLS * pieces * pieces * pieces; c++) {
        const skg_box piece = box_of(whole, c, pieces);
        if (!skg_box_crossed(&piece, source, pixel, &enters, &leaves)) continue;
        sum += integral(&way, c, enters, leaves);
        for (int b = 0; b < SKG_SELF_TEST_BOXES; b++)
            if (skg_box_crossed(&scene->boxes[b], source, pixel, &from, &to))
                sum -= integral(&way, c, fmax(enters, from), fmin(leaves, to));
    }
    return sum;
}
