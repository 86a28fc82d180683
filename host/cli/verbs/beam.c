/* The verb `beam`: a spectrum, its mean energy, layers and kerma. */
#include "verbs/verbs.h"

#include "common/encode.h"
#include "common/say.h"
#include "common/values.h"
#include "verbs/plot.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FILTERS_MAX = 32 };

static const char *const authors[] = {"Ebel", "Birch and Marshall"}; /* by SKG_TUBE_MODEL_ */

typedef struct {
    skg_filter filters[FILTERS_MAX];
    skg_material *materials[FILTERS_MAX];
    int64_t filter_count;
    skg_tube tube;
    skg_spectrum *spectrum; /* of the given load and distance, or of the file */
    skg_quality quality;    /* of the spectrum */
    double per_mas;         /* factor from the spectrum's photons to those of 1 mAs at 1 m; NaN for a file */
    const char *file;
} beam;

/* --- flags ---------------------------------------------------------------------------------------------- */

static int read_filter(const char *text, beam *b) {
    char name[256];
    double mm = 0;
    int exit_status = cli_read_filter(text, name, sizeof name, &mm);
    if (exit_status != CLI_DONE) return exit_status;
    if (b->filter_count == FILTERS_MAX)
        return cli_error(CLI_USAGE, "--filter: more than %d filters", FILTERS_MAX);
    skg_material **material = &b->materials[b->filter_count];
    skg_status status = skg_material_create_named(name, material);
    if (status != SKG_OK) return cli_fail(status);
    b->filters[b->filter_count] =
        (skg_filter){.size = (int32_t)sizeof(skg_filter), .material = *material, .thickness_mm = mm};
    b->filter_count++;
    return CLI_DONE;
}

/* Reads "65uGy/mAs@100cm". */
static int read_output(const char *text, skg_tube *tube) {
    static const char unit[] = "uGy/mAs@";
    char *end = NULL, *length = NULL;
    double output = strtod(text, &end), distance = 0;
    if (end != text && strncmp(end, unit, strlen(unit)) == 0) {
        const char *at = end + strlen(unit);
        distance = strtod(at, &length);
        tube->output_ugy_mas = output;
        tube->output_at_mm = distance * cli_millimetres(length);
        if (length != at && output > 0 && tube->output_at_mm > 0) return CLI_DONE;
    }
    return cli_error(CLI_USAGE, "--output %s is not an output such as 65uGy/mAs@100cm", text);
}

static int read_tube(const cli_arguments *arguments, beam *b) {
    skg_tube *tube = &b->tube;
    tube->mas = 1, tube->distance_mm = 1000, tube->pixel_mm2 = 1;
    int exit_status = cli_number(arguments, "--kvp", 10, 450, &tube->kvp);
    if (exit_status == CLI_DONE) exit_status = cli_number(arguments, "--angle", 3, 60, &tube->angle_deg);
    if (exit_status == CLI_DONE) exit_status = cli_number(arguments, "--bin", 0.1, 10, &tube->bin_kev);
    if (exit_status == CLI_DONE) exit_status = cli_number(arguments, "--mas", 1e-9, 1e9, &tube->mas);
    if (exit_status == CLI_DONE)
        exit_status = cli_number(arguments, "--distance", 1e-3, 1e9, &tube->distance_mm);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--model", &tube->model);
    const char *anode = cli_value(arguments, "--anode"), *output = cli_value(arguments, "--output");
    if (exit_status == CLI_DONE && anode) {
        skg_status status = skg_element_number_get(anode, &tube->anode);
        if (status != SKG_OK) exit_status = cli_fail(status);
    }
    if (exit_status == CLI_DONE && output) exit_status = read_output(output, tube);
    return exit_status;
}

/* Refuses flags of a tube together with a file, and the file's flag without one. */
static int check_source(const cli_arguments *arguments, beam *b) {
    static const char *const of_tube[] = {"--kvp", "--angle", "--anode",    "--model",
                                          "--bin", "--mas",   "--distance", "--output"};
    b->file = cli_value(arguments, "--file");
    if (!b->file && !cli_given(arguments, "--kvp"))
        return cli_error(CLI_USAGE, "beam: no beam is named; add --kvp KV or --file FILE");
    if (!b->file && cli_given(arguments, "--unit")) return cli_error(CLI_USAGE, "--unit needs --file");
    for (size_t i = 0; b->file && i < sizeof of_tube / sizeof *of_tube; i++)
        if (cli_given(arguments, of_tube[i]))
            return cli_error(CLI_USAGE, "%s describes a tube and --file a spectrum; give one of them",
                             of_tube[i]);
    return CLI_DONE;
}

static skg_status make_spectrum(const char *unit, beam *b) {
    if (!b->file) {
        b->tube.filters = b->filters;
        b->tube.filter_count = b->filter_count;
        b->tube.log = cli_log;
        b->per_mas = pow(b->tube.distance_mm / 1000, 2) / b->tube.mas;
        return skg_spectrum_create_tube(&b->tube, &b->spectrum);
    }
    skg_spectrum *unfiltered = NULL;
    b->per_mas = (double)NAN;
    skg_status status = skg_spectrum_load(b->file, unit, &unfiltered);
    if (status == SKG_OK)
        status = skg_spectrum_create_filtered(unfiltered, b->filter_count, b->filters, &b->spectrum);
    skg_spectrum_release(&unfiltered);
    return status;
}

static int make_beam(const cli_arguments *arguments, beam *b) {
    int32_t unit = 1;
    const char *text;
    int exit_status = check_source(arguments, b);
    if (exit_status == CLI_DONE) exit_status = cli_choice(arguments, "--unit", &unit);
    if (exit_status == CLI_DONE) exit_status = read_tube(arguments, b);
    for (int i = 0; exit_status == CLI_DONE && (text = cli_nth_value(arguments, "--filter", i)); i++)
        exit_status = read_filter(text, b);
    if (exit_status != CLI_DONE) return exit_status;
    skg_status status = make_spectrum(cli_find_flag(arguments->manual, "--unit")->values[unit].name, b);
    if (status == SKG_OK) status = skg_spectrum_quality_get(b->spectrum, &b->quality);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* --- report --------------------------------------------------------------------------------------------- */

/* "90 kV, W, 12 degrees, Ebel; 0.1 mm Cu" */
static void describe(const beam *b, char *text, size_t size) {
    const char *symbol = "", *name = "";
    int used;
    if (b->file) {
        used = snprintf(text, size, "%s", b->file);
    } else {
        skg_element_symbol_get(b->tube.anode, &symbol);
        used = snprintf(text, size, "%g kV, %s, %g degrees, %s", b->tube.kvp, symbol, b->tube.angle_deg,
                        authors[b->tube.model]);
    }
    for (int64_t i = 0; i < b->filter_count && used >= 0 && (size_t)used < size; i++) {
        skg_material_name_get(b->materials[i], &name);
        used += snprintf(text + used, size - (size_t)used, "%s %g mm %s", i == 0 ? ";" : ",",
                         b->filters[i].thickness_mm, name);
    }
}

static void print_beam(const beam *b) {
    char text[512];
    const skg_quality *q = &b->quality;
    int64_t bins = 0;
    describe(b, text, sizeof text);
    skg_spectrum_bin_count(b->spectrum, &bins);
    printf("%s\n", text);
    printf("  mean energy   %.2f keV (%" PRId64 " energies)\n", q->mean_kev, bins);
    printf("  HVL1          %.4g mm Al   %.4g mm Cu\n", q->hvl1_mm_al, q->hvl1_mm_cu);
    printf("  HVL2          %.4g mm Al   %.4g mm Cu\n", q->hvl2_mm_al, q->hvl2_mm_cu);
    printf("  homogeneity   %.3f (HVL1/HVL2 in Al)\n", q->homogeneity);
    if (b->file) {
        printf("  photons       %.6g, in the file's unit\n", q->photons);
        return;
    }
    printf("  output        %.4g uGy/mAs air kerma, %.4g photons/mm2/mAs at 1 m\n",
           q->air_kerma_ugy * b->per_mas, q->photons * b->per_mas);
    if (b->tube.mas != 1 || b->tube.distance_mm != 1000)
        printf("  %g mAs at %g mm   %.4g uGy, %.4g photons/mm2\n", b->tube.mas, b->tube.distance_mm,
               q->air_kerma_ugy, q->photons);
}

static json_t *beam_json(const beam *b) {
    const skg_quality *q = &b->quality;
    json_t *object = json_object(), *bins = json_array();
    int64_t count = 0;
    json_object_set_new(object, "mean_energy_keV", cli_json_number(q->mean_kev));
    json_object_set_new(object, "hvl1_mm_al", cli_json_number(q->hvl1_mm_al));
    json_object_set_new(object, "hvl2_mm_al", cli_json_number(q->hvl2_mm_al));
    json_object_set_new(object, "hvl1_mm_cu", cli_json_number(q->hvl1_mm_cu));
    json_object_set_new(object, "hvl2_mm_cu", cli_json_number(q->hvl2_mm_cu));
    json_object_set_new(object, "homogeneity", cli_json_number(q->homogeneity));
    json_object_set_new(object, "air_kerma_uGy_per_mAs_1m", cli_json_number(q->air_kerma_ugy * b->per_mas));
    json_object_set_new(object, "photons_per_mm2_mAs_1m", cli_json_number(q->photons * b->per_mas));
    skg_spectrum_bin_count(b->spectrum, &count);
    for (int64_t i = 0; i < count; i++) {
        double bin[2];
        if (skg_spectrum_bin_get(b->spectrum, i, &bin[0], &bin[1]) == SKG_OK)
            json_array_append_new(bins, cli_json_numbers(bin, 2));
    }
    json_object_set_new(object, "bins", bins);
    return object;
}

/* --- files ---------------------------------------------------------------------------------------------- */

static char *beam_csv(const beam *b) {
    char *text = NULL;
    size_t size = 0;
    int64_t count = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) return NULL;
    fprintf(stream, "energy (keV),photons%s\n", b->file ? "" : " per mm2");
    skg_spectrum_bin_count(b->spectrum, &count);
    for (int64_t i = 0; i < count; i++) {
        double kev, photons;
        if (skg_spectrum_bin_get(b->spectrum, i, &kev, &photons) == SKG_OK)
            fprintf(stream, "%.10g,%.10g\n", kev, photons);
    }
    if (fclose(stream) == 0) return text;
    free(text);
    return NULL;
}

/* Four corners of a bar for each bin, as wide as the smallest distance between bins. x and y: [4 count]. */
static void make_steps(const skg_spectrum *spectrum, int64_t count, double *x, double *y) {
    double width = HUGE_VAL, before = 0, kev = 0, photons = 0;
    for (int64_t i = 0; i < count; i++, before = kev) {
        skg_spectrum_bin_get(spectrum, i, &kev, &photons);
        if (i > 0) width = fmin(width, kev - before);
    }
    if (count == 1) width = 1;
    for (int64_t i = 0; i < count; i++) {
        skg_spectrum_bin_get(spectrum, i, &kev, &photons);
        x[4 * i] = x[4 * i + 1] = kev - width / 2;
        x[4 * i + 2] = x[4 * i + 3] = kev + width / 2;
        y[4 * i] = y[4 * i + 3] = 0;
        y[4 * i + 1] = y[4 * i + 2] = photons;
        int joins = i > 0 && x[4 * i] - x[4 * i - 1] < 1e-6 * width;
        if (joins) y[4 * i - 1] = y[4 * i - 2], y[4 * i] = photons; /* adjoining bars share an edge */
    }
}

static int write_outputs(const cli_arguments *arguments, const beam *b) {
    char title[512];
    int64_t count = 0;
    int exit_status;
    skg_spectrum_bin_count(b->spectrum, &count);
    double *x = calloc(4 * (size_t)count, sizeof *x), *y = calloc(4 * (size_t)count, sizeof *y);
    char *csv = beam_csv(b);
    if (x && y && csv) {
        const cli_curve curve = {.name = "photons", .x = x, .y = y, .count = 4 * count};
        const cli_plot plot = {.title = title,
                               .x_label = "photon energy (keV)",
                               .y_label = b->file ? "photons" : "photons per mm2 and bin",
                               .is_filled = 1,
                               .curves = &curve,
                               .count = 1};
        make_steps(b->spectrum, count, x, y);
        describe(b, title, sizeof title);
        exit_status = cli_write_plots(arguments, &plot, csv);
    } else {
        exit_status = cli_error(CLI_DEVICE, "out of host memory");
    }
    free(x);
    free(y);
    free(csv);
    return exit_status;
}

int cli_beam(const cli_arguments *arguments) {
    static const beam nothing;
    beam b = nothing;
    int plots = 0;
    skg_tube_init(&b.tube);
    skg_quality_init(&b.quality);
    int exit_status = cli_check_plots(arguments, &plots);
    if (exit_status == CLI_DONE) exit_status = make_beam(arguments, &b);
    if (exit_status == CLI_DONE) exit_status = write_outputs(arguments, &b);
    if (exit_status == CLI_DONE && cli_given(arguments, "--json"))
        exit_status = cli_json_print(beam_json(&b));
    else if (exit_status == CLI_DONE && !cli_is_quiet())
        print_beam(&b);
    if (exit_status == CLI_DONE) cli_report_plots(arguments);
    skg_spectrum_release(&b.spectrum);
    for (int64_t i = 0; i < b.filter_count; i++) skg_material_release(&b.materials[i]);
    return exit_status;
}
