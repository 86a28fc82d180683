/* The table xcom.txt: natural cubic splines of ln(cross section) over ln E for each process. Photo absorption has a
 * spline of its own from each edge to the next. */
#include "spline.h"
#include "tables.h"

#include <math.h>
#include <string.h>

int first_knot[SKG_LAST_ELEMENT + 2];

typedef struct {
    int count;
    double energy[KNOTS_MAX], section[SKG_PROCESSES][KNOTS_MAX];
} element_table;

/* The spline of one process through the rows that rows[0..count) names. */
static void fit(const skg_knot *knots, int process, int count, const int *rows, skg_knot *out) {
    double x[KNOTS_MAX] = {0}, y[KNOTS_MAX] = {0}, second[KNOTS_MAX], scratch[KNOTS_MAX];
    for (int i = 0; i < count; i++) {
        x[i] = knots[rows[i]].log_energy;
        y[i] = knots[rows[i]].value[process];
    }
    (process == SKG_PHOTO ? skg_spline_piece : skg_spline_natural)(count, x, y, second, scratch);
    for (int i = 0; i < count; i++) out[rows[i]].second[process] = second[i];
}

/* Rayleigh and Compton scattering have no edges: the two rows of an edge are one point. */
static void fit_scattering(int process, int count, skg_knot *knots) {
    int rows[KNOTS_MAX] = {0}, points = 0;
    for (int i = 0; i < count; i++)
        if (i == 0 || knots[i].energy_kev > knots[i - 1].energy_kev) rows[points++] = i;
    fit(knots, process, points, rows, knots);
    for (int i = 1; i < count; i++)
        if (!(knots[i].energy_kev > knots[i - 1].energy_kev))
            knots[i].second[process] = knots[i - 1].second[process];
}

static void fit_photo(int count, skg_knot *knots) {
    int rows[KNOTS_MAX] = {0}, points = 0;
    for (int i = 0; i < count; i++) {
        rows[points++] = i;
        int edge = i + 1 < count && !(knots[i + 1].energy_kev > knots[i].energy_kev);
        if (edge || i + 1 == count) {
            fit(knots, SKG_PHOTO, points, rows, knots);
            points = 0;
        }
    }
}

/* Pair production begins at the threshold. The row below the first positive one continues the line of that one. */
static void fit_pairs(const element_table *e, skg_knot *knots) {
    int rows[KNOTS_MAX] = {0}, points = 0;
    for (int i = 0; i < e->count; i++) {
        double left = 1 - SKG_PAIR_THRESHOLD_KEV / e->energy[i];
        if (e->section[SKG_PAIR][i] <= 0) continue;
        knots[i].value[SKG_PAIR] = log(e->section[SKG_PAIR][i] / (left * left * left));
        rows[points++] = i;
    }
    fit(knots, SKG_PAIR, points, rows, knots);
    int first = rows[0];
    const skg_knot *a = &knots[first], *b = &knots[first + 1];
    double h = b->log_energy - a->log_energy;
    double slope = (b->value[SKG_PAIR] - a->value[SKG_PAIR]) / h - h / 6 * b->second[SKG_PAIR];
    knots[first - 1].value[SKG_PAIR] =
        a->value[SKG_PAIR] + slope * (knots[first - 1].log_energy - a->log_energy);
}

static void write_element(const table *t, const element_table *e, FILE *out) {
    static skg_knot knots[KNOTS_MAX];
    memset(knots, 0, sizeof knots);
    if (e->count < 2 || e->energy[0] > 1 || e->energy[e->count - 1] < 2e4)
        table_stop(t, "an element does not reach from 1 keV to 20 MeV");
    for (int i = 0; i < e->count; i++) {
        knots[i].energy_kev = e->energy[i];
        knots[i].log_energy = log(e->energy[i]);
        for (int p = 0; p < SKG_PAIR; p++) knots[i].value[p] = log(e->section[p][i]);
    }
    fit_scattering(SKG_RAYLEIGH, e->count, knots);
    fit_scattering(SKG_COMPTON, e->count, knots);
    fit_photo(e->count, knots);
    fit_pairs(e, knots);
    for (int i = 0; i < e->count; i++) {
        const skg_knot *k = &knots[i];
        fprintf(out, "{%.17g,%.17g,{%.17g,%.17g,%.17g,%.17g},{%.17g,%.17g,%.17g,%.17g}},\n", k->energy_kev,
                k->log_energy, k->value[0], k->value[1], k->value[2], k->value[3], k->second[0], k->second[1],
                k->second[2], k->second[3]);
    }
}

static void read_row(const table *t, element_table *e) {
    double row[5];
    char rest;
    if (sscanf(t->text, "%lf %lf %lf %lf %lf %c", &row[0], &row[1], &row[2], &row[3], &row[4], &rest) != 5)
        table_stop(t, "not an energy and four cross sections");
    int i = e->count;
    if (i == KNOTS_MAX) table_stop(t, "too many rows in one element");
    if (i > 0 && row[0] < e->energy[i - 1]) table_stop(t, "energies fall");
    if (i > 1 && !(row[0] > e->energy[i - 2])) table_stop(t, "one energy three times");
    if (!(row[0] > 0 && row[1] > 0 && row[2] > 0 && row[3] > 0 && row[4] >= 0))
        table_stop(t, "a cross section is not positive");
    e->energy[i] = row[0];
    for (int p = 0; p < SKG_PROCESSES; p++) e->section[p][i] = row[p + 1];
    e->count++;
}

void write_cross_sections(const char *folder, FILE *out) {
    static element_table e;
    table t;
    int z = 0, knots = 0;
    fprintf(out, "const skg_knot skg_knots[] = {\n");
    table_open(&t, folder, "xcom.txt");
    while (table_next(&t)) {
        int next;
        if (sscanf(t.text, "element %d", &next) != 1) {
            if (z == 0) table_stop(&t, "no element yet");
            read_row(&t, &e);
            continue;
        }
        if (next != z + 1) table_stop(&t, "elements have to follow each other");
        if (z > 0) write_element(&t, &e, out);
        knots += e.count;
        first_knot[next] = knots;
        e.count = 0;
        z = next;
    }
    if (z != SKG_LAST_ELEMENT) table_stop(&t, "elements are missing");
    write_element(&t, &e, out);
    first_knot[z + 1] = knots + e.count;
    fprintf(out, "};\n\n");
}
