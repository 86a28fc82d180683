/* Counts of the pixels of a counting detector for the charge of one photon: shares of clouds, thresholds, anti-coincidence. */
#include "beam/counter_pixels.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

/* kT/e at 300 K, V (CODATA 2018). */
static const double THERMAL_VOLT = 0.02585199;
/* Standard deviations beyond which a cloud, and a pulse's noise, are taken as ended: the rest is 6e-7. */
static const double END = 5;

/* Pixels that get charge in one history: a cloud of at most half a pixel ends within 6 along each direction. */
enum { CHARGED_MAX = 36 * SKG_DEPOSITS_MAX };
typedef struct {
    int column, row;
    double kev;
} pixel;
typedef struct {
    int count;
    pixel pixels[CHARGED_MAX];
} charge;

double skg_cloud_width(const skg_counting *c, double z) {
    const double drift = c->thickness_mm - z;
    const double grown = c->bias_v > 0 ? 2 * THERMAL_VOLT * drift * c->thickness_mm / c->bias_v : 0;
    return sqrt(c->cloud_mm * c->cloud_mm + grown);
}

enum { ACROSS_MAX = 8 };

/* The pixels that a cloud at x reaches along one direction, and its shares in them. Returns how many. */
static int share_out(double x, double pitch, double width, int *first, double shares[ACROSS_MAX]) {
    const int low = (int)floor((x - END * width) / pitch), high = (int)floor((x + END * width) / pitch);
    double before = 0;
    *first = low;
    for (int i = low; i <= high; i++) {
        const double below = i == high ? 1 : 0.5 * (1 + erf(((i + 1) * pitch - x) / (sqrt(2) * width)));
        shares[i - low] = below - before;
        before = below;
    }
    return high - low + 1;
}

static void add_charge(charge *all, int column, int row, double kev) {
    pixel *p = all->pixels;
    if (!(kev > 0)) return;
    for (; p < all->pixels + all->count; p++)
        if (p->column == column && p->row == row) {
            p->kev += kev;
            return;
        }
    *p = (pixel){column, row, kev};
    all->count++;
}

static void collect(const skg_counting *c, int count, const skg_deposit *deposits, charge *all) {
    all->count = 0;
    for (int d = 0; d < count; d++) {
        const double width = skg_cloud_width(c, deposits[d].z);
        double columns[ACROSS_MAX], rows[ACROSS_MAX];
        int column = 0, row = 0;
        const int across = share_out(deposits[d].x, c->pixel_mm[0], width, &column, columns);
        const int down = share_out(deposits[d].y, c->pixel_mm[1], width, &row, rows);
        for (int j = 0; j < down; j++)
            for (int i = 0; i < across; i++)
                add_charge(all, column + i, row + j, deposits[d].kev * columns[i] * rows[j]);
    }
}

/* The chances that a pulse falls into each window. Returns 0 if it falls into none. */
static int sort_pulse(const skg_counting *c, double kev, double noise, double *chances) {
    double above[SKG_THRESHOLDS_MAX + 1];
    if (kev < c->threshold_kev[0] - END * noise) return 0;
    for (int64_t t = 0; t < c->count; t++) {
        const double over = kev - c->threshold_kev[t];
        above[t] = fabs(over) < END * noise ? 0.5 * erfc(-over / (sqrt(2) * noise)) : over >= 0;
    }
    above[c->count] = 0;
    for (int64_t t = 0; t < c->count; t++) chances[t] = above[t] - above[t + 1];
    return 1;
}

double skg_pulse_noise(const skg_counting *c) {
    return c->electronic_kev * (c->anti_coincidence ? 2 : 1);
}

double skg_pulse_step(const skg_counting *c) {
    return (c->threshold_kev[c->count - 1] + END * skg_pulse_noise(c)) / SKG_PULSE_STEPS;
}

int32_t skg_pulse_first(const skg_counting *c) {
    const double first = floor((c->threshold_kev[0] - END * skg_pulse_noise(c)) / skg_pulse_step(c));
    return first > 1 ? (int32_t)first : 1;
}

/* A pixel that may count, with its pulse without noise, and with what chance in each window. */
typedef struct {
    int column, row;
    double kev;
    double chances[SKG_THRESHOLDS_MAX];
} hit;

static int list_pixels(const skg_counting *c, const charge *all, hit *hits) {
    int count = 0;
    for (const pixel *p = all->pixels; p < all->pixels + all->count; p++) {
        hits[count].column = p->column, hits[count].row = p->row, hits[count].kev = p->kev;
        count += sort_pulse(c, p->kev, c->electronic_kev, hits[count].chances);
    }
    return count;
}

/* The sum of the 2 x 2 pixels that begin at a row and a column. */
static double square_sum(const charge *all, int column, int row) {
    double sum = 0;
    for (const pixel *p = all->pixels; p < all->pixels + all->count; p++)
        if ((p->column == column || p->column == column + 1) && (p->row == row || p->row == row + 1))
            sum += p->kev;
    return sum;
}

/* Anti-coincidence (R. Ballabriga et al., Nuclear Instruments and Methods A 633 (2011) S15-S18): the pixel with most charge counts the
 * largest sum of 2 x 2 that it belongs to, and silences the eight around it; what is further away goes on by itself. */
static int list_sums(const skg_counting *c, charge *all, hit *hits) {
    int count = 0;
    for (;;) {
        const pixel *most = all->pixels, *end = all->pixels + all->count;
        for (const pixel *p = most; p < end; p++)
            if (p->kev > most->kev) most = p;
        if (most == end || !(most->kev > 0)) return count;
        const int column = most->column, row = most->row;
        double sum = 0;
        for (int corner = 0; corner < 4; corner++)
            sum = fmax(sum, square_sum(all, column - corner % 2, row - corner / 2));
        hits[count].column = column, hits[count].row = row, hits[count].kev = sum;
        count += sort_pulse(c, sum, skg_pulse_noise(c), hits[count].chances);
        for (pixel *p = all->pixels; p < end; p++)
            if (abs(p->column - column) < 2 && abs(p->row - row) < 2) p->kev = 0;
    }
}

/* The place in a table of an offset; what is beyond its reach counts at its border. */
static int place_of(int columns, int rows) {
    const int reach = SKG_COUNTING_REACH;
    const int column = columns < -reach ? -reach : columns > reach ? reach : columns;
    const int row = rows < -reach ? -reach : rows > reach ? reach : rows;
    return (row + reach) * SKG_COUNTING_SIDE + column + reach;
}

/* Adds a pulse to the two steps that it lies between, so that means are kept. Pulses above the last step lie above all thresholds,
 * alone and in sums. */
static void add_height(const skg_counting *c, const hit *pulse, double *heights) {
    const double steps = pulse->kev / skg_pulse_step(c);
    const int low = (int)floor(fmin(steps, SKG_PULSE_STEPS + 1));
    const double part = steps - low;
    for (int w = 0; w < (int)c->count; w++) {
        double *of_window = heights + (ptrdiff_t)w * SKG_PULSE_STEPS - 1;
        if (low >= 1 && low <= SKG_PULSE_STEPS) of_window[low] += (1 - part) * pulse->chances[w];
        if (low + 1 <= SKG_PULSE_STEPS) of_window[low + 1] += (low >= 1 ? part : 1) * pulse->chances[w];
    }
}

void skg_pixels_count(const skg_counting *counting, int count, const skg_deposit *deposits, double *counts,
                      double *heights) {
    enum { PIXELS = SKG_COUNTING_PIXELS };
    const int windows = (int)counting->count;
    double *spread = counts + windows, *pairs = spread + windows * PIXELS;
    charge all;
    hit hits[CHARGED_MAX];
    collect(counting, count, deposits, &all);
    const int found =
        counting->anti_coincidence ? list_sums(counting, &all, hits) : list_pixels(counting, &all, hits);
    for (const hit *a = hits; a < hits + found; a++) {
        if (heights) add_height(counting, a, heights);
        for (int w = 0; w < windows; w++) {
            const double chance = a->chances[w];
            counts[w] += chance;
            spread[w * PIXELS + place_of(a->column, a->row)] += chance;
            pairs[w * (windows + 1) * PIXELS + PIXELS / 2] += chance;
            for (const hit *b = hits; b < hits + found; b++) {
                const int place = place_of(b->column - a->column, b->row - a->row);
                for (int other = 0; b != a && other < windows; other++)
                    pairs[(w * windows + other) * PIXELS + place] += chance * b->chances[other];
            }
        }
    }
}
