/* Sharing of counts between neighbouring pixels for a beam: kernels of the means, and kernels that give the noise the covariance of
 * counts. */
#include "beam/counter_kernels.h"
#include "core/eigen.h"
#include "core/maths.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIDE = SKG_COUNTING_SIDE,
    REACH = SKG_COUNTING_REACH,
    PIXELS = SKG_COUNTING_PIXELS,
    MIDDLE = PIXELS / 2
};
/* Frequencies along a side, from 0 to half a cycle a pixel. */
enum { FREQUENCIES = 17 };
/* Weights outside a smaller square that together are at most this are left out. */
static const double LEFT_OUT = 1e-3;

/* Sums over the beam. */
typedef struct {
    int32_t windows, reserved;
    double counts[SKG_THRESHOLDS_MAX];
    double spread[SKG_THRESHOLDS_MAX][PIXELS];
    double pairs[SKG_THRESHOLDS_MAX][SKG_THRESHOLDS_MAX][PIXELS];
    double heights[SKG_THRESHOLDS_MAX][SKG_PULSE_STEPS]; /* if pulses are moved */
} beam_sums;

static void add_up(const skg_counter *counter, const skg_counter_row *row, double photons, beam_sums *sums) {
    for (int32_t w = 0; w < sums->windows; w++) {
        sums->counts[w] += photons * row->counts[w];
        for (int k = 0; k < PIXELS; k++)
            sums->spread[w][k] += photons * skg_counter_spread(counter, row, w)[k];
        for (int32_t o = 0; o < sums->windows; o++)
            for (int k = 0; k < PIXELS; k++)
                sums->pairs[w][o][k] += photons * skg_counter_pairs(counter, row, w, o)[k];
        for (int j = 0; skg_counting_moves(&counter->counting) && j < SKG_PULSE_STEPS; j++)
            sums->heights[w][j] += photons * skg_counter_heights(counter, row, w)[j];
    }
}

static skg_status find_sums(skg_counter *counter, const skg_spectrum *spectrum, beam_sums *sums) {
    const skg_counter_row **rows = NULL;
    SKG_TRY(skg_alloc(spectrum->count, sizeof *rows, "counting detector", &rows));
    sums->windows = (int32_t)counter->counting.count;
    const skg_status status = skg_counter_rows_get(counter, spectrum->count, spectrum->energy_kev, rows);
    for (int64_t i = 0; status == SKG_OK && i < spectrum->count; i++)
        if (spectrum->photons[i] > 0) add_up(counter, rows[i], spectrum->photons[i], sums);
    skg_free(&rows);
    return status;
}

/* cos(2 pi f k) for frequency number f of FREQUENCIES. */
static double wave(int f, int k) {
    return cos(SKG_PI * f * k / (FREQUENCIES - 1));
}

/* The transform of a table that is even along both directions. */
static double transform(const double *table, int fx, int fy) {
    double sum = 0;
    for (int j = -REACH; j <= REACH; j++)
        for (int i = -REACH; i <= REACH; i++)
            sum += table[(j + REACH) * SIDE + i + REACH] * wave(fx, i) * wave(fy, j);
    return sum;
}

/* The covariance at a frequency, over the counts, becomes its symmetrical root. */
static void take_root(const beam_sums *sums, int fx, int fy, double *root) {
    const int n = sums->windows;
    double matrix[SKG_THRESHOLDS_MAX * SKG_THRESHOLDS_MAX], vectors[SKG_THRESHOLDS_MAX * SKG_THRESHOLDS_MAX];
    double values[SKG_THRESHOLDS_MAX];
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            const double scale = sqrt(sums->counts[a] * sums->counts[b]);
            const double both = transform(sums->pairs[a][b], fx, fy) + transform(sums->pairs[b][a], fx, fy);
            matrix[a * n + b] = scale > 0 ? both / (2 * scale) : a == b;
        }
    skg_eigen(n, matrix, values, vectors);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            root[a * n + b] = 0;
            for (int v = 0; v < n; v++)
                root[a * n + b] += sqrt(fmax(values[v], 0)) * vectors[v * n + a] * vectors[v * n + b];
        }
}

/* Adds the weights of one frequency: a mean over the frequencies of both signs. */
static void add_frequency(const beam_sums *sums, int fx, int fy, double *noise) {
    const int n = sums->windows, last = FREQUENCIES - 1;
    double root[SKG_THRESHOLDS_MAX * SKG_THRESHOLDS_MAX];
    const double times = (fx > 0 && fx < last ? 2 : 1) * (fy > 0 && fy < last ? 2 : 1);
    const double share = times / (4.0 * last * last);
    take_root(sums, fx, fy, root);
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            const double scale = sums->counts[b] > 0 ? sqrt(sums->counts[a] / sums->counts[b]) : a == b;
            for (int k = 0; k < PIXELS; k++)
                noise[(a * n + b) * PIXELS + k] +=
                    share * scale * root[a * n + b] * wave(fx, k % SIDE - REACH) * wave(fy, k / SIDE - REACH);
        }
}

/* The size of the weights outside a square, over those in it. */
static double outside(const double *table, int reach) {
    double in = 0, out = 0;
    for (int k = 0; k < PIXELS; k++) {
        const int far = abs(k % SIDE - REACH) > reach || abs(k / SIDE - REACH) > reach;
        *(far ? &out : &in) += fabs(table[k]);
    }
    return in > 0 ? out / in : 0;
}

/* The smallest square that all tables fit in. */
static int32_t find_reach(int64_t count, const double *tables) {
    int32_t reach = REACH;
    for (;;) {
        for (int64_t t = 0; reach > 0 && t < count; t++)
            if (outside(tables + t * PIXELS, reach - 1) > LEFT_OUT) return reach;
        if (reach == 0) return 0;
        reach--;
    }
}

/* Cuts a table to a smaller square. */
static void cut(const double *table, int reach, double *to) {
    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++) *to++ = table[(j + REACH) * SIDE + i + REACH];
}

/* Means keep their sum, and pixels their variance. */
static void scale_means(int size, double *means) {
    double sum = 0;
    for (int k = 0; k < size; k++) sum += means[k];
    for (int k = 0; k < size; k++) means[k] /= sum;
}

static void fill_heights(const skg_counting *counting, const beam_sums *sums, skg_counter_kernels *made) {
    double *heights = made->below + (ptrdiff_t)sums->windows * SKG_PULSE_STEPS;
    skg_pile_up_below(counting, made->below);
    for (int k = 0; k < sums->windows * SKG_PULSE_STEPS; k++) {
        const double counts = sums->counts[k / SKG_PULSE_STEPS];
        heights[k] = counts > 0 ? sums->heights[k / SKG_PULSE_STEPS][k % SKG_PULSE_STEPS] / counts : 0;
    }
}

static void fill(const beam_sums *sums, const double *wide, skg_counter_kernels *made) {
    const int n = sums->windows, size = (2 * made->reach + 1) * (2 * made->reach + 1);
    for (int t = 0; t < n; t++) {
        cut(wide + t * PIXELS, made->reach, made->means + t * size);
        scale_means(size, made->means + t * size);
    }
    for (int t = 0; t < n * n; t++) cut(wide + (n + t) * PIXELS, made->reach, made->noise + t * size);
}

skg_status skg_counter_kernels_make(skg_counter *counter, const skg_spectrum *spectrum,
                                    skg_counter_kernels *kernels) {
    beam_sums *sums = NULL;
    double *wide = NULL;
    const int64_t n = counter->counting.count, tables = n * (1 + n);
    skg_status status = SKG_OK;
    *kernels = (skg_counter_kernels){.windows = (int32_t)n};
    SKG_TRY_CLEANUP(skg_alloc(1, sizeof *sums, "counting detector", &sums));
    SKG_TRY_CLEANUP(skg_alloc(tables * PIXELS, sizeof *wide, "counting detector", &wide));
    SKG_TRY_CLEANUP(find_sums(counter, spectrum, sums));
    for (int w = 0; w < n; w++)
        if (sums->counts[w] > 0)
            memcpy(wide + w * PIXELS, sums->spread[w], sizeof sums->spread[w]);
        else
            wide[w * PIXELS + MIDDLE] = 1;
    for (int f = 0; f < FREQUENCIES * FREQUENCIES; f++)
        add_frequency(sums, f % FREQUENCIES, f / FREQUENCIES, wide + n * PIXELS);
    kernels->reach = find_reach(tables, wide);
    if (skg_counting_moves(&counter->counting)) kernels->first = skg_pulse_first(&counter->counting);
    const int64_t size = (2 * kernels->reach + 1) * (2 * kernels->reach + 1);
    SKG_TRY_CLEANUP(skg_alloc(skg_counter_kernels_size(kernels), sizeof *kernels->means, "counting detector",
                              &kernels->means));
    kernels->noise = kernels->means + n * size, kernels->below = kernels->means + tables * size;
    fill(sums, wide, kernels);
    if (kernels->first) fill_heights(&counter->counting, sums, kernels);
cleanup:
    skg_free(&wide);
    skg_free(&sums);
    if (status != SKG_OK) skg_counter_kernels_release(kernels);
    return status;
}

void skg_counter_kernels_release(skg_counter_kernels *kernels) {
    skg_free(&kernels->means);
    kernels->noise = kernels->below = NULL;
}
