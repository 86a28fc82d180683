/* Settings that a study tries: the values of each dial, and better ones. */
#include "cost/dial.h"
#include "cost/dials.h"
#include "cost/measuring.h"

/* Points are measured in this order: what the scene has today and its neighbours say most. */
enum { NOW, NEXT, SOON, LATER, LAST };

static const double REFERENCE =
    4; /* an image of a reference may take so many times the time of a setting's */

void cost_add_point(cost_study *study, int dial, int priority, cost_setting setting) {
    const int reference = dial == COST_SEVERAL ? COST_OF_ALL : cost_dials[dial].reference;
    for (int i = 0; i < study->measured.count; i++) {
        cost_point *point = &study->measured.points[i];
        if (point->reference != reference || !cost_is_same(study, &point->setting, &setting)) continue;
        if (priority < point->priority) point->priority = priority;
        return;
    }
    if (study->measured.count == COST_POINTS_MAX) return;
    const double ms = cost_estimate_ms(study, &setting);
    if (ms > cost_patience_ms(study) && priority > NOW) {
        char text[160];
        cost_describe(study, &setting, text, sizeof text);
        cost_note(study, "%s left out: one image would take about %.2g s", text, 1e-3 * ms);
        study->left_out += ms <= COST_PATIENCE_MAX_MS; /* more time would have been of use */
        return;
    }
    study->measured.points[study->measured.count++] = (cost_point){
        .dial = dial, .reference = reference, .priority = priority, .shot = -1, .setting = setting};
}

/* Precision, with every energy and every plane. */
static void add_precision(cost_study *study) {
    static const int32_t precisions[] = {SKG_PRECISION_HALF, SKG_PRECISION_SINGLE, SKG_PRECISION_DOUBLE};
    cost_setting its = study->subject.own;
    its.tolerance = 0;
    its.bins = study->subject.finest;
    for (int i = 0; i < 2 + study->session.device.double_precision; i++) {
        its.precision = precisions[i];
        cost_add_point(study, COST_PRECISION, i ? NEXT : LATER, its);
    }
}

static void add_tolerances(cost_study *study) {
    static const double tolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
    const int32_t finest = study->measured.references[COST_OF_RAYS].setting.precision;
    cost_setting its = study->subject.own;
    if (!study->subject.has_energies) return;
    its.bins = study->subject.finest;
    for (its.precision = SKG_PRECISION_SINGLE; its.precision <= finest; its.precision++)
        for (int i = study->quick; i < 6; i += 1 + study->quick) {
            its.tolerance = tolerances[i];
            cost_add_point(study, COST_TOLERANCE, LATER, its);
        }
    if (!(study->subject.own.tolerance > 0)) return;
    /* The scene's own tolerance by itself, and what is better. */
    its.precision = finest;
    its.tolerance = study->subject.own.tolerance;
    cost_add_point(study, COST_TOLERANCE, NEXT, its);
    its.tolerance = study->subject.own.tolerance / 10;
    cost_add_point(study, COST_TOLERANCE, SOON, its);
}

static void add_bins(cost_study *study) {
    static const int64_t bins[] = {64, 32, 16, 8, 4};
    cost_setting its = study->subject.own;
    if (!study->subject.has_energies) return;
    its.precision = study->measured.references[COST_OF_RAYS].setting.precision;
    its.tolerance = 0;
    if (study->subject.finest)
        cost_add_point(study, COST_BINS, NEXT, its); /* the scene's own by themselves */
    its.precision = SKG_PRECISION_SINGLE;
    for (int i = 0; study->subject.has_tube && i < 5; i += 1 + study->quick) {
        if (!cost_has_bins(study, bins[i])) break; /* wider than the tube's model allows */
        its.bins = bins[i];
        its.tolerance = 0;
        cost_add_point(study, COST_BINS, LATER, its);
        its.tolerance = 1e-4;
        cost_add_point(study, COST_BINS, LATER, its);
    }
}

/* The scene with one of the rays' dials changed, which shows what a change of it is worth. */
static void add_changes(cost_study *study) {
    cost_setting its = study->subject.own;
    for (its.precision = SKG_PRECISION_SINGLE;
         its.precision <= study->measured.references[COST_OF_RAYS].setting.precision; its.precision++)
        cost_add_point(study, COST_SEVERAL, NEXT, its);
    if (!study->subject.has_energies) return;
    its = study->subject.own;
    its.bins = study->subject.finest;
    cost_add_point(study, COST_SEVERAL, NEXT, its);
    its = study->subject.own;
    its.tolerance = study->subject.own.tolerance > 0 ? study->subject.own.tolerance / 10 : 1e-4;
    cost_add_point(study, COST_SEVERAL, NEXT, its);
    its.tolerance = study->subject.own.tolerance > 0 ? study->subject.own.tolerance * 10 : 1e-3;
    if (its.tolerance <= 0.1) cost_add_point(study, COST_SEVERAL, SOON, its);
}

/* Powers of two of source samples and the scene's own number, in rising order, against at least four times as many. */
static void add_samples(cost_study *study) {
    cost_setting its = study->subject.own;
    if (!study->subject.has_spot) return;
    its.samples = study->quick ? 256 : 4096;
    while (its.samples > 16 && cost_estimate_ms(study, &its) > REFERENCE * cost_patience_ms(study))
        its.samples /= 4;
    const int64_t most = its.samples / 4, own = study->subject.own.samples;
    study->measured.references[COST_OF_SAMPLES].setting = its;
    for (int64_t n = 1, before = 0; n <= most; before = n, n *= study->quick ? 4 : 2) {
        if (before < own && own < n) cost_add_point(study, COST_SAMPLES, NEXT, study->subject.own);
        its.samples = n;
        cost_add_point(study, COST_SAMPLES, n >= own && n <= 4 * own ? NEXT : LATER, its);
    }
}

/* Rays per side of a pixel and the scene's own number, in rising order, against at least twice as many. At most 16 source
 * samples, to save time. */
static void add_supersampling(cost_study *study) {
    static const int32_t sides[] = {1, 2, 3, 4, 6, 8};
    cost_setting its = study->subject.own;
    if (its.samples > 16) its.samples = 16;
    its.supersampling = study->quick ? 8 : 16;
    while (its.supersampling > 2 && cost_estimate_ms(study, &its) > REFERENCE * cost_patience_ms(study))
        its.supersampling /= 2;
    const int32_t most = its.supersampling / 2, own = study->subject.own.supersampling;
    study->measured.references[COST_OF_AREAS].setting = its;
    for (int i = 0, before = 0; i < 6 && sides[i] <= most; before = sides[i++]) {
        its.supersampling = own;
        if (before < own && own < sides[i]) cost_add_point(study, COST_SUPERSAMPLING, NEXT, its);
        its.supersampling = sides[i];
        cost_add_point(study, COST_SUPERSAMPLING, sides[i] >= own && sides[i] <= 3 * own ? NEXT : LATER, its);
    }
}

int32_t cost_best_repair(const cost_study *study) {
    const int32_t own = study->session.options.repair;
    return (study->subject.has_leaky ? SKG_REPAIR_EXACT : own) + (study->subject.has_shells ? COST_UNITE : 0);
}

/* Repair of the pixels where the hits of a leaky mesh do not cancel, against the exact repair; and whether components are united, if the
 * scene has them united. */
static void add_repair(cost_study *study) {
    const int32_t best = cost_best_repair(study);
    cost_setting its = study->subject.own;
    for (its.repair = SKG_REPAIR_NONE; its.repair <= best; its.repair++) {
        const int is_own = its.repair % COST_UNITE == best % COST_UNITE;
        if (study->subject.has_leaky ? its.repair < COST_UNITE || is_own
                                     : study->subject.has_shells && is_own)
            cost_add_point(study, COST_REPAIR, SOON, its);
    }
    its.repair = best;
    study->measured.references[COST_OF_REPAIR].setting = its;
}

/* Meshings in rising order, the scene's own among them, against the finest. */
static void add_triangles(cost_study *study) {
    const int finest = study->meshing_count - 1;
    cost_setting its = study->subject.own;
    int has_own = 0, seen_finer = 0;
    for (int i = 0; i < finest; i++) {
        const int64_t triangles = study->meshings[i].triangles;
        its.meshing = -1;
        if (!has_own && triangles >= study->subject.triangles)
            has_own = 1, cost_add_point(study, COST_TRIANGLES, NEXT, its);
        its.meshing = i;
        if (triangles == study->subject.triangles) continue;
        const int is_next = triangles > study->subject.triangles && seen_finer++ < 2;
        cost_add_point(study, COST_TRIANGLES, is_next ? NEXT : LATER, its);
    }
    its.meshing = -1;
    if (!has_own && study->meshing_count) cost_add_point(study, COST_TRIANGLES, NEXT, its);
    its.meshing = finest;
    study->measured.references[COST_OF_TRIANGLES].setting = its;
}

/* Relaxation, against none with the scene's hysteresis. */
static void add_relaxation(cost_study *study) {
    static const int32_t relaxations[] = {0, 1, 2, 5, 10, 20};
    cost_setting its = study->subject.own;
    if (!study->subject.has_breath) return;
    its.hysteresis = study->subject.body.hysteresis;
    its.relaxation = 0;
    study->measured.references[COST_OF_BREATH].setting = its;
    for (int i = 0; i < 6; i += study->quick ? 2 : 1) {
        its.relaxation = relaxations[i];
        cost_add_point(study, COST_RELAXATION, LAST, its);
    }
    its.relaxation = study->subject.body.relaxation;
    cost_add_point(study, COST_RELAXATION, LAST, its);
}

/* Hysteresis, with the scene's relaxation. */
static void add_hysteresis(cost_study *study) {
    static const double hystereses[] = {0, 0.25, 0.5, 0.75, 1};
    cost_setting its = study->subject.own;
    its.relaxation = study->subject.body.relaxation;
    for (int i = 0; study->subject.has_breath && i < 5; i += study->quick ? 4 : 1) {
        its.hysteresis = hystereses[i];
        cost_add_point(study, COST_HYSTERESIS, LAST, its);
    }
}

static int improve_precision(const cost_study *study, cost_setting *setting) {
    setting->precision = SKG_PRECISION_DOUBLE;
    return study->session.device.double_precision;
}

static int improve_tolerance(const cost_study *study, cost_setting *setting) {
    (void)study;
    setting->tolerance = 0;
    return 1;
}

static int improve_bins(const cost_study *study, cost_setting *setting) {
    setting->bins = study->subject.finest;
    return 1;
}

static int improve_samples(const cost_study *study, cost_setting *setting) {
    (void)study;
    setting->samples *= 4;
    return setting->samples > 0;
}

static int improve_supersampling(const cost_study *study, cost_setting *setting) {
    (void)study;
    setting->supersampling *= 2;
    return 1;
}

static int improve_repair(const cost_study *study, cost_setting *setting) {
    setting->repair = cost_best_repair(study);
    return 1;
}

static int improve_triangles(const cost_study *study, cost_setting *setting) {
    setting->meshing = cost_coarse_meshing(study);
    return setting->meshing >= 0;
}

/* The values of each dial, and a better one for the coarse pass, which is 0 where there is none. Not members of cost_dial: points are compared
 * by its rows, so that these functions stand above. */
static const struct {
    void (*add)(cost_study *study);
    int (*improve)(const cost_study *study, cost_setting *setting);
} rows[COST_DIALS] = {[COST_PRECISION] = {add_precision, improve_precision},
                      [COST_TOLERANCE] = {add_tolerances, improve_tolerance},
                      [COST_BINS] = {add_bins, improve_bins},
                      [COST_SAMPLES] = {add_samples, improve_samples},
                      [COST_SUPERSAMPLING] = {add_supersampling, improve_supersampling},
                      [COST_REPAIR] = {add_repair, improve_repair},
                      [COST_TRIANGLES] = {add_triangles, improve_triangles},
                      [COST_RELAXATION] = {add_relaxation, NULL},
                      [COST_HYSTERESIS] = {add_hysteresis, NULL}};

int cost_improve(const cost_study *study, int dial, cost_setting *setting) {
    return rows[dial].improve(study, setting);
}

cost_setting cost_best_of_all(const cost_study *study, double max_ms) {
    const int32_t max_side = study->quick ? 8 : 16;
    const int64_t max_samples = study->quick ? 256 : 4096;
    cost_setting its = study->subject.own;
    its.meshing = study->meshing_count - 1;
    if (study->subject.has_leaky) its.repair = cost_best_repair(study);
    for (int grown = 1; grown;) {
        cost_setting more = its;
        grown = 0;
        more.supersampling *= 2;
        if (more.supersampling <= max_side && cost_estimate_ms(study, &more) <= max_ms) its = more, grown = 1;
        more = its;
        more.samples *= 4;
        if (more.samples > 0 && more.samples <= max_samples && cost_estimate_ms(study, &more) <= max_ms)
            its = more, grown = 1;
    }
    return its;
}

void cost_choose_settings(cost_study *study) {
    cost_add_point(study, COST_SCENE, NOW, study->subject.own);
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++) {
        rows[dial].add(study);
        if (dial == COST_BINS) add_changes(study);
    }
}
