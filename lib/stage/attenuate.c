/* From path lengths to intensities: the kernels of attenuate.cl, their options and arguments. */
#include "stage/attenuate.h"
#include "core/maths.h"
#include "stage/raster_private.h"

#include <skiagraph/plan.h>

#include <math.h>
#include <string.h>

/* How many kernels an attenuator keeps. */
enum { KERNELS_MAX = 16 };

/* A work-item attenuates `runs` vectors of pixels together, `strip` times. A GPU hides latency by the former; a CPU has less
 * to compile by the latter. The rays of a pixel of the image belong to the same runs. */
typedef struct {
    int runs, strip;
    int64_t group[2];
} work_shape;

static work_shape shape_of(const skg_context *context, int32_t fine) {
    static const work_shape gpu = {4, 1, {8, 16}}, cpu = {SKG_CPU_RUNS, SKG_CPU_STRIP, {1, 16}};
    work_shape shape = context->device->info.gpu ? gpu : cpu;
    if (fine > 2) shape.runs = fine;
    return shape;
}

/* The -D names of the program: X(name, value, value in the program of skg_kernels_get_first). Everything that tells programs of
 * this stage apart stands here and in the options of its kernels. */
#define DEFINES(X)                                                                                           \
    X(PLANES, planes_of(attenuation), 1)                                                                     \
    X(CHANNELS, attenuation->channels, 1)                                                                    \
    X(OUTPUT_DOUBLE, place->output_double, 0)                                                                \
    X(RUNS, shape.runs, SKG_CPU_RUNS)                                                                        \
    X(STRIP, shape.strip, SKG_CPU_STRIP)                                                                     \
    X(FINE, sums->fine, 1)                                                                                   \
    X(GENERAL, is_general(attenuation), 0)                                                                   \
    X(PLAIN, is_plain(attenuation), 0)
#define DEFINE_NUMBER(name, value, first) DEFINE_##name,
#define DEFINE(name, value, first) {"SKG_" #name, value},
#define DEFINE_FIRST(name, value, first) {"SKG_" #name, first},
enum { DEFINES(DEFINE_NUMBER) DEFINE_COUNT };

typedef struct {
    skg_kernel_options options;
    skg_define defines[DEFINE_COUNT];
} kernel_key;

struct skg_attenuator {
    skg_context *context;
    int32_t count, next;
    kernel_key keys[KERNELS_MAX];
    cl_kernel kernels[KERNELS_MAX];
    skg_buffer lines; /* of a curved detector, and behind them the tables of shades */
    double *sent;     /* the numbers that `lines` holds; NULL: none */
    int64_t sent_count;
};

/* Whether a general program is needed (kernels/attenuation/planes.clh), and the planes that a program has memory for. */
static int is_general(const skg_attenuation *attenuation) {
    return attenuation->planes > SKG_FEW_PLANES || skg_attenuation_shades(attenuation) > 0 ||
           attenuation->noise;
}

/* Whether a program is worth its compilation that has constants for what is shown (kernels/attenuation/planes.clh). Images of one plane
 * are quick, and share the program of path lengths. */
static int is_plain(const skg_attenuation *attenuation) {
    return !is_general(attenuation) && attenuation->planes > 1 && attenuation->shown == SKG_SHOW_INTENSITY &&
           attenuation->world_plane < 0 && !attenuation->ratio && !attenuation->falloff &&
           !attenuation->collimated;
}

static int64_t planes_of(const skg_attenuation *attenuation) {
    return is_general(attenuation) ? skg_round_up(attenuation->planes, SKG_PLANES_STEP) : attenuation->planes;
}

skg_status skg_attenuator_create(skg_context *context, skg_attenuator **attenuator) {
    SKG_TRY(skg_alloc(1, sizeof **attenuator, "attenuation", attenuator));
    (*attenuator)->context = context;
    return SKG_OK;
}

void skg_attenuator_release(skg_attenuator **attenuator) {
    if (!*attenuator) return;
    for (int32_t i = 0; i < (*attenuator)->count; i++) clReleaseKernel((*attenuator)->kernels[i]);
    skg_buffer_release(&(*attenuator)->lines);
    skg_free(&(*attenuator)->sent);
    skg_free(attenuator);
}

static int is_same(const kernel_key *a, const kernel_key *b) {
    for (int d = 0; d < DEFINE_COUNT; d++)
        if (a->defines[d].value != b->defines[d].value) return 0;
    return memcmp(&a->options, &b->options, sizeof a->options) == 0;
}

/* Whether the kernel is in the program of skg_kernels_get_first. Other rasters than that of this program share it. */
static int is_first(const skg_attenuator *attenuator, const kernel_key *key) {
    const kernel_key first = {.options = key->options, .defines = {DEFINES(DEFINE_FIRST)}};
    return is_same(key, &first) && skg_kernels_are_first(attenuator->context, &key->options);
}

enum { GENERAL = 1, WEIGHED = 2 };

/* weighed: 0, or with the kernel skg_weights: its option SKG_WEIGHED. */
static skg_status get_files(const skg_attenuator *attenuator, const kernel_key *key, int64_t weighed,
                            cl_program *program) {
    static const struct {
        const char *name;
        int of; /* GENERAL: noise and shades; WEIGHED: weights; 0: any */
    } all[] = {{"exponential.clh", 0},  {"random.clh", GENERAL}, {"noise.clh", GENERAL},
               {"shades.clh", GENERAL}, {"planes.clh", 0},       {"quantum.clh", GENERAL},
               {"attenuate.cl", 0},     {"weights.cl", WEIGHED}};
    enum { FILES = sizeof all / sizeof *all };
    skg_define defines[DEFINE_COUNT + 1];
    const char *files[FILES];
    int count = 0;
    const int has = (key->defines[DEFINE_GENERAL].value ? GENERAL : 0) | (weighed ? WEIGHED : 0);
    for (int f = 0; f < FILES; f++)
        if ((all[f].of & has) == all[f].of) files[count++] = all[f].name;
    if (weighed == 0)
        return skg_kernels_get(attenuator->context, &key->options, count, files, SKG_DEFINES(key->defines),
                               program);
    memcpy(defines, key->defines, sizeof key->defines);
    defines[DEFINE_COUNT] = (skg_define){"SKG_WEIGHED", weighed};
    return skg_kernels_get(attenuator->context, &key->options, count, files, SKG_DEFINES(defines), program);
}

static skg_status get_program(const skg_attenuator *attenuator, const kernel_key *key, cl_program *program) {
    if (is_first(attenuator, key)) return skg_kernels_get_first(attenuator->context, program);
    return get_files(attenuator, key, 0, program);
}

static skg_status get_kernel(skg_attenuator *attenuator, const kernel_key *key, cl_kernel *kernel) {
    cl_program program = NULL;
    for (int32_t i = 0; i < attenuator->count; i++)
        if (is_same(&attenuator->keys[i], key)) {
            *kernel = attenuator->kernels[i];
            return SKG_OK;
        }
    SKG_TRY(get_program(attenuator, key, &program));
    SKG_TRY(skg_kernel_create(program, "skg_attenuate", kernel));
    /* When all places are taken the oldest kernel goes; its program stays with the context. */
    const int32_t slot = attenuator->count < KERNELS_MAX ? attenuator->count++ : attenuator->next;
    if (attenuator->kernels[slot]) clReleaseKernel(attenuator->kernels[slot]);
    attenuator->next = (slot + 1) % KERNELS_MAX;
    attenuator->keys[slot] = *key;
    attenuator->kernels[slot] = *kernel;
    return SKG_OK;
}

/* Weight of the world's plane, then the length of a ray's path through the world over |ray|: 1 for a point source; for a parallel beam,
 * whose |ray| is 1 mm, the length behind the start, linear in column and row. */
static void find_world(const skg_camera *camera, const skg_attenuation *attenuation, double world[4]) {
    world[0] = attenuation->world_weight;
    world[1] = camera->parallel ? 1 - camera->start[0] : 1;
    world[2] = -camera->start[1];
    world[3] = -camera->start[2];
}

static kernel_key key_of(const skg_sums *sums, const skg_attenuation *attenuation,
                         const skg_image_place *place) {
    /* Of the raster's options only the type of its sums changes this kernel; the others stay 0, so that rasters which differ
 * elsewhere share a kernel. */
    const skg_raster *raster = sums->raster;
    const work_shape shape = shape_of(raster->context, sums->fine);
    return (kernel_key){.options = {.precision = raster->options.kernels.precision,
                                    .bits = raster->options.kernels.bits,
                                    .half = raster->options.kernels.half,
                                    .curved = raster->options.kernels.curved},
                        .defines = {DEFINES(DEFINE)}};
}

skg_status skg_attenuate_prefetch(const skg_attenuator *attenuator, const skg_raster_options *options,
                                  const skg_sums *sums, const skg_attenuation *attenuation,
                                  const skg_image_place *place) {
    const skg_raster raster = {.context = attenuator->context, .options = *options};
    skg_sums own = *sums;
    own.raster = &raster;
    const kernel_key key = key_of(&own, attenuation, place);
    return get_program(attenuator, &key, NULL);
}

/* The work-items that the pixels of a raster need. */
static skg_work_size work_of(const skg_sums *sums, int32_t precision) {
    const skg_raster *raster = sums->raster;
    const work_shape shape = shape_of(raster->context, sums->fine);
    const int64_t pixels = skg_kernel_lanes(raster->context, precision) * shape.runs * shape.strip;
    return (skg_work_size){2,
                           {(raster->layout.columns + pixels - 1) / pixels, raster->layout.rows / sums->fine},
                           {shape.group[0], shape.group[1]}};
}

/* The image that the pixels of a raster make: of a curved detector, the raster's rows are its columns. */
static skg_image_args image_of(const skg_sums *sums, int64_t channels, const skg_image_place *place) {
    const skg_raster_layout *layout = &sums->raster->layout;
    const int curved = sums->raster->options.kernels.curved;
    const int64_t columns = layout->columns / sums->fine, rows = layout->rows / sums->fine;
    return skg_image_of(place, curved ? rows : columns, curved ? columns : rows, channels);
}

/* The scalar arguments that do not depend on the caller's factor and share. */
static skg_attenuate_double scalars_of(const skg_sums *sums, const skg_camera *camera,
                                       const skg_attenuation *attenuation, const skg_image_place *place) {
    const int32_t falloff = attenuation->falloff && !camera->parallel;
    skg_attenuate_double args = {
        .foot = falloff ? skg_camera_foot(camera) : 0,
        .layout = sums->raster->layout,
        .planes = attenuation->planes,
        .sums = sums->mixed,
        .nodes = attenuation->nodes,
        .world_plane = attenuation->world_plane,
        .shown = attenuation->shown,
        .ratio = attenuation->ratio,
        .falloff = falloff,
        .energies = attenuation->energies,
        .add = place->add,
        .ranged = attenuation->range.memory != NULL,
        .noise = !attenuation->noise  ? 0
                 : attenuation->apart ? SKG_NOISE_APART
                                      : SKG_NOISE_DRAWN,
        .collimated = attenuation->collimated,
        .image = image_of(sums, attenuation->channels, place),
    };
    for (int k = 0; k < 4; k++) args.window[k] = attenuation->window[k];
    args.layout.first_plane = sums->pass * args.layout.planes;
    skg_camera_rays(camera, sums->scale, &args.ray);
    find_world(camera, attenuation, args.world);
    if (skg_attenuation_shades(attenuation)) skg_shades_see(attenuation->shades, camera, &args.shades);
    return args;
}

/* Gives the device the lines of a curved detector and the tables of shades, where they differ from those it has. tables: the buffer
 * of the kernel. */
static skg_status send_lines(skg_attenuator *attenuator, const skg_camera *camera, int32_t is_double,
                             const skg_attenuation *attenuation, cl_mem *tables) {
    *tables = attenuation->tables.memory;
    if (!skg_camera_is_curved(camera)) return SKG_OK;
    const int64_t lines = SKG_LINES_SIZE(camera->rows);
    const int64_t shades = skg_attenuation_shades(attenuation) ? attenuation->shades->table_count : 0;
    double *made = NULL;
    SKG_TRY(skg_alloc(lines + shades, sizeof *made, "attenuation", &made));
    skg_bends_table(camera, 1, made);
    if (shades) memcpy(made + lines, attenuation->shades->tables, (size_t)shades * sizeof *made);
    skg_status status = SKG_OK;
    if (attenuator->sent_count != lines + shades ||
        memcmp(made, attenuator->sent, (size_t)(lines + shades) * sizeof *made) != 0)
        status =
            skg_attenuation_upload(attenuator->context, is_double, lines + shades, made, &attenuator->lines);
    skg_free(&attenuator->sent);
    attenuator->sent = made;
    attenuator->sent_count = status == SKG_OK ? lines + shades : 0;
    *tables = attenuator->lines.memory;
    return status;
}

skg_status skg_attenuate(skg_attenuator *attenuator, const skg_sums *sums, const skg_camera *camera,
                         const skg_attenuation *attenuation, double factor, double share, double least,
                         cl_mem negative, const skg_noise_args *noise, const skg_image_place *place,
                         skg_stage_log *log) {
    const skg_raster *raster = sums->raster;
    const kernel_key key = key_of(sums, attenuation, place);
    const int is_double = key.options.precision == SKG_PRECISION_DOUBLE;
    skg_attenuate_double args = scalars_of(sums, camera, attenuation, place);
    skg_attenuate_float rounded;
    cl_kernel kernel = NULL;
    /* The kernel compares with this limit what it computes: exponents if these are shown, else powers of two. */
    args.limit = -least * (attenuation->shown == SKG_SHOW_EXPONENT ? 1 : SKG_LOG2_E);
    args.factor = factor;
    args.photons = SKG_FEW_PHOTONS * share;
    if (noise) args.key = *noise;
    SKG_ROUND_ARGUMENTS(args, rounded, shades.rows);
    SKG_TRY(get_kernel(attenuator, &key, &kernel));
    cl_mem tables = NULL;
    SKG_TRY(send_lines(attenuator, camera, is_double, attenuation, &tables));
    const skg_argument arguments[] = {
        SKG_ARGUMENT_WITH(ATTENUATE, args, is_double, args, rounded),
        SKG_ARGUMENT(ATTENUATE, copies, raster->sums.memory),
        SKG_ARGUMENT(ATTENUATE, used, raster->used.memory),
        SKG_ARGUMENT(ATTENUATE, coefficients, attenuation->coefficients.memory),
        SKG_ARGUMENT(ATTENUATE, weights, attenuation->weights.memory),
        SKG_ARGUMENT(ATTENUATE, variances, attenuation->variances.memory),
        SKG_ARGUMENT(ATTENUATE, lists, sums->lists),
        SKG_ARGUMENT(ATTENUATE, range, attenuation->range.memory),
        SKG_ARGUMENT(ATTENUATE, polynomials, attenuation->polynomials.memory),
        SKG_ARGUMENT(ATTENUATE, tables, tables),
        SKG_ARGUMENT(ATTENUATE, negative, negative),
        SKG_ARGUMENT(ATTENUATE, output, place->memory),
    };
    const skg_work_size work = work_of(sums, key.options.precision);
    return SKG_LAUNCH(raster->context, kernel, "attenuate", &work, arguments, log);
}

skg_weight_layout skg_attenuate_weight_layout(const skg_raster *raster, int32_t fine) {
    const int64_t run = shape_of(raster->context, fine).runs *
                        skg_kernel_lanes(raster->context, raster->options.kernels.precision);
    const int64_t stride = skg_round_up(raster->layout.columns, run);
    const skg_work_size work =
        work_of(&(skg_sums){.raster = raster, .fine = fine}, raster->options.kernels.precision);
    return (skg_weight_layout){.planes = raster->layout.planes,
                               .stride = stride,
                               .plane = stride * raster->layout.rows,
                               .items = work.items[0] * work.items[1]};
}

/* The planes of accumulators that a program of skg_weights has memory for: a power of two, so that few programs serve all scenes. */
static int64_t weighed_of(const skg_sums *sums, const skg_attenuation *attenuation) {
    const int32_t needed =
        sums->mixed ? sums->mixed : attenuation->planes - skg_attenuation_shades(attenuation);
    int64_t weighed = 4;
    while (weighed < needed) weighed *= 2;
    return weighed;
}

skg_status skg_attenuate_transpose(skg_attenuator *attenuator, const skg_sums *sums, const skg_camera *camera,
                                   const skg_attenuation *attenuation, const skg_transposition *asked,
                                   skg_stage_log *log) {
    const skg_raster *raster = sums->raster;
    const skg_weight_layout layout = skg_attenuate_weight_layout(raster, sums->fine);
    const skg_image_place place = {.row_stride = layout.stride, .channel_stride = layout.plane};
    skg_attenuation mean = *attenuation;
    mean.noise = 0;
    mean.range = (skg_buffer){0};
    kernel_key key = key_of(sums, &mean, &place);
    key.defines[DEFINE_PLAIN].value = 0; /* one program serves all that is shown */
    const int is_double = key.options.precision == SKG_PRECISION_DOUBLE;
    skg_attenuate_double args = scalars_of(sums, camera, &mean, &place);
    skg_attenuate_float rounded;
    const cl_int channel = asked->channel, rays = asked->rays, of_planes = asked->of_planes,
                 relative = asked->relative;
    cl_program program = NULL;
    args.factor = asked->factor;
    SKG_ROUND_ARGUMENTS(args, rounded, shades.rows);
    SKG_TRY(get_files(attenuator, &key, weighed_of(sums, &mean), &program));
    const skg_argument arguments[] = {
        SKG_ARGUMENT_WITH(WEIGHTS, args, is_double, args, rounded),
        SKG_ARGUMENT(WEIGHTS, copies, raster->sums.memory),
        SKG_ARGUMENT(WEIGHTS, used, raster->used.memory),
        SKG_ARGUMENT(WEIGHTS, coefficients, mean.coefficients.memory),
        SKG_ARGUMENT(WEIGHTS, weights_of_nodes, mean.weights.memory),
        SKG_ARGUMENT(WEIGHTS, lists, sums->lists),
        SKG_ARGUMENT(WEIGHTS, polynomials, mean.polynomials.memory),
        SKG_ARGUMENT(WEIGHTS, tables, mean.tables.memory),
        SKG_ARGUMENT(WEIGHTS, adjoint, asked->adjoint),
        SKG_ARGUMENT(WEIGHTS, channel, channel),
        SKG_ARGUMENT(WEIGHTS, wanted, asked->wanted),
        SKG_ARGUMENT(WEIGHTS, rays, rays),
        SKG_ARGUMENT(WEIGHTS, of_planes, of_planes),
        SKG_ARGUMENT(WEIGHTS, relative, relative),
        SKG_ARGUMENT(WEIGHTS, weights, asked->weights),
        SKG_ARGUMENT(WEIGHTS, most, asked->most),
        SKG_ARGUMENT(WEIGHTS, of_rays, asked->of_rays),
    };
    const skg_work_size work = work_of(sums, key.options.precision);
    return SKG_LAUNCH_ONCE(raster->context, program, "skg_weights", "weights", &work, arguments, log);
}

skg_status skg_attenuate_flat_field(skg_attenuator *attenuator, const skg_sums *sums,
                                    const skg_camera *camera, const skg_attenuation *attenuation,
                                    double factor, cl_mem negative, const skg_image_place *place,
                                    skg_stage_log *log) {
    skg_raster nothing = *sums->raster;
    skg_sums no_sums = *sums;
    skg_attenuation quiet = *attenuation;
    nothing.layout.copies = 0; /* sums over no copies are 0 */
    no_sums.raster = &nothing;
    quiet.noise = 0;
    quiet.collimated = 0; /* ratios are to the flat field without jaws */
    quiet.range = (skg_buffer){0};
    return skg_attenuate(attenuator, &no_sums, camera, &quiet, factor, 1, -HUGE_VAL, negative, NULL, place,
                         log);
}

skg_status skg_attenuate_logarithm(skg_attenuator *attenuator, const skg_sums *sums,
                                   const skg_attenuation *attenuation, const skg_image_place *place,
                                   skg_stage_log *log) {
    const skg_image_args image = image_of(sums, attenuation->channels / attenuation->layers, place);
    const int64_t columns = image.columns, rows = image.rows;
    const skg_argument arguments[] = {
        SKG_ARGUMENT(LOGARITHM, image, image),
        SKG_ARGUMENT(LOGARITHM, output, place->memory),
    };
    const skg_sums plain = {.raster = sums->raster, .fine = 1}; /* the image is finished */
    const kernel_key key = key_of(&plain, attenuation, place);
    cl_program program = NULL;
    SKG_TRY(get_program(attenuator, &key, &program));
    const int64_t lanes = skg_kernel_lanes(attenuator->context, key.options.precision);
    const skg_work_size work = {2, {(columns + lanes - 1) / lanes, rows}, {8, 16}};
    return SKG_LAUNCH_ONCE(attenuator->context, program, "skg_logarithm", "logarithm", &work, arguments, log);
}
