/* The key Beam of a source: energies, a file of them, or a tube. */
#include "core/context.h"
#include "core/text.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const char *const example = "[{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]";

static skg_status read_channel(const skg_json_node *node, double *energy_kev, double *photons) {
    skg_json_object channel;
    skg_json_node energy_node, unit_node, photons_node;
    double energy = 0, kev = 1;
    const char *unit = NULL;
    SKG_TRY(skg_json_read_object(node, &skg_keys_channel, &channel));
    SKG_TRY(skg_json_need(&channel, "Energy", "60", &energy_node));
    SKG_TRY(skg_json_need(&channel, "Unit", "\"keV\"", &unit_node));
    SKG_TRY(skg_json_need(&channel, "PhotonCount", "1000", &photons_node));
    SKG_TRY(skg_json_number(&energy_node, &energy));
    SKG_TRY(skg_json_text(&unit_node, &unit));
    SKG_TRY(skg_json_number(&photons_node, photons));
    skg_status status = skg_unit_of_energy(unit, &kev);
    SKG_TRY(skg_json_at(&unit_node, status));
    *energy_kev = energy * kev;
    /* A spectrum of this energy alone, so that an error names this channel. */
    skg_spectrum *check = NULL;
    status = skg_spectrum_create_mono(*energy_kev, *photons, &check);
    skg_spectrum_release(&check);
    return skg_json_at(node, status);
}

static skg_status read_channels(skg_setup *setup, const skg_json_node *node) {
    double *energies = NULL, *photons = NULL;
    int64_t count = 0;
    skg_status status = SKG_OK;
    SKG_TRY(skg_json_array(node, example, &count));
    if (count == 0) return skg_json_fail(node, SKG_ERR_BEAM, "has no energy; give %s", example);
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "beam", &energies));
    SKG_TRY_CLEANUP(skg_alloc(count, sizeof(double), "beam", &photons));
    for (int64_t i = 0; i < count; i++) {
        skg_json_node channel = skg_json_element(node, i);
        SKG_TRY_CLEANUP(read_channel(&channel, &energies[i], &photons[i]));
    }
    SKG_TRY_CLEANUP(skg_spectrum_create_bins(count, energies, photons, &setup->spectrum));
cleanup:
    skg_free(&energies);
    skg_free(&photons);
    return status;
}

static skg_status read_file(skg_setup_reader *reader, const skg_json_object *beam,
                            const skg_json_node *node) {
    const char *name = NULL, *path = NULL, *unit = NULL;
    skg_json_node unit_node;
    SKG_TRY(skg_json_text(node, &name));
    SKG_TRY(skg_json_need(beam, "Unit", "\"keV\"", &unit_node));
    SKG_TRY(skg_json_text(&unit_node, &unit));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    return skg_json_at(node, skg_spectrum_load(path, unit, &reader->setup->spectrum));
}

/* A number in the first of the units given, which a warning says, or [number, unit] with one of them. */
static skg_status read_quantity(const skg_json_node *node, const char *what, const char *const *units,
                                const double *values, int64_t count, double *quantity) {
    int64_t choice = 0;
    if (!json_is_array(node->value)) {
        SKG_TRY(skg_json_number(node, quantity));
        return skg_json_remark(node, "has no unit, and counts in %s; write [%g, \"%s\"]", units[0], *quantity,
                               units[0]);
    }
    skg_json_node number = skg_json_element(node, 0), unit = skg_json_element(node, 1);
    SKG_TRY(skg_json_number(&number, quantity));
    SKG_TRY(skg_json_choice(&unit, what, units, count, &choice));
    *quantity *= values[choice];
    return SKG_OK;
}

/* A load of 0 would leave nothing to see; in the struct of a tube it means that none is known. */
static skg_status no_load(const skg_json_node *node, double mas) {
    return skg_json_fail(
        node, SKG_ERR_BEAM,
        "makes a load of %g mAs, which gives no photons; give one above 0, or leave it out for the photons of "
        "1 mAs per mm2 at 1 m",
        mas);
}

/* mAs, or exposure time (s) times tube current (mA). *given: 0 where there is neither. */
static skg_status read_mas(const skg_json_object *beam, double *mas, int32_t *given) {
    static const char *const times[] = {"s", "sec", "ms", "msec", "milliseconds", "millisecond", "seconds"};
    static const double seconds[] = {1, 1, 1e-3, 1e-3, 1e-3, 1e-3, 1};
    static const char *const currents[] = {"mA", "milliampere", "milliamperes", "A", "ampere", "amperes"};
    static const double milliamperes[] = {1, 1, 1, 1e3, 1e3, 1e3};
    skg_json_node node = skg_json_member(beam, "mAs"), time = skg_json_member(beam, "ExposureTime");
    skg_json_node current = skg_json_member(beam, "X-ray tube current");
    double t = 0, i = 0;
    *given = node.value || (time.value && current.value);
    if (node.value) SKG_TRY(skg_json_number(&node, mas));
    if (node.value && !(*mas > 0)) return no_load(&node, *mas);
    if (!time.value || !current.value) {
        if (node.value || (!time.value && !current.value)) return SKG_OK;
        return skg_json_fail(time.value ? &time : &current, SKG_ERR_FORMAT,
                             "exposure time and tube current go together; give both, or mAs");
    }
    SKG_TRY(read_quantity(&time, "unit of time", times, seconds, 7, &t));
    SKG_TRY(read_quantity(&current, "unit of tube current", currents, milliamperes, 6, &i));
    if (!(t * i > 0)) return no_load(t > 0 ? &current : &time, t * i);
    if (node.value && fabs(*mas - t * i) > 1e-3 * fabs(*mas)) /* numbers of files are rounded */
        return skg_json_fail(&node, SKG_ERR_FORMAT,
                             "%g mAs, but exposure time and tube current make %g; leave out what is wrong",
                             *mas, t * i);
    if (!node.value) *mas = t * i;
    return SKG_OK;
}

enum { FILTERS_MAX = 32 };

typedef struct {
    skg_filter filters[FILTERS_MAX];
    skg_material *materials[FILTERS_MAX];
    int64_t count;
} filter_list;

/* ["Cu", 0.1, "mm"]; the unit may be absent and is then mm; an element may be given by its number. */
static skg_status read_filter(const skg_json_node *node, filter_list *list) {
    static const char *const one = "[\"Cu\", 0.1, \"mm\"]";
    int64_t length = 0, z = 0;
    double thickness = 0, mm = 1;
    const char *name = NULL;
    SKG_TRY(skg_json_array(node, one, &length));
    if (length < 2 || length > 3)
        return skg_json_fail(node, SKG_ERR_FORMAT, "has %" PRId64 " elements; give %s", length, one);
    skg_json_node material = skg_json_element(node, 0), value = skg_json_element(node, 1);
    skg_json_node unit = skg_json_element(node, 2);
    SKG_TRY(skg_json_number(&value, &thickness));
    if (unit.value) SKG_TRY(skg_json_unit_of_length(&unit, &mm));
    skg_material **place = &list->materials[list->count];
    skg_status status;
    if (json_is_integer(material.value)) {
        SKG_TRY(skg_json_integer(&material, 1, 92, &z));
        status = skg_material_create_element((int32_t)z, place);
    } else {
        SKG_TRY(skg_json_text(&material, &name));
        status = skg_material_create_named(name, place);
    }
    SKG_TRY(skg_json_at(&material, status));
    list->filters[list->count] =
        (skg_filter){.size = (int32_t)sizeof(skg_filter), .material = *place, .thickness_mm = thickness * mm};
    list->count++;
    return SKG_OK;
}

static skg_status read_filters(const skg_json_object *beam, filter_list *list) {
    skg_json_node node = skg_json_member(beam, "Filter");
    int64_t count = 0;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_array(&node, "[[\"Cu\", 0.1, \"mm\"]]", &count));
    if (count > FILTERS_MAX)
        return skg_json_fail(&node, SKG_ERR_FORMAT, "has %" PRId64 " filters; at most %d are possible", count,
                             FILTERS_MAX);
    for (int64_t i = 0; i < count; i++) {
        skg_json_node filter = skg_json_element(&node, i);
        SKG_TRY(read_filter(&filter, list));
    }
    return SKG_OK;
}

/* Output of a tube: air kerma by load, and the distance where it was measured. */
static skg_status read_output(const skg_json_object *beam, skg_tube *tube) {
    static const char *const form = "[65, \"uGy/mAs\", 100, \"cm\"]", *const units[] = {"uGy/mAs"};
    skg_json_node node = skg_json_member(beam, "Output");
    int64_t count = 0, choice = 0;
    double mm = 1;
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_array(&node, form, &count));
    if (count != 4)
        return skg_json_fail(&node, SKG_ERR_FORMAT, "has %" PRId64 " elements; give %s", count, form);
    skg_json_node value = skg_json_element(&node, 0), unit = skg_json_element(&node, 1);
    skg_json_node distance = skg_json_element(&node, 2), length = skg_json_element(&node, 3);
    SKG_TRY(skg_json_number(&value, &tube->output_ugy_mas));
    SKG_TRY(skg_json_choice(&unit, "unit of output", units, 1, &choice));
    SKG_TRY(skg_json_number(&distance, &tube->output_at_mm));
    SKG_TRY(skg_json_unit_of_length(&length, &mm));
    tube->output_at_mm *= mm;
    if (!(tube->output_ugy_mas > 0))
        return skg_json_fail(&value, SKG_ERR_BEAM, "is %g; give an output above 0", tube->output_ugy_mas);
    return SKG_OK;
}

/* Everything but voltage, load and filters. heel_deg: the anode's angle that Heel gives; 0: none. */
static skg_status read_options(const skg_json_object *beam, double heel_deg, skg_tube *tube) {
    static const char *const models[] = {"Ebel", "Birch"};
    skg_json_node angle = skg_json_member(beam, "TubeAngle"), anode = skg_json_member(beam, "Anode");
    skg_json_node model = skg_json_member(beam, "Model"),
                  bins = skg_json_member(beam, "MaxNumberOfEnergyBins");
    int64_t most = 0, choice = 0;
    const char *text = NULL;
    if (angle.value) SKG_TRY(skg_json_number(&angle, &tube->angle_deg));
    if (angle.value && heel_deg > 0 && heel_deg != tube->angle_deg)
        return skg_json_fail(&angle, SKG_ERR_BEAM,
                             "is %g degrees, but AnodeAngle of Heel is %g; give one of them", tube->angle_deg,
                             heel_deg);
    if (heel_deg > 0) tube->angle_deg = heel_deg;
    if (anode.value) {
        SKG_TRY(skg_json_text(&anode, &text));
        skg_status status = skg_element_number_get(text, &tube->anode);
        SKG_TRY(skg_json_at(&anode, status));
    }
    if (model.value) SKG_TRY(skg_json_choice(&model, "model of a tube", models, 2, &choice));
    tube->model = choice == 0 ? SKG_TUBE_MODEL_EBEL : SKG_TUBE_MODEL_BIRCH;
    if (bins.value) {
        SKG_TRY(skg_json_integer(&bins, 2, 5000, &most));
        tube->bin_kev = fmax(1, tube->kvp / (double)most);
    }
    return read_output(beam, tube);
}

static skg_status read_tube(skg_setup_reader *reader, const skg_json_object *beam, const skg_json_node *kvp) {
    skg_tube tube;
    filter_list list = {.count = 0};
    skg_status status = SKG_OK;
    skg_tube_init(&tube);
    tube.log = reader->log.call, tube.log_user = reader->log.user;
    SKG_TRY(skg_json_number(kvp, &tube.kvp));
    SKG_TRY(read_mas(beam, &tube.mas, &reader->setup->absolute));
    skg_heel *heel = &reader->setup->heel;
    SKG_TRY(read_options(beam, heel->angle_deg, &tube));
    heel->anode = tube.anode, heel->kvp = tube.kvp;
    heel->angle_deg = tube.angle_deg, heel->bin_kev = tube.bin_kev;
    reader->setup->has_tube = 1;
    SKG_TRY_CLEANUP(read_filters(beam, &list));
    tube.filters = list.filters;
    tube.filter_count = list.count;
    status = skg_spectrum_create_tube(&tube, &reader->setup->spectrum);
    status = skg_json_at(beam->node, status);
cleanup:
    for (int64_t i = 0; i < FILTERS_MAX; i++) skg_material_release(&list.materials[i]);
    return status;
}

/* Bins: rows of keV and photons, per pixel, or with At1m per mm2 at 1 m. */
static skg_status read_bins(skg_setup_reader *reader, const skg_json_object *beam,
                            const skg_json_node *node) {
    const skg_json_node at = skg_json_member(beam, "At1m");
    double *rows = NULL, *columns = NULL;
    skg_spectrum *bins = NULL;
    int64_t count = 0;
    if (at.value) SKG_TRY(skg_json_flag(&at, &reader->setup->absolute));
    SKG_TRY(skg_setup_read_rows(node, 2, "[[60, 1000]], in keV and photons", &count, &rows));
    skg_status status = skg_alloc(2 * count, sizeof *columns, "beam", &columns);
    SKG_TRY_CLEANUP(status);
    for (int64_t i = 0; i < count; i++) columns[i] = rows[2 * i], columns[count + i] = rows[2 * i + 1];
    status = skg_spectrum_create_bins(count, columns, columns + count, &bins);
    SKG_TRY_CLEANUP(skg_json_at(node, status));
    if (reader->setup->absolute)
        status = skg_spectrum_create_absolute(bins, &reader->setup->spectrum);
    else
        reader->setup->spectrum = bins, bins = NULL;
cleanup:
    skg_spectrum_release(&bins);
    skg_free(&rows);
    skg_free(&columns);
    return status;
}

skg_status skg_setup_read_beam(skg_setup_reader *reader, const skg_json_node *node) {
    if (!json_is_object(node->value)) return read_channels(reader->setup, node);
    skg_json_object beam;
    SKG_TRY(skg_json_read_object(node, &skg_keys_beam, &beam));
    skg_json_node file = skg_json_member(&beam, "TextFile"), macro = skg_json_member(&beam, "GateMacro");
    skg_json_node kvp = skg_json_member(&beam, "kVp"), bins = skg_json_member(&beam, "Bins");
    int32_t given = (file.value != NULL) + (macro.value != NULL) + (kvp.value != NULL) + (bins.value != NULL);
    if (given > 1)
        return skg_json_fail(node, SKG_ERR_FORMAT,
                             "describes several beams; give one of kVp, Bins, TextFile, GateMacro");
    if (file.value) return read_file(reader, &beam, &file);
    if (macro.value) return read_file(reader, &beam, &macro);
    if (bins.value) return read_bins(reader, &beam, &bins);
    if (kvp.value) return read_tube(reader, &beam, &kvp);
    return skg_json_fail(node, SKG_ERR_FORMAT, "describes no beam; give %s, or {\"kVp\": 85}", example);
}
