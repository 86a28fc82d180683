/* Sources of error that are dials, and why one is absent. */
#include "cost/findings.h"

#include "common/say.h"
#include "cost/dial.h"
#include "cost/dials.h"
#include "cost/measuring.h"
#include "cost/output.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

const cost_source_row cost_sources[COST_SOURCES] = {
    [COST_SOURCE_TRIANGLES] = {"triangles", COST_TRIANGLES},
    [COST_SOURCE_PRECISION] = {"precision", COST_PRECISION},
    [COST_SOURCE_BINS] = {"bins of the spectrum", COST_BINS},
    [COST_SOURCE_TOLERANCE] = {"tolerance", COST_TOLERANCE},
    [COST_SOURCE_SAMPLES] = {"source samples", COST_SAMPLES},
    [COST_SOURCE_SUPERSAMPLING] = {"supersampling", COST_SUPERSAMPLING},
    [COST_SOURCE_REPAIR] = {"repair", COST_REPAIR},
    [COST_SOURCE_SURFACE] = {"true surface", COST_SCENE},
    [COST_SOURCE_SCATTER] = {"scatter", COST_SCENE}};

static int reference_of(int source) {
    return cost_dials[cost_sources[source].dial].reference;
}

/* The setting in which only this source errs: the scene's value, all else as the reference has it. */
static cost_setting alone(const cost_study *study, int source) {
    cost_setting its = study->measured.references[reference_of(source)].setting;
    cost_take(cost_sources[source].dial, &study->subject.own, &its);
    return its;
}

static int find_point(const cost_study *study, int reference, const cost_setting *setting) {
    for (int i = 0; i < study->measured.count; i++)
        if (study->measured.points[i].reference == reference &&
            cost_is_same(study, &study->measured.points[i].setting, setting))
            return i;
    return -1;
}

/* Points that differ from today's in the source's dial only. */
typedef struct {
    int source, today;
} family;

static cost_offer look_at_family(const cost_study *study, int index, const void *user) {
    const family *its = user;
    const cost_point *point = &study->measured.points[index];
    cost_setting changed = study->measured.points[its->today].setting;
    cost_take(cost_sources[its->source].dial, &point->setting, &changed);
    const int is_of_it = index != its->today && point->reference == reference_of(its->source) &&
                         cost_is_same(study, &changed, &point->setting);
    return (cost_offer){is_of_it ? point->rms_flat : (double)NAN, cost_price_of(study, point)};
}

/* Price of the halving: change of the time of today's image, ms. Where today's value was measured with other settings of the remaining
 * dials, the times are scaled by their ratio. */
static void price(const cost_study *study, cost_source *source) {
    const cost_shot *here = &study->measured.shots[study->measured.here];
    const cost_shot *from = &study->measured.shots[study->measured.points[source->own].shot];
    const cost_shot *to = &study->measured.shots[study->measured.points[source->halving].shot];
    const double scale = from == here ? 1 : here->price_ms / from->price_ms;
    source->halving_ms = scale * (to->price_ms - from->price_ms);
    source->halving_uncertainty_ms = scale * hypot(to->uncertainty_ms, from->uncertainty_ms);
}

/* The scene with the dial's better value, all else as it is. */
static int name_halving(const cost_study *study, int number, cost_source *source) {
    const int dial = cost_sources[number].dial;
    cost_setting setting = study->subject.own;
    cost_take(dial, &study->measured.points[source->halving].setting, &setting);
    cost_describe_dial(study, &setting, dial, source->buys, sizeof source->buys);
    source->command = cost_command(study, &setting);
    return source->command ? CLI_DONE : cli_error(CLI_DEVICE, "out of host memory");
}

const char *cost_why_not(const cost_study *study, int source) {
    const skg_spot *spot = study->session.options.spot;
    if (source == COST_SOURCE_TRIANGLES && *study->triangles_reason) return study->triangles_reason;
    if (source == COST_SOURCE_TRIANGLES && !study->subject.has_round)
        return "the body that the triangles stand for is not known, so that no finer mesh can be made";
    if (source == COST_SOURCE_PRECISION && !study->session.device.double_precision)
        return "not measured: the device has no double precision";
    if (source == COST_SOURCE_SAMPLES && spot && spot->shape != SKG_SPOT_POINT && spot->grid > 0)
        return "not measured: the scene fixes the samples by a grid";
    return cost_time_reason();
}

const char *cost_why_absent(const cost_study *study, int source) {
    const char *label;
    switch (source) {
    case COST_SOURCE_TRIANGLES:
    case COST_SOURCE_SURFACE:
        if (cost_count_unknown(study, &label) > 0 && !study->subject.is_thorax) return NULL;
        if (source == COST_SOURCE_SURFACE && study->subject.is_thorax < 0) return NULL;
        if (source == COST_SOURCE_SURFACE) return "every part is a body whose surface is known";
        return study->subject.has_round ? NULL : "cuboids and step wedges are exact";
    case COST_SOURCE_PRECISION:
        return study->subject.own.precision == SKG_PRECISION_DOUBLE ? "the scene has double precision" : NULL;
    case COST_SOURCE_BINS:
        if (!study->subject.has_energies) return "the beam has one energy";
        return study->subject.finest == 0 ? "the spectrum's bins are not wider than they need be" : NULL;
    case COST_SOURCE_TOLERANCE:
        if (!study->subject.has_energies) return "the beam has one energy";
        return study->subject.own.tolerance > 0 ? NULL : "the tolerance is 0: every energy is computed";
    case COST_SOURCE_SAMPLES:
        return study->subject.has_spot ||
                       (study->session.options.spot && study->session.options.spot->grid > 0)
                   ? NULL
                   : "the source is a point or a parallel beam";
    case COST_SOURCE_REPAIR:
        return study->subject.has_leaky || study->subject.has_shells ? NULL : "no mesh is leaky";
    default:
        return NULL;
    }
}

/* The error against the reference of the dial, and what halves it. */
static int take_fine(cost_study *study, int number) {
    cost_source *source = &study->judged.sources[number];
    const cost_point *today = &study->measured.points[source->own];
    source->state = COST_FINE;
    source->error = today->rms_flat;
    source->max = today->max_flat;
    source->halving = cost_cheapest(study, study->measured.count, look_at_family,
                                    &(family){number, source->own}, today->rms_flat / 2, NULL);
    if (source->halving < 0) {
        snprintf(source->reason, sizeof source->reason, "%s",
                 source->error > 0 ? "no measured setting has half of this error"
                                   : "nothing is left to halve");
        return CLI_DONE;
    }
    price(study, source);
    return name_halving(study, number, source);
}

static void take_coarse(cost_study *study, int number) {
    const cost_coarse *coarse = &study->measured.coarse[number];
    cost_source *source = &study->judged.sources[number];
    source->state = coarse->state;
    snprintf(source->reason, sizeof source->reason, "%s", coarse->reason);
    if (coarse->state != COST_COARSE) {
        if (number == COST_SOURCE_TRIANGLES && !study->subject.has_round) source->state = COST_NOT_KNOWN;
        return;
    }
    source->error = coarse->error;
    source->max = coarse->max;
    snprintf(source->reason, sizeof source->reason, "coarsely: beside %s", coarse->compared);
}

static int measure_source(cost_study *study, int number) {
    cost_source *source = &study->judged.sources[number];
    const cost_setting setting = alone(study, number);
    source->own = find_point(study, reference_of(number), &setting);
    if (source->own >= 0) return take_fine(study, number);
    take_coarse(study, number);
    return CLI_DONE;
}

/* Names the parts whose true surface, behind their triangles, no setting changes and no run can measure. */
static void name_unknown(const cost_study *study, cost_source *source) {
    const char *label = "";
    const int64_t parts = cost_count_unknown(study, &label);
    if (study->subject.is_thorax < 0)
        snprintf(source->reason, sizeof source->reason,
                 "not known while the time does not suffice to measure the triangles");
    else
        snprintf(source->reason, sizeof source->reason,
                 "the body behind the triangles of %" PRId64 " part%s (%.40s%s) is not known", parts,
                 parts == 1 ? "" : "s", label, parts > 1 ? " and others" : "");
}

int cost_find_sources(cost_study *study) {
    int exit_status = CLI_DONE;
    study->judged.largest = -1;
    for (int number = 0; number < COST_SOURCES && exit_status == CLI_DONE; number++) {
        cost_source *source = &study->judged.sources[number];
        const char *none = cost_why_absent(study, number);
        *source = (cost_source){.state = COST_ABSENT,
                                .error = (double)NAN,
                                .max = (double)NAN,
                                .own = -1,
                                .halving = -1,
                                .halving_ms = (double)NAN,
                                .halving_uncertainty_ms = (double)NAN};
        if (none) {
            source->error = source->max = 0;
            snprintf(source->reason, sizeof source->reason, "%s", none);
        } else if (number == COST_SOURCE_SCATTER) {
            cost_take_scatter(study, source);
        } else if (number == COST_SOURCE_SURFACE) {
            source->state = COST_NOT_KNOWN;
            name_unknown(study, source);
        } else {
            exit_status = measure_source(study, number);
        }
        if (number < COST_SOURCE_SURFACE &&
            source->error >
                (study->judged.largest < 0 ? 0 : study->judged.sources[study->judged.largest].error))
            study->judged.largest = number;
    }
    return exit_status;
}

void cost_describe_source(const cost_study *study, int number, char *text, size_t size) {
    *text = '\0';
    if (number < COST_SOURCE_SURFACE)
        cost_describe_dial(study, &study->subject.own, cost_sources[number].dial, text, size);
}

/* The error of the most accurate point of a family that is not more accurate than `best`: an upper bound of that of `best`. */
static double error_near(const cost_study *study, int source, const cost_setting *best) {
    double least = (double)NAN;
    for (int i = 0; i < study->measured.count; i++) {
        const cost_point *point = &study->measured.points[i];
        if (point->reference != reference_of(source) || point->dial != cost_sources[source].dial) continue;
        if (point->setting.samples > best->samples || point->setting.supersampling > best->supersampling ||
            cost_triangles(study, &point->setting) > cost_triangles(study, best))
            continue;
        if (!(point->rms_flat >= least)) least = point->rms_flat;
    }
    return least;
}

/* Grey levels, of 256, that a whole flat field is in a PNG of transmission, whose ends are percentiles of the pixels. */
static double find_grey_levels(const cost_study *study) {
    double low = 0, high = 0;
    skg_picture picture;
    skg_picture_init(&picture);
    picture.type = SKG_TYPE_FLOAT64;
    picture.columns = study->session.view.columns;
    picture.rows = study->session.view.rows;
    picture.channels = 1;
    picture.data = study->measured.references[COST_OF_ALL].image;
    picture.display = SKG_DISPLAY_TRANSMISSION;
    picture.quantity = SKG_QUANTITY_ENERGY;
    picture.flat_field = study->subject.flat_field;
    if (!picture.data || skg_picture_window_get(&picture, 0.005, 0.005, &low, &high) != SKG_OK ||
        !(high > low))
        return 0;
    return 255 / (high - low);
}

void cost_find_trust(cost_study *study) {
    static const int sampled[] = {COST_SOURCE_TRIANGLES, COST_SOURCE_SAMPLES, COST_SOURCE_SUPERSAMPLING};
    const cost_setting *best = &study->measured.references[COST_OF_ALL].setting;
    double squares = 0;
    for (int k = 0; k < 3; k++) {
        /* Where no point of the dial was measured, the best image may err as much as the scene's; NaN: nothing is known. */
        const double near = error_near(study, sampled[k], best),
                     own = study->judged.sources[sampled[k]].error;
        const double error = isnan(near) ? own : near;
        if (study->judged.sources[sampled[k]].state != COST_NOT_KNOWN) squares += error * error;
    }
    study->judged.reference_error =
        study->measured.references[COST_OF_ALL].image ? sqrt(squares) : (double)NAN;
    study->judged.grey_levels = find_grey_levels(study);
}

void cost_find_unrest(cost_study *study) {
    study->judged.unrest = (double)NAN;
    if (study->measured.pulse_count >= 4) {
        cost_sort(study->measured.pulse_count, study->measured.pulse_ms);
        const double *ms = study->measured.pulse_ms;
        const int64_t n = study->measured.pulse_count;
        study->judged.unrest = (ms[(3 * n) / 4] - ms[n / 4]) / ms[n / 2];
    }
    for (int i = 0; i < study->measured.shot_count; i++) {
        cost_shot *shot = &study->measured.shots[i];
        if (isnan(shot->uncertainty_ms))
            shot->uncertainty_ms = (isnan(study->judged.unrest) ? 1 : study->judged.unrest) * shot->price_ms;
    }
}
