/* The verb `material`: coefficients of a material. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/say.h"
#include "verbs/matter.h"
#include "verbs/plot.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { ROWS_MAX = 100000, GRID = 600 };

static const double usual_kev[] = {10, 15, 20, 30, 40, 50, 60, 80, 100, 150};

/* --- energies ------------------------------------------------------------------------------------------ */

/* Reads the low end, the high end and the step of --energy. Step 0: one energy. */
static int read_energies(const char *text, double numbers[3]) {
    const char *at = text;
    int count = 0;
    while (count < 3) {
        char *end = NULL;
        numbers[count] = strtod(at, &end);
        if (end == at || (*end && *end != ':') || !(numbers[count] > 0 && numbers[count] < HUGE_VAL)) break;
        count++;
        at = end;
        if (*end != ':') break;
        at = end + 1;
    }
    if (count == 0 || *at || at[-1] == ':' || (count > 1 && !(numbers[0] < numbers[1])))
        return cli_error(CLI_USAGE, "--energy %s is not KEV, LOW:HIGH or LOW:HIGH:STEP in keV", text);
    if (count == 1) numbers[1] = numbers[0], numbers[2] = 0;
    if (count == 2) numbers[2] = 1;
    if (count > 1 && (numbers[1] - numbers[0]) / numbers[2] >= ROWS_MAX)
        return cli_error(CLI_USAGE, "--energy %s: more than %d energies; make the step wider", text,
                         ROWS_MAX);
    return CLI_DONE;
}

static int make_rows(const char *text, cli_matter *m) {
    double n[3] = {0, 0, 0};
    m->count = sizeof usual_kev / sizeof *usual_kev;
    if (text) {
        int exit_status = read_energies(text, n);
        if (exit_status != CLI_DONE) return exit_status;
        m->count = n[2] > 0 ? (int64_t)((n[1] - n[0]) / n[2] * (1 + 1e-12) + 1e-9) + 1 : 1;
    }
    m->rows = calloc((size_t)m->count, sizeof *m->rows);
    if (!m->rows) return cli_error(CLI_DEVICE, "out of host memory");
    for (int64_t i = 0; i < m->count; i++)
        m->rows[i].kev = text ? fmin(n[0] + (double)i * n[2], n[1]) : usual_kev[i];
    m->low = m->rows[0].kev;
    m->high = text ? n[1] : m->rows[m->count - 1].kev;
    return CLI_DONE;
}

/* --- values --------------------------------------------------------------------------------------------- */

static skg_status fill_row(const cli_matter *m, cli_matter_row *r) {
    r->mu_rho = r->per_cm = r->hu = r->naive_per_cm = (double)NAN;
    for (int p = 0; p < CLI_PROCESSES; p++) r->process[p] = (double)NAN;
    skg_status status = SKG_OK;
    if (m->has_parts) {
        skg_coefficients c;
        skg_coefficients_init(&c);
        status = skg_material_coefficients_get(m->material, r->kev, &c);
        const double process[CLI_PROCESSES] = {c.rayleigh, c.compton, c.photo, c.pair};
        memcpy(r->process, process, sizeof process);
        r->mu_rho = c.total;
    }
    if (status == SKG_OK && m->has_per_cm)
        status = skg_material_attenuation_get(m->material, r->kev, &r->per_cm);
    if (status == SKG_OK && m->has_per_cm) status = skg_material_hounsfield_get(m->material, r->kev, &r->hu);
    if (status == SKG_OK && m->naive)
        status = skg_material_attenuation_get(m->naive, r->kev, &r->naive_per_cm);
    return status;
}

static skg_status find_matter(const char *name, double density, cli_matter *m) {
    int64_t parts = 0;
    skg_status status = skg_material_create_named(name, &m->material);
    if (status == SKG_OK && density > 0) {
        skg_material *tabled = m->material;
        m->material = NULL;
        status = skg_material_create_at_density(tabled, density, &m->material);
        skg_material_release(&tabled);
    }
    if (status == SKG_OK) status = skg_material_name_get(m->material, &m->name);
    if (status == SKG_OK) status = skg_material_note_get(m->material, &m->note);
    if (status == SKG_OK) status = skg_material_density_get(m->material, &m->density);
    if (status == SKG_OK) status = skg_material_element_count(m->material, &parts);
    m->has_parts = parts > 0;
    m->has_per_cm = m->density > 0 || !m->has_parts;
    return status;
}

static int find_naive(const cli_arguments *arguments, const char *name, cli_matter *m) {
    int32_t interpolation = -1;
    char *end = NULL;
    int exit_status = cli_choice(arguments, "--naive", &interpolation);
    if (exit_status != CLI_DONE || interpolation < 0) return exit_status;
    double hu = strncasecmp(name, "HU:", 3) == 0 ? strtod(name + 3, &end) : (double)NAN;
    if (!end || *end) return cli_error(CLI_USAGE, "--naive needs a Hounsfield number, such as HU:52");
    skg_status status = skg_material_create_naive_hounsfield(
        hu, interpolation == 0 ? SKG_INTERPOLATION_BILINEAR : SKG_INTERPOLATION_BILOGARITHMIC, &m->naive);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* --- plot ----------------------------------------------------------------------------------------------- */

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Energies for the plot: evenly spaced in their logarithms, and the two sides of every absorption edge. */
static double *plot_energies(const cli_matter *m, int64_t *count) {
    int64_t edge_count = 0;
    double *edges = cli_matter_edges(m, &edge_count);
    double *kev = calloc((size_t)(GRID + 2 * edge_count), sizeof *kev);
    *count = 0;
    for (int i = 0; kev && i < GRID; i++)
        kev[(*count)++] = fmin(m->low * pow(m->high / m->low, i / (GRID - 1.0)), m->high);
    for (int64_t i = 0; kev && i < edge_count; i++) {
        kev[(*count)++] = fmax(edges[i] * (1 - 1e-9), m->low);
        kev[(*count)++] = edges[i];
    }
    free(edges);
    if (kev) qsort(kev, (size_t)*count, sizeof *kev, ascending);
    return kev;
}

/* Values of mu/rho and of each process; of mu alone if only mu is known, or if mu is compared with --naive. */
static int fill_curves(const cli_matter *m, const double *kev, int64_t count, double *values) {
    int by_mass = m->has_parts && !m->naive;
    for (int64_t i = 0; i < count; i++) {
        cli_matter_row r = {.kev = kev[i]};
        skg_status status = fill_row(m, &r);
        if (status != SKG_OK) return cli_fail(status);
        values[i] = by_mass ? r.mu_rho : r.per_cm;
        values[count + i] = r.naive_per_cm;
        for (int p = 0; by_mass && p < CLI_PROCESSES; p++) values[(p + 1) * count + i] = r.process[p];
    }
    return CLI_DONE;
}

static int write_outputs(const cli_arguments *arguments, const cli_matter *m, int plots) {
    int64_t count = 0;
    int by_mass = m->has_parts && !m->naive, exit_status = CLI_DONE;
    double *kev = NULL, *values = NULL;
    char *csv = cli_matter_csv(m), title[256];
    cli_curve curves[CLI_PROCESSES + 1] = {{.name = by_mass ? "total" : m->name}};
    cli_plot plot = {.title = title, .x_label = "photon energy (keV)", .is_log = 1, .curves = curves};
    if (plots > 0) kev = plot_energies(m, &count);
    if (kev) values = calloc((size_t)count * (CLI_PROCESSES + 1), sizeof *values);
    if (!csv || (plots > 0 && !values)) exit_status = cli_error(CLI_DEVICE, "out of host memory");
    if (exit_status == CLI_DONE && plots > 0) exit_status = fill_curves(m, kev, count, values);
    if (exit_status == CLI_DONE) {
        if (m->density > 0)
            snprintf(title, sizeof title, "%s, %g g/cm3", m->name, m->density);
        else
            snprintf(title, sizeof title, "%s", m->name);
        plot.y_label = by_mass ? "mass attenuation coefficient (cm2/g)" : "attenuation coefficient (1/cm)";
        plot.count = by_mass ? CLI_PROCESSES + 1 : m->naive ? 2 : 1;
        for (int c = 0; plots > 0 && c < plot.count; c++)
            curves[c].x = kev, curves[c].y = values + c * count, curves[c].count = count;
        for (int p = 0; by_mass && p < CLI_PROCESSES; p++) curves[p + 1].name = cli_processes[p];
        if (m->naive) curves[0].name = "Schneider 2000", curves[1].name = "naive (Eq. 13)";
        if (by_mass && m->high <= 1022)
            plot.count--; /* no pair production below twice an electron's rest energy */
        exit_status = cli_write_plots(arguments, &plot, csv);
    }
    free(csv);
    free(kev);
    free(values);
    return exit_status;
}

/* --- verb ----------------------------------------------------------------------------------------------- */

static int list_names(int json) {
    int64_t count = 0;
    json_t *list = json ? json_array() : NULL;
    skg_material_tabled_count(&count);
    for (int64_t i = 0; i < count; i++) {
        const char *name;
        double density;
        if (skg_material_tabled_get(i, &name, &density) != SKG_OK) break;
        if (json) {
            json_t *object = json_object();
            json_object_set_new(object, "name", cli_json_text(name));
            json_object_set_new(object, "density_g_cm3", cli_json_number(density));
            json_array_append_new(list, object);
        } else {
            printf("%12.6g g/cm3  %s\n", density, name);
        }
    }
    if (!json) return CLI_DONE;
    json_t *object = json_object();
    json_object_set_new(object, "materials", list);
    return cli_json_print(object);
}

static int look_up(const cli_arguments *arguments, cli_matter *m) {
    const char *name = arguments->operands[0];
    double density = 0;
    int plots = 0;
    int exit_status = cli_number(arguments, "--density", 1e-9, 1e3, &density);
    if (exit_status == CLI_DONE) exit_status = cli_check_plots(arguments, &plots);
    if (exit_status == CLI_DONE) exit_status = make_rows(cli_value(arguments, "--energy"), m);
    if (exit_status == CLI_DONE && plots > 0 && !(m->low < m->high))
        exit_status = cli_error(CLI_USAGE, "a plot needs a range of energies: --energy 10:150");
    if (exit_status == CLI_DONE) exit_status = find_naive(arguments, name, m);
    if (exit_status != CLI_DONE) return exit_status;
    skg_status status = find_matter(name, density, m);
    for (int64_t i = 0; status == SKG_OK && i < m->count; i++) status = fill_row(m, &m->rows[i]);
    if (status != SKG_OK) return cli_fail(status);
    exit_status = write_outputs(arguments, m, plots);
    if (exit_status != CLI_DONE) return exit_status;
    if (cli_given(arguments, "--json")) return cli_json_print(cli_matter_json(m));
    if (!cli_is_quiet()) cli_matter_print(m);
    cli_report_plots(arguments);
    return CLI_DONE;
}

int cli_material(const cli_arguments *arguments) {
    cli_matter m = {.material = NULL};
    if (cli_given(arguments, "--list")) return list_names(cli_given(arguments, "--json"));
    if (arguments->operand_count == 0)
        return cli_error(CLI_USAGE, "material: no material is named; give a NAME, or --list");
    int exit_status = look_up(arguments, &m);
    skg_material_release(&m.material);
    skg_material_release(&m.naive);
    free(m.rows);
    return exit_status;
}
