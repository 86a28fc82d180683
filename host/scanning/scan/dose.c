/* The dose of a scan, as the sum over its projections. */
#include "core/core.h"
#include "core/log.h"
#include "core/text.h"
#include "frame/quiet.h"

#include <skiagraph/scan_dose.h>

#include <inttypes.h>

/* More projections are not followed: over a 64th of a turn the dose of a part changes little, and evenly. */
enum { FOLLOWED_MAX = 64 };

/* The k-th projection that is followed: in the middle of its share. */
static int64_t projection_of(int64_t k, int64_t followed, int64_t projections) {
    return (2 * k + 1) * projections / (2 * followed);
}

static skg_status expose(skg_plan *plan, const skg_scan *scan, int64_t index, const skg_dose_options *options,
                         skg_dose **dose) {
    skg_view view;
    skg_view_init(&view);
    SKG_TRY(skg_scan_view_get(scan, index, &view));
    const skg_status status = skg_plan_view_set(plan, &view);
    if (status == SKG_STALE)
        return skg_fail(SKG_ERR_UNSUPPORTED, "dose: projection %" PRId64 ": %s", index, skg_last_error());
    SKG_TRY(status);
    return skg_dose_create(plan, options, dose);
}

/* The place where air kerma is wanted if none is named: that of the first projection. */
static skg_status find_place(skg_plan *plan, const skg_scan *scan, double place[3]) {
    skg_dose_options options;
    skg_dose_point point;
    skg_dose *dose = NULL;
    skg_dose_options_init(&options);
    skg_dose_point_init(&point);
    options.histories = 0;
    SKG_TRY(expose(plan, scan, 0, &options, &dose));
    const skg_status status = skg_dose_point_get(dose, 0, &point);
    skg_dose_release(&dose);
    for (int k = 0; k < 3; k++) place[k] = point.at[k];
    return status;
}

static skg_status create(skg_plan *plan, const skg_scan *scan, const skg_dose_options *given,
                         skg_dose **dose) {
    SKG_PLAIN;
    skg_dose *exposures[FOLLOWED_MAX] = {0};
    double times[FOLLOWED_MAX], place[3];
    int64_t projections = 0;
    skg_dose_options options;
    skg_view first;
    skg_status status = SKG_OK, back;
    SKG_NEEDS_OF("skg_scan_dose_create", plan);
    SKG_NEEDS_OF("skg_scan_dose_create", scan);
    SKG_NEEDS_OF("skg_scan_dose_create", dose);
    *dose = NULL;
    skg_dose_options_init(&options);
    if (given) SKG_TRY(skg_struct_read(given, "skg_dose_options", &options, sizeof options));
    skg_view_init(&first);
    SKG_TRY(skg_scan_projection_count(scan, &projections));
    SKG_TRY(skg_scan_view_get(scan, 0, &first));
    const int64_t followed = projections < FOLLOWED_MAX ? projections : FOLLOWED_MAX;
    skg_progress *progress = options.progress;
    options.progress = NULL;
    options.histories =
        options.histories > 0 ? (options.histories + followed - 1) / followed : options.histories;
    if (options.point_count == 0) {
        SKG_TRY(find_place(plan, scan, place));
        options.point_count = 1, options.points = place;
    }
    for (int64_t k = 0; k < followed; k++, options.seed++) {
        SKG_TRY_CLEANUP(skg_progress_step(progress, k, followed));
        times[k] = (double)projections / (double)followed;
        SKG_TRY_CLEANUP(expose(plan, scan, projection_of(k, followed, projections), &options, &exposures[k]));
    }
    SKG_TRY_CLEANUP(skg_progress_step(progress, followed, followed));
    status = skg_dose_sum(followed, exposures, times, dose);
cleanup:
    back = skg_plan_view_set(plan, &first); /* also after a failure */
    if (status == SKG_OK) status = back;
    for (int64_t k = 0; k < followed; k++) skg_dose_release(&exposures[k]);
    if (status != SKG_OK) skg_dose_release(dose);
    return status;
}

skg_status skg_scan_dose_create(skg_plan *plan, const skg_scan *scan, const skg_dose_options *options,
                                skg_dose **dose) {
    const skg_call begun = skg_plan_call_begin(plan);
    return skg_call_end(begun, create(plan, scan, options, dose));
}
