/* The key Counting of a detector: a sensor that counts photons by thresholds. */
#include "core/maths.h"
#include "setup/keys.h"
#include "setup/sections.h"

static skg_status read_number(const skg_json_object *object, const char *name, double *value) {
    const skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_number(&node, value) : SKG_OK;
}

static skg_status read_flag(const skg_json_object *object, const char *name, int32_t *value) {
    const skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_flag(&node, value) : SKG_OK;
}

/* keV; more than fit are refused with their number. */
static skg_status read_thresholds(const skg_json_object *object, double thresholds[SKG_THRESHOLDS_MAX],
                                  int64_t *count) {
    skg_json_node node;
    SKG_TRY(skg_json_need(object, "Thresholds", "[20, 50]", &node));
    SKG_TRY(skg_json_array(&node, "[20, 50], in keV", count));
    if (*count < 1 || *count > SKG_THRESHOLDS_MAX)
        return skg_json_fail(&node, SKG_ERR_FORMAT, "has %d thresholds; give 1 to %d, in keV", (int)*count,
                             (int)SKG_THRESHOLDS_MAX);
    return skg_json_numbers(&node, "[20, 50], in keV", *count, thresholds);
}

static skg_status read_pile_up(const skg_json_object *object, skg_counting *counting) {
    static const char *const ways[] = {[SKG_PILE_UP_NONE] = "none",
                                       [SKG_PILE_UP_NONPARALYSABLE] = "nonparalysable",
                                       [SKG_PILE_UP_PARALYSABLE] = "paralysable"};
    static const char *const needed[] = {"DeadTime", "ExposureTime"};
    const skg_json_node node = skg_json_member(object, "PileUp");
    int64_t choice = SKG_PILE_UP_NONE;
    if (node.value) SKG_TRY(skg_json_choice(&node, "kind of pile-up", ways, 3, &choice));
    counting->pile_up = (int32_t)choice;
    for (int k = 0; k < 2; k++) {
        skg_json_node member = skg_json_member(object, needed[k]);
        if (member.value && !choice)
            return skg_json_fail(&member, SKG_ERR_FORMAT,
                                 "matters for pile-up alone; give PileUp \"paralysable\" or "
                                 "\"nonparalysable\", or leave it out");
        if (choice) SKG_TRY(skg_json_need(object, needed[k], k ? "0.1, in s" : "100, in ns", &member));
    }
    SKG_TRY(read_number(object, "DeadTime", &counting->dead_time_ns));
    return read_number(object, "ExposureTime", &counting->exposure_s);
}

/* Keys of the detector that have no meaning beside Counting. */
static skg_status refuse_others(const skg_json_object *detector) {
    static const char *const others[] = {"EnergyResponse", "Scintillator", "LSF", "PSF", "MTF", "DQE",
                                         "Binning",        "GreyValues"};
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        const skg_json_node other = skg_json_member(detector, others[k]);
        if (other.value)
            return skg_json_fail(
                &other, SKG_ERR_FORMAT,
                "is not combined with Counting, which says what the sensor records, and where; "
                "leave one of them out");
    }
    return SKG_OK;
}

static skg_status read_sensor(const skg_json_object *object, skg_counting *counting) {
    skg_json_node thickness;
    const skg_json_node cloud = skg_json_member(object, "Cloud");
    SKG_TRY(skg_json_need(object, "Thickness", "[1, \"mm\"]", &thickness));
    SKG_TRY(skg_json_lengths(&thickness, "[1, \"mm\"]", 1, &counting->thickness_mm));
    if (cloud.value) SKG_TRY(skg_json_lengths(&cloud, "[5, \"um\"]", 1, &counting->cloud_mm));
    SKG_TRY(read_number(object, "ElectronicNoise", &counting->electronic_kev));
    SKG_TRY(read_number(object, "Bias", &counting->bias_v));
    SKG_TRY(read_flag(object, "Fluorescence", &counting->fluorescence));
    SKG_TRY(read_flag(object, "AntiCoincidence", &counting->anti_coincidence));
    return read_pile_up(object, counting);
}

skg_status skg_setup_read_counting(skg_setup_reader *reader, const skg_json_object *detector) {
    const skg_json_node node = skg_json_member(detector, "Counting");
    const skg_view *view = &reader->setup->view;
    double thresholds[SKG_THRESHOLDS_MAX];
    skg_json_object object;
    skg_json_node material_node;
    skg_counting counting;
    if (!node.value) return SKG_OK;
    SKG_TRY(refuse_others(detector));
    SKG_TRY(skg_json_read_object(&node, &skg_keys_counting, &object));
    skg_counting_init(&counting);
    counting.threshold_kev = thresholds;
    SKG_TRY(skg_json_need(&object, "Material", "\"CdTe\"", &material_node));
    SKG_TRY(read_thresholds(&object, thresholds, &counting.count));
    SKG_TRY(read_sensor(&object, &counting));
    counting.pixel_mm[0] = skg_length(view->column_step), counting.pixel_mm[1] = skg_length(view->row_step);
    const skg_json_node density = skg_json_member(&object, "Density");
    SKG_TRY(skg_setup_read_material(reader, &material_node, &density, "sensor", &counting.material));
    const skg_status status = skg_counter_create(&counting, &reader->setup->counter);
    skg_material_release(&counting.material);
    return skg_json_at(&node, status);
}
