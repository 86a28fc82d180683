/* Finds the attributes that DICOM asks of a scene: the voltage, and how far the source is from the middle of the parts. */
#include "dicom/dicom.h"

#include <math.h>

/* The middle of the box around all parts, in the world. Returns 0 if there is none. */
static skg_status find_middle(const skg_scene *scene, double middle[3], int *found) {
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    int64_t parts = 0;
    skg_status status = skg_scene_part_count(scene, &parts);
    for (int64_t p = 0; p < parts && status == SKG_OK; p++) {
        skg_part part;
        skg_mesh_health health;
        skg_part_init(&part);
        skg_mesh_health_init(&health);
        status = skg_scene_part_get(scene, p, &part);
        if (status == SKG_OK) status = skg_mesh_health_get(part.mesh, &health);
        for (int corner = 0; corner < 8 && status == SKG_OK; corner++)
            for (int r = 0; r < 3; r++) {
                double at = part.pose[4 * r + 3];
                for (int k = 0; k < 3; k++)
                    at += part.pose[4 * r + k] * health.bounds[(corner >> k & 1) * 3 + k];
                low[r] = fmin(low[r], at), high[r] = fmax(high[r], at);
            }
    }
    for (int k = 0; k < 3; k++) middle[k] = 0.5 * (low[k] + high[k]);
    *found = status == SKG_OK && low[0] <= high[0];
    return status;
}

/* The highest energy with photons, which of a tube's spectrum is its voltage to a bin. */
static skg_status find_kvp(const skg_spectrum *spectrum, double *kvp) {
    int64_t bins = 0;
    skg_status status = skg_spectrum_bin_count(spectrum, &bins);
    for (int64_t b = 0; b < bins && status == SKG_OK; b++) {
        double energy = 0, photons = 0;
        status = skg_spectrum_bin_get(spectrum, b, &energy, &photons);
        if (status == SKG_OK && photons > 0 && energy > *kvp) *kvp = energy;
    }
    return status;
}

skg_status cli_dicom_facts_of(const skg_scene *scene, const skg_spectrum *spectrum, const skg_view *view,
                              cli_dicom_facts *facts) {
    double middle[3], squares = 0;
    int found = 0;
    facts->kvp = facts->patient_mm = 0;
    skg_status status = find_middle(scene, middle, &found);
    for (int k = 0; k < 3 && found; k++)
        squares += (middle[k] - view->source[k]) * (middle[k] - view->source[k]);
    if (view->projection == SKG_PROJECTION_POINT) facts->patient_mm = sqrt(squares);
    if (status == SKG_OK && spectrum) status = find_kvp(spectrum, &facts->kvp);
    return status;
}
