#include "plan/options.h"

#include "beam/spectrum.h"
#include "spectral/quantity.h"

#include <inttypes.h>
#include <math.h>

void skg_plan_options_init_sized(void *options, int32_t size) {
    const skg_plan_options defaults = {.precision = SKG_PRECISION_SINGLE,
                                       .overlaps = 1,
                                       .falloff = SKG_FALLOFF_AUTO,
                                       .supersampling = 1,
                                       .swank = 1,
                                       .repair = SKG_REPAIR_NEIGHBOURS};
    skg_struct_init(options, size, &defaults, sizeof defaults);
}

void skg_heel_init_sized(void *heel, int32_t size) {
    const skg_heel defaults = {.anode = 74, .angle_deg = 12, .bin_kev = 1};
    skg_struct_init(heel, size, &defaults, sizeof defaults);
}

void skg_dqe_init_sized(void *dqe, int32_t size) {
    const skg_dqe defaults = {0};
    skg_struct_init(dqe, size, &defaults, sizeof defaults);
}

static skg_status check_kev(const char *what, double kev) {
    if (kev >= 0 && isfinite(kev)) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s is %g keV; 0 or more", what, kev);
}

static skg_status check_flag(const char *name, int32_t flag) {
    if (flag == 0 || flag == 1) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s is %" PRId32 "; 1 or 0", name, flag);
}

static skg_status check_flags(const skg_plan_options *options) {
    SKG_TRY(check_flag("overlaps", options->overlaps));
    SKG_TRY(check_flag("profile", options->profile));
    if (options->falloff != SKG_FALLOFF_AUTO) SKG_TRY(check_flag("falloff", options->falloff));
    SKG_TRY(check_flag("noise", options->noise));
    SKG_TRY(check_flag("oblique", options->oblique));
    return check_flag("clip", options->clip);
}

/* Blur by depths, and noise power by frequency. */
static skg_status check_layers(const skg_plan_options *options) {
    const skg_depth_blur *depths = options->depth_blur;
    const int64_t channels = options->bands > 0 ? options->bands : 1;
    if (depths && !skg_response_is_layer(options->response))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "a blur by depths needs to know where photons interact, but the detector %s; give the response "
            "of a scintillator, or one blur for all",
            options->response ? "has a table of energies" : "is ideal");
    if (depths && depths->count * channels > SKG_CHANNELS_MAX)
        return skg_fail(SKG_ERR_ARGUMENT, "%" PRId64 " depths of %" PRId64 " bands; at most %d together",
                        depths->count, channels, (int)SKG_CHANNELS_MAX);
    if (options->dqe && depths)
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "the power of the noise follows from a DQE and from a blur by depths; give one of them");
    if (options->dqe && options->bands > 0)
        return skg_fail(SKG_ERR_ARGUMENT, "a DQE by spatial frequency is that of an image without bands");
    return SKG_OK;
}

static skg_status check_detector(const skg_plan_options *options) {
    const int kev = options->electronic_kev > 0 || options->quantum_step_kev > 0;
    SKG_TRY(check_kev("electronic noise", options->electronic_kev));
    SKG_TRY(check_kev("the quantisation's step", options->quantum_step_kev));
    if (options->oblique && !skg_response_is_layer(options->response))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "rays cross the layer of a scintillator obliquely, but the detector %s; give the response "
            "of a scintillator, or leave oblique out",
            options->response ? "has a table of energies" : "is ideal");
    SKG_TRY(check_layers(options));
    if (!(options->swank > 0 && options->swank <= 1))
        return skg_fail(SKG_ERR_ARGUMENT, "the Swank factor is %g; above 0, at most 1", options->swank);
    if (kev && skg_quantity_counts(options))
        return skg_fail(
            SKG_ERR_ARGUMENT,
            "electronic noise and quantisation are in keV, but photons are counted; leave them out, or "
            "take %s",
            options->quantity == SKG_QUANTITY_PHOTONS ? "another quantity"
                                                      : "SKG_BAND_WEIGHT_ENERGY (BandWeight)");
    return SKG_OK;
}

skg_status skg_plan_options_check(const skg_plan_options *options, const skg_device_info *device) {
    if (options->precision < SKG_PRECISION_SINGLE || options->precision > SKG_PRECISION_HALF)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "precision %" PRId32
                        " is unknown; SKG_PRECISION_SINGLE, SKG_PRECISION_DOUBLE or SKG_PRECISION_HALF",
                        options->precision);
    if (options->precision == SKG_PRECISION_DOUBLE && !device->has_double)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s has no fp64, so precision double does not work there; take single", device->name);
    if (options->strategy < SKG_STRATEGY_AUTO || options->strategy > SKG_STRATEGY_ATOMICS)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "strategy %" PRId32 " is unknown; SKG_STRATEGY_AUTO, _COPIES, _TILES or "
                        "_ATOMICS",
                        options->strategy);
    if (options->quantity < SKG_QUANTITY_ENERGY || options->quantity > SKG_QUANTITY_ATTENUATION)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "quantity %" PRId32 " is unknown; SKG_QUANTITY_ENERGY to SKG_QUANTITY_ATTENUATION",
                        options->quantity);
    SKG_TRY(check_flags(options));
    if (options->band_weight != SKG_BAND_WEIGHT_PHOTONS && options->band_weight != SKG_BAND_WEIGHT_ENERGY)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "weight of bands %" PRId32
                        " is unknown; SKG_BAND_WEIGHT_PHOTONS or SKG_BAND_WEIGHT_ENERGY",
                        options->band_weight);
    if (!(options->tolerance >= 0 && options->tolerance < 1))
        return skg_fail(SKG_ERR_ARGUMENT, "a tolerance of %g; a relative error from 0 to below 1",
                        options->tolerance);
    if (options->repair < SKG_REPAIR_NONE || options->repair > SKG_REPAIR_EXACT)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "repair %" PRId32 " is unknown; SKG_REPAIR_NONE, _NEIGHBOURS or _EXACT",
                        options->repair);
    if (options->tile < 0 || options->tile > 32768)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "a tile of %" PRId32 " pixels is not usable; 0 lets the plan choose", options->tile);
    return check_detector(options);
}
