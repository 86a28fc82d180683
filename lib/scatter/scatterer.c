/* The scatter of a frame: from its object to smoothed images, unless they are known. */
#include "scatter/scatterer.h"

#include "core/clock.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* First histories of a batch: fewer say too little of their own error. */
enum { FIRST = 512 };

/* Of the attenuation or of angles in a material, above which a scene is warned of. */
static const double MIXTURE_ERROR = 0.05;

/* Of what scatters straight on, above which cells where parts compete are warned of. */
static const double CELLS_ERROR = 0.05;

/* Digest of everything that the scatter of a frame depends on: view, materials, and each part's place, mesh, density and fill. */
static skg_digest key_of(const skg_scatter_work *work) {
    const skg_recipe *recipe = work->recipe;
    const skg_scene *scene = recipe->scene;
    skg_digester digester;
    skg_digest_start(&digester);
    skg_digest_add(&digester, work->view, sizeof *work->view);
    skg_digest_add(&digester, &recipe->materials, sizeof recipe->materials);
    for (int64_t i = 0; i < scene->count; i++) {
        const double matter[2] = {work->density ? work->density[i] : 1, work->fill ? work->fill[i] : 1};
        skg_digest_add(&digester, skg_scatter_pose(work, i), 16 * sizeof(double));
        skg_digest_add(&digester, &scene->parts[i].mesh->version, sizeof scene->parts[i].mesh->version);
        skg_digest_add(&digester, matter, sizeof matter);
    }
    return skg_digest_end(&digester);
}

/* Sums over the histories so far, as images of layers and channels, channels fastest. */
typedef struct {
    int64_t *sums;  /* as skg_trace_read */
    double *values; /* [batches][rows][columns] workspace */
    int64_t columns, rows;
    int32_t channels, images;
    double systematic; /* share of the mean that no number of histories takes away: skg_judged */
    skg_rounds rounds;
    skg_cosines all;       /* of all images together */
    skg_cosines *channel;  /* [channels] of its layers together */
    skg_cosines *image;    /* [images] with several layers */
    skg_cosines *variance; /* [images] with noise */
} arrived;

/* Adds planes first to before end of each batch of every `step`th image from number `image` on. */
static void add_planes(const arrived *a, int32_t image, int32_t step, int first, int end) {
    const int64_t places = a->columns * a->rows;
    for (int64_t b = 0; b < SKG_SCATTER_BATCHES; b++)
        for (int64_t p = 0; p < places; p++) {
            double sum = 0;
            for (int64_t i = image; i < a->images; i += step)
                for (int k = first; k < end; k++)
                    sum += (double)a->sums[((b * a->images + i) * SKG_SCATTER_PLANES + k) * places + p];
            a->values[b * places + p] = sum;
        }
}

static skg_status fit(arrived *a, skg_cosines *cosines) {
    const skg_arrivals arrivals = {SKG_SCATTER_BATCHES, a->columns, a->rows, a->values};
    skg_cosines_free(cosines);
    SKG_TRY(skg_cosines_fit(&arrivals, cosines));
    const double off = a->systematic * cosines->mean;
    cosines->bias += off * off;
    cosines->sigma = hypot(cosines->sigma, off);
    return SKG_OK;
}

/* Returns the statistical error that histories have to reach. The systematic error of cells and materials may leave little or nothing of
 * the tolerance; then histories stop where they would add little to it. */
static double within_reach(double tolerance, double systematic) {
    const double most = SKG_SCATTER_MOST * tolerance;
    return systematic <= most ? tolerance : hypot(systematic, sqrt(tolerance * tolerance - most * most));
}

/* Follows histories until the error is what was asked for. */
static skg_status follow(skg_context *context, const skg_scatter *asked, skg_tracing *t, arrived *a) {
    double error = 0;
    a->rounds = skg_rounds_begin(asked, FIRST, within_reach(asked->tolerance, a->systematic));
    do {
        SKG_TRY(skg_trace_until(context, t, a->rounds.end));
        SKG_TRY(skg_trace_read(context, t, a->sums));
        add_planes(a, 0, 1, 0, SKG_SCATTER_KINDS);
        SKG_TRY(fit(a, &a->all));
        error = a->all.mean > 0 ? a->all.sigma / a->all.mean : 0;
    } while (skg_rounds_next(&a->rounds, error));
    skg_rounds_warn(context, &a->rounds, asked, error);
    return SKG_OK;
}

/* Shares of the orders and kinds. */
static void share_out(const arrived *a, skg_scatter_report *report) {
    const int64_t places = a->columns * a->rows;
    double kinds[SKG_SCATTER_KINDS] = {0}, sum = 0;
    for (int64_t b = 0; b < SKG_SCATTER_BATCHES * a->images; b++)
        for (int k = 0; k < SKG_SCATTER_KINDS; k++)
            for (int64_t p = 0; p < places; p++)
                kinds[k] += (double)a->sums[(b * SKG_SCATTER_PLANES + k) * places + p];
    for (int k = 0; k < SKG_SCATTER_KINDS; k++) sum += kinds[k];
    for (int k = 0; k < 3 && sum > 0; k++) {
        report->orders[k] = (kinds[k] + kinds[k + 3]) / sum;
        report->rayleigh += kinds[k] / sum;
    }
}

/* Divides the stated error among its parts. */
static void divide(const arrived *a, skg_scatter_report *report) {
    const skg_cosines *all = &a->all;
    const double off = a->systematic * all->mean, per = all->sigma > 0 ? report->sigma / all->sigma : 0;
    report->errors[0] = per * sqrt(fmax(all->sigma * all->sigma - all->bias, 0));
    report->errors[1] = per * off;
    report->errors[2] = per * sqrt(fmax(all->bias - off * off, 0));
}

static void free_components(skg_scatterer *s) {
    for (int32_t k = 0; k < s->channels * SKG_SCATTER_KINDS; k++) skg_cosines_free(&s->components[k]);
    skg_free(&s->components);
    s->channels = 0;
}

/* Planes of images as add_planes, by the cosines that their sum has. */
static skg_status take_like(arrived *a, int32_t image, int32_t step, int first, int end,
                            const skg_cosines *like, skg_cosines *cosines) {
    const int64_t places = a->columns * a->rows;
    add_planes(a, image, step, first, end);
    for (int64_t p = 0; p < places; p++) {
        double sum = 0;
        for (int64_t b = 0; b < SKG_SCATTER_BATCHES; b++) sum += a->values[b * places + p];
        a->values[p] = sum / SKG_SCATTER_BATCHES;
    }
    return skg_cosines_like(like, a->values, cosines);
}

/* Smooths each channel, its orders and kinds, and its layers. noise: 1: their variances, too */
static skg_status smooth(arrived *a, int noise, skg_scatterer *s) {
    SKG_TRY(skg_alloc(a->channels * SKG_SCATTER_KINDS, sizeof *s->components, "scatter", &s->components));
    s->channels = a->channels;
    for (int32_t c = 0; c < a->channels; c++) {
        skg_cosines *own = &a->channel[c];
        add_planes(a, c, a->channels, 0, SKG_SCATTER_KINDS);
        SKG_TRY(fit(a, own));
        for (int k = 0; k < SKG_SCATTER_KINDS; k++)
            SKG_TRY(take_like(a, c, a->channels, k, k + 1, own, &s->components[c * SKG_SCATTER_KINDS + k]));
    }
    for (int32_t i = 0; i < a->images; i++) {
        if (a->images > a->channels)
            SKG_TRY(
                take_like(a, i, a->images, 0, SKG_SCATTER_KINDS, &a->channel[i % a->channels], &a->image[i]));
        if (!noise) continue;
        add_planes(a, i, a->images, SKG_SCATTER_KINDS, SKG_SCATTER_PLANES);
        SKG_TRY(fit(a, &a->variance[i]));
    }
    return SKG_OK;
}

static skg_status trace(skg_context *context, const skg_scatter_work *work, const skg_scatter_object *object,
                        skg_scatterer *s, arrived *a) {
    skg_scatter_tables tables;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_scatter_tables_make(work, object, &tables));
    SKG_TRY_CLEANUP(skg_trace_begin(context, work, object, &tables, a->columns, a->rows, &s->tracing));
    SKG_TRY_CLEANUP(follow(context, work->recipe->options.scatter, &s->tracing, a));
    SKG_TRY_CLEANUP(smooth(a, work->recipe->options.noise, s));
    s->photons = tables.photons * skg_sight_photons(work, &s->tracing.args) /
                 ((double)s->tracing.args.scale * (double)s->tracing.args.end);
    s->signal = tables.signal;
    const skg_shown_scatter shown = {
        .work = work,
        .mean = a->channel,
        .staged = a->images > a->channels ? a->image : a->channel,
        .variance = work->recipe->options.noise ? a->variance : NULL,
        .photons = s->photons,
        .signal = s->signal,
        .power = tables.variance,
    };
    s->report.histories = (int64_t)s->tracing.args.end * SKG_SCATTER_BATCHES;
    status = skg_shown_scatter_send(context, &shown, &s->images);
cleanup:
    skg_scatter_tables_free(&tables);
    return status;
}

static skg_status begin(const skg_scatter_work *work, arrived *a) {
    const skg_model *model = &work->recipe->model;
    skg_trace_places(work, &a->columns, &a->rows);
    a->channels = model->channels, a->images = skg_model_sums(model);
    const int64_t places = a->columns * a->rows, planes = (int64_t)a->images * SKG_SCATTER_PLANES;
    SKG_TRY(skg_alloc(SKG_SCATTER_BATCHES * planes * places, sizeof *a->sums, "scatter", &a->sums));
    SKG_TRY(skg_alloc(SKG_SCATTER_BATCHES * places, sizeof *a->values, "scatter", &a->values));
    SKG_TRY(skg_alloc(a->channels, sizeof *a->channel, "scatter", &a->channel));
    SKG_TRY(skg_alloc(a->images, sizeof *a->image, "scatter", &a->image));
    return skg_alloc(a->images, sizeof *a->variance, "scatter", &a->variance);
}

static void drop(arrived *a) {
    skg_cosines_free(&a->all);
    for (int32_t c = 0; a->channel && c < a->channels; c++) skg_cosines_free(&a->channel[c]);
    for (int32_t i = 0; a->image && i < a->images; i++) skg_cosines_free(&a->image[i]);
    for (int32_t i = 0; a->variance && i < a->images; i++) skg_cosines_free(&a->variance[i]);
    skg_free(&a->channel);
    skg_free(&a->image);
    skg_free(&a->variance);
    skg_free(&a->sums);
    skg_free(&a->values);
}

static skg_status compute(skg_context *context, const skg_scatter_work *work,
                          const skg_scatter_object *object, skg_scatterer *s) {
    arrived a = {0};
    skg_status status = SKG_OK;
    const skg_shown_scatter nothing = {.work = work};
    SKG_TRY_CLEANUP(begin(work, &a));
    a.systematic = object->judged.all;
    if (object->cells.mixtures)
        SKG_TRY_CLEANUP(trace(context, work, object, s, &a));
    else
        SKG_TRY_CLEANUP(skg_shown_scatter_send(context, &nothing, &s->images));
    s->report.mean = s->images.average;
    s->report.sigma = s->images.error;
    share_out(&a, &s->report);
    divide(&a, &s->report);
    s->report.cosines = (int32_t)a.all.count;
cleanup:
    drop(&a);
    return status;
}

static void warn_of_mixtures(const skg_context *context, const skg_scatter_physics *physics,
                             skg_scatterer *s) {
    if (s->warned || !(physics->error > MIXTURE_ERROR)) return;
    s->warned = 1;
    skg_log(
        context, SKG_LOG_WARNING,
        "scatter: twelve coefficients a cell stand for %" PRId64
        " materials, with errors of up to %.2g %% in attenuation and %.2g %% in angles and fluorescence; fewer compositions are mixed "
        "better, and up to twelve exactly",
        physics->materials, 100 * physics->attenuation_error, 100 * physics->error);
}

static void warn_of_cells(const skg_context *context, const skg_scatter_object *object, skg_scatterer *s) {
    const skg_cells *cells = &object->cells;
    const int of_volume = cells->within != NULL;
    if (s->cells_warned || !(object->settled_error > CELLS_ERROR)) return;
    s->cells_warned = 1;
    skg_log(
        context, SKG_LOG_WARNING,
        "scatter: cells of %.3g x %.3g x %.3g mm scatter %.2g %% more or less straight on than the parts do, because %s; the scatter "
        "may be wrong by as much, which is in its stated error. Give %sScatter a smaller Voxel",
        cells->size[0] / (double)cells->count[0], cells->size[1] / (double)cells->count[1],
        cells->size[2] / (double)cells->count[2], 100 * object->settled_error,
        of_volume ? "each holds the mean of those of the volume in it"
                  : "parts of different priority, or clipped ones, are thinner or smaller",
        of_volume ? "" : "these parts one priority where they do not overlap, or ");
}

skg_status skg_scatterer_run(skg_context *context, skg_scatterer *s, const skg_scatter_work *work) {
    const skg_digest key = key_of(work);
    const double begun = skg_seconds();
    skg_scatter_object object;
    if (s->known && skg_digest_same(&s->key, &key)) return SKG_OK;
    s->known = 0;
    free_components(s);
    s->report = (skg_scatter_report){.size = sizeof s->report};
    skg_status status = skg_scatter_object_make(work, &object);
    if (status == SKG_OK) status = compute(context, work, &object, s);
    if (status == SKG_OK) warn_of_mixtures(context, &object.physics, s);
    if (status == SKG_OK) warn_of_cells(context, &object, s);
    s->report.cells_error = object.judged.cells;
    s->report.mixture_error = object.physics.error;
    memcpy(s->report.cells, object.cells.count, sizeof s->report.cells);
    s->report.seconds = skg_seconds() - begun;
    skg_scatter_object_free(&object);
    s->key = key;
    s->known = status == SKG_OK;
    return status;
}

/* Digest of everything that the scatter of a frame from a series depends on. */
static skg_digest key_in_series(const skg_scatter_work *work, const skg_scatter_series *series,
                                double place) {
    skg_digester digester;
    skg_digest_start(&digester);
    skg_digest_add(&digester, &series->number, sizeof series->number);
    skg_digest_add(&digester, &place, sizeof place);
    skg_digest_add(&digester, work->view, sizeof *work->view);
    return skg_digest_end(&digester);
}

skg_status skg_scatterer_take(skg_context *context, skg_scatterer *s, const skg_scatter_work *work,
                              const skg_scatter_series *series, double place) {
    const skg_digest key = key_in_series(work, series, place);
    const double begun = skg_seconds(), t = place / (double)(series->report.frames - 1);
    skg_cosines mean = {0}, variance = {0};
    skg_status status = SKG_OK;
    if (s->known && skg_digest_same(&s->key, &key)) return SKG_OK;
    s->known = 0;
    free_components(s);
    s->report = (skg_scatter_report){.size = sizeof s->report, .histories = series->report.histories};
    SKG_TRY_CLEANUP(skg_joint_at(&series->mean, t, &mean));
    if (series->variance.value) SKG_TRY_CLEANUP(skg_joint_at(&series->variance, t, &variance));
    const skg_shown_scatter shown = {.work = work,
                                     .mean = &mean,
                                     .staged = &mean,
                                     .variance = series->variance.value ? &variance : NULL,
                                     .photons = 1,
                                     .signal = series->signal,
                                     .power = series->power};
    SKG_TRY_CLEANUP(skg_shown_scatter_send(context, &shown, &s->images));
    s->report.mean = s->images.average;
    s->report.sigma = s->report.errors[0] = s->images.error;
    s->report.cosines = (int32_t)mean.count;
    s->report.seconds = skg_seconds() - begun;
    s->key = key;
    s->known = 1;
cleanup:
    skg_cosines_free(&mean);
    skg_cosines_free(&variance);
    return status;
}

skg_status skg_scatterer_component(skg_context *context, skg_scatterer *s, const skg_scatter_work *work,
                                   int component) {
    const skg_shown_scatter shown = {
        .work = work, .mean = s->components, .photons = s->photons, .signal = s->signal};
    return skg_shown_component_send(context, &shown, component, &s->images);
}

void skg_scatterer_release(skg_scatterer *s) {
    free_components(s);
    skg_trace_release(&s->tracing);
    skg_scattered_release(&s->stage);
    skg_scatter_images_release(&s->images);
}

int64_t skg_scatterer_bytes(const skg_scatterer *s) {
    return skg_trace_bytes(&s->tracing) + skg_scatter_images_bytes(&s->images);
}
