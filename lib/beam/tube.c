/* The spectrum of an X-ray tube: model, calibration, filters, output. */
#include "beam/spectrum.h"
#include "core/context.h"
#include "core/text.h"
#include "material/material.h"
#include "material/shells.h"

#include <inttypes.h>
#include <math.h>

enum { TUNGSTEN = 74, BINS_MAX = 5000 };

void skg_tube_init_sized(void *tube, int32_t size) {
    const skg_tube defaults = {.angle_deg = 12, .anode = TUNGSTEN, .bin_kev = 1, .output_at_mm = 1000};
    skg_struct_init(tube, size, &defaults, sizeof defaults);
}

static skg_status check_value(const char *what, double value, double lowest, double highest,
                              const char *unit) {
    if (value >= lowest && value <= highest) return SKG_OK;
    return skg_fail(SKG_ERR_BEAM, "%s of %g %s is not usable; give %g to %g", what, value, unit, lowest,
                    highest);
}

/* A pixel at a distance, or neither: then the plan has both from its view. */
static skg_status check_pixel(const skg_tube *tube) {
    if (tube->distance_mm == 0 && tube->pixel_mm2 == 0) return SKG_OK;
    SKG_TRY(check_value("a distance", tube->distance_mm, 1e-3, 1e9, "mm"));
    SKG_TRY(check_value("a pixel", tube->pixel_mm2, 1e-12, 1e12, "mm2"));
    if (tube->mas > 0) return SKG_OK;
    return skg_fail(SKG_ERR_BEAM, "a pixel of %g mm2 at %g mm without a tube load; give mas, too",
                    tube->pixel_mm2, tube->distance_mm);
}

skg_status skg_tube_check(const skg_tube *tube) {
    const char *symbol;
    if (tube->model != SKG_TUBE_MODEL_EBEL && tube->model != SKG_TUBE_MODEL_BIRCH)
        return skg_fail(SKG_ERR_BEAM,
                        "tube model %" PRId32
                        " is not known; give SKG_TUBE_MODEL_EBEL or SKG_TUBE_MODEL_BIRCH",
                        tube->model);
    SKG_TRY(check_value("a tube voltage", tube->kvp, 10, 450, "kV"));
    SKG_TRY(check_value("an anode angle", tube->angle_deg, 3, 60, "degrees"));
    SKG_TRY(skg_element_symbol_get(tube->anode, &symbol));
    if (tube->anode < 20)
        return skg_fail(SKG_ERR_BEAM, "an anode of %s is not usable; give calcium (20) to uranium (92)",
                        symbol);
    SKG_TRY(check_value("a bin", tube->bin_kev, 0.1, 10, "keV"));
    if (tube->mas != 0) SKG_TRY(check_value("a tube load", tube->mas, 1e-12, 1e12, "mAs"));
    SKG_TRY(check_pixel(tube));
    SKG_TRY(check_value("an output", tube->output_ugy_mas, 0, 1e12, "uGy/mAs"));
    return check_value("an output's distance", tube->output_at_mm, 1e-3, 1e9, "mm");
}

/* The unfiltered continuum in bins. */
static skg_status continuum(const skg_tube *tube, skg_spectrum **spectrum) {
    const skg_anode anode = {tube->anode, tube->kvp, tube->angle_deg};
    const skg_tube_calibration *calibration = skg_tube_calibration_of(tube->anode);
    double w = tube->bin_kev, first = SKG_LOWEST_KEV;
    int64_t count = (int64_t)ceil((tube->kvp - first) / w - 1e-9);
    if (count < 2 || count > BINS_MAX)
        return skg_fail(SKG_ERR_BEAM, "bins of %g keV: 2 to %d of them can be made at %g kV", w, BINS_MAX,
                        tube->kvp);
    SKG_TRY(skg_spectrum_make(count, spectrum));
    skg_spectrum *s = *spectrum;
    for (int64_t i = 0; i < count; i++) {
        double low = first + (double)i * w, high = fmin(low + w, tube->kvp), middle = (low + high) / 2;
        s->energy_kev[i] = middle;
        s->photons[i] = (high - low) * skg_tube_continuum(calibration, tube->model, &anode, middle);
    }
    return SKG_OK;
}

/* Adds the lines of a shell, each to the bin that holds its energy. */
static void add_lines(const skg_tube *tube, int32_t shell, skg_spectrum *spectrum) {
    const skg_anode anode = {tube->anode, tube->kvp, tube->angle_deg};
    const skg_tube_calibration *calibration = skg_tube_calibration_of(tube->anode);
    const int lines = shell == SKG_SHELL_K ? SKG_K_LINES : SKG_L_LINES;
    for (int k = 0; k < lines; k++) {
        double kev = 0, photons = skg_tube_line(calibration, &anode, shell, k, &kev);
        int64_t i = (int64_t)((kev - SKG_LOWEST_KEV) / tube->bin_kev);
        if (photons > 0 && i >= 0 && i < spectrum->count) spectrum->photons[i] += photons;
    }
}

/* The first half-value layer behind 2.5 mm of aluminium. */
static skg_status hardened(const skg_spectrum *spectrum, double *hvl) {
    skg_filter filter = {.size = (int32_t)sizeof filter, .thickness_mm = 2.5};
    skg_material *aluminium = NULL;
    skg_spectrum *behind = NULL;
    double second = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_material_create_element(13, &aluminium));
    filter.material = aluminium;
    SKG_TRY_CLEANUP(skg_spectrum_create_filtered(spectrum, 1, &filter, &behind));
    SKG_TRY_CLEANUP(skg_half_value_layers(behind, aluminium, hvl, &second));
cleanup:
    skg_spectrum_release(&behind);
    skg_material_release(&aluminium);
    return status;
}

skg_status skg_tube_bare(const skg_tube *tube, skg_spectrum **spectrum) {
    SKG_TRY(continuum(tube, spectrum));
    add_lines(tube, SKG_SHELL_K, *spectrum);
    add_lines(tube, SKG_SHELL_L, *spectrum);
    return SKG_OK;
}

/* Says what lies outside the range for which the model was compared with others. */
static void warn_of_range(const skg_tube *tube, const skg_logger *log) {
    const char *symbol = skg_elements[tube->anode].symbol;
    const skg_tube_calibration *calibration = skg_tube_calibration_of(tube->anode);
    const skg_tube_range *range = &calibration->range;
    if (range->z != tube->anode) {
        skg_logger_say(
            log, SKG_LOG_WARNING,
            "an anode of %s: the tube model is validated for W, Mo and Rh only; output and lines are "
            "scaled as those of W",
            symbol);
        return;
    }
    if (tube->kvp < range->kvp[0] || tube->kvp > range->kvp[1])
        skg_logger_say(
            log, SKG_LOG_WARNING,
            "%g kV: the tube model is validated from %g to %g kV only, with an anode of %s; output and "
            "half-value layers %s",
            tube->kvp, range->kvp[0], range->kvp[1], symbol,
            tube->kvp > range->kvp[1] && tube->kvp <= calibration->last_kvp
                ? "change from there as by another computation (xpecgen), and are not verified by measurements"
                : "are not verified");
    if (tube->angle_deg < range->angle_deg[0] || tube->angle_deg > range->angle_deg[1])
        skg_logger_say(
            log, SKG_LOG_WARNING,
            "an anode angle of %g degrees: the tube model is validated from %g to %g degrees only, with "
            "an anode of %s",
            tube->angle_deg, range->angle_deg[0], range->angle_deg[1], symbol);
}

/* The models are validated behind 0.5 mm of aluminium or as much of another metal, where next to nothing is left below
 * SOFT_KEV. */
static const double SOFT_KEV = 7, SOFT_SHARE = 0.01;

static void warn_of_filters(const skg_tube *tube, const skg_spectrum *behind, const skg_logger *log) {
    double soft = 0;
    for (int64_t i = 0; i < behind->count && behind->energy_kev[i] < SOFT_KEV; i++)
        soft += behind->photons[i] * skg_air_kerma(behind->energy_kev[i]);
    const double share = soft / skg_spectrum_kerma(behind);
    if (share > SOFT_SHARE)
        skg_logger_say(
            log, SKG_LOG_WARNING,
            "%.2g %% of the air kerma is that of photons below %g keV, for which the tube model is not "
            "validated; it is from 0.5 mm of aluminium on. Name all filters: none is assumed at %g kV",
            100 * share, SOFT_KEV, tube->kvp);
}

static skg_status warn(const skg_tube *tube, const skg_spectrum *bare, const skg_spectrum *behind) {
    const skg_logger log = tube->context ? tube->context->log : (skg_logger){tube->log, tube->log_user};
    if (!log.call) return SKG_OK;
    warn_of_range(tube, &log);
    warn_of_filters(tube, behind, &log);
    if (tube->kvp < 70) return SKG_OK;
    double needed = 0, hvl = 0, second = 0;
    skg_material *aluminium = NULL;
    SKG_TRY(hardened(bare, &needed));
    SKG_TRY(skg_material_create_element(13, &aluminium));
    skg_status status = skg_half_value_layers(behind, aluminium, &hvl, &second);
    skg_material_release(&aluminium);
    if (status == SKG_OK && hvl < needed * (1 - 1e-9))
        skg_logger_say(
            &log, SKG_LOG_WARNING,
            "the beam's half-value layer is %.2f mm Al; 2.5 mm Al of filters, which IEC 60601-1-3 asks for "
            "from 70 kV on, would give %.2f mm. No inherent filtration is assumed: name all filters",
            hvl, needed);
    return status;
}

skg_status skg_spectrum_create_tube(const skg_tube *tube, skg_spectrum **spectrum) {
    SKG_PLAIN;
    skg_tube ours;
    skg_spectrum *bare = NULL, *behind = NULL; /* without and with its filters */
    skg_status status = SKG_OK;
    SKG_NEEDS(spectrum);
    *spectrum = NULL;
    skg_tube_init(&ours);
    SKG_TRY(skg_struct_read(tube, "skg_tube", &ours, sizeof ours));
    SKG_TRY(skg_tube_check(&ours));
    SKG_TRY(skg_tube_bare(&ours, &bare));
    SKG_TRY_CLEANUP(skg_spectrum_create_filtered(bare, ours.filter_count, ours.filters, &behind));
    SKG_TRY_CLEANUP(warn(&ours, bare, behind));
    double scale = ours.mas > 0 ? ours.mas : 1;
    if (ours.pixel_mm2 > 0) scale *= skg_microsteradians(ours.pixel_mm2, ours.distance_mm);
    if (ours.output_ugy_mas > 0)
        scale *= ours.output_ugy_mas * pow(ours.output_at_mm / 1000, 2) / skg_spectrum_kerma(behind);
    SKG_TRY_CLEANUP(skg_spectrum_create_scaled(behind, scale, spectrum));
    (*spectrum)->absolute = ours.mas > 0 && !(ours.pixel_mm2 > 0);
    (*spectrum)->unloaded = !(ours.mas > 0);
cleanup:
    skg_spectrum_release(&bare);
    skg_spectrum_release(&behind);
    return status;
}
