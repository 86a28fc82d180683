#include "core/text.h"
#include "plan/decisions.h"
#include "spectral/verification.h"

#include <inttypes.h>
#include <stdio.h>

skg_status skg_plan_precision_bound(const skg_recipe *recipe, double *bound) {
    skg_rounding found;
    SKG_TRY(skg_rounding_find(recipe->scene, &recipe->view, &recipe->model, &recipe->options, &found));
    *bound = found.bound;
    return SKG_OK;
}

static skg_status warn_half(const skg_recipe *recipe, const skg_context *context) {
    double bound = 0;
    SKG_TRY(skg_plan_precision_bound(recipe, &bound));
    skg_log(
        context, SKG_LOG_WARNING,
        "precision half: intensities of this scene may be wrong by %.2g %%, since distances from the source are "
        "rounded to 11 bits; it is for comparison with 16-bit buffers; take single otherwise",
        100 * bound);
    return SKG_OK;
}

skg_status skg_plan_precision_warn(const skg_recipe *recipe, const skg_context *context) {
    skg_rounding found;
    char more[64] = "";
    if (recipe->options.precision == SKG_PRECISION_HALF) return warn_half(recipe, context);
    if (recipe->options.precision == SKG_PRECISION_DOUBLE) return SKG_OK;
    SKG_TRY(skg_rounding_find_thin(recipe->scene, &recipe->view, &recipe->model, &recipe->options, &found));
    if (found.thin_count == 0) return SKG_OK;
    if (found.thin_count > 1)
        snprintf(more, sizeof more, " (and %" PRId64 " more %s)", found.thin_count - 1,
                 skg_plural(found.thin_count - 1, "part", "parts"));
    skg_log(
        context, SKG_LOG_WARNING,
        "part %s%s is thin and lies along the rays: in precision single its path of up to %.3g mm may be wrong by %.2g "
        "mm, %.2g %% of it; take precision double",
        recipe->scene->parts[found.thin].label, more, found.thin_longest, found.thin_error,
        100 * found.thin_error / found.thin_longest);
    return SKG_OK;
}
