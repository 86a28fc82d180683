#include "stage/attenuate.h"

#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Kernels of one context's plan: by precision of sums, of the output, planes, channels and what is shown. */
enum { MOST_KERNELS = 16 };

/* Vectors of a work-item. One energy at 512 x 512 on two cores: 0.25 ms with 1, 0.18 ms with 4. */
enum { RUNS = 4 };

typedef struct {
    skg_kernel_options options;
    int32_t planes, channels, shown, world, ratio, falloff, noise, output_double, add, ranged, energies,
        mixed;
} kernel_key;

struct skg_attenuator {
    skg_context *context;
    int32_t count, next;
    kernel_key keys[MOST_KERNELS];
    cl_kernel kernels[MOST_KERNELS];
};

static skg_status upload(skg_context *context, int32_t is_double, int64_t count, const double *numbers,
                         skg_buffer *buffer) {
    if (is_double)
        return skg_buffer_write(context, buffer, count * (int64_t)sizeof *numbers, numbers, "attenuation");
    float *rounded = NULL;
    SKG_TRY(skg_alloc(count, sizeof *rounded, "attenuation", &rounded));
    for (int64_t i = 0; i < count; i++) rounded[i] = (float)numbers[i];
    skg_status status =
        skg_buffer_write(context, buffer, count * (int64_t)sizeof *rounded, rounded, "attenuation");
    skg_free(&rounded);
    return status;
}

skg_status skg_attenuation_create(skg_context *context, int32_t precision, const skg_attenuation *shape,
                                  const skg_attenuation_tables *tables, skg_attenuation *attenuation) {
    const int32_t is_double = precision == SKG_PRECISION_DOUBLE;
    const int64_t count = (int64_t)shape->nodes * shape->planes;
    double *scaled = NULL;
    SKG_TRY(skg_alloc(count, sizeof *scaled, "attenuation", &scaled));
    /* exp(-x) = 2^(-x log2 e) */
    for (int64_t i = 0; i < count; i++)
        scaled[i] = tables->coefficients[i] * (shape->shown == SKG_SHOWN_EXPONENT ? 1 : -1.4426950408889634);
    *attenuation = *shape;
    skg_status status = upload(context, is_double, count, scaled, &attenuation->coefficients);
    skg_free(&scaled);
    SKG_TRY(status);
    const int64_t weighted = (int64_t)shape->nodes * shape->channels;
    if (shape->noise)
        SKG_TRY(upload(context, is_double, weighted, tables->variances, &attenuation->variances));
    if (tables->range)
        SKG_TRY(upload(context, is_double, 2 * (int64_t)shape->planes, tables->range, &attenuation->range));
    return upload(context, is_double, weighted, tables->weights, &attenuation->weights);
}

void skg_attenuation_release(skg_attenuation *attenuation) {
    skg_buffer_release(&attenuation->coefficients);
    skg_buffer_release(&attenuation->weights);
    skg_buffer_release(&attenuation->variances);
    skg_buffer_release(&attenuation->range);
}

skg_status skg_attenuator_create(skg_context *context, skg_attenuator **attenuator) {
    SKG_TRY(skg_alloc(1, sizeof **attenuator, "attenuation", attenuator));
    (*attenuator)->context = context;
    return SKG_OK;
}

void skg_attenuator_release(skg_attenuator **attenuator) {
    if (!*attenuator) return;
    for (int32_t i = 0; i < (*attenuator)->count; i++) clReleaseKernel((*attenuator)->kernels[i]);
    skg_free(attenuator);
}

static skg_status get_program(const skg_attenuator *attenuator, const kernel_key *key, cl_program *program) {
    static const char *const quiet[] = {"exponential.clh", "attenuate.cl"};
    static const char *const noisy[] = {"exponential.clh", "random.clh", "noise.clh", "attenuate.cl"};
    char more[320];
    snprintf(
        more, sizeof more,
        "-D SKG_PLANES=%d -D SKG_CHANNELS=%d -D SKG_SHOW=%d -D SKG_WORLD=%d -D SKG_RATIO=%d -D SKG_FALLOFF=%d "
        "-D SKG_NOISE=%d -D SKG_OUTPUT_DOUBLE=%d -D SKG_ADD=%d -D SKG_RUNS=%d -D SKG_RANGED=%d -D SKG_SUMS=%d%s",
        (int)key->planes, (int)key->channels, (int)key->shown, (int)key->world, (int)key->ratio,
        (int)key->falloff, (int)key->noise, (int)key->output_double, (int)key->add, RUNS, (int)key->ranged,
        (int)key->mixed, key->energies ? " -D SKG_HALF_UNIT=0.001f" : "");
    return skg_kernels_get(attenuator->context, &key->options, key->noise ? 4 : 2, key->noise ? noisy : quiet,
                           more, program);
}

static skg_status get_kernel(skg_attenuator *attenuator, const kernel_key *key, cl_kernel *kernel) {
    cl_program program = NULL;
    for (int32_t i = 0; i < attenuator->count; i++)
        if (memcmp(&attenuator->keys[i], key, sizeof *key) == 0) {
            *kernel = attenuator->kernels[i];
            return SKG_OK;
        }
    SKG_TRY(get_program(attenuator, key, &program));
    SKG_TRY(skg_kernel_create(program, "skg_attenuate", kernel));
    /* Full: the oldest goes; its program stays with the context. */
    const int32_t slot = attenuator->count < MOST_KERNELS ? attenuator->count++ : attenuator->next;
    if (attenuator->kernels[slot]) clReleaseKernel(attenuator->kernels[slot]);
    attenuator->next = (slot + 1) % MOST_KERNELS;
    attenuator->keys[slot] = *key;
    attenuator->kernels[slot] = *kernel;
    return SKG_OK;
}

static size_t padded(int64_t items, int64_t group) {
    return (size_t)((items + group - 1) / group * group);
}

/* Arguments that do not depend on the precision, from `output` on. */
static skg_status set_place(cl_kernel kernel, const skg_image_place *place) {
    const cl_long offset = place->offset, row = place->row_stride, channel = place->channel_stride;
    SKG_TRY(skg_kernel_set(kernel, 10, sizeof place->memory, &place->memory));
    SKG_TRY(skg_kernel_set(kernel, 11, sizeof offset, &offset));
    SKG_TRY(skg_kernel_set(kernel, 12, sizeof row, &row));
    return skg_kernel_set(kernel, 13, sizeof channel, &channel);
}

/* Arguments from `first` on of effects that are there: world, falloff, noise, range. */
static skg_status set_effects(cl_kernel kernel, cl_uint first, const kernel_key *key,
                              const skg_camera *camera, const skg_attenuation *attenuation,
                              const skg_noise_args *noise, double photons) {
    const int single = key->options.precision == SKG_PRECISION_SINGLE;
    if (key->world) {
        /* |ray| times path: the whole ray of a point source; with a parallel beam, whose |ray| is 1 mm, from
         * the start. */
        const double way[4] = {attenuation->world_weight, camera->parallel ? 1 - camera->start[0] : 1,
                               -camera->start[1], -camera->start[2]};
        const cl_int plane = attenuation->world_plane;
        cl_float4 way_single;
        for (int k = 0; k < 4; k++) way_single.s[k] = (float)way[k];
        SKG_TRY(skg_kernel_set(kernel, first++, sizeof plane, &plane));
        SKG_TRY(skg_kernel_set(kernel, first++, single ? sizeof way_single : sizeof way,
                               single ? (const void *)&way_single : (const void *)way));
    }
    if (key->falloff) {
        const double nearest = skg_camera_nearest_ray(camera);
        const float nearest_single = (float)nearest;
        SKG_TRY(skg_kernel_set(kernel, first++, single ? sizeof nearest_single : sizeof nearest,
                               single ? (const void *)&nearest_single : (const void *)&nearest));
    }
    if (key->noise) {
        const float photons_single = (float)photons;
        SKG_TRY(skg_kernel_set_memory(kernel, first++, 1, &attenuation->variances.memory));
        SKG_TRY(skg_kernel_set(kernel, first++, sizeof *noise, noise));
        SKG_TRY(skg_kernel_set(kernel, first++, single ? sizeof photons_single : sizeof photons,
                               single ? (const void *)&photons_single : (const void *)&photons));
    }
    if (key->ranged)
        return skg_kernel_set(kernel, first, sizeof attenuation->range.memory, &attenuation->range.memory);
    return SKG_OK;
}

static kernel_key key_of(const skg_raster *raster, const skg_camera *camera,
                         const skg_attenuation *attenuation, const skg_image_place *place, int32_t mixed) {
    /* Of the raster's abilities only the type of its sums is of interest here. */
    return (kernel_key){.options = {.precision = raster->options.kernels.precision,
                                    .bits = raster->options.kernels.bits,
                                    .half = raster->options.kernels.half},
                        .planes = attenuation->planes,
                        .channels = attenuation->channels,
                        .shown = attenuation->shown,
                        .world = attenuation->world_plane >= 0,
                        .ratio = attenuation->ratio,
                        .falloff = attenuation->falloff && !camera->parallel,
                        .noise = attenuation->noise,
                        .output_double = place->output_double,
                        .energies = raster->options.kernels.half && attenuation->energies,
                        .add = place->add,
                        .mixed = mixed,
                        .ranged = attenuation->range.memory != NULL};
}

skg_status skg_attenuate(skg_attenuator *attenuator, const skg_sums *sums, const skg_camera *camera,
                         const skg_attenuation *attenuation, double factor, double least, cl_mem negative,
                         const skg_noise_args *noise, const skg_image_place *place, skg_stage_log *log) {
    const skg_raster *raster = sums->raster;
    const kernel_key key = key_of(raster, camera, attenuation, place, sums->mixed);
    const int single = key.options.precision == SKG_PRECISION_SINGLE;
    /* As the kernel counts: powers of two above a limit. */
    const double limit = -least * (attenuation->shown == SKG_SHOWN_EXPONENT ? 1 : 1.4426950408889634);
    const float factor_single = (float)factor, limit_single = (float)limit;
    cl_kernel kernel = NULL;
    skg_ray_double ray;
    skg_ray_float ray_single;
    SKG_TRY(get_kernel(attenuator, &key, &kernel));
    skg_camera_rays(camera, sums->scale, &ray);
    skg_rays_round(&ray, &ray_single);
    SKG_TRY(skg_kernel_set(kernel, 0, sizeof raster->frame, &raster->frame));
    SKG_TRY(skg_kernel_set(kernel, 1, single ? sizeof ray_single : sizeof ray,
                           single ? (const void *)&ray_single : (const void *)&ray));
    SKG_TRY(skg_kernel_set_memory(kernel, 2, 2, (cl_mem[]){raster->sums.memory, raster->used.memory}));
    SKG_TRY(skg_kernel_set(kernel, 4, sizeof attenuation->nodes, &attenuation->nodes));
    SKG_TRY(skg_kernel_set_memory(kernel, 5, 2,
                                  (cl_mem[]){attenuation->coefficients.memory, attenuation->weights.memory}));
    SKG_TRY(skg_kernel_set(kernel, 7, single ? sizeof factor_single : sizeof factor,
                           single ? (const void *)&factor_single : (const void *)&factor));
    SKG_TRY(skg_kernel_set(kernel, 8, single ? sizeof limit_single : sizeof limit,
                           single ? (const void *)&limit_single : (const void *)&limit));
    SKG_TRY(skg_kernel_set(kernel, 9, sizeof negative, &negative));
    SKG_TRY(set_place(kernel, place));
    if (sums->mixed) SKG_TRY(skg_kernel_set(kernel, 14, sizeof sums->lists, &sums->lists));
    SKG_TRY(set_effects(kernel, sums->mixed ? 15 : 14, &key, camera, attenuation, noise,
                        SKG_FEW_PHOTONS * factor));
    const int64_t lanes = skg_kernel_lanes(raster->context, key.options.precision) * RUNS;
    const size_t local[2] = {8, 16}; /* large groups: PoCL takes some 20 ns for each */
    const size_t global[2] = {padded((raster->frame.columns + lanes - 1) / lanes, 8),
                              padded(raster->frame.rows, 16)};
    return skg_kernel_run(raster->context, kernel, "attenuate", 2, global, local, log);
}

skg_status skg_attenuate_open(skg_attenuator *attenuator, const skg_sums *sums, const skg_camera *camera,
                              const skg_attenuation *attenuation, double factor, cl_mem negative,
                              const skg_image_place *place, skg_stage_log *log) {
    skg_raster nothing = *sums->raster;
    skg_sums no_sums = *sums;
    skg_attenuation quiet = *attenuation;
    nothing.frame.copies = 0; /* sums over no copies are 0 */
    no_sums.raster = &nothing;
    quiet.noise = 0;
    quiet.range = (skg_buffer){0};
    return skg_attenuate(attenuator, &no_sums, camera, &quiet, factor, -HUGE_VAL, negative, NULL, place, log);
}

skg_status skg_attenuate_logarithm(skg_attenuator *attenuator, const skg_raster *raster,
                                   const skg_attenuation *attenuation, const skg_image_place *place,
                                   skg_stage_log *log) {
    const cl_int size[3] = {raster->frame.columns, raster->frame.rows, attenuation->channels};
    const cl_long offset = place->offset, row = place->row_stride, channel = place->channel_stride;
    const skg_camera no_camera = {0};
    const kernel_key key = key_of(raster, &no_camera, attenuation, place, 0);
    cl_program program = NULL;
    cl_kernel kernel = NULL;
    skg_status status = SKG_OK;
    SKG_TRY(get_program(attenuator, &key, &program));
    SKG_TRY(skg_kernel_create(program, "skg_logarithm", &kernel));
    for (cl_uint k = 0; k < 3; k++) SKG_TRY_CLEANUP(skg_kernel_set(kernel, k, sizeof size[k], &size[k]));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 3, sizeof place->memory, &place->memory));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 4, sizeof offset, &offset));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 5, sizeof row, &row));
    SKG_TRY_CLEANUP(skg_kernel_set(kernel, 6, sizeof channel, &channel));
    const int64_t lanes = skg_kernel_lanes(raster->context, key.options.precision);
    const size_t local[2] = {8, 16};
    const size_t global[2] = {padded((size[0] + lanes - 1) / lanes, 8), padded(size[1], 16)};
    status = skg_kernel_run(raster->context, kernel, "logarithm", 2, global, local, log);
cleanup:
    clReleaseKernel(kernel);
    return status;
}
