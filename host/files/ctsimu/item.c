/* Values of a CTSimU scenario with units, drifts and deviations. */
#include "ctsimu/parts.h"

#include "core/files.h"
#include "core/maths.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH = 16, SENTENCE = 1024 };

skg_item skg_item_root(skg_ctsimu *scenario) {
    return (skg_item){.scenario = scenario, .value = scenario->file->root};
}

/* The member with one of the spellings "a|b". */
static json_t *find_member(const json_t *object, const char *spellings, size_t length, char *found,
                           size_t size) {
    const char *at = spellings, *end = spellings + length;
    json_t *value = NULL;
    while (at < end && !value) {
        const char *bar = memchr(at, '|', (size_t)(end - at));
        snprintf(found, size, "%.*s", (int)((bar ? bar : end) - at), at);
        value = json_object_get(object, found);
        at = bar ? bar + 1 : end;
    }
    return value;
}

skg_item skg_item_at(const skg_item *item, const char *keys) {
    skg_item result = *item;
    while (*keys) {
        char key[64];
        const size_t length = strcspn(keys, "."), used = strlen(result.path);
        json_t *value = find_member(result.value, keys, length, key, sizeof key);
        result.value = json_is_null(value) ? NULL : value;
        snprintf(result.path + used, sizeof result.path - used, "%s%s", used ? "." : "", key);
        keys += length + (keys[length] == '.');
    }
    return result;
}

skg_item skg_item_element(const skg_item *array, int64_t index) {
    skg_item result = *array;
    const size_t used = strlen(result.path);
    json_t *value = json_array_get(array->value, (size_t)index);
    result.value = json_is_null(value) ? NULL : value;
    snprintf(result.path + used, sizeof result.path - used, "[%" PRId64 "]", index);
    return result;
}

/* The nodes of a path, from the root on, for messages with a line. Returns the last one. */
static const skg_json_node *make_nodes(const skg_item *item, skg_json_node *nodes, char *keys) {
    int depth = 0;
    nodes[0] = skg_json_root(item->scenario->file);
    strcpy(keys, item->path);
    for (char *at = keys; *at && depth + 1 < DEPTH;) {
        skg_json_node *node = &nodes[depth + 1];
        *node = (skg_json_node){.file = item->scenario->file, .up = &nodes[depth]};
        if (*at == '[') {
            node->index = strtoll(at + 1, &at, 10);
            node->value = json_array_get(nodes[depth].value, (size_t)node->index);
            at++;
        } else {
            const size_t length = strcspn(at, ".[");
            const char after = at[length];
            node->key = at;
            at += length;
            /* "samples[0]": the bracket has to stay for the next node. */
            if (after == '[') memmove(at + 1, at, strlen(at) + 1);
            *at = '\0';
            if (after) at++;
            node->value = json_object_get(nodes[depth].value, node->key);
        }
        if (*at == '.') at++;
        depth++;
    }
    return &nodes[depth];
}

skg_status skg_item_fail(const skg_item *item, skg_status status, const char *format, ...) {
    skg_json_node nodes[DEPTH];
    char keys[SKG_ITEM_PATH + DEPTH], sentence[SENTENCE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    return skg_json_fail(make_nodes(item, nodes, keys), status, "%s", sentence);
}

skg_status skg_item_remark(const skg_item *item, const char *format, ...) {
    skg_json_node nodes[DEPTH];
    char keys[SKG_ITEM_PATH + DEPTH], sentence[SENTENCE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    return skg_json_remark(make_nodes(item, nodes, keys), "%s", sentence);
}

/* The value of a parameter: its member "value" if it is an object. */
static skg_item bare(const skg_item *item) {
    return json_is_object(item->value) ? skg_item_at(item, "value") : *item;
}

int skg_item_given(const skg_item *item) {
    return bare(item).value != NULL;
}

typedef struct {
    const char *name;
    double factor;
} unit_name;

static const double degree = SKG_PI / 180;

static const unit_name *units_of(skg_item_unit unit) {
    static const unit_name lengths[] = {{"mm", 1},   {"nm", 1e-6}, {"um", 1e-3}, {"cm", 10},
                                        {"dm", 100}, {"m", 1000},  {NULL, 0}};
    static const unit_name angles[] = {{"rad", 1}, {"deg", degree}, {NULL, 0}};
    static const unit_name times[] = {{"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}, {NULL, 0}};
    static const unit_name voltages[] = {{"kV", 1}, {"V", 1e-3}, {"MV", 1e3}, {NULL, 0}};
    static const unit_name currents[] = {{"mA", 1}, {"uA", 1e-3}, {"A", 1e3}, {NULL, 0}};
    static const unit_name densities[] = {{"g/cm^3", 1}, {"kg/m^3", 1e-3}, {NULL, 0}};
    static const unit_name none[] = {{NULL, 0}};
    static const unit_name *const all[] = {
        [SKG_UNIT_NONE] = none,   [SKG_UNIT_MM] = lengths,  [SKG_UNIT_RAD] = angles,     [SKG_UNIT_S] = times,
        [SKG_UNIT_KV] = voltages, [SKG_UNIT_MA] = currents, [SKG_UNIT_G_CM3] = densities};
    return all[unit];
}

/* The factor of the unit that stands in an item; an absent one leaves the factor. */
static skg_status read_unit(const skg_item *item, skg_item_unit unit, double *factor) {
    const unit_name *known = units_of(unit);
    const char *name = json_string_value(item->value);
    if (!item->value || !known->name) return SKG_OK;
    for (; known->name && name; known++)
        if (strcmp(known->name, name) == 0) {
            *factor = known->factor;
            return SKG_OK;
        }
    return skg_item_fail(item, SKG_ERR_FORMAT, "\"%s\" is no unit of this quantity; give %s",
                         name ? name : "", units_of(unit)->name);
}

/* Numbers without a unit are in degrees where angles are meant, as the toolbox of the format takes them. */
static double unit_by_default(skg_item_unit unit) {
    return unit == SKG_UNIT_RAD ? degree : 1;
}

skg_status skg_item_number(const skg_item *item, skg_item_unit unit, double *number) {
    const skg_item value = bare(item), name = skg_item_at(item, "unit");
    double factor = unit_by_default(unit);
    if (!value.value) return SKG_OK;
    if (!json_is_number(value.value)) return skg_item_fail(&value, SKG_ERR_FORMAT, "is no number");
    SKG_TRY(read_unit(&name, unit, &factor));
    *number = factor * json_number_value(value.value);
    return SKG_OK;
}

skg_status skg_item_text(const skg_item *item, const char **text) {
    const skg_item value = bare(item);
    *text = NULL;
    if (!value.value) return SKG_OK;
    *text = json_string_value(value.value);
    return *text ? SKG_OK : skg_item_fail(&value, SKG_ERR_FORMAT, "is no string");
}

skg_status skg_item_flag(const skg_item *item, int32_t *flag) {
    const skg_item value = bare(item);
    if (!value.value) return SKG_OK;
    if (!json_is_boolean(value.value))
        return skg_item_fail(&value, SKG_ERR_FORMAT, "is neither true nor false");
    *flag = json_is_true(value.value);
    return SKG_OK;
}

skg_status skg_item_integer(const skg_item *item, int64_t least, int64_t most, int64_t *integer) {
    double number = (double)*integer;
    SKG_TRY(skg_item_number(item, SKG_UNIT_NONE, &number));
    if (number != floor(number) || number < (double)least || number > (double)most)
        return skg_item_fail(item, SKG_ERR_FORMAT, "is %g; give a whole number from %" PRId64 " to %" PRId64,
                             number, least, most);
    *integer = (int64_t)number;
    return SKG_OK;
}

skg_status skg_item_file(const skg_item *item, const char **path) {
    const char *name = NULL;
    SKG_TRY(skg_item_text(item, &name));
    *path = NULL;
    if (!name || !*name) return SKG_OK;
    SKG_TRY(item->scenario->find(item->scenario->user, name, path));
    const skg_status status = skg_input_check(*path, SKG_INPUT_LARGE);
    return status == SKG_OK ? SKG_OK : skg_item_fail(item, status, "%s", skg_last_error());
}

/* Adds the values of a drift, which are spread evenly over the projections. */
static void add_drift(double *sums, int64_t frames, int64_t count, const double *values) {
    for (int64_t k = 0; k < frames; k++) {
        const double at = frames > 1 ? (double)k / (double)(frames - 1) * (double)(count - 1) : 0;
        const int64_t left = (int64_t)fmin(floor(at), (double)(count - 1));
        const double share = at - (double)left;
        const int64_t right = left + 1 < count ? left + 1 : left;
        sums[k] += (1 - share) * values[left] + share * values[right];
    }
}

/* The values of a drift: an array, a number, or the first column of a file. The caller frees them. */
static skg_status read_values(const skg_item *drift, int64_t *count, double **values) {
    const skg_item value = skg_item_at(drift, "value"), file = skg_item_at(drift, "file");
    const char *path = NULL;
    if (json_is_array(value.value)) {
        *count = (int64_t)json_array_size(value.value);
        SKG_TRY(skg_alloc(*count, sizeof **values, "drift", values));
        for (int64_t i = 0; i < *count; i++) {
            const skg_item element = skg_item_element(&value, i);
            if (!json_is_number(element.value))
                return skg_item_fail(&element, SKG_ERR_FORMAT, "is no number");
            (*values)[i] = json_number_value(element.value);
        }
        return SKG_OK;
    }
    if (json_is_number(value.value)) {
        *count = 1;
        SKG_TRY(skg_alloc(1, sizeof **values, "drift", values));
        **values = json_number_value(value.value);
        return SKG_OK;
    }
    SKG_TRY(skg_item_file(&file, &path));
    return path ? skg_read_list(path, count, values) : SKG_OK;
}

static skg_status read_drift(const skg_item *drift, skg_item_unit unit, double factor,
                             skg_parameter *parameter) {
    const skg_item name = skg_item_at(drift, "unit"), known = skg_item_at(drift, "known_to_reconstruction");
    const int64_t frames = drift->scenario->frames;
    double *values = NULL;
    int64_t count = 0;
    int32_t is_known = 1;
    skg_status status = SKG_OK;
    SKG_TRY(read_unit(&name, unit, &factor));
    SKG_TRY(skg_item_flag(&known, &is_known));
    SKG_TRY_CLEANUP(read_values(drift, &count, &values));
    for (int64_t i = 0; i < count; i++) values[i] *= factor;
    if (count > 0) add_drift(parameter->all, frames, count, values);
    if (count > 0 && is_known) add_drift(parameter->known, frames, count, values);
cleanup:
    skg_free(&values);
    return status;
}

skg_status skg_parameter_read(const skg_item *item, skg_item_unit unit, double fallback,
                              skg_parameter *parameter) {
    const skg_item drifts = skg_item_at(item, "drifts"), name = skg_item_at(item, "unit");
    double factor = unit_by_default(unit);
    *parameter = (skg_parameter){.value = fallback};
    SKG_TRY(skg_item_number(item, unit, &parameter->value));
    if (!json_is_object(item->value) || !drifts.value) return SKG_OK;
    json_array_append(item->scenario->drifts_read, drifts.value);
    const int64_t count = json_is_array(drifts.value) ? (int64_t)json_array_size(drifts.value) : 1;
    if (count == 0) return SKG_OK;
    SKG_TRY(read_unit(&name, unit, &factor));
    SKG_TRY(skg_alloc(item->scenario->frames, sizeof(double), "drift", &parameter->all));
    SKG_TRY(skg_alloc(item->scenario->frames, sizeof(double), "drift", &parameter->known));
    for (int64_t i = 0; i < count; i++) {
        const skg_item drift = json_is_array(drifts.value) ? skg_item_element(&drifts, i) : drifts;
        if (drift.value) SKG_TRY(read_drift(&drift, unit, factor, parameter));
    }
    return SKG_OK;
}

void skg_parameter_free(skg_parameter *parameter) {
    skg_free(&parameter->all);
    skg_free(&parameter->known);
}
