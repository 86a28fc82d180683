/* acquisition: times, flat and dark fields, and how the current drifts. */
#include "ctsimu/parts.h"

/* {"Number": 3, "Frames": 20, "Noise": true} */
static skg_status put_fields(const skg_item *item, const char *key, json_t *scan) {
    const skg_item number = skg_item_at(item, "number"), frames = skg_item_at(item, "frame_average");
    const skg_item ideal = skg_item_at(item, "ideal"), corrected = skg_item_at(item, "correction");
    int64_t count = 0, average = 1;
    int32_t is_ideal = 0, is_corrected = 0;
    SKG_TRY(skg_item_integer(&number, 0, 1000, &count));
    SKG_TRY(skg_item_integer(&frames, 1, 1000000, &average));
    SKG_TRY(skg_item_flag(&ideal, &is_ideal));
    SKG_TRY(skg_item_flag(&corrected, &is_corrected));
    if (is_corrected && count > 0)
        SKG_TRY(skg_item_remark(
            &corrected, "projections are written as they are recorded; flat and dark fields beside them "
                        "serve to correct them"));
    return skg_ctsimu_put(scan, key,
                          json_pack("{s:I, s:I, s:b}", "Number", (json_int_t)count, "Frames",
                                    (json_int_t)average, "Noise", !is_ideal));
}

/* Intensity of each projection over that of the first one. */
static skg_status put_intensity(skg_ctsimu *scenario, json_t *scan) {
    const skg_item root = skg_item_root(scenario), current = skg_item_at(&root, "source.current");
    skg_parameter drift = {0};
    skg_status status = skg_parameter_read(&current, SKG_UNIT_MA, 1, &drift);
    if (status == SKG_OK && drift.all) {
        json_t *list = json_array();
        const double first = skg_parameter_at(&drift, 0, 0);
        for (int64_t k = 0; k < scenario->frames && status == SKG_OK; k++) {
            const double share = skg_parameter_at(&drift, k, 0) / first;
            if (!(share >= 0))
                status =
                    skg_item_fail(&current, SKG_ERR_BEAM, "is negative in projection %lld", (long long)k);
            json_array_append_new(list, json_real(share));
        }
        if (status == SKG_OK)
            status = skg_ctsimu_put(scan, "Intensity", list);
        else
            json_decref(list);
    }
    skg_parameter_free(&drift);
    return status;
}

skg_status skg_ctsimu_put_acquisition(skg_ctsimu *scenario, json_t *scene) {
    const skg_item root = skg_item_root(scenario), acquisition = skg_item_at(&root, "acquisition");
    const skg_item exposure_item = skg_item_at(&root, "detector.integration_time");
    const skg_item dead_item = skg_item_at(&root, "detector.dead_time");
    const skg_item average = skg_item_at(&acquisition, "frame_average");
    const skg_item flats = skg_item_at(&acquisition, "flat_field"),
                   darks = skg_item_at(&acquisition, "dark_field");
    json_t *scan = json_object_get(scene, "Scan");
    double exposure = 0, dead = 0;
    int64_t frames = 1;
    SKG_TRY(skg_item_number(&exposure_item, SKG_UNIT_S, &exposure));
    SKG_TRY(skg_item_number(&dead_item, SKG_UNIT_S, &dead));
    SKG_TRY(skg_item_integer(&average, 1, 1000000, &frames));
    SKG_TRY(skg_ctsimu_put(scan, "Interval", json_real((double)frames * (exposure + dead))));
    SKG_TRY(skg_ctsimu_put(scan, "Exposure", json_real((double)frames * exposure)));
    SKG_TRY(put_fields(&flats, "Flats", scan));
    SKG_TRY(put_fields(&darks, "Darks", scan));
    SKG_TRY(put_intensity(scenario, scan));
    return skg_ctsimu_put(scan, "Layout", json_string("CTSimU"));
}
