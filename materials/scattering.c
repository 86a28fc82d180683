/* The table scattering.txt: natural cubic splines of ln F and ln S over ln x. */
#include "spline.h"
#include "tables.h"

#include <math.h>

typedef struct {
    int z, count;
    double log_momentum[SKG_MOMENTA], value[SKG_SCATTERINGS][SKG_MOMENTA];
} atom_table;

static void write_atom(const table *t, const atom_table *a, FILE *out) {
    double second[SKG_SCATTERINGS][SKG_MOMENTA], scratch[SKG_MOMENTA];
    if (a->count != SKG_MOMENTA) table_stop(t, "an element has another number of rows");
    for (int k = 0; k < SKG_SCATTERINGS; k++)
        skg_spline_natural(SKG_MOMENTA, a->log_momentum, a->value[k], second[k], scratch);
    fprintf(out, "{");
    for (int i = 0; i < SKG_MOMENTA; i++)
        fprintf(out, "{{%.8ef,%.8ef},{%.8ef,%.8ef}},\n", a->value[0][i], a->value[1][i], second[0][i],
                second[1][i]);
    fprintf(out, "},\n");
}

static void read_row(const table *t, atom_table *a) {
    /* xraylib gives five digits. */
    const double rounding = 1e-4;
    double x, f, s;
    char rest;
    const int i = a->count;
    if (sscanf(t->text, "%lf %lf %lf %c", &x, &f, &s, &rest) != 3)
        table_stop(t, "not a momentum transfer, F and S");
    if (i == SKG_MOMENTA) table_stop(t, "too many rows in one element");
    if (!(x > 0 && f > 0 && s > 0)) table_stop(t, "a number is not positive");
    if (f > a->z || s > a->z) table_stop(t, "F or S exceeds the number of electrons");
    if (a->z > 1 && a->log_momentum[i] != log(x))
        table_stop(t, "not the momentum transfer of the first element");
    if (i > 0 && !(log(x) > a->log_momentum[i - 1])) table_stop(t, "momentum transfers do not rise");
    if (i > 0 && (log(f) >= a->value[SKG_COHERENT][i - 1] || log(s) < a->value[SKG_INCOHERENT][i - 1]))
        table_stop(t, "F has to fall and S must not");
    if (i == SKG_MOMENTA - 1 && s < a->z * (1 - rounding)) table_stop(t, "the last S is not Z");
    a->log_momentum[i] = log(x);
    a->value[SKG_COHERENT][i] = log(f);
    a->value[SKG_INCOHERENT][i] = log(s);
    a->count++;
}

void write_scattering(const char *folder, FILE *out) {
    static atom_table a;
    table t;
    fprintf(
        out,
        "const skg_scattering_row skg_scattering_rows[SKG_LAST_ELEMENT + 1][SKG_MOMENTA] = {\n{{{0, 0}, {0, 0}}},\n");
    table_open(&t, folder, "scattering.txt");
    while (table_next(&t)) {
        int next;
        if (sscanf(t.text, "element %d", &next) != 1) {
            if (a.z == 0) table_stop(&t, "no element yet");
            read_row(&t, &a);
            continue;
        }
        if (next != a.z + 1 || next > SKG_LAST_ELEMENT) table_stop(&t, "elements have to follow each other");
        if (a.z > 0) write_atom(&t, &a, out);
        a.z = next;
        a.count = 0;
    }
    if (a.z != SKG_LAST_ELEMENT) table_stop(&t, "elements are missing");
    write_atom(&t, &a, out);
    fprintf(out, "};\n\nconst double skg_log_momenta[SKG_MOMENTA] = {\n");
    for (int i = 0; i < SKG_MOMENTA; i++) fprintf(out, "%.17g,\n", a.log_momentum[i]);
    fprintf(out, "};\n");
}
