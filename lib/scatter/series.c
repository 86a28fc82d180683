/* Scatter of a series of frames, computed for a few of them. */
#include "scatter/tracing.h"

#include "core/clock.h"

#include <math.h>

/* First number of intervals between the frames that are followed, and first histories of a batch in each of them. */
enum { INTERVALS = 16, FIRST = 256 };

/* Frames between them that show whether they are enough, in shares of the series. */
static const double CHECKED[] = {0.0902, 0.3262, 0.5623, 0.7082, 0.9443};
enum { CHECKS = sizeof CHECKED / sizeof *CHECKED };

/* A difference from these counts above so many of its standard errors, and if it is more than this share of the error. */
static const double SURE = 2, SHARE = 0.5;

/* A frame that is followed. */
typedef struct {
    int64_t index, end; /* histories of a batch so far */
    uint64_t seed;
    double *sums; /* [2][batches][rows][columns] photons and what adds to the variance */
    /* [batches][rows][columns] each: cosines of these, per history; photons of the spectrum */
    double *found[2];
    double photons; /* that a sum of 1 stands for, times histories of a batch */
} knot;

typedef struct {
    skg_context *context;
    skg_scatter_series *series;
    skg_series_frame frame;
    void *user;
    int64_t count, columns, rows; /* of frames; of the grid */
    int32_t noise;
    int64_t intervals;
    skg_rounds rounds;
    knot *knots; /* [intervals + 1] */
    knot checks[CHECKS];
    int64_t *sums;     /* as skg_trace_read */
    double systematic; /* the greatest of the frames, what cells and materials are off by */
    skg_tracing tracing;
} maker;

static int64_t places_of(const maker *m) {
    return m->rows * m->columns;
}

static void drop_knot(knot *k) {
    skg_free(&k->sums);
    skg_free(&k->found[0]);
    skg_free(&k->found[1]);
}

/* Frames are far apart in seeds, so that their noise is independent. */
static uint64_t seed_of(int64_t number) {
    static const uint64_t APART = 0x9E3779B97F4A7C15u;
    return APART * (uint64_t)(number + 1);
}

/* Adds the device's sums to those of a frame. */
static void add_sums(const maker *m, knot *k) {
    const int64_t places = places_of(m);
    for (int64_t b = 0; b < SKG_SCATTER_BATCHES; b++)
        for (int plane = 0; plane < SKG_SCATTER_PLANES; plane++) {
            const int64_t *from = m->sums + (b * SKG_SCATTER_PLANES + plane) * places;
            double *to = k->sums + ((plane < SKG_SCATTER_KINDS ? 0 : SKG_SCATTER_BATCHES) + b) * places;
            for (int64_t p = 0; p < places; p++) to[p] += (double)from[p];
        }
}

static skg_status trace(maker *m, const skg_scatter_work *work, const skg_scatter_object *object, knot *k) {
    skg_scatter_tables tables;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_scatter_tables_make(work, object, &tables));
    SKG_TRY_CLEANUP(skg_trace_begin(m->context, work, object, &tables, m->columns, m->rows, &m->tracing));
    m->tracing.args.end = (SKG_INT)k->end;
    SKG_TRY_CLEANUP(skg_trace_until(m->context, &m->tracing, m->rounds.end));
    SKG_TRY_CLEANUP(skg_trace_read(m->context, &m->tracing, m->sums));
    add_sums(m, k);
    k->photons = tables.photons * skg_sight_photons(work, &m->tracing.args) / (double)m->tracing.args.scale;
    m->series->signal = tables.signal;
    m->series->power = tables.variance;
cleanup:
    skg_scatter_tables_free(&tables);
    return status;
}

static skg_status find_cosines(const maker *m, knot *k) {
    const int64_t all = SKG_SCATTER_BATCHES * places_of(m);
    for (int i = 0; i <= m->noise; i++) {
        SKG_TRY(skg_cosines_of(m->columns, m->rows, SKG_SCATTER_BATCHES, k->sums + i * all, k->found[i]));
        for (int64_t p = 0; p < all; p++) k->found[i][p] *= k->photons / (double)m->rounds.end;
    }
    return SKG_OK;
}

/* Follows histories of a frame up to m->rounds.end. */
static skg_status follow(maker *m, knot *k) {
    const int64_t all = SKG_SCATTER_BATCHES * places_of(m);
    skg_scatter_work work = {.recipe = m->series->recipe};
    skg_scatter_object object = {0};
    if (k->end >= m->rounds.end) return SKG_OK;
    if (!k->sums) {
        SKG_TRY(skg_alloc(2 * all, sizeof *k->sums, "series", &k->sums));
        SKG_TRY(skg_alloc(all, sizeof *k->found[0], "series", &k->found[0]));
        SKG_TRY(skg_alloc(all, sizeof *k->found[1], "series", &k->found[1]));
    }
    SKG_TRY(m->frame(k->index, &work, m->user));
    work.seed = k->seed;
    skg_status status = skg_scatter_object_make(&work, &object);
    if (status == SKG_OK && object.cells.mixtures) status = trace(m, &work, &object, k);
    if (status == SKG_OK) m->systematic = fmax(m->systematic, object.judged.all);
    skg_scatter_object_free(&object);
    if (status != SKG_OK) return status;
    m->series->report.histories += (m->rounds.end - k->end) * SKG_SCATTER_BATCHES;
    k->end = m->rounds.end;
    return find_cosines(m, k);
}

static double place_of(const maker *m, int64_t index) {
    return (double)index / (double)(m->count - 1);
}

/* Frames at equal distances, those of half as many intervals among them. */
static skg_status place_knots(maker *m, int64_t intervals) {
    knot *knots = NULL;
    SKG_TRY(skg_alloc(intervals + 1, sizeof *knots, "series", &knots));
    for (int64_t i = 0; i <= intervals; i++) {
        if (m->knots && i % 2 == 0) {
            knots[i] = m->knots[i / 2];
            continue;
        }
        knots[i].index = llround((double)i * (double)(m->count - 1) / (double)intervals);
        knots[i].seed = seed_of(CHECKS + knots[i].index);
    }
    skg_free(&m->knots);
    m->knots = knots;
    m->intervals = intervals;
    return SKG_OK;
}

static void place_checks(maker *m) {
    for (int i = 0; i < CHECKS; i++) {
        m->checks[i].index = llround(CHECKED[i] * (double)(m->count - 1));
        m->checks[i].seed = seed_of(i);
    }
}

/* of: 0: photons, 1: what adds to the variance */
static skg_status fit(const maker *m, int of, skg_joint *joint) {
    const int64_t knots = m->intervals + 1;
    const double **found = NULL;
    double *at = NULL;
    skg_status status = SKG_OK;
    skg_joint_free(joint);
    SKG_TRY_CLEANUP(skg_alloc(knots, sizeof *found, "series", &found));
    SKG_TRY_CLEANUP(skg_alloc(knots, sizeof *at, "series", &at));
    for (int64_t i = 0; i < knots; i++) {
        found[i] = m->knots[i].found[of];
        at[i] = place_of(m, m->knots[i].index);
    }
    status = skg_joint_fit(SKG_SCATTER_BATCHES, m->columns, m->rows, knots, at, found, joint);
cleanup:
    skg_free(&found);
    skg_free(&at);
    return status;
}

/* How far the frames between differ from the smooth functions, beyond noise: mean square, and its standard error. */
static skg_status check(const maker *m, double *square, double *error) {
    *square = *error = 0;
    for (int i = 0; i < CHECKS; i++) {
        double own = 0, its = 0;
        SKG_TRY(skg_joint_compare(&m->series->mean, place_of(m, m->checks[i].index), m->checks[i].found[0],
                                  &own, &its));
        *square += own / CHECKS;
        *error += its * its / (CHECKS * CHECKS);
    }
    *error = sqrt(*error);
    return SKG_OK;
}

static skg_status follow_all(maker *m) {
    for (int64_t i = 0; i <= m->intervals; i++) SKG_TRY(follow(m, &m->knots[i]));
    for (int i = 0; i < CHECKS; i++) SKG_TRY(follow(m, &m->checks[i]));
    return fit(m, 0, &m->series->mean);
}

/* Follows more frames, or more histories of each, until the error is what was asked for. */
static skg_status converge(maker *m, int32_t *is_smooth) {
    const skg_scatter *asked = m->series->recipe->options.scatter;
    const double tolerance = asked->histories ? 0 : asked->tolerance;
    m->rounds = skg_rounds_begin(asked, FIRST, tolerance);
    SKG_TRY(place_knots(m, INTERVALS));
    place_checks(m);
    for (;;) {
        double square = 0, doubt = 0;
        SKG_TRY(follow_all(m));
        SKG_TRY(check(m, &square, &doubt));
        const skg_joint *mean = &m->series->mean;
        const double bar = SHARE * fmax(mean->sigma, tolerance * mean->mean);
        if (square > SURE * doubt && square > bar * bar) {
            *is_smooth = 4 * m->intervals <= m->count;
            if (!*is_smooth) return SKG_OK;
            SKG_TRY(place_knots(m, 2 * m->intervals));
            continue;
        }
        m->series->mean.bias += fmax(square, 0);
        const double sigma = sqrt(mean->sigma * mean->sigma + fmax(square, 0));
        const double error = mean->mean > 0 ? sigma / mean->mean : 0;
        m->series->mean.sigma = sigma;
        *is_smooth = 1;
        if (skg_rounds_next(&m->rounds, error)) continue;
        skg_rounds_warn(m->context, &m->rounds, asked, error);
        return SKG_OK;
    }
}

static skg_status begin(maker *m) {
    skg_scatter_work work = {.recipe = m->series->recipe};
    SKG_TRY(m->frame(0, &work, m->user));
    skg_trace_places(&work, &m->columns, &m->rows);
    return skg_alloc(SKG_SCATTER_BATCHES * SKG_SCATTER_PLANES * places_of(m), sizeof *m->sums, "scatter",
                     &m->sums);
}

skg_status skg_series_make(skg_context *context, int64_t count, skg_series_frame frame, void *user,
                           skg_scatter_series *series, int32_t *is_smooth) {
    maker m = {.context = context, .series = series, .frame = frame, .user = user, .count = count};
    const double begun = skg_seconds();
    skg_status status = SKG_OK;
    *is_smooth = 0;
    /* Bands and layers would each need a fit of their own. */
    if (count < 2 * INTERVALS || skg_model_sums(&series->recipe->model) > 1) return SKG_OK;
    m.noise = series->recipe->options.noise != 0;
    SKG_TRY_CLEANUP(begin(&m));
    SKG_TRY_CLEANUP(converge(&m, is_smooth));
    if (*is_smooth && m.noise) SKG_TRY_CLEANUP(fit(&m, 1, &series->variance));
    const double off = m.systematic * series->mean.mean; /* more histories do not make up for it */
    series->mean.bias += off * off;
    series->mean.sigma = hypot(series->mean.sigma, off);
    series->report.frames = count;
    series->report.followed = m.intervals + 1;
    series->report.error = series->mean.mean > 0 ? series->mean.sigma / series->mean.mean : 0;
    series->report.seconds = skg_seconds() - begun;
cleanup:
    for (int64_t i = 0; m.knots && i <= m.intervals; i++) drop_knot(&m.knots[i]);
    for (int i = 0; i < CHECKS; i++) drop_knot(&m.checks[i]);
    skg_free(&m.knots);
    skg_free(&m.sums);
    skg_trace_release(&m.tracing);
    return status;
}

void skg_series_drop(skg_scatter_series *series) {
    skg_joint_free(&series->mean);
    skg_joint_free(&series->variance);
}
