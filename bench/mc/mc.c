/* Images against a Monte Carlo reference: the primary, which the library computes, and what scatter adds to
 * it. */
#include "common/bench.h"
#include "mc/reference.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const char usage[] = "--scene FILE.json --reference PREFIX [--into PREFIX] [--csv FILE] [--rays N] "
                            "[--device CONFIG] [--quick]";

typedef struct {
    const char *scene, *reference, *into, *csv, *device;
    long rays; /* n x n rays in a pixel; the reference has 8 x 8 */
} settings;

typedef struct {
    skg_context *context;
    skg_setup *setup;
    skg_scene *scene;
    skg_spectrum *spectrum;
    skg_view view;
    int64_t count;
} job;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    *out = (settings){.rays = 8};
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            out->rays = 2;
        else if (bench_option(&arguments, "--rays", &value))
            bench_numbers(value, 1, 16, 1, &out->rays);
        else if (!bench_option(&arguments, "--scene", &out->scene) &&
                 !bench_option(&arguments, "--reference", &out->reference) &&
                 !bench_option(&arguments, "--into", &out->into) &&
                 !bench_option(&arguments, "--csv", &out->csv) &&
                 !bench_option(&arguments, "--device", &out->device))
            bench_usage(&arguments, usage);
    }
    if (!out->scene || !out->reference) bench_usage(&arguments, usage);
}

static void open_job(const settings *set, job *j) {
    *j = (job){.context = bench_context(set->device)};
    bench_try(skg_setup_load(j->context, set->scene, 0, NULL, &j->setup), set->scene);
    skg_view_init(&j->view);
    bench_try(skg_setup_scene_get(j->setup, &j->scene), "scene");
    bench_try(skg_setup_spectrum_get(j->setup, &j->spectrum), "beam");
    bench_try(skg_setup_view_get(j->setup, &j->view), "view");
    j->count = j->view.columns * j->view.rows;
}

/* An image in double, computed in `precision`. */
static double *take(const job *j, int32_t precision, int32_t quantity, int32_t falloff, long rays) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_output output;
    double *image = bench_alloc((size_t)j->count, sizeof *image);
    skg_plan_options_init(&options);
    options.precision = precision;
    options.quantity = quantity;
    options.falloff = falloff;
    options.supersampling = (int32_t)rays;
    bench_try(skg_plan_create(j->context, j->scene, &j->view, j->spectrum, &options, &plan), "plan");
    skg_output_init(&output);
    float *narrow = bench_alloc((size_t)j->count, sizeof *narrow);
    output.type = precision == SKG_PRECISION_DOUBLE ? SKG_TYPE_FLOAT64 : SKG_TYPE_FLOAT32;
    output.data = precision == SKG_PRECISION_DOUBLE ? (void *)image : (void *)narrow;
    bench_try(skg_plan_image(plan, &output), "image");
    for (int64_t p = 0; precision == SKG_PRECISION_SINGLE && p < j->count; p++) image[p] = (double)narrow[p];
    free(narrow);
    skg_plan_release(&plan);
    return image;
}

/* --- comparison --- */

typedef struct {
    double ncc, mean, worst; /* mean and largest |ours / reference - 1| */
} comparison;

/* Prints a row and writes it to the CSV. min_ncc, most: the targets of the NCC and of the mean error; 0:
 * none. Returns 1 if a target is missed. */
static int compare(const char *what, const double *ours, const double *reference, int64_t count,
                   double min_ncc, double most, FILE *csv) {
    comparison c = {.ncc = reference_ncc(ours, reference, count)};
    for (int64_t p = 0; p < count; p++) {
        const double error = fabs(ours[p] / reference[p] - 1);
        c.mean += error / (double)count;
        c.worst = fmax(c.worst, error);
    }
    const int missed = c.ncc < min_ncc || (most > 0 && !(c.mean <= most));
    printf("| %s | %.7f | %.3g | %.3g | ", what, c.ncc, c.mean, c.worst);
    if (min_ncc > 0) printf("NCC at least %g: %s", min_ncc, missed ? "MISSED" : "met");
    if (most > 0) printf("mean error at most %g: %s", most, missed ? "MISSED" : "met");
    printf(" |\n");
    if (csv) fprintf(csv, "\"%s\",%.8f,%.4g,%.4g\n", what, c.ncc, c.mean, c.worst);
    return missed;
}

/* ratio = a / b */
static double *divide(const double *a, const double *b, int64_t count) {
    double *ratio = bench_alloc((size_t)count, sizeof *ratio);
    for (int64_t p = 0; p < count; p++) ratio[p] = a[p] / b[p];
    return ratio;
}

static void scale_to(double *image, double by, int64_t count) {
    for (int64_t p = 0; p < count; p++) image[p] *= by;
}

static void print_scatter(const double *scatter, const double *primary, const double *behind, int64_t count) {
    double most = 0, mean = 0;
    int64_t pixels = 0;
    for (int64_t p = 0; p < count; p++) {
        if (!(behind[p] < 0.99)) continue; /* outside the object's shadow */
        mean += scatter[p] / (scatter[p] + primary[p]);
        most = fmax(most, scatter[p] / (scatter[p] + primary[p]));
        pixels++;
    }
    printf("\nScatter's share of the total behind the object: %.2f %% on average, %.2f %% at most (%" PRId64
           " pixels).\n",
           100 * mean / (double)pixels, 100 * most, pixels);
}

/* --- drawing --- */

static void write_drawing(const char *prefix, const job *j, const double *ours, const double *total) {
    double *error = bench_alloc((size_t)j->count, sizeof *error);
    char path[4096];
    for (int64_t p = 0; p < j->count; p++) error[p] = 100 * (ours[p] / total[p] - 1);
    reference_write(prefix, "ours", ours, j->count);
    reference_write(prefix, "total", total, j->count);
    reference_write(prefix, "error", error, j->count);
    snprintf(path, sizeof path, "%sprofiles.csv", prefix);
    FILE *file = bench_open(path);
    const int64_t n = j->view.columns, middle = j->view.rows / 2;
    fprintf(file, "pixel,row_ours,row_total,column_ours,column_total\n");
    for (int64_t k = 0; k < n && k < j->view.rows; k++)
        fprintf(file, "%" PRId64 ",%.8g,%.8g,%.8g,%.8g\n", k, ours[middle * n + k], total[middle * n + k],
                ours[k * n + n / 2], total[k * n + n / 2]);
    fclose(file);
    free(error);
}

static int run(const settings *set, const job *j, FILE *csv) {
    const int64_t n = j->count, middle = j->view.rows / 2 * j->view.columns + j->view.columns / 2;
    const int64_t columns = j->view.columns, rows = j->view.rows;
    double *flat = reference_read(set->reference, "open", columns, rows, 1);
    double *primary = reference_read(set->reference, "primary", columns, rows, 1);
    double *scatter = reference_read(set->reference, "scatter", columns, rows, 1);
    double *total = reference_read(set->reference, "total", columns, rows, 1);
    double *primary_share = divide(primary, flat, n), *total_share = divide(total, flat, n);
    int missed = 0;
    skg_device_info info;
    skg_device_info_init(&info);
    bench_try(skg_context_device_get(j->context, &info), "device");
    printf("| image | NCC | mean rel. error | largest | bar |\n|---|---|---|---|---|\n");
    for (int32_t precision = 0; precision <= info.double_precision; precision++) {
        double *ours = take(j, precision, SKG_QUANTITY_TRANSMISSION, 0, set->rays);
        missed |=
            compare(precision ? "I/I0, double, against the primary" : "I/I0, single, against the primary",
                    ours, primary_share, n, 0, 1e-4, csv);
        missed |= compare(precision ? "I/I0, double, against the total" : "I/I0, single, against the total",
                          ours, total_share, n, 0.9999, 0, csv);
        if (precision == 0 && set->into) write_drawing(set->into, j, ours, total_share);
        free(ours);
    }
    for (int32_t falloff = 1; falloff >= 0; falloff--) {
        double *ours = take(j, SKG_PRECISION_SINGLE, SKG_QUANTITY_ENERGY, falloff, set->rays), kev = 0,
               photons = 0;
        bench_try(skg_spectrum_bin_get(j->spectrum, 0, &kev, &photons), "beam");
        /* Scaled to the reference's unit: the flat fields are equal in the middle of the detector. */
        scale_to(ours, flat[middle] / (kev * photons), n);
        compare(falloff ? "energy with falloff, against the primary"
                        : "energy without falloff, against the primary",
                ours, primary, n, 0, 0, csv);
        compare(falloff ? "energy with falloff, against the total"
                        : "energy without falloff, against the total",
                ours, total, n, 0, 0, csv);
        free(ours);
    }
    print_scatter(scatter, primary, primary_share, n);
    double *const all[] = {flat, primary, scatter, total, primary_share, total_share};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
    return missed;
}

int main(int count, char **words) {
    settings set;
    job j;
    read_settings(count, words, &set);
    open_job(&set, &j);
    FILE *csv = set.csv ? bench_open(set.csv) : NULL;
    if (csv) fprintf(csv, "image,ncc,mean_error,largest_error\n");
    const int missed = run(&set, &j, csv);
    if (csv) fclose(csv);
    skg_setup_release(&j.setup);
    skg_context_release(&j.context);
    return missed;
}
