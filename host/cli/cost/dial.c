/* The table of dials; reads, writes, describes and compares their values, and finds the cheapest setting within an error. */
#include "cost/dial.h"

#include "common/encode.h"

#include <math.h>
#include <string.h>

static const char *precision_word(const cost_study *study, const cost_setting *setting) {
    (void)study;
    return cost_precision_name(setting);
}

static double triangle_count(const cost_study *study, const cost_setting *setting) {
    return (double)cost_triangles(study, setting);
}

#define INT32(member) offsetof(cost_setting, member), COST_IS_INT32
#define INT64(member) offsetof(cost_setting, member), COST_IS_INT64
#define REAL(member) offsetof(cost_setting, member), COST_IS_REAL

/* clang-format off */
const cost_dial cost_dials[COST_DIALS] = {
    [COST_SCENE] = {.name = "scene", .reference = COST_OF_RAYS},
    [COST_PRECISION] = {"precision", "precision", COST_OF_RAYS, INT32(precision), -1, precision_word, NULL,
                        "%s precision", "%s", " --precision %s", NULL},
    [COST_TOLERANCE] = {"tolerance", "tolerance", COST_OF_RAYS, REAL(tolerance), -1, NULL, NULL,
                        "tolerance %.3g", "tolerance %.3g", " --tolerance %.3g", NULL},
    [COST_BINS] = {"bins", "bins", COST_OF_RAYS, INT64(bins), 0, NULL, NULL,
                   "%.0f bins", "%.0f bins", " --set Source.Beam.MaxNumberOfEnergyBins=%.0f", "max_bins"},
    [COST_SAMPLES] = {"source samples", "samples", COST_OF_SAMPLES, INT64(samples), 0, NULL, NULL,
                      "%.0f source samples", "%.0f samples", " --set Source.Samples=%.0f", NULL},
    [COST_SUPERSAMPLING] = {"supersampling", "supersampling", COST_OF_AREAS, INT32(supersampling), -1, NULL, NULL,
                            "%1$.0f x %1$.0f rays a pixel", "%1$.0f x %1$.0f rays", " --set Detector.Oversampling=%.0f", NULL},
    [COST_REPAIR] = {"repair", "repair", COST_OF_REPAIR, INT32(repair), -1, cost_repair_of, NULL,
                     "%s repair", "repair %s", NULL, NULL},
    [COST_TRIANGLES] = {"triangles", "triangles", COST_OF_TRIANGLES, INT32(meshing), -1, NULL, triangle_count,
                        "%.0f triangles", "%.0f triangles", NULL, NULL},
    [COST_RELAXATION] = {"relaxation", "relaxation", COST_OF_BREATH, INT32(relaxation), -1, NULL, NULL,
                         NULL, "relaxation %.0f", NULL, NULL},
    [COST_HYSTERESIS] = {"hysteresis", "hysteresis", COST_OF_BREATH, REAL(hysteresis), -1, NULL, NULL,
                         NULL, "hysteresis %g", NULL, NULL}};
/* clang-format on */

static size_t bytes_of(int dial) {
    return cost_dials[dial].kind == COST_IS_INT32 ? sizeof(int32_t) : 8;
}

void cost_take(int dial, const cost_setting *from, cost_setting *to) {
    const size_t at = cost_dials[dial].at;
    memcpy((char *)to + at, (const char *)from + at, bytes_of(dial));
}

double cost_read(int kind, const void *at) {
    int32_t small;
    int64_t large;
    double real;
    switch (kind) {
    case COST_IS_INT32:
        memcpy(&small, at, sizeof small);
        return small;
    case COST_IS_INT64:
        memcpy(&large, at, sizeof large);
        return (double)large;
    default:
        memcpy(&real, at, sizeof real);
        return real;
    }
}

json_t *cost_number_json(int kind, double value) {
    return kind == COST_IS_REAL ? cli_json_number(value) : json_integer((json_int_t)value);
}

void cost_put_number(FILE *stream, int kind, double value) {
    if (!isnan(value)) fprintf(stream, kind == COST_IS_REAL ? "%.6g" : "%.0f", value);
    fputc(',', stream);
}

static double value_of(int dial, const cost_setting *setting) {
    return cost_read(cost_dials[dial].kind, (const char *)setting + cost_dials[dial].at);
}

int cost_has_value(int dial, const cost_setting *setting) {
    return value_of(dial, setting) != cost_dials[dial].none;
}

static double number_of(const cost_study *study, const cost_setting *setting, int dial) {
    const cost_dial *row = &cost_dials[dial];
    return row->number ? row->number(study, setting) : value_of(dial, setting);
}

/* A word, or NULL: the value is a number. Empty: the scene has no such dial. */
static const char *word_of(const cost_study *study, const cost_setting *setting, int dial) {
    if (dial == COST_REPAIR && !study->subject.has_leaky && !study->subject.has_shells) return "";
    return cost_dials[dial].word ? cost_dials[dial].word(study, setting) : NULL;
}

json_t *cost_value_json(const cost_study *study, const cost_setting *setting, int dial) {
    const char *word = word_of(study, setting, dial);
    const double number = number_of(study, setting, dial);
    if (word) return *word ? cli_json_text(word) : json_null();
    if (number == cost_dials[dial].none) return json_null();
    return cost_number_json(cost_dials[dial].kind, number);
}

void cost_put_value(FILE *stream, const cost_study *study, const cost_setting *setting, int dial) {
    const char *word = word_of(study, setting, dial);
    const double number = number_of(study, setting, dial);
    if (word)
        fprintf(stream, "%s,", word);
    else /* below 0: the setting has no breath */
        cost_put_number(stream, cost_dials[dial].kind, number < 0 ? (double)NAN : number);
}

void cost_append_value(const cost_study *study, const cost_setting *setting, int dial, const char *format,
                       char *text, size_t size) {
    const cost_dial *row = &cost_dials[dial];
    if (row->word)
        cost_append(text, size, format, row->word(study, setting));
    else
        cost_append(text, size, format, number_of(study, setting, dial));
}

/* For people, to whom the number of the finest bins says nothing. */
static void append_words(const cost_study *study, const cost_setting *setting, int dial, const char *format,
                         char *text, size_t size) {
    if (dial == COST_BINS && setting->bins == COST_FINEST_BINS) format = "bins of 1 keV";
    if (dial == COST_BINS && !cost_has_value(dial, setting)) format = "the scene's bins";
    cost_append_value(study, setting, dial, format, text, size);
}

void cost_describe_dial(const cost_study *study, const cost_setting *setting, int dial, char *text,
                        size_t size) {
    *text = '\0';
    if (dial < COST_DIALS && cost_dials[dial].sentence)
        append_words(study, setting, dial, cost_dials[dial].sentence, text, size);
    else
        cost_describe(study, setting, text, size);
}

void cost_describe(const cost_study *study, const cost_setting *setting, char *text, size_t size) {
    *text = '\0';
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++) {
        if (!cost_has_value(dial, setting)) continue;
        if (*text) cost_append(text, size, ", ");
        append_words(study, setting, dial, cost_dials[dial].listed, text, size);
    }
}

/* A repair may be the scene's own by number, or by standing for it. */
static int is_same_value(const cost_study *study, int dial, const cost_setting *a, const cost_setting *b) {
    if (dial == COST_REPAIR) return cost_repair(study, a) == cost_repair(study, b);
    return value_of(dial, a) == value_of(dial, b);
}

int cost_is_same(const cost_study *study, const cost_setting *a, const cost_setting *b) {
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++)
        if (!is_same_value(study, dial, a, b)) return 0;
    return 1;
}

int cost_changed_dial(const cost_study *study, const cost_setting *setting) {
    int found = COST_SCENE;
    for (int dial = COST_PRECISION; dial < COST_DIALS; dial++)
        if (!is_same_value(study, dial, setting, &study->subject.own))
            found = found == COST_SCENE ? dial : COST_SEVERAL;
    return found;
}

const char *cost_dial_name(int dial) {
    return dial == COST_SEVERAL ? "several" : cost_dials[dial].name;
}

int cost_cheapest(const cost_study *study, int count, cost_look look, const void *user, double most,
                  int *best) {
    int cheapest = -1, nearest = -1;
    double price = 0, error = 0;
    for (int i = 0; i < count; i++) {
        const cost_offer its = look(study, i, user);
        if (isnan(its.error)) continue;
        if (nearest < 0 || its.error < error) nearest = i, error = its.error;
        if (its.error <= most && (cheapest < 0 || its.price < price)) cheapest = i, price = its.price;
    }
    if (best) *best = nearest;
    return cheapest;
}

int cost_is_on_frontier(const cost_study *study, int count, cost_look look, const void *user, int index) {
    const cost_offer its = look(study, index, user);
    for (int i = 0; i < count; i++) {
        const cost_offer other = look(study, i, user);
        const int no_worse = other.price <= its.price && other.error <= its.error;
        if (no_worse && (other.price < its.price || other.error < its.error)) return 0;
    }
    return !isnan(its.error);
}

double cost_price_of(const cost_study *study, const cost_point *point) {
    return study->measured.shots[point->shot].price_ms;
}
