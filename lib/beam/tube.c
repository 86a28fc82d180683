/* The spectrum of an X-ray tube: model, calibration, filters, output. */
#include "beam/spectrum.h"
#include "core/context.h"
#include "core/plain.h"
#include "material/material.h"

#include <inttypes.h>
#include <math.h>

enum { TUNGSTEN = 74, MOST_BINS = 5000 };

void skg_tube_init_sized(void *tube, int32_t size) {
    const skg_tube defaults = {.angle_deg = 12,
                               .anode = TUNGSTEN,
                               .bin_kev = 1,
                               .mas = 1,
                               .distance_mm = 1000,
                               .pixel_mm2 = 1,
                               .output_at_mm = 1000};
    skg_struct_init(tube, size, &defaults, sizeof defaults);
}

static skg_status check_value(const char *what, double value, double lowest, double highest,
                              const char *unit) {
    if (value >= lowest && value <= highest) return SKG_OK;
    return skg_fail(SKG_ERR_BEAM, "%s of %g %s is not usable; give %g to %g", what, value, unit, lowest,
                    highest);
}

static skg_status check_tube(const skg_tube *tube) {
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
    SKG_TRY(check_value("a tube load", tube->mas, 1e-12, 1e12, "mAs"));
    SKG_TRY(check_value("a distance", tube->distance_mm, 1e-3, 1e9, "mm"));
    SKG_TRY(check_value("a pixel", tube->pixel_mm2, 1e-12, 1e12, "mm2"));
    SKG_TRY(check_value("an output", tube->output_ugy_mas, 0, 1e12, "uGy/mAs"));
    return check_value("an output's distance", tube->output_at_mm, 1e-3, 1e9, "mm");
}

/* Factors on Ebel's continuum and lines. u: tube voltage over K edge.
 *
 * They are fitted to the air kerma that SpekPy 2.5 gives for tungsten at 12 degrees behind 2.5 mm of aluminium,
 * and to the share of the K lines in the photons there: 1.6, 5.7, 8.7 and 11.2 % at 80, 100, 120 and 150 kV. As
 * published, the model is 45 to 60 % too high, and its lines are 4 to 5 times too weak. */
static double continuum_factor(double kvp) {
    return 0.688 * exp(-0.00133 * (kvp - 60));
}

static double line_factor(double kvp, double u) {
    return continuum_factor(kvp) * 3.82 * pow(u - 1, -0.165);
}

/* The unfiltered continuum in bins. Birch's is still a shape without scale. */
static skg_status shape(const skg_tube *tube, int32_t model, skg_spectrum **spectrum) {
    skg_anode anode = {tube->anode, tube->kvp, tube->angle_deg};
    double w = tube->bin_kev, first = SKG_LOWEST_KEV;
    int64_t count = (int64_t)ceil((tube->kvp - first) / w - 1e-9);
    if (count < 2 || count > MOST_BINS)
        return skg_fail(SKG_ERR_BEAM, "bins of %g keV: 2 to %d of them can be made at %g kV", w, MOST_BINS,
                        tube->kvp);
    SKG_TRY(skg_spectrum_make(count, spectrum));
    skg_spectrum *s = *spectrum;
    for (int64_t i = 0; i < count; i++) {
        double low = first + (double)i * w, high = fmin(low + w, tube->kvp), middle = (low + high) / 2;
        s->energy_kev[i] = middle;
        s->photons[i] = (high - low) * (model == SKG_TUBE_MODEL_EBEL
                                            ? continuum_factor(tube->kvp) * skg_ebel_continuum(&anode, middle)
                                            : skg_birch_continuum(&anode, middle));
    }
    return SKG_OK;
}

/* Adds each line to the bin that holds its energy. */
static void add_lines(const skg_tube *tube, skg_spectrum *spectrum) {
    skg_anode anode = {tube->anode, tube->kvp, tube->angle_deg};
    for (int k = 0; k < SKG_K_LINES; k++) {
        double kev = 0, u = 0, photons = skg_ebel_line(&anode, k, &kev, &u);
        int64_t i = (int64_t)((kev - SKG_LOWEST_KEV) / tube->bin_kev);
        if (photons > 0 && i >= 0 && i < spectrum->count)
            spectrum->photons[i] += photons * line_factor(tube->kvp, u);
    }
}

/* The air kerma behind 2.5 mm of aluminium and, if hvl is given, the half-value layer there. */
static skg_status hardened(const skg_spectrum *spectrum, double *kerma, double *hvl) {
    skg_filter filter = {.size = (int32_t)sizeof filter, .thickness_mm = 2.5};
    skg_material *aluminium = NULL;
    skg_spectrum *behind = NULL;
    double second = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_material_create_element(13, &aluminium));
    filter.material = aluminium;
    SKG_TRY_CLEANUP(skg_spectrum_create_filtered(spectrum, 1, &filter, &behind));
    *kerma = skg_spectrum_kerma(behind);
    if (hvl) SKG_TRY_CLEANUP(skg_half_value_layers(behind, aluminium, hvl, &second));
cleanup:
    skg_spectrum_release(&behind);
    skg_material_release(&aluminium);
    return status;
}

/* The unfiltered spectrum per mAs and mm2 at 1 m. */
static skg_status unfiltered(const skg_tube *tube, skg_spectrum **spectrum) {
    SKG_TRY(shape(tube, tube->model, spectrum));
    skg_status status = SKG_OK;
    if (tube->model == SKG_TUBE_MODEL_BIRCH) {
        skg_spectrum *reference = NULL;
        double own = 0, wanted = 0;
        SKG_TRY_CLEANUP(hardened(*spectrum, &own, NULL));
        SKG_TRY_CLEANUP(shape(tube, SKG_TUBE_MODEL_EBEL, &reference));
        status = hardened(reference, &wanted, NULL);
        skg_spectrum_release(&reference);
        if (status != SKG_OK) goto cleanup;
        for (int64_t i = 0; i < (*spectrum)->count; i++) (*spectrum)->photons[i] *= wanted / own;
    }
    add_lines(tube, *spectrum);
    return SKG_OK;
cleanup:
    skg_spectrum_release(spectrum);
    return status;
}

static skg_status warn(const skg_tube *tube, const skg_spectrum *bare, const skg_spectrum *behind) {
    const skg_logger log = tube->context ? tube->context->log : (skg_logger){tube->log, tube->log_user};
    if (!log.call) return SKG_OK;
    if (tube->kvp > 150 || tube->kvp < 20)
        skg_logger_say(&log, SKG_LOG_WARNING, "%g kV: the tube model is validated from 20 to 150 kV only",
                       tube->kvp);
    if (tube->anode != TUNGSTEN)
        skg_logger_say(&log, SKG_LOG_WARNING, "an anode of %s: the tube model is validated for W only",
                       skg_elements[tube->anode].symbol);
    if (tube->kvp < 70) return SKG_OK;
    double kerma = 0, needed = 0, hvl = 0, second = 0;
    skg_material *aluminium = NULL;
    SKG_TRY(hardened(bare, &kerma, &needed));
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
    SKG_TRY(check_tube(&ours));
    SKG_TRY(unfiltered(&ours, &bare));
    SKG_TRY_CLEANUP(skg_spectrum_create_filtered(bare, ours.filter_count, ours.filters, &behind));
    SKG_TRY_CLEANUP(warn(&ours, bare, behind));
    double scale = ours.mas * ours.pixel_mm2 * pow(1000 / ours.distance_mm, 2);
    if (ours.output_ugy_mas > 0)
        scale *= ours.output_ugy_mas * pow(ours.output_at_mm / 1000, 2) / skg_spectrum_kerma(behind);
    status = skg_spectrum_create_scaled(behind, scale, spectrum);
cleanup:
    skg_spectrum_release(&bare);
    skg_spectrum_release(&behind);
    return status;
}
