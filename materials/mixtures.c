/* The tables elements.txt, tissues.txt, compounds.txt, schneider.txt, k_lines.txt and l_lines.txt. */
#include "tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static char symbols[SKG_LAST_ELEMENT + 1][4];

/* The most rows of one file; compounds.txt has 170. */
enum { ROWS_MAX = 400 };

typedef struct {
    char names[256], source[256];
    double number; /* density, or lowest Hounsfield number */
    int first, count;
} mixture;

void write_elements(const char *folder, FILE *out) {
    table t;
    int last = 0;
    fprintf(out, "const skg_element_row skg_elements[] = {\n{0, 0, 0, 0, 0, 0},\n");
    table_open(&t, folder, "elements.txt");
    while (table_next(&t)) {
        int z;
        char names[64];
        double weight, density;
        if (last == SKG_LAST_ELEMENT) table_stop(&t, "too many elements");
        if (sscanf(t.text, "%d %3s %63s %lf %lf", &z, symbols[last + 1], names, &weight, &density) != 5 ||
            z != last + 1 || !(weight > 0 && density >= 0))
            table_stop(&t, "not the next element: number, symbol, name, weight, density");
        last = z;
        fprintf(out, "{\"%s\", \"%s\", %.17g, %.17g, %d, %d},\n", symbols[z], names, weight, density,
                first_knot[z], first_knot[z + 1]);
    }
    if (last != SKG_LAST_ELEMENT) table_stop(&t, "elements are missing");
    fprintf(out, "};\n\n");
}

/* The atomic number of a symbol. */
static int table_element(const table *t, const char *symbol) {
    for (int z = 1; z <= SKG_LAST_ELEMENT; z++)
        if (strcmp(symbols[z], symbol) == 0) return z;
    table_stop(t, "a symbol is not known");
}

/* Writes "H 0.1 O 0.9", whose numbers sum to `whole`, as fractions of 1. Returns their number. The sources round
 * fractions to four decimals or more, so the sum has to be right to 1e-4. */
static int write_fractions(const table *t, char *text, double whole, FILE *out) {
    int count = 0;
    double sum = 0;
    char *rest = NULL;
    for (char *word = strtok_r(text, " ", &rest); word; word = strtok_r(NULL, " ", &rest), count++) {
        char *value = strtok_r(NULL, " ", &rest);
        double fraction = value ? strtod(value, NULL) / whole : 0;
        if (!(fraction > 0)) table_stop(t, "a fraction is not positive");
        fprintf(out, "{%d, %.17g},\n", table_element(t, word), fraction);
        sum += fraction;
    }
    if (fabs(sum - 1) > 1e-4) table_stop(t, "the fractions do not sum to one");
    return count;
}

static void copy(const table *t, const char *from, size_t size, char *to) {
    if (strlen(from) >= size || strpbrk(from, "\"\\")) table_stop(t, "a text is too long or not plain");
    strcpy(to, from);
}

/* Reads the rows of one file, and writes their fractions. */
static int read_mixtures(const char *folder, const char *name, int *fractions, FILE *out, mixture *rows) {
    table t;
    char *fields[4];
    int count = 0;
    table_open(&t, folder, name);
    while (table_next(&t)) {
        if (count == ROWS_MAX) table_stop(&t, "too many rows");
        mixture *row = &rows[count++];
        table_fields(&t, 4, fields);
        copy(&t, fields[0], sizeof row->names, row->names);
        copy(&t, fields[3], sizeof row->source, row->source);
        row->number = strtod(fields[1], NULL);
        if (!(row->number > 0)) table_stop(&t, "the density is not positive");
        row->first = *fractions;
        row->count = write_fractions(&t, fields[2], 1, out);
        *fractions += row->count;
    }
    return count;
}

static int read_hounsfield(const char *folder, int *fractions, FILE *out, mixture *rows) {
    table t;
    char *fields[3];
    int count = 0;
    table_open(&t, folder, "schneider.txt");
    while (table_next(&t)) {
        mixture *row = &rows[count++];
        table_fields(&t, 3, fields);
        copy(&t, fields[1], sizeof row->names, row->names);
        row->number = strtod(fields[0], NULL);
        row->first = *fractions;
        row->count = write_fractions(&t, fields[2], 100, out);
        *fractions += row->count;
    }
    return count;
}

void write_mixtures(const char *folder, FILE *out) {
    static mixture rows[2 * ROWS_MAX], tissues[ROWS_MAX];
    int fractions = 0;
    fprintf(out, "const skg_mass_fraction skg_mass_fractions[] = {\n");
    int count = read_mixtures(folder, "tissues.txt", &fractions, out, rows);
    count += read_mixtures(folder, "compounds.txt", &fractions, out, rows + count);
    int tissue_count = read_hounsfield(folder, &fractions, out, tissues);
    fprintf(out, "};\n\nconst skg_mixture_row skg_mixtures[] = {\n");
    for (int i = 0; i < count; i++)
        fprintf(out, "{\"%s\", %.17g, %d, %d, \"%s\"},\n", rows[i].names, rows[i].number, rows[i].first,
                rows[i].count, rows[i].source);
    fprintf(out, "};\nconst int32_t skg_mixture_count = %d;\n\n", count);
    fprintf(out, "const skg_hounsfield_row skg_hounsfield_rows[] = {\n");
    for (int i = 0; i < tissue_count; i++)
        fprintf(out, "{%.17g, \"%s\", %d, %d},\n", tissues[i].number, tissues[i].names, tissues[i].first,
                tissues[i].count);
    fprintf(out, "};\nconst int32_t skg_hounsfield_count = %d;\n\n", tissue_count);
}

/* An array of shells. first: numbers in front of the lines: the edge, and the yield if there is one. */
static void write_shells(const char *folder, const char *file, const char *name, int first, int lines,
                         FILE *out) {
    table t;
    int count = 0;
    fprintf(out, "const skg_shell_row skg_%s_shells[] = {\n", name);
    table_open(&t, folder, file);
    while (table_next(&t)) {
        double v[2 + 2 * SKG_L_LINES];
        char *rest = t.text;
        long z = strtol(rest, &rest, 10);
        for (int k = 0; k < first + 2 * lines; k++) {
            char *end = rest;
            v[k] = strtod(rest, &end);
            if (end == rest) table_stop(&t, "numbers are missing");
            rest = end;
        }
        fprintf(out, "{%ld, %.17g, %.17g, {", z, v[0], first == 2 ? v[1] : 1.0);
        for (int k = 0; k < lines; k++) fprintf(out, "%.17g, ", v[first + 2 * k]);
        fprintf(out, "}, {");
        for (int k = 0; k < lines; k++) fprintf(out, "%.17g, ", v[first + 1 + 2 * k]);
        fprintf(out, "}},\n");
        count++;
    }
    fprintf(out, "};\nconst int32_t skg_%s_shell_count = %d;\n", name, count);
}

void write_all_shells(const char *folder, FILE *out) {
    write_shells(folder, "k_lines.txt", "k", 2, SKG_K_LINES, out);
    write_shells(folder, "l_lines.txt", "l", 1, SKG_L_LINES, out);
}
