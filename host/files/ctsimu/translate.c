/* A scenario as a whole. */
#include "ctsimu/parts.h"

#include <string.h>

int skg_ctsimu_is(const skg_json_file *file) {
    const json_t *root = file->root;
    const char *type = json_string_value(json_object_get(json_object_get(root, "file"), "file_type"));
    if (type && strncmp(type, "CTSimU", 6) == 0) return 1;
    return json_is_object(json_object_get(root, "geometry")) &&
           json_is_object(json_object_get(root, "acquisition"));
}

/* Formats 1.0 to 1.2, and later ones of version 1 with a warning. */
static skg_status check_version(skg_ctsimu *scenario) {
    const skg_item root = skg_item_root(scenario), type = skg_item_at(&root, "file.file_type");
    const skg_item major_item = skg_item_at(&root, "file.file_format_version.major");
    const skg_item minor_item = skg_item_at(&root, "file.file_format_version.minor");
    const char *name = NULL;
    int64_t major = 1, minor = 0;
    SKG_TRY(skg_item_text(&type, &name));
    if (name && strcmp(name, "CTSimU Scenario") != 0)
        return skg_item_fail(&type, SKG_ERR_UNSUPPORTED,
                             "is \"%s\"; a scan needs a \"CTSimU Scenario\", which the metadata names", name);
    SKG_TRY(skg_item_integer(&major_item, 0, INT32_MAX, &major));
    SKG_TRY(skg_item_integer(&minor_item, 0, INT32_MAX, &minor));
    if (major != 1)
        return skg_item_fail(
            &major_item, SKG_ERR_UNSUPPORTED,
            "is %lld; formats 1.0 to 1.2 are read, and the toolbox ctsimu converts older files",
            (long long)major);
    return minor <= 2
               ? SKG_OK
               : skg_item_remark(&minor_item, "is later than format 1.2, which is the last that is known");
}

static skg_status translate(skg_ctsimu *scenario, json_t *scene) {
    static const char *const sections[] = {"Source", "Detector", "Scan"};
    skg_ctsimu_geometry geometry = {.columns = 0};
    skg_status status = SKG_OK;
    SKG_TRY(check_version(scenario));
    for (int s = 0; s < 3; s++) SKG_TRY(skg_ctsimu_put(scene, sections[s], json_object()));
    SKG_TRY(skg_ctsimu_put(scene, "Samples", json_array()));
    SKG_TRY_CLEANUP(skg_ctsimu_read_geometry(scenario, &geometry));
    SKG_TRY_CLEANUP(skg_ctsimu_put_views(scenario, &geometry, scene));
    SKG_TRY_CLEANUP(skg_ctsimu_put_samples(scenario, &geometry, scene));
    SKG_TRY_CLEANUP(skg_ctsimu_put_world(scenario, scene));
    SKG_TRY_CLEANUP(skg_ctsimu_put_beam(scenario, &geometry, scene));
    SKG_TRY_CLEANUP(skg_ctsimu_put_detector(scenario, &geometry, scene));
    SKG_TRY_CLEANUP(skg_ctsimu_put_acquisition(scenario, scene));
    SKG_TRY_CLEANUP(skg_ctsimu_remark_rest(scenario));
cleanup:
    skg_ctsimu_geometry_free(&geometry);
    return status;
}

skg_status skg_ctsimu_translate(skg_json_file *file, skg_ctsimu_find find, void *user) {
    skg_ctsimu scenario = {
        .file = file, .find = find, .user = user, .drifts_read = json_array(), .frames = 1};
    json_t *scene = json_object();
    skg_status status = scene && scenario.drifts_read
                            ? translate(&scenario, scene)
                            : skg_fail(SKG_ERR_MEMORY, "%s: no memory for its scene", file->path);
    json_decref(scenario.drifts_read);
    if (status != SKG_OK) {
        json_decref(scene);
        return status;
    }
    json_decref(file->root);
    file->root = scene;
    skg_free(&file->text);
    return SKG_OK;
}
