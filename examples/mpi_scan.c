/* A circular scan over the processes of an MPI program: each takes every n-th projection, and process 0 gathers the sums of
 * all. A process makes a context of its own after MPI_Init, because OpenCL does not survive a fork.
 *
 *     mpicc mpi_scan.c $(pkg-config --cflags --libs skiagraph) -lm -o mpi_scan && mpirun -n 2 ./mpi_scan phantom.json */
#include <skiagraph/skiagraph.h>

#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

enum { PROJECTIONS = 16 };
static const double pi = 3.14159265358979323846;

static int failed(skg_status status) {
    if (status == SKG_OK) return 0;
    fprintf(stderr, "%s: %s\n", skg_status_name(status), skg_last_error());
    return SKG_FAILED(status) || status == SKG_STALE; /* after SKG_RANGE the image is there */
}

/* Turns a vector about the z axis. */
static void turn(double angle, double v[3]) {
    const double x = v[0], y = v[1];
    v[0] = cos(angle) * x - sin(angle) * y;
    v[1] = sin(angle) * x + cos(angle) * y;
}

/* The energy that arrives in this process's projections; 0 for those of the others. */
static int scan(skg_plan *plan, const skg_view *first, int rank, int size, double sums[PROJECTIONS]) {
    const int64_t pixels = first->columns * first->rows;
    float *image = calloc((size_t)pixels, sizeof *image);
    skg_output output;
    skg_output_init(&output);
    output.data = image;
    int bad = !image;
    for (int n = rank; n < PROJECTIONS && !bad; n += size) {
        const double angle = 2 * pi * n / PROJECTIONS;
        skg_view view = *first;
        turn(angle, view.source);
        turn(angle, view.centre);
        turn(angle, view.column_step);
        turn(angle, view.row_step);
        bad = failed(skg_plan_view_set(plan, &view)) || failed(skg_plan_image(plan, &output));
        for (int64_t i = 0; i < pixels && !bad; i++) sums[n] += (double)image[i];
    }
    free(image);
    return bad;
}

static int run(const char *path, int rank, int size, double sums[PROJECTIONS]) {
    skg_context *context = NULL;
    skg_setup *setup = NULL;
    skg_scene *scene = NULL;
    skg_spectrum *spectrum = NULL;
    skg_plan *plan = NULL;
    skg_view view;
    skg_plan_options options;
    skg_view_init(&view);
    skg_plan_options_init(&options);
    const int bad =
        failed(skg_context_create(NULL, &context)) ||
        failed(skg_setup_load(context, path, 0, NULL, &setup)) ||
        failed(skg_setup_scene_get(setup, &scene)) || failed(skg_setup_spectrum_get(setup, &spectrum)) ||
        failed(skg_setup_view_get(setup, &view)) || failed(skg_setup_options_get(setup, &options)) ||
        failed(skg_plan_create(context, scene, &view, spectrum, &options, &plan)) ||
        scan(plan, &view, rank, size, sums);
    skg_plan_release(&plan);
    skg_setup_release(&setup);
    skg_context_release(&context);
    return bad;
}

int main(int count, char **words) {
    double mine[PROJECTIONS] = {0}, all[PROJECTIONS] = {0};
    int rank = 0, size = 1, bad, worst = 0;
    MPI_Init(&count, &words);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    bad = count != 2 || run(words[1], rank, size, mine);
    MPI_Reduce(mine, all, PROJECTIONS, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    MPI_Allreduce(&bad, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    for (int n = 0; n < PROJECTIONS && rank == 0 && !worst; n++)
        printf("%6.1f degrees: %.9e keV\n", 360.0 * n / PROJECTIONS, all[n]);
    MPI_Finalize();
    return worst;
}
