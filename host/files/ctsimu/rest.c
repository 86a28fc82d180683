/* The keys of the format: which are read, which document something, and which are not simulated. */
#include "ctsimu/parts.h"

#include <stdio.h>
#include <string.h>

/* How a key is treated. A path ends in .* where all that is below is treated alike. */
typedef struct {
    const char *path;
    enum { READ, DOCUMENTS, IGNORED } kind;
    const char *effect; /* of IGNORED: what is done instead */
} key_rule;

static const key_rule rules[] = {
    {"file.*", DOCUMENTS, NULL},
    {"environment.material_id", READ, NULL},
    {"environment.temperature", DOCUMENTS, NULL},
    {"geometry.detector.*", READ, NULL},
    {"geometry.source.beam_divergence", IGNORED, "the beam does not diverge"},
    {"geometry.source.*", READ, NULL},
    {"geometry.stage.*", READ, NULL},
    {"detector.model", DOCUMENTS, NULL},
    {"detector.manufacturer", DOCUMENTS, NULL},
    {"detector.type", READ, NULL},
    {"detector.columns", READ, NULL},
    {"detector.rows", READ, NULL},
    {"detector.pixel_pitch.*", READ, NULL},
    {"detector.bit_depth", READ, NULL},
    {"detector.integration_time", READ, NULL},
    {"detector.dead_time", READ, NULL},
    {"detector.image_lag", READ, NULL},
    {"detector.gray_value.*", READ, NULL},
    {"detector.grey_value.*", READ, NULL},
    {"detector.noise.*", READ, NULL},
    {"detector.gain", DOCUMENTS, NULL},
    {"detector.unsharpness.*", READ, NULL},
    {"detector.sharpness.*", READ, NULL},
    {"detector.bad_pixel_map.*", READ, NULL},
    {"detector.scintillator.*", READ, NULL},
    {"detector.window.front", READ, NULL},
    {"detector.filters.front", READ, NULL},
    {"detector.window.rear", IGNORED, "nothing is scattered back"},
    {"detector.filters.rear", IGNORED, "nothing is scattered back"},
    {"source.model", DOCUMENTS, NULL},
    {"source.manufacturer", DOCUMENTS, NULL},
    {"source.voltage", READ, NULL},
    {"source.current", READ, NULL},
    {"source.target.thickness", IGNORED, "the target is thick"},
    {"source.target.angle.incidence", DOCUMENTS, NULL},
    {"source.target.*", READ, NULL},
    {"source.spot.size.w", IGNORED, "the spot is flat"},
    {"source.spot.sigma.w", IGNORED, "the spot is flat"},
    {"source.spot.*", READ, NULL},
    {"source.spectrum.*", READ, NULL},
    {"source.window", READ, NULL},
    {"source.filters", READ, NULL},
    {"samples", READ, NULL},
    {"acquisition.start_angle", READ, NULL},
    {"acquisition.stop_angle", READ, NULL},
    {"acquisition.direction", READ, NULL},
    {"acquisition.scan_speed", DOCUMENTS, NULL},
    {"acquisition.scan_mode", READ, NULL},
    {"acquisition.number_of_projections", READ, NULL},
    {"acquisition.include_final_angle", READ, NULL},
    {"acquisition.frame_average", READ, NULL},
    {"acquisition.dark_field.*", READ, NULL},
    {"acquisition.flat_field.*", READ, NULL},
    {"acquisition.pixel_binning.*", READ, NULL},
    {"acquisition.scattering", IGNORED, "its photons are added by `image --scatter 0.01` only"},
    {"materials", READ, NULL},
    {"simulation.*", DOCUMENTS, NULL},
};

/* The rule of a path; NULL with *is_group: some rule is below it. */
static const key_rule *find_rule(const char *path, int *is_group) {
    const size_t length = strlen(path);
    *is_group = 0;
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        const char *rule = rules[i].path, *star = strchr(rule, '*');
        if (strcmp(rule, path) == 0) return &rules[i];
        if (strncmp(rule, path, length) == 0 && rule[length] == '.') {
            if (!star || star != rule + length + 1) *is_group = 1;
            if (star == rule + length + 1 && !*is_group) return &rules[i];
        }
        if (star && strncmp(rule, path, (size_t)(star - rule)) == 0) return &rules[i];
    }
    return NULL;
}

/* Whether a value asks for anything. */
static int asks(const json_t *value) {
    if (json_is_object(value) && json_object_get(value, "value"))
        return asks(json_object_get(value, "value"));
    if (json_is_number(value)) return json_number_value(value) != 0;
    if (json_is_string(value)) return *json_string_value(value) != '\0';
    if (json_is_array(value)) return json_array_size(value) > 0;
    if (!json_is_object(value)) return json_is_true(value);
    const char *key = NULL;
    json_t *member = NULL;
    json_object_foreach((json_t *)value, key, member) if (asks(member)) return 1;
    return 0;
}

static skg_status remark_keys(const skg_item *item) {
    const char *key = NULL;
    json_t *value = NULL;
    json_object_foreach(item->value, key, value) {
        const skg_item member = skg_item_at(item, key);
        int is_group = 0;
        if (!member.value || strcmp(key, "comment") == 0) continue;
        const key_rule *rule = find_rule(member.path, &is_group);
        if (is_group && json_is_object(value))
            SKG_TRY(remark_keys(&member));
        else if (!rule && !is_group)
            SKG_TRY(skg_item_remark(&member, "is no key of CTSimU scenarios 1.0 to 1.2, and has no effect"));
        else if (rule && rule->kind == IGNORED && asks(value))
            SKG_TRY(skg_item_remark(&member, "is not simulated: %s", rule->effect));
    }
    return SKG_OK;
}

static int was_read(const skg_ctsimu *scenario, const json_t *drifts) {
    for (size_t i = 0; i < json_array_size(scenario->drifts_read); i++)
        if (json_array_get(scenario->drifts_read, i) == drifts) return 1;
    return 0;
}

/* The files of drifts that are not simulated have to be there all the same. */
static skg_status check_files(const skg_item *drifts) {
    for (int64_t i = 0; i < (int64_t)json_array_size(drifts->value); i++) {
        const skg_item drift = skg_item_element(drifts, i), file = skg_item_at(&drift, "file");
        const char *path = NULL;
        if (json_is_string(file.value)) SKG_TRY(skg_item_file(&file, &path));
    }
    return SKG_OK;
}

/* Drifts that nobody read, wherever they are. */
static skg_status remark_drifts(const skg_item *item) {
    const char *key = NULL;
    json_t *value = NULL;
    for (int64_t i = 0; i < (int64_t)json_array_size(item->value); i++) {
        const skg_item element = skg_item_element(item, i);
        SKG_TRY(remark_drifts(&element));
    }
    if (!json_is_object(item->value)) return SKG_OK;
    json_object_foreach(item->value, key, value) {
        const skg_item member = skg_item_at(item, key);
        if (!member.value) continue;
        if (strcmp(key, "drifts") != 0)
            SKG_TRY(remark_drifts(&member));
        else if (!was_read(item->scenario, value) && asks(value)) {
            SKG_TRY(check_files(&member));
            SKG_TRY(skg_item_remark(&member, "is not simulated; the value itself holds throughout the scan"));
        }
    }
    return SKG_OK;
}

skg_status skg_ctsimu_remark_rest(skg_ctsimu *scenario) {
    const skg_item root = skg_item_root(scenario), mode = skg_item_at(&root, "acquisition.scan_mode");
    const char *name = NULL;
    int64_t bins = 1;
    SKG_TRY(remark_keys(&root));
    SKG_TRY(remark_drifts(&root));
    SKG_TRY(skg_item_text(&mode, &name));
    if (name && strcmp(name, "continuous") == 0)
        SKG_TRY(skg_item_remark(&mode, "the stage stands still while a projection is exposed"));
    for (int k = 0; k < 2; k++) {
        const skg_item binning =
            skg_item_at(&root, k == 0 ? "acquisition.pixel_binning.u" : "acquisition.pixel_binning.v");
        bins = 1;
        SKG_TRY(skg_item_integer(&binning, 1, 1000, &bins));
        if (bins > 1) SKG_TRY(skg_item_remark(&binning, "is not simulated: pixels are written as they are"));
    }
    return SKG_OK;
}
