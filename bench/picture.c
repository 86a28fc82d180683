/* The 3D view: time of a picture of the generated thorax, with all copies between host and device. */
#include "common/bench.h"
#include "common/thorax.h"

#include "affinity/affinity.h"

#include <stdlib.h>

static const char usage[] =
    "[--quick] [--triangles N] [--size N] [--repeats N] [--device CONFIG] [--affinity] [--csv FILE]";

/* The pictures that are compared: parts as skg_look_colours_get has them, and all opaque. */
enum { TRANSLUCENT, OPAQUE, PICTURES };
static const char *const names[PICTURES] = {"translucent skin", "all parts opaque"};

typedef struct {
    skg_context *context;
    skg_scene *scene;
    skg_view view;
    skg_look look;
    uint8_t *rgba;
} picture;

static void draw(void *contender) {
    picture *p = contender;
    bench_try(skg_scene_picture(p->context, p->scene, &p->view, &p->look, p->rgba), "picture");
}

int main(int count, char **words) {
    bench_arguments arguments = {count, words, 1};
    const char *value = NULL, *device = NULL, *csv = NULL;
    long triangles = 42000, size = 1024, repeats = 40;
    int affinity = 0;
    while (arguments.next < arguments.count) {
        if (bench_flag(&arguments, "--quick"))
            repeats = 4;
        else if (bench_flag(&arguments, "--affinity"))
            affinity = 1;
        else if (bench_option(&arguments, "--triangles", &value))
            bench_numbers(value, 1000, 2000000, 1, &triangles);
        else if (bench_option(&arguments, "--size", &value))
            bench_numbers(value, 64, SKG_LOOK_PIXELS_MAX, 1, &size);
        else if (bench_option(&arguments, "--repeats", &value))
            bench_numbers(value, 1, BENCH_SAMPLES / 4, 1, &repeats);
        else if (!bench_option(&arguments, "--device", &device) && !bench_option(&arguments, "--csv", &csv))
            bench_usage(&arguments, usage);
    }
    if (affinity) host_pin_threads();
    bench_thorax thorax;
    bench_times times[PICTURES] = {0};
    picture pictures[PICTURES];
    void *what[PICTURES];
    bench_frame frames[PICTURES];
    skg_context *context = bench_context(device);
    thorax_make(triangles, THORAX_CLOSED, &thorax);
    skg_scene *scene = thorax_scene(context, &thorax);
    uint8_t *colours = bench_alloc((size_t)thorax.parts, 4), *rgba = bench_alloc((size_t)(size * size), 4);
    bench_try(skg_look_colours_get(scene, colours), "colours");
    for (int64_t i = 0; i < thorax.parts; i++) colours[4 * i + 3] = 255;
    for (int k = 0; k < PICTURES; k++) {
        pictures[k] = (picture){.context = context, .scene = scene, .rgba = rgba};
        thorax_view(512, &pictures[k].view);
        skg_look_init(&pictures[k].look);
        pictures[k].look.columns = pictures[k].look.rows = size;
        if (k == OPAQUE) pictures[k].look.colours = colours;
        what[k] = &pictures[k], frames[k] = draw;
    }
    bench_interleave(PICTURES, frames, what, 4, (int)repeats, times);
    printf(
        "%lld parts, %lld triangles, %ld x %ld pixels, 2 x 2 samples each. Times in ms, of whole calls.\n"
        "Target: translucent at most 15 on two cores.\n\n| picture | minimum | median |\n|---|---:|---:|\n",
        (long long)thorax.parts, (long long)thorax.triangles, size, size);
    FILE *table = csv ? bench_open(csv) : NULL;
    if (table) fprintf(table, "picture,minimum_ms,median_ms\n");
    for (int k = 0; k < PICTURES; k++) {
        printf("| %s | %.4g | %.4g |\n", names[k], bench_min(&times[k]), bench_median(&times[k]));
        if (table) fprintf(table, "%s,%.6g,%.6g\n", names[k], bench_min(&times[k]), bench_median(&times[k]));
    }
    if (table) fclose(table);
    free(colours);
    free(rgba);
    skg_scene_release(&scene);
    thorax_free(&thorax);
    skg_context_release(&context);
    return EXIT_SUCCESS;
}
