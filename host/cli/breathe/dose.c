/* The dose of all frames of a film together. */
#include "breathe/outputs.h"

#include "common/encode.h"

#include <stdio.h>

skg_status film_dose(const fluoroscopy *f, int64_t frames, skg_dose **sum) {
    skg_dose_options options;
    skg_dose *one = NULL;
    const double times = (double)frames;
    *sum = NULL;
    skg_dose_options_init(&options);
    options.histories = 0;
    skg_status status = skg_dose_create(f->plan, &options, &one);
    if (status == SKG_OK) status = skg_dose_sum(1, &one, &times, sum);
    skg_dose_release(&one);
    /* Without mAs a tube has no number of photons, and curved detectors no field. */
    return status == SKG_ERR_BEAM || status == SKG_ERR_UNSUPPORTED ? SKG_OK : status;
}

static void read_sum(const skg_dose *sum, skg_dose_report *report, skg_dose_point *point) {
    skg_dose_report_init(report);
    skg_dose_point_init(point);
    skg_dose_report_get(sum, report);
    skg_dose_point_get(sum, 0, point);
}

json_t *film_dose_json(const skg_dose *sum) {
    skg_dose_report report;
    skg_dose_point point;
    if (!sum) return json_null();
    read_sum(sum, &report, &point);
    json_t *object = json_object();
    json_object_set_new(object, "at", cli_json_numbers(point.at, 3));
    json_object_set_new(object, "air_kerma_uGy", cli_json_number(point.air_kerma_ugy));
    json_object_set_new(object, "kap_uGy_cm2", cli_json_number(report.kap_ugy_cm2));
    json_object_set_new(object, "detector_air_kerma_uGy", cli_json_number(report.detector_air_kerma_ugy));
    return object;
}

void film_dose_print(const skg_dose *sum) {
    skg_dose_report report;
    skg_dose_point point;
    if (!sum) return;
    read_sum(sum, &report, &point);
    printf(
        "all frames together: air kerma %.4g uGy free in air at (%.6g, %.6g, %.6g) mm, kerma-area product %.4g "
        "uGy cm2,\nair kerma at the detector %.4g uGy\n",
        point.air_kerma_ugy, point.at[0], point.at[1], point.at[2], report.kap_ugy_cm2,
        report.detector_air_kerma_ugy);
}
