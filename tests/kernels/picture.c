/* Shared code of tests of the kernels: meshes as plain arrays, one frame from them, and a slow referee. */
#include "kernels/picture.h"

#include "core/maths.h"
#include "stage/attenuate.h"
#include "stage/raster_private.h"
#include "support/angles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double shape_random(unsigned *seed) {
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

static shape shape_make(int64_t vertices, int64_t triangles) {
    shape s = {vertices, triangles, calloc((size_t)vertices * 3, sizeof(double)),
               calloc((size_t)triangles * 3, sizeof(int32_t))};
    if (!s.positions || !s.corners) abort();
    return s;
}

void shape_free(shape *s) {
    free(s->positions);
    free(s->corners);
}

static void set_corners(shape *s, int64_t triangle, int64_t a, int64_t b, int64_t c) {
    s->corners[3 * triangle] = (int32_t)a;
    s->corners[3 * triangle + 1] = (int32_t)b;
    s->corners[3 * triangle + 2] = (int32_t)c;
}

shape shape_sphere(double radius, int around, int down) {
    shape s = shape_make((int64_t)around * (down - 1) + 2, 2 * (int64_t)around * (down - 1));
    for (int r = 1; r < down; r++)
        for (int k = 0; k < around; k++) {
            double *v = s.positions + 3 * ((r - 1) * around + k);
            v[0] = radius * sin(pi * r / down) * cos(2 * pi * k / around);
            v[2] = radius * sin(pi * r / down) * sin(2 * pi * k / around);
            v[1] = -radius * cos(pi * r / down);
        }
    const int64_t south = s.vertices - 2, north = s.vertices - 1;
    s.positions[3 * south + 1] = -radius;
    s.positions[3 * north + 1] = radius;
    int64_t t = 0;
    for (int k = 0; k < around; k++) set_corners(&s, t++, south, k, (k + 1) % around);
    for (int r = 1; r < down - 1; r++)
        for (int k = 0; k < around; k++) {
            const int64_t a = (r - 1) * around + k, b = (r - 1) * around + (k + 1) % around;
            set_corners(&s, t++, a, b + around, b);
            set_corners(&s, t++, a, a + around, b + around);
        }
    for (int k = 0; k < around; k++)
        set_corners(&s, t++, north, (int64_t)(down - 2) * around + (k + 1) % around,
                    (int64_t)(down - 2) * around + k);
    return s;
}

shape shape_box(double x, double y, double z) {
    static const int32_t faces[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    shape s = shape_make(8, 12);
    for (int k = 0; k < 8; k++) {
        s.positions[3 * k] = (k & 1 ? 0.5 : -0.5) * x;
        s.positions[3 * k + 1] = (k & 2 ? 0.5 : -0.5) * y;
        s.positions[3 * k + 2] = (k & 4 ? 0.5 : -0.5) * z;
    }
    memcpy(s.corners, faces, sizeof faces);
    return s;
}

/* A point near the ray to a random pixel, moved by a few units in the last place. */
static void near_ray(const skg_view *view, unsigned *seed, const double box[4], double depth, int ulps,
                     double *v) {
    const double column = floor(box[0] + shape_random(seed) * box[2]),
                 row = floor(box[1] + shape_random(seed) * box[3]);
    for (int k = 0; k < 3; k++) {
        const double pixel = view->centre[k] +
                             (column - 0.5 * (double)(view->columns - 1)) * view->column_step[k] +
                             (row - 0.5 * (double)(view->rows - 1)) * view->row_step[k];
        float x = (float)(view->source[k] + depth * (pixel - view->source[k]));
        for (int u = (int)(shape_random(seed) * (2 * ulps + 1)) - ulps; u != 0; u += u < 0 ? 1 : -1)
            x = nextafterf(x, u < 0 ? -INFINITY : INFINITY);
        v[k] = (double)x;
    }
}

shape shape_octahedra(int count, unsigned seed, const skg_view *view, int ulps) {
    static const int32_t faces[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    shape s = shape_make(6 * count, 8 * count);
    for (int n = 0; n < count; n++) {
        const double box[4] = {shape_random(&seed) * (double)(view->columns - 8),
                               shape_random(&seed) * (double)(view->rows - 8), 2 + 30 * shape_random(&seed),
                               2 + 30 * shape_random(&seed)};
        for (int k = 0; k < 6; k++)
            near_ray(view, &seed, box, 0.6 + 0.3 * shape_random(&seed), ulps, s.positions + 3 * (6 * n + k));
        for (int k = 0; k < 24; k++) s.corners[24 * n + k] = faces[k] + 6 * n;
    }
    return s;
}

shape shape_unweld(const shape *from) {
    shape s = shape_make(3 * from->triangles, from->triangles);
    for (int64_t k = 0; k < 3 * s.triangles; k++) {
        memcpy(s.positions + 3 * k, from->positions + 3 * from->corners[k], 3 * sizeof(double));
        s.corners[k] = (int32_t)k;
    }
    return s;
}

shape shape_shuffle(const shape *from, unsigned seed) {
    shape s = shape_make(from->vertices, from->triangles);
    memcpy(s.positions, from->positions, (size_t)s.vertices * 3 * sizeof(double));
    memcpy(s.corners, from->corners, (size_t)s.triangles * 3 * sizeof(int32_t));
    for (int64_t k = s.triangles - 1; k > 0; k--) {
        const int64_t other = (int64_t)(shape_random(&seed) * (double)(k + 1));
        for (int c = 0; c < 3; c++) {
            const int32_t corner = s.corners[3 * k + c];
            s.corners[3 * k + c] = s.corners[3 * other + c];
            s.corners[3 * other + c] = corner;
        }
    }
    return s;
}

skg_view view_make(int64_t columns, int64_t rows, double pitch) {
    skg_view view = {.size = sizeof view,
                     .projection = SKG_PROJECTION_POINT,
                     .columns = columns,
                     .rows = rows,
                     .source = {0, 0, -1000},
                     .centre = {0, 0, 200},
                     .column_step = {pitch, 0, 0},
                     .row_step = {0, pitch, 0}};
    return view;
}

body body_make(const shape *s, int plane) {
    return (body){
        .shape = s, .pose = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, .plane = plane, .weight = 1};
}

void picture_free(picture *p) {
    free(p->values);
    free(p->sums);
}

static skg_status make_geometry(skg_context *context, int32_t precision, int bodies, const body *of,
                                skg_geometry *geometry) {
    skg_mesh_layout *meshes = calloc((size_t)bodies, sizeof *meshes);
    int64_t *mesh_of = calloc((size_t)bodies, sizeof *mesh_of);
    int64_t count = 0;
    for (int b = 0; b < bodies; b++) {
        int same = 0;
        while (same < b && of[same].shape != of[b].shape) same++;
        mesh_of[b] = same < b ? mesh_of[same] : count;
        if (same < b) continue;
        const shape *s = of[b].shape;
        skg_mesh_layout *layout = &meshes[count++];
        *layout = (skg_mesh_layout){.vertices = s->vertices, .triangles = s->triangles, .flat = 1};
        if (skg_alloc(3 * s->triangles, sizeof *layout->corners, "corners", &layout->corners) == SKG_OK)
            memcpy(layout->corners, s->corners, (size_t)s->triangles * 3 * sizeof *layout->corners);
    }
    skg_status status = skg_geometry_create(context, precision, count, meshes, bodies, mesh_of, geometry);
    for (int b = 0; b < bodies && status == SKG_OK; b++) {
        const shape *s = of[b].shape;
        float *offsets = calloc((size_t)s->vertices * 3, sizeof *offsets);
        for (int64_t k = 0; k < s->vertices * 3; k++) offsets[k] = (float)s->positions[k];
        status = skg_geometry_upload(
            context, geometry, geometry->mesh_vertex[mesh_of[b]], s->vertices,
            precision == SKG_PRECISION_DOUBLE ? (const void *)s->positions : (const void *)offsets, NULL);
        clFinish(context->device->queue);
        free(offsets);
    }
    free(meshes);
    free(mesh_of);
    return status;
}

/* The middle of the depths at which a shape stands, of those on paths. */
static double middle_depth(const skg_camera *camera, const body *of) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int64_t v = 0; v < of->shape->vertices; v++) {
        double world[3], h[3];
        skg_pose_point(of->pose, of->shape->positions + 3 * v, world);
        skg_camera_see(camera, world, h);
        const double depth = camera->parallel ? h[2] + 1 : h[2];
        low = fmin(low, depth), high = fmax(high, depth);
    }
    if (!camera->parallel) low = fmin(fmax(low, 0), 1), high = fmin(fmax(high, 0), 1);
    return isfinite(low) ? 0.5 * (low + high) : 1;
}

static skg_status project(skg_context *context, skg_geometry *geometry, const skg_raster *raster,
                          const skg_camera *camera, int bodies, const body *of, double scale) {
    static const double origin[3] = {0, 0, 0};
    skg_geometry_part *parts = calloc((size_t)bodies, sizeof *parts);
    skg_contribution *weights = calloc((size_t)bodies, sizeof *weights);
    for (int b = 0; b < bodies; b++) {
        weights[b] = (skg_contribution){of[b].plane, of[b].weight, of[b].bias};
        parts[b] =
            (skg_geometry_part){.pose = of[b].pose,
                                .origin = origin,
                                .reference = middle_depth(camera, &of[b]),
                                .depth = 0.1, /* of the path: what is steep is nearly the same for all */
                                .columns = {0, (double)camera->columns},
                                .rows = {0, (double)camera->rows},
                                .contributions = 1,
                                .contribution = &weights[b]};
    }
    skg_status status = skg_geometry_weigh(context, geometry, camera, parts, scale);
    if (status == SKG_OK)
        status = skg_geometry_project(context, geometry, skg_raster_projection(raster), NULL);
    free(parts);
    free(weights);
    return status;
}

/* Sums of the copies in use, by the host. */
static skg_status read_sums(skg_context *context, const skg_raster *raster, int32_t bits, picture *result) {
    const skg_raster_layout *f = &raster->layout;
    const size_t count = (size_t)f->copies * (size_t)f->planes * (size_t)f->plane, bytes = (size_t)bits / 8;
    unsigned char *all = malloc(count * bytes);
    cl_int *used = malloc((size_t)f->copies * sizeof *used);
    cl_command_queue queue = context->device->queue;
    SKG_CL_TRY(
        clEnqueueReadBuffer(queue, raster->sums.memory, CL_TRUE, 0, count * bytes, all, 0, NULL, NULL));
    SKG_CL_TRY(clEnqueueReadBuffer(queue, raster->used.memory, CL_TRUE, 0, (size_t)f->copies * sizeof *used,
                                   used, 0, NULL, NULL));
    result->hash = 1469598103934665603u;
    for (int64_t n = 0; n < result->planes * result->rows * result->columns; n++) {
        const int64_t plane = n / (result->rows * result->columns), row = n / result->columns % result->rows;
        const int64_t place = plane * f->plane + row * f->stride + n % result->columns;
        uint64_t sum = 0;
        for (int64_t c = 0; c < f->copies; c++)
            if (SKG_COUNTS(used[c], plane)) {
                const int64_t at = c * f->planes * f->plane + place;
                sum += bits == 64 ? ((uint64_t *)all)[at] : (uint64_t)(int64_t)((int32_t *)all)[at];
            }
        result->sums[n] = bits == 64 ? sum : (uint64_t)(int64_t)(int32_t)(uint32_t)sum;
        result->hash = (result->hash ^ result->sums[n]) * 1099511628211u;
    }
    free(all);
    free(used);
    return SKG_OK;
}

/* Lengths of a plane are its exponents, with coefficient 1 for it and 0 for the others. */
static skg_status read_lengths(skg_context *context, skg_raster *raster, const skg_camera *camera,
                               double scale, picture *result) {
    const int64_t size = result->rows * result->columns;
    const int wide = context->device->info.double_precision;
    skg_buffer output = {0}, negative = {0};
    skg_attenuator *attenuator = NULL;
    float *narrow = calloc((size_t)size, sizeof *narrow);
    skg_status status = skg_attenuator_create(context, &attenuator);
    SKG_TRY_CLEANUP(skg_buffer_reserve(context, &output, size * 8, CL_MEM_READ_WRITE, "lengths"));
    SKG_TRY_CLEANUP(skg_buffer_reserve(context, &negative, 16, CL_MEM_READ_WRITE, "lengths"));
    for (int64_t plane = 0; plane < result->planes && status == SKG_OK; plane++) {
        double *values = result->values + plane * size, weight = 1, coefficients[16] = {0};
        const skg_image_place place = {
            .memory = output.memory, .output_double = wide, .row_stride = result->columns};
        skg_attenuation attenuation;
        coefficients[plane] = 1;
        const skg_attenuation of_plane = {.planes = (int32_t)result->planes,
                                          .nodes = 1,
                                          .channels = 1,
                                          .shown = SKG_SHOW_EXPONENT,
                                          .world_plane = -1};
        const skg_attenuation_tables tables = {.coefficients = coefficients, .weights = &weight};
        status = skg_attenuation_create(context, raster->options.kernels.precision, &of_plane, &tables,
                                        &attenuation);
        if (status == SKG_OK)
            status =
                skg_attenuate(attenuator, &(skg_sums){.raster = raster, .scale = scale, .fine = 1}, camera,
                              &attenuation, 1, 1, -HUGE_VAL, negative.memory, NULL, &place, NULL);
        skg_attenuation_release(&attenuation);
        if (status != SKG_OK) break;
        SKG_CL_CLEANUP(clEnqueueReadBuffer(context->device->queue, output.memory, CL_TRUE, 0,
                                           (size_t)size * (wide ? 8 : 4),
                                           wide ? (void *)values : (void *)narrow, 0, NULL, NULL));
        for (int64_t k = 0; k < size && !wide; k++) values[k] = (double)narrow[k];
    }
cleanup:
    skg_attenuator_release(&attenuator);
    skg_buffer_release(&output);
    skg_buffer_release(&negative);
    free(narrow);
    return status;
}

static skg_status read_bad_pixels(skg_context *context, skg_raster *raster, picture *result) {
    skg_buffer buffer = {0}, planes = {0};
    const cl_int plane = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(
        skg_buffer_reserve(context, &buffer, sizeof result->bad_pixels, CL_MEM_READ_WRITE, "verdict"));
    SKG_TRY_CLEANUP(skg_buffer_reserve(context, &planes, sizeof plane, CL_MEM_READ_ONLY, "planes"));
    SKG_CL_CLEANUP(clEnqueueWriteBuffer(context->device->queue, planes.memory, CL_TRUE, 0, sizeof plane,
                                        &plane, 0, NULL, NULL));
    SKG_TRY_CLEANUP(skg_raster_bad_pixels(raster, 1, planes.memory, 0, buffer.memory, NULL));
    SKG_CL_CLEANUP(clEnqueueReadBuffer(context->device->queue, buffer.memory, CL_TRUE, 0,
                                       sizeof result->bad_pixels, result->bad_pixels, 0, NULL, NULL));
cleanup:
    skg_buffer_release(&buffer);
    skg_buffer_release(&planes);
    return status;
}

skg_status picture_take(skg_context *context, const skg_raster_options *options, const skg_view *view,
                        int bodies, const body *of, double scale, picture *result) {
    skg_geometry geometry = {0};
    skg_raster *raster = NULL;
    skg_camera camera;
    skg_raster_options with_size = *options;
    skg_status status = SKG_OK;
    *result = (picture){.columns = view->columns, .rows = view->rows, .planes = options->planes};
    const size_t count = (size_t)(result->planes * result->columns * result->rows);
    result->values = calloc(count, sizeof *result->values);
    result->sums = calloc(count, sizeof *result->sums);
    with_size.columns = view->columns;
    with_size.rows = view->rows;
    SKG_TRY_CLEANUP(make_geometry(context, options->kernels.precision, bodies, of, &geometry));
    with_size.triangles = geometry.triangles;
    SKG_TRY_CLEANUP(skg_camera_make(view, NULL, 0, 0, &camera));
    SKG_TRY_CLEANUP(skg_raster_create(context, &with_size, &raster));
    SKG_TRY_CLEANUP(project(context, &geometry, raster, &camera, bodies, of, scale));
    SKG_TRY_CLEANUP(skg_raster_run(raster, &geometry, NULL, NULL));
    SKG_TRY_CLEANUP(read_lengths(context, raster, &camera, scale, result));
    SKG_TRY_CLEANUP(read_bad_pixels(context, raster, result));
    SKG_TRY_CLEANUP(read_sums(context, raster, options->kernels.bits, result));
    SKG_CL_CLEANUP(clEnqueueReadBuffer(context->device->queue, geometry.bad.memory, CL_TRUE, 0,
                                       sizeof result->bad, &result->bad, 0, NULL, NULL));
cleanup:
    skg_raster_release(&raster);
    skg_geometry_release(&geometry);
    return status;
}
