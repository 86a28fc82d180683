/* The self-test of volumes: cells of different attenuation in a turned box, which boxes of a higher priority displace. */
#include "selftest/selftest.h"

#include <math.h>

/* Cells along the axes of the box. */
enum { ACROSS = 4, DOWN = 3, DEEP = 5, CELLS = ACROSS * DOWN * DEEP };
static const int counts[3] = {ACROSS, DOWN, DEEP};

/* 1/cm of a cell: whole numbers, so that cells are codes of 16 bits. */
static uint16_t attenuation_of(int cell) {
    return (uint16_t)(cell * 7 % 3);
}

static void split(int cell, int place[3]) {
    place[0] = cell % ACROSS, place[1] = cell / ACROSS % DOWN, place[2] = cell / ACROSS / DOWN;
}

/* A cell as a box. */
static skg_box box_of(const skg_box *whole, int cell) {
    skg_box box = *whole;
    int place[3];
    split(cell, place);
    for (int a = 0; a < 3; a++) {
        box.half[a] = whole->half[a] / counts[a];
        for (int k = 0; k < 3; k++)
            box.centre[k] += (2 * place[a] + 1 - counts[a]) * box.half[a] * whole->axes[3 * a + k];
    }
    return box;
}

skg_status skg_self_test_volume(const skg_box *box, skg_volume **volume) {
    uint16_t cells[CELLS];
    skg_volume_source source;
    const skg_box first = box_of(box, 0);
    for (int c = 0; c < CELLS; c++) cells[c] = attenuation_of(c);
    skg_volume_source_init(&source);
    source.values = SKG_VOLUME_MU, source.type = SKG_VOLUME_UINT16, source.cells = cells;
    source.columns = ACROSS, source.rows = DOWN, source.slices = DEEP;
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 3; a++) source.affine[4 * k + a] = 2 * first.half[a] * box->axes[3 * a + k];
        source.affine[4 * k + 3] = first.centre[k];
    }
    return skg_volume_create(&source, volume);
}

double skg_self_test_cells(const skg_self_test_scene *scene, const double *source, const double *pixel) {
    double sum = 0, enters, leaves, from, to;
    for (int c = 0; c < CELLS; c++) {
        const skg_box cell = box_of(&scene->boxes[SKG_SELF_TEST_BOXES], c);
        if (!skg_box_crossed(&cell, source, pixel, &enters, &leaves)) continue;
        double left = leaves - enters;
        for (int b = 0; b < SKG_SELF_TEST_BOXES; b++)
            if (skg_box_crossed(&scene->boxes[b], source, pixel, &from, &to))
                left -= fmax(0, fmin(leaves, to) - fmax(enters, from));
        sum += left * attenuation_of(c);
    }
    return sum;
}
