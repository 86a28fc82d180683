/* Path lengths of one closed mesh: the library against plain C with OpenMP and against Embree, in one run. */
#include "agree.h"
#include "contenders.h"
#include "table.h"

#include "affinity/affinity.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "[--quick] [--shapes 0,1 (sphere, blob)] [--triangles N,N] [--sizes N,N] [--repeats N] [--threads N]\n"
    "    [--device CONFIG] [--affinity] [--csv FILE]";

enum { LISTED = 16 };

typedef struct {
    long shapes[LISTED], triangles[LISTED], sizes[LISTED];
    int shape_count, triangle_count, size_count;
    int repeats, threads, affinity;
    const char *device, *csv;
} settings;

static void read_settings(int count, char **words, settings *out) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL;
    long number = 0;
    *out = (settings){.repeats = 25, .threads = omp_get_max_threads()};
    out->shape_count = bench_numbers("0,1", 0, 1, LISTED, out->shapes);
    out->triangle_count =
        bench_numbers("1000,10000,42000,168000,1000000,4000000", 8, 50000000, LISTED, out->triangles);
    out->size_count = bench_numbers("512,1024,2048", 16, 8192, LISTED, out->sizes);
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick")) {
            out->triangle_count = bench_numbers("1000,42000", 8, 50000000, LISTED, out->triangles);
            out->size_count = bench_numbers("512,1024", 16, 8192, LISTED, out->sizes);
            out->repeats = 10;
        } else if (bench_flag(&arguments, "--affinity")) {
            out->affinity = 1;
        } else if (bench_option(&arguments, "--shapes", &value)) {
            out->shape_count = bench_numbers(value, 0, 1, LISTED, out->shapes);
        } else if (bench_option(&arguments, "--triangles", &value)) {
            out->triangle_count = bench_numbers(value, 8, 50000000, LISTED, out->triangles);
        } else if (bench_option(&arguments, "--sizes", &value)) {
            out->size_count = bench_numbers(value, 16, 8192, LISTED, out->sizes);
        } else if (bench_option(&arguments, "--repeats", &value)) {
            bench_numbers(value, 5, BENCH_SAMPLES, 1, &number);
            out->repeats = (int)number;
        } else if (bench_option(&arguments, "--threads", &value)) {
            bench_numbers(value, 1, 1024, 1, &number);
            out->threads = (int)number;
        } else if (!bench_option(&arguments, "--device", &out->device) &&
                   !bench_option(&arguments, "--csv", &out->csv)) {
            bench_usage(&arguments, usage);
        }
    }
}

/* The source stands on the axis, 1000 mm before the mesh's centre; the detector of 400 mm stands 1200 mm from
 * it. */
static void make_view(long size, skg_view *view) {
    skg_view_init(view);
    view->columns = view->rows = size;
    view->source[2] = -1000;
    view->centre[2] = 200;
    view->column_step[0] = view->row_step[1] = 400.0 / (double)size;
}

/* Ends the program if the images differ by more than rounding. The library and plain C each have an rms error
 * of at most 3e-7 of the longest path. Embree sums absolute distances in float (rms 1e-4 mm of 320 mm), and
 * misses or doubles a hit on an edge in at most one pixel of 10,000. */
static void check(const char *what, const float *image, const float *reference, long size, double rms_bar,
                  double gross_share) {
    agreement found;
    agree(image, reference, (int64_t)size * size, &found);
    if (!agree_within(&found, rms_bar, (int64_t)(gross_share * (double)found.pixels)))
        bench_die(
            "%s disagrees with plain C: rms %.3g mm, worst %.3g mm of %.4g mm, %lld of %lld pixels off by more "
            "than a thousandth; nothing was timed",
            what, found.rms, found.worst, found.longest, (long long)found.gross, (long long)found.pixels);
}

/* All contenders on one shape and one detector. */
static void compare(const settings *set, skg_context *context, int kind, const bench_shape *shape, long size,
                    table *rows) {
    skg_view view;
    make_view(size, &view);
    float *images[CONTENDERS];
    for (int k = 0; k < CONTENDERS; k++) images[k] = bench_alloc((size_t)(size * size), sizeof *images[k]);
    scanline *plain = scanline_create(shape, &view, set->threads, images[PLAIN]);
    library *ours = library_create(context, shape, &view, images[OURS]);
    const bench_frame frames[CONTENDERS] = {
        scanline_frame,
        library_frame,
#if BENCH_EMBREE
        embree_frame
    };
    embree *rays = embree_create(shape, &view, set->threads, images[EMBREE]);
    void *const who[CONTENDERS] = {plain, ours, rays};
#else
    };
    void *const who[CONTENDERS] = {plain, ours};
#endif
    for (int k = 0; k < CONTENDERS; k++) frames[k](who[k]);
    check("the library", images[OURS], images[PLAIN], size, 6e-7, 1e-5);
#if BENCH_EMBREE
    check("Embree", images[EMBREE], images[PLAIN], size, 3e-6, 1e-4);
#endif
    table_row *row = table_add(rows);
    row->shape = kind, row->triangles = shape->triangles, row->size = size;
    const int per_turn = 5;
    bench_interleave(CONTENDERS, frames, who, (set->repeats + per_turn - 1) / per_turn, per_turn, row->times);
    table_print(row);
#if BENCH_EMBREE
    embree_free(rays);
#endif
    library_free(ours);
    scanline_free(plain);
    for (int k = 0; k < CONTENDERS; k++) free(images[k]);
}

static void run(const settings *set, skg_context *context, table *rows) {
    table_head();
    for (int s = 0; s < set->shape_count; s++) {
        for (int t = 0; t < set->triangle_count; t++) {
            bench_shape shape;
            const int kind = (int)set->shapes[s];
            shape_make(kind, kind == SHAPE_BLOB ? 140 : 160, set->triangles[t], &shape);
            for (int d = 0; d < set->size_count; d++)
                compare(set, context, kind, &shape, set->sizes[d], rows);
            shape_free(&shape);
        }
    }
}

int main(int count, char **words) {
    settings set;
    read_settings(count, words, &set);
    const char *pinned = set.affinity ? host_pin_threads() : "not pinned (--affinity is not given)";
    skg_context *context = bench_context(set.device);
    skg_device_info device;
    skg_device_info_init(&device);
    bench_try(skg_context_device_get(context, &device), "device");
    printf("Device: %s (%s), %d compute units; threads of plain C and Embree: %d; PoCL's threads: %s.\n\n",
           device.name, device.version, (int)device.compute_units, set.threads, pinned);
    table rows = {0};
    run(&set, context, &rows);
    table_targets(&rows);
    if (set.csv) table_write(&rows, set.csv);
    table_free(&rows);
    skg_context_release(&context);
    return 0;
}
