/* Runs histories of photons on the device. */
#include "scatter/tracing.h"

#include "core/clock.h"
#include "core/maths.h"
#include "plan/decisions.h"
#include "scatter/interactions.h"

#include <math.h>
#include <string.h>

/* Sums are whole multiples of this share of the largest signal. */
static const double UNIT = 0x1p-36;

/* A launch takes about this long, s: drivers of screens give up after some seconds. */
static const double LAUNCH_S = 0.3;

/* Places along the longer side of the detector. */
enum { PLACES = 32 };

/* The first coordinates of exod2_base2_m20_CKN, a lattice whose first 2^m points are good for every m (R. Cools, F. Y. Kuo and
 * D. Nuyens, Constructing embedded lattice rules for multivariate integration, SIAM Journal on Scientific Computing 28 (2006)
 * 2162-2188). */
static const uint32_t LATTICE[SKG_SCATTER_DIMENSIONS] = {1,      182667, 469891, 498753, 110745, 446247,
                                                         250185, 118627, 245333, 283199, 408519, 391023,
                                                         246327, 126539, 399185, 461527};

/* A shift for each batch and coordinate, by SplitMix64 (G. L. Steele, D. Lea and C. H. Flood, Fast splittable pseudorandom number
 * generators, OOPSLA 2014). */
static uint32_t next_shift(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (uint32_t)((z ^ z >> 31) >> 32);
}

void skg_trace_places(const skg_scatter_work *work, int64_t *columns, int64_t *rows) {
    const skg_view *view = work->view;
    const skg_scatter *asked = work->recipe->options.scatter;
    const double across = skg_length(view->column_step) * (double)view->columns;
    const double down = skg_length(view->row_step) * (double)view->rows, longer = fmax(across, down);
    *columns = asked->columns ? asked->columns : (int64_t)ceil(PLACES * across / longer - 1e-9);
    *rows = asked->rows ? asked->rows : (int64_t)ceil(PLACES * down / longer - 1e-9);
    if (*columns > view->columns) *columns = view->columns;
    if (*rows > view->rows) *rows = view->rows;
}

static skg_status send_lattice(skg_context *context, int64_t seed, skg_buffer *buffer) {
    uint32_t table[SKG_SCATTER_BATCHES + 1][SKG_SCATTER_DIMENSIONS];
    uint64_t state = (uint64_t)seed;
    memcpy(table[0], LATTICE, sizeof LATTICE);
    for (int b = 1; b <= SKG_SCATTER_BATCHES; b++)
        for (int d = 0; d < SKG_SCATTER_DIMENSIONS; d++) table[b][d] = next_shift(&state);
    return skg_buffer_write(context, buffer, sizeof table, table, "lattice");
}

static skg_status send_spots(skg_context *context, const skg_scatter_work *work, const skg_cells *cells,
                             skg_tracing *t) {
    float(*spots)[4] = NULL;
    int64_t count = 0;
    skg_status status = skg_sight_spots(work, cells, &count, &spots);
    if (status == SKG_OK)
        status = skg_buffer_write(context, &t->spots, count * (int64_t)sizeof *spots, spots, "source");
    t->args.spots = (SKG_INT)count;
    skg_free(&spots);
    return status;
}

/* Sends mixtures with as many coefficients as there are, one vector each: twelve take the place of sixteen. */
static skg_status send_mixtures(skg_context *context, int64_t count, const skg_mixture *mixtures,
                                int32_t fours, skg_buffer *buffer, const char *what) {
    const int64_t each = (int64_t)fours * SKG_SCATTER_FOUR,
                  held = each < SKG_SCATTER_RANK ? each : SKG_SCATTER_RANK;
    float *packed = NULL;
    SKG_TRY(skg_alloc(count * each, sizeof *packed, "scatter", &packed));
    for (int64_t i = 0; i < count; i++) memcpy(packed + i * each, mixtures[i], (size_t)held * sizeof *packed);
    const skg_status status =
        skg_buffer_write(context, buffer, count * each * (int64_t)sizeof *packed, packed, what);
    skg_free(&packed);
    return status;
}

static skg_status send_tables(skg_context *context, const skg_scatter_object *object,
                              const skg_scatter_tables *tables, skg_tracing *t) {
    const skg_scatter_physics *p = &object->physics;
    const skg_cells *cells = &object->cells;
    const int64_t four = 4 * (int64_t)sizeof(float);
    t->fours = p->rank > 2 * SKG_SCATTER_FOUR ? 4 : p->rank / SKG_SCATTER_FOUR;
    SKG_TRY(send_mixtures(context, cells->media_count, (const skg_mixture *)cells->media, t->fours, &t->media,
                          "cells"));
    SKG_TRY(skg_buffer_write(context, &t->tree, cells->tree_count * (int64_t)sizeof *cells->tree, cells->tree,
                             "cells"));
    SKG_TRY(skg_buffer_write(context, &t->faces, cells->face_count * (int64_t)sizeof *cells->faces,
                             cells->faces, "cells"));
    SKG_TRY(send_mixtures(context, tables->energy_rows, (const skg_mixture *)tables->energies, t->fours,
                          &t->energies, "energies"));
    SKG_TRY(send_mixtures(context, p->momenta * 2, (const skg_mixture *)tables->momenta, t->fours,
                          &t->momenta, "momenta"));
    SKG_TRY(skg_buffer_write(context, &t->angles,
                             SKG_ANGLE_ROWS * (SKG_SCATTER_ANGLES + 1) * (int64_t)sizeof *tables->angles,
                             tables->angles, "angles"));
    if (tables->profiles)
        SKG_TRY(skg_buffer_write(context, &t->profiles,
                                 tables->profile_count * (int64_t)sizeof *tables->profiles, tables->profiles,
                                 "beam"));
    if (tables->detector)
        SKG_TRY(skg_buffer_write(context, &t->detector,
                                 tables->detector_count * (int64_t)sizeof *tables->detector, tables->detector,
                                 "detector"));
    return skg_buffer_write(context, &t->beam, (tables->bins + tables->lines) * four, tables->beam, "beam");
}

static void fill_tables(const skg_scatter_physics *p, const skg_scatter_tables *tables,
                        skg_scatter_args *args) {
    args->energies = (SKG_INT)p->energies;
    args->momenta = (SKG_INT)p->momenta;
    args->bins = (SKG_INT)tables->bins;
    args->shells = (SKG_INT)p->shells;
    args->log_low = (float)log(p->low_kev);
    args->per_log = (float)((double)(p->energies - 1) / log(p->high_kev / p->low_kev));
    args->per_momentum = (float)(1 / p->momentum_scale);
    args->per_log_momentum = (float)((double)(p->momenta - 1) / log1p(p->momentum_high / p->momentum_scale));
    args->angle_last = SKG_ANGLE_ROWS - 1;
    args->angle_rows = (float)((double)(SKG_ANGLE_ROWS - 1) / (double)(p->energies - 1));
    args->min_kev = (float)(p->low_kev * 1.0001);
    args->scale = (float)(1 / UNIT);
}

static void fill_profile(const skg_beam_profile *p, skg_tracing *t) {
    skg_scatter_args *args = &t->args;
    for (int k = 0; k < 3; k++) {
        args->anode[k] = (float)p->anode[k];
        args->central[k] = (float)p->central[k];
        args->fan[k] = (float)p->fan[k];
    }
    if (p->heel) {
        args->heel_low = (float)p->low;
        args->heel_per = p->high > p->low ? (float)((SKG_HEEL_ROWS - 1) / (p->high - p->low)) : 0;
        args->heel_rows = SKG_HEEL_ROWS;
    }
    if (p->bowtie) args->fan_rows = (SKG_INT)p->filter->count;
}

static void fill_images(const skg_recipe *recipe, const skg_scatter_tables *tables, skg_tracing *t) {
    t->args.bands = tables->bands;
    t->args.edges = recipe->options.bands > 0 ? tables->bands + 1 : 0;
    t->args.layers = tables->layers;
    t->args.cosines = tables->cosines;
}

static skg_status clear(skg_context *context, skg_tracing *t) {
    static const cl_int none = 0;
    t->sums_count = (int64_t)SKG_SCATTER_BATCHES * t->args.layers * t->args.bands * SKG_SCATTER_PLANES *
                    t->args.rows * t->args.columns;
    const int64_t bytes = t->sums_count * (int64_t)sizeof(int64_t);
    SKG_TRY(skg_buffer_reserve(context, &t->sums, bytes, CL_MEM_READ_WRITE, "scatter"));
    SKG_CL_TRY(clEnqueueFillBuffer(context->device->queue, t->sums.memory, &none, sizeof none, 0,
                                   (size_t)bytes, 0, NULL, NULL));
    return SKG_OK;
}

skg_status skg_trace_begin(skg_context *context, const skg_scatter_work *work,
                           const skg_scatter_object *object, const skg_scatter_tables *tables,
                           int64_t columns, int64_t rows, skg_tracing *t) {
    const int64_t seed = (int64_t)((uint64_t)work->recipe->options.scatter->seed + work->seed);
    t->args = (skg_scatter_args){.columns = (SKG_INT)columns, .rows = (SKG_INT)rows};
    t->progress = work->progress;
    t->args.seed[0] = (SKG_INT)(uint32_t)(uint64_t)seed;
    t->args.seed[1] = (SKG_INT)(uint32_t)((uint64_t)seed >> 32);
    t->args.noise = work->recipe->options.noise != 0;
    t->args.grid = work->recipe->options.grid != NULL;
    t->parallel = work->view->projection != SKG_PROJECTION_POINT;
    SKG_TRY(skg_sight_fill(work, &object->cells, &t->args));
    fill_tables(&object->physics, tables, &t->args);
    fill_profile(&tables->profile, t);
    fill_images(work->recipe, tables, t);
    t->args.rough = (SKG_INT)object->cells.rough;
    t->args.world_around = skg_scatter_world(work->recipe) != NULL;
    SKG_TRY(send_tables(context, object, tables, t));
    SKG_TRY(send_spots(context, work, &object->cells, t));
    SKG_TRY(send_lattice(context, seed, &t->lattice));
    return clear(context, t);
}

static skg_status get_program(skg_context *context, const skg_tracing *t, cl_program *program) {
    static const char *const files[] = {"exponential.clh", "random.clh",       "noise.clh", "scatter.clh",
                                        "walk.clh",        "fluorescence.clh", "sight.clh", "strips.clh",
                                        "arrive.clh",      "profile.clh",      "emit.clh",  "tally.clh",
                                        "next_event.clh",  "scatter.cl"};
    const skg_kernel_options options = {
        .precision = SKG_PRECISION_SINGLE, .bits = 32, .parallel = t->parallel};
    const skg_define fours[] = {{"SKG_FOURS", t->fours}};
    return skg_kernels_get(context, &options, (int32_t)(sizeof files / sizeof *files), files,
                           t->fours > 1 ? SKG_DEFINES(fours) : NULL, program);
}

/* Batches for each compute unit from which on units take whole ones: the last of them wait for an eighth of their time at most. */
enum { ALONE_FROM = 4 };

/* Enqueues histories args.first to args.end of all batches. */
static skg_status launch(skg_context *context, cl_program program, skg_tracing *t) {
    const skg_device_info *device = &context->device->info;
    const int64_t histories = t->args.end - t->args.first, group = device->gpu ? 32 : 1;
    const int64_t items = (int64_t)device->compute_units * (device->gpu ? 256 : 8);
    int64_t each = histories * SKG_SCATTER_BATCHES / items;
    each = each < 64 ? 64 : each > 1024 ? 1024 : each;
    /* Where few processors share the batches, each takes whole ones, and adds without atomics. */
    t->args.alone = !device->gpu && device->compute_units * ALONE_FROM <= SKG_SCATTER_BATCHES;
    if (t->args.alone) each = histories;
    t->args.each = (SKG_INT)each;
    const skg_work_size work = {2, {(histories + each - 1) / each, SKG_SCATTER_BATCHES}, {group, 1}};
    const skg_argument arguments[] = {
        SKG_ARGUMENT(SCATTER, args, t->args),
        SKG_ARGUMENT(SCATTER, media, t->media.memory),
        SKG_ARGUMENT(SCATTER, tree, t->tree.memory),
        SKG_ARGUMENT(SCATTER, faces, t->faces.memory),
        SKG_ARGUMENT(SCATTER, energies, t->energies.memory),
        SKG_ARGUMENT(SCATTER, momenta, t->momenta.memory),
        SKG_ARGUMENT(SCATTER, angles, t->angles.memory),
        SKG_ARGUMENT(SCATTER, beam, t->beam.memory),
        SKG_ARGUMENT(SCATTER, profiles, t->profiles.memory),
        SKG_ARGUMENT(SCATTER, spots, t->spots.memory),
        SKG_ARGUMENT(SCATTER, lattice, t->lattice.memory),
        SKG_ARGUMENT(SCATTER, detector, t->detector.memory),
        SKG_ARGUMENT(SCATTER, sums, t->sums.memory),
    };
    return SKG_LAUNCH_ONCE(context, program, "skg_scatter", "scatter", &work, arguments, NULL);
}

skg_status skg_trace_until(skg_context *context, skg_tracing *t, int64_t end) {
    cl_program program = NULL;
    int64_t chunk = 64;
    SKG_TRY(get_program(context, t, &program));
    for (int64_t first = t->args.end; first < end; first = t->args.end) {
        const double begun = skg_seconds();
        SKG_TRY(skg_progress_step(t->progress, first, end));
        t->args.first = (SKG_INT)first;
        t->args.end = (SKG_INT)(first + chunk < end ? first + chunk : end);
        SKG_TRY(launch(context, program, t));
        SKG_CL_TRY(clFinish(context->device->queue));
        const double took = skg_seconds() - begun;
        if (2 * took < LAUNCH_S) chunk *= 2;
        if (took > 2 * LAUNCH_S && chunk > 64) chunk /= 2;
    }
    return SKG_OK;
}

skg_status skg_trace_read(skg_context *context, const skg_tracing *t, int64_t *sums) {
    SKG_CL_TRY(clEnqueueReadBuffer(context->device->queue, t->sums.memory, CL_TRUE, 0,
                                   (size_t)t->sums_count * sizeof *sums, sums, 0, NULL, NULL));
    return SKG_OK;
}

void skg_trace_release(skg_tracing *t) {
    skg_buffer *const buffers[] = {&t->media, &t->tree,     &t->faces, &t->energies, &t->momenta,  &t->angles,
                                   &t->beam,  &t->profiles, &t->spots, &t->lattice,  &t->detector, &t->sums};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++) skg_buffer_release(buffers[i]);
}

int64_t skg_trace_bytes(const skg_tracing *t) {
    return t->media.bytes + t->tree.bytes + t->faces.bytes + t->energies.bytes + t->momenta.bytes +
           t->angles.bytes + t->beam.bytes + t->profiles.bytes + t->spots.bytes + t->lattice.bytes +
           t->detector.bytes + t->sums.bytes;
}
