/* source: spectrum, filters and focal spot. */
#include "core/files.h"
#include "core/maths.h"
#include "ctsimu/parts.h"

#include <math.h>
#include <string.h>

enum { FILTERS_MAX = 32 };

typedef struct {
    skg_filter filters[FILTERS_MAX];
    skg_material *materials[FILTERS_MAX];
    int64_t count;
} filter_list;

static void filters_free(filter_list *list) {
    for (int64_t i = 0; i < FILTERS_MAX; i++) skg_material_release(&list->materials[i]);
}

/* Adds the layers of an array of {material_id, thickness}. */
static skg_status add_filters(const skg_item *array, filter_list *list) {
    for (int64_t i = 0; i < (int64_t)json_array_size(array->value); i++) {
        const skg_item one = skg_item_element(array, i), id = skg_item_at(&one, "material_id");
        const skg_item thickness = skg_item_at(&one, "thickness");
        skg_filter filter;
        skg_filter_init(&filter);
        if (!one.value) continue;
        if (list->count == FILTERS_MAX)
            return skg_item_fail(array, SKG_ERR_BEAM, "is filter %d; at most %d are possible",
                                 FILTERS_MAX + 1, FILTERS_MAX);
        SKG_TRY(skg_item_number(&thickness, SKG_UNIT_MM, &filter.thickness_mm));
        SKG_TRY(skg_ctsimu_material(&id, &list->materials[list->count]));
        filter.material = list->materials[list->count];
        if (filter.material && filter.thickness_mm > 0) list->filters[list->count++] = filter;
        if (!filter.material || filter.thickness_mm > 0) continue;
        skg_material_release(&list->materials[list->count]);
    }
    return SKG_OK;
}

/* Photons per sr and mAs from a file: energies in keV, photons in 1/(s sr mA). */
static skg_status load_spectrum(const skg_item *item, const char *path, skg_spectrum **spectrum) {
    double *columns[3] = {NULL}, *energies = NULL, *photons = NULL;
    int64_t rows = 0, width = 0, count = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_read_columns_of(path, 2, 3, &rows, &width, columns));
    energies = columns[0], photons = columns[1];
    for (int64_t i = 0; i < rows; i++) {
        /* Cross sections begin at 1 keV; below it nothing leaves a tube. */
        if (energies[i] < 1 || photons[i] <= 0) continue;
        energies[count] = energies[i];
        photons[count++] = photons[i];
    }
    SKG_TRY_CLEANUP(skg_spectrum_create_bins(count, energies, photons, spectrum));
cleanup:
    for (int k = 0; k < 3; k++) skg_free(&columns[k]);
    return status == SKG_OK ? SKG_OK : skg_item_fail(item, status, "%s", skg_last_error());
}

/* The spectrum of the tube's voltage and target, per sr and mAs. */
static skg_status make_tube(skg_ctsimu *scenario, double kvp, skg_spectrum **spectrum) {
    const skg_item root = skg_item_root(scenario), source = skg_item_at(&root, "source");
    const skg_item angle = skg_item_at(&source, "target.angle.emission");
    const skg_item id = skg_item_at(&source, "target.material_id"),
                   type = skg_item_at(&source, "target.type");
    skg_material *target = NULL;
    const char *name = NULL;
    double emission = 0;
    int64_t elements = 0;
    skg_tube tube;
    skg_status status = SKG_OK;
    skg_tube_init(&tube);
    tube.kvp = kvp;
    SKG_TRY(skg_item_number(&angle, SKG_UNIT_RAD, &emission));
    SKG_TRY(skg_item_text(&type, &name));
    if (emission > 0) tube.angle_deg = emission * 180 / SKG_PI;
    if (name && strcmp(name, "transmission") == 0)
        SKG_TRY(skg_item_remark(&type, "a transmission target is computed as a reflection target"));
    SKG_TRY(skg_ctsimu_material(&id, &target));
    if (target) status = skg_material_element_count(target, &elements);
    if (status == SKG_OK && elements == 1)
        status = skg_material_element_get(target, 0, &tube.anode, &emission);
    skg_material_release(&target);
    if (status == SKG_OK) status = skg_spectrum_create_tube(&tube, spectrum);
    if (status != SKG_OK) return skg_item_fail(&source, status, "%s", skg_last_error());
    skg_spectrum *whole = *spectrum;
    *spectrum = NULL;
    status = skg_spectrum_create_scaled(whole, 1e6, spectrum); /* from a mm2 at 1 m to 1 sr */
    skg_spectrum_release(&whole);
    return status;
}

/* Whether grey values depend on the number of photons: not those between imin and imax. */
static int is_absolute(const skg_item *root) {
    const skg_item grey = skg_item_at(root, "detector.gray_value|grey_value");
    const skg_item file = skg_item_at(&grey, "intensity_characteristics_file");
    const skg_item factor = skg_item_at(&grey, "factor");
    return skg_item_given(&file) || skg_item_given(&factor);
}

/* Without its filters. has_window: the spectrum has passed the window of the tube already. */
static skg_status make_spectrum(skg_ctsimu *scenario, int32_t *has_window, skg_spectrum **spectrum) {
    const skg_item root = skg_item_root(scenario), source = skg_item_at(&root, "source");
    const skg_item mono = skg_item_at(&source, "spectrum.monochromatic"),
                   voltage = skg_item_at(&source, "voltage");
    const skg_item file = skg_item_at(&source, "spectrum.file"),
                   brems = skg_item_at(&source, "spectrum.bremsstrahlung");
    const char *path = NULL;
    double kvp = 0;
    int32_t is_mono = 0, is_tube = 0;
    SKG_TRY(skg_item_file(&file, &path));
    *has_window = path != NULL;
    if (path) return load_spectrum(&file, path, spectrum);
    SKG_TRY(skg_item_flag(&mono, &is_mono));
    SKG_TRY(skg_item_flag(&brems, &is_tube));
    SKG_TRY(skg_item_number(&voltage, SKG_UNIT_KV, &kvp));
    if (!(kvp > 0)) return skg_item_fail(&voltage, SKG_ERR_BEAM, "is missing or not above 0");
    if (!is_mono || is_tube) return make_tube(scenario, kvp, spectrum);
    if (is_absolute(&root))
        SKG_TRY(skg_item_remark(
            &mono, "the format does not say how many photons a monochromatic beam has, on which the "
                   "grey values depend; 1e12 per second, sr and mA are assumed"));
    return skg_spectrum_create_mono(kvp, 1e12, spectrum);
}

/* mAs of a frame, and the solid angle of the pixel at the foot of the perpendicular from the source. */
static skg_status find_scale(skg_ctsimu *scenario, const skg_ctsimu_geometry *g, double *scale) {
    const skg_item root = skg_item_root(scenario), current = skg_item_at(&root, "source.current");
    const skg_item time = skg_item_at(&root, "detector.integration_time");
    double ma = 1, seconds = 1;
    skg_parameter drift = {0};
    skg_status status = skg_parameter_read(&current, SKG_UNIT_MA, 1, &drift);
    ma = skg_parameter_at(&drift, 0, 0);
    skg_parameter_free(&drift);
    SKG_TRY(status);
    SKG_TRY(skg_item_number(&time, SKG_UNIT_S, &seconds));
    if (!(ma > 0)) return skg_item_fail(&current, SKG_ERR_BEAM, "is %g mA in the first projection", ma);
    if (!(seconds > 0)) seconds = 1;
    *scale = ma * seconds * g->pitch[0] * g->pitch[1] / (g->distance_mm * g->distance_mm);
    return SKG_OK;
}

static skg_status put_bins(const skg_spectrum *spectrum, double scale, json_t *source) {
    json_t *beam = json_array();
    int64_t count = 0;
    skg_status status = skg_spectrum_bin_count(spectrum, &count);
    for (int64_t i = 0; i < count && status == SKG_OK && beam; i++) {
        double energy = 0, photons = 0;
        status = skg_spectrum_bin_get(spectrum, i, &energy, &photons);
        json_array_append_new(beam, json_pack("{s:f, s:s, s:f}", "Energy", energy, "Unit", "keV",
                                              "PhotonCount", photons * scale));
    }
    if (status == SKG_OK) return skg_ctsimu_put(source, "Beam", beam);
    json_decref(beam);
    return status;
}

/* A Gaussian spot by its sigmas, otherwise a rectangle. */
static skg_status put_spot(skg_ctsimu *scenario, json_t *source, int is_parallel) {
    static const char *const names[] = {"source.spot.sigma.u", "source.spot.sigma.v", "source.spot.size.u",
                                        "source.spot.size.v"};
    const double fwhm = 2 * sqrt(2 * log(2));
    const skg_item root = skg_item_root(scenario), map = skg_item_at(&root, "source.spot.intensity_map.file");
    double mm[4] = {0};
    const char *path = NULL;
    for (int k = 0; k < 4; k++) {
        const skg_item item = skg_item_at(&root, names[k]);
        SKG_TRY(skg_item_number(&item, SKG_UNIT_MM, &mm[k]));
    }
    const int is_gaussian = mm[0] > 0 && mm[1] > 0, is_flat = !is_gaussian && mm[2] > 0 && mm[3] > 0;
    SKG_TRY(skg_item_file(&map, &path));
    if (path)
        SKG_TRY(skg_item_remark(&map, "is not simulated; the spot is %s",
                                is_gaussian ? "a normal distribution with the sigmas that are given"
                                : is_flat   ? "a rectangle of the size that is given"
                                            : "a point"));
    if (is_parallel) return skg_ctsimu_put(source, "Shape", json_string("Parallel"));
    if (!is_gaussian && !is_flat) return skg_ctsimu_put(source, "Shape", json_string("Point"));
    return skg_ctsimu_put(source, "Shape",
                          is_gaussian
                              ? json_pack("[s, f, f, s]", "Gaussian", fwhm * mm[0], fwhm * mm[1], "mm")
                              : json_pack("[s, f, f, s]", "Rectangle", mm[2], mm[3], "mm"));
}

skg_status skg_ctsimu_put_beam(skg_ctsimu *scenario, const skg_ctsimu_geometry *g, json_t *scene) {
    const skg_item root = skg_item_root(scenario), window = skg_item_at(&root, "source.window");
    const skg_item filters = skg_item_at(&root, "source.filters");
    const skg_item front = skg_item_at(&root, "detector.filters.front");
    const skg_item front_window = skg_item_at(&root, "detector.window.front");
    json_t *source = json_object_get(scene, "Source");
    filter_list list = {.count = 0};
    skg_spectrum *spectrum = NULL, *filtered = NULL;
    double scale = 1;
    int32_t has_window = 0;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(make_spectrum(scenario, &has_window, &spectrum));
    if (!has_window) SKG_TRY_CLEANUP(add_filters(&window, &list));
    SKG_TRY_CLEANUP(add_filters(&filters, &list));
    SKG_TRY_CLEANUP(add_filters(&front, &list));
    SKG_TRY_CLEANUP(add_filters(&front_window, &list));
    SKG_TRY_CLEANUP(skg_spectrum_create_filtered(spectrum, list.count, list.filters, &filtered));
    SKG_TRY_CLEANUP(find_scale(scenario, g, &scale));
    SKG_TRY_CLEANUP(put_bins(filtered, scale, source));
    SKG_TRY_CLEANUP(put_spot(scenario, source, g->is_parallel));
    if (!g->is_parallel) SKG_TRY_CLEANUP(skg_ctsimu_put(scene, "Falloff", json_true()));
cleanup:
    skg_spectrum_release(&spectrum);
    skg_spectrum_release(&filtered);
    filters_free(&list);
    return status;
}
