/* The options of a plan: defaults and checks. */
#include "plan/decisions.h"

#include <inttypes.h>

void skg_plan_options_init_sized(void *options, int32_t size) {
    const skg_plan_options defaults = {.precision = SKG_PRECISION_SINGLE,
                                       .overlaps = 1,
                                       .falloff = SKG_FALLOFF_AUTO,
                                       .supersampling = 1,
                                       .swank = 1,
                                       .repair = SKG_REPAIR_NEIGHBOURS};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

skg_status skg_check_flag(const char *name, int32_t flag) {
    if (flag == 0 || flag == 1) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s is %" PRId32 "; 1 or 0", name, flag);
}

skg_status skg_check_choice(const char *name, int32_t choice, int32_t last, const char *choices) {
    if (choice >= 0 && choice <= last) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s %" PRId32 " is unknown; %s", name, choice, choices);
}

skg_status skg_plan_options_check(const skg_plan_options *options, const skg_device_info *device) {
    SKG_TRY(skg_check_choice("precision", options->precision, SKG_PRECISION_HALF,
                             "SKG_PRECISION_SINGLE, SKG_PRECISION_DOUBLE or SKG_PRECISION_HALF"));
    if (options->precision == SKG_PRECISION_DOUBLE && !device->double_precision)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s has no fp64, so precision double does not work there; take single", device->name);
    SKG_TRY(skg_check_choice("strategy", options->strategy, SKG_STRATEGY_ATOMICS,
                             "SKG_STRATEGY_AUTO, _COPIES, _TILES or _ATOMICS"));
    SKG_TRY(skg_check_choice("quantity", options->quantity, SKG_QUANTITY_ATTENUATION,
                             "SKG_QUANTITY_ENERGY to SKG_QUANTITY_ATTENUATION"));
    if (options->tile < 0 || options->tile > 32768)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a tile of %" PRId32 " pixels is not usable; 0 lets the plan choose", options->tile);
    return skg_check_flag("profile", options->profile);
}
