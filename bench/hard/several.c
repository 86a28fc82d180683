/* Scenes of several parts against the ray caster: the source on faces, and the bound of the precision. */
#include "hard/several.h"

#include "common/bench.h"
#include "support/drawn.h"
#include "support/faces.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static skg_scene *scene_of(skg_context *context, int count, const solid *solids, const double *mu) {
    skg_scene *scene = NULL;
    bench_try(skg_scene_create(context, &scene), "scene");
    for (int p = 0; p < count; p++) {
        const solid *s = &solids[p];
        char label[16];
        skg_part part;
        if (!(mu[p] > 0)) continue;
        skg_part_init(&part);
        snprintf(label, sizeof label, "part %d", p);
        part.label = label;
        bench_try(skg_mesh_create(context, label,
                                  &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                     .vertices = s->vertices,
                                                     .positions = s->positions,
                                                     .triangles = s->triangles,
                                                     .corners = s->corners,
                                                     .unit_mm = 1},
                                  &part.mesh),
                  "mesh");
        bench_try(skg_material_create_mu(label, mu[p], &part.material), "material");
        bench_try(skg_scene_part_add(scene, &part, NULL), "part");
        skg_mesh_release(&part.mesh);
        skg_material_release(&part.material);
    }
    return scene;
}

/* The image of a plan of its own in doubles, to be freed, and the bound that the plan states. */
static double *image_of(skg_context *context, skg_scene *scene, const skg_view *view, int32_t precision,
                        int32_t quantity, double *bound) {
    skg_plan_options options;
    skg_plan *plan = NULL;
    skg_output output;
    skg_spectrum *beam = NULL;
    double *image = bench_alloc((size_t)(view->rows * view->columns), sizeof *image);
    bench_try(skg_spectrum_create_mono(100, 1, &beam), "beam");
    skg_plan_options_init(&options);
    options.precision = precision, options.quantity = quantity, options.overlaps = 0;
    bench_try(skg_plan_create(context, scene, view, beam, &options, &plan), "plan");
    skg_output_init(&output);
    output.type = SKG_TYPE_FLOAT64;
    output.data = image;
    bench_try(skg_plan_image(plan, &output), "image");
    bench_try(skg_plan_precision_bound_get(plan, bound), "bound");
    skg_plan_release(&plan);
    skg_spectrum_release(&beam);
    return image;
}

int64_t hard_faces(skg_context *context, int64_t first, int64_t count) {
    int64_t out = 0;
    for (int64_t n = first; n < first + count; n++) {
        face_scene s = face_scene_make((uint64_t)n);
        skg_scene *scene = scene_of(context, FACE_PARTS, s.parts, s.mu);
        double bound, worst[2] = {0};
        for (int32_t precision = SKG_PRECISION_SINGLE; precision <= SKG_PRECISION_DOUBLE; precision++) {
            double *image = image_of(context, scene, &s.view, precision, SKG_QUANTITY_ATTENUATION, &bound);
            worst[precision == SKG_PRECISION_DOUBLE] =
                face_scene_judge(&s, image, precision == SKG_PRECISION_DOUBLE, 24, (uint64_t)n);
            free(image);
        }
        if (worst[0] > 1 || worst[1] > 1)
            printf("%s: %.3g bars in single, %.3g in double\n", s.name, worst[0], worst[1]), out++;
        skg_scene_release(&scene);
        face_scene_free(&s);
    }
    printf("%" PRId64 " scenes with the source on faces, from number %" PRId64 " on: %" PRId64
           " out of the bar\n",
           count, first, out);
    return out;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int64_t hard_drawn(skg_context *context, int64_t first, int64_t count) {
    double *ratios = bench_alloc((size_t)(2 * count), sizeof *ratios), *whole = ratios + count;
    int64_t out = 0;
    for (int64_t n = 0; n < count; n++) {
        drawn_scene s = drawn_scene_make((uint64_t)(first + n));
        skg_scene *scene = scene_of(context, s.parts, s.solids, s.mu);
        double bound, other;
        double *single =
            image_of(context, scene, &s.view, SKG_PRECISION_SINGLE, SKG_QUANTITY_TRANSMISSION, &bound);
        double *twice =
            image_of(context, scene, &s.view, SKG_PRECISION_DOUBLE, SKG_QUANTITY_TRANSMISSION, &other);
        const drawn_error error = drawn_scene_judge(&s, single, twice);
        const int64_t pixel = error.pixel;
        ratios[n] = bound / fmax(error.outside, 0x1p-24); /* kernels compute with floats */
        whole[n] = bound / fmax(error.whole, 0x1p-24);
        if (error.outside > bound)
            printf("%s: %.3g at pixel %" PRId64 ", bound %.3g\n", s.name, error.outside, pixel, bound), out++;
        free(single);
        free(twice);
        skg_scene_release(&scene);
        drawn_scene_free(&s);
    }
    qsort(ratios, (size_t)count, sizeof *ratios, ascending);
    qsort(whole, (size_t)count, sizeof *whole, ascending);
    printf("%" PRId64 " drawn scenes from number %" PRId64 " on: %" PRId64
           " above the bound; bound over error: least %.3g, median %.3g, over the whole error %.3g\n",
           count, first, out, ratios[0], ratios[count / 2], whole[count / 2]);
    free(ratios);
    return out;
}
