/* The section Breathing of a scene file. */
#include "breath/signal.h"
#include "core/maths.h"
#include "setup/keys.h"
#include "setup/sections.h"

#include <inttypes.h>
#include <math.h>

static const char *const points_example = "[[0, 0], [2.5, 110]]: seconds, value";

void skg_breathing_section_free(skg_breathing_section *section) {
    skg_setup_organs_free(section);
    for (int64_t i = 0; i < section->contrast_count; i++)
        skg_free(&section->contrasts[i].fill_fraction.points);
    skg_free(&section->samples);
    skg_free(&section->signal);
    skg_free(&section->holds);
    skg_free(&section->contrasts);
    skg_free(&section->weight.points);
    skg_free(&section->needle.points);
}

static skg_status read_number(const skg_json_object *object, const char *name, double *number) {
    skg_json_node node = skg_json_member(object, name);
    return node.value ? skg_json_number(&node, number) : SKG_OK;
}

static skg_status read_samples(skg_breathing_section *section, const skg_json_node *node) {
    skg_breath *breath = &section->breath;
    SKG_TRY(skg_json_array(node, "[1, 0.5, 0, 0.5]", &breath->sample_count));
    SKG_TRY(skg_alloc(breath->sample_count, sizeof *section->samples, "waveform", &section->samples));
    for (int64_t i = 0; i < breath->sample_count; i++) {
        skg_json_node sample = skg_json_element(node, i);
        SKG_TRY(skg_json_number(&sample, &section->samples[i]));
    }
    breath->samples = section->samples;
    breath->waveform = SKG_WAVEFORM_SAMPLED;
    return SKG_OK;
}

/* The named pattern comes first, because the other keys change it. */
static skg_status read_waveform(skg_breathing_section *section, const skg_json_object *object) {
    static const char *const waveforms[] = {"Sine", "Lujan", "Asymmetric"};
    skg_breath *breath = &section->breath;
    skg_json_node pattern = skg_json_member(object, "Pattern"),
                  waveform = skg_json_member(object, "Waveform");
    skg_json_node exponent = skg_json_member(object, "Exponent");
    const char *name = NULL;
    int64_t choice = 0;
    if (pattern.value) {
        SKG_TRY(skg_json_text(&pattern, &name));
        skg_status status = skg_breath_pattern_get(name, breath);
        SKG_TRY(skg_json_at(&pattern, status));
    }
    if (waveform.value && json_is_array(waveform.value)) {
        SKG_TRY(read_samples(section, &waveform));
    } else if (waveform.value) {
        SKG_TRY(skg_json_choice(&waveform, "waveform", waveforms, 3, &choice));
        breath->waveform = (int32_t)choice;
    }
    if (exponent.value) {
        SKG_TRY(skg_json_integer(&exponent, 1, 8, &choice));
        breath->exponent = (int32_t)choice;
    }
    SKG_TRY(read_number(object, "Period", &breath->period_s));
    SKG_TRY(read_number(object, "StartPhase", &breath->start_phase));
    SKG_TRY(read_number(object, "ExpirationRatio", &breath->expiration_ratio));
    SKG_TRY(read_number(object, "Thoracic", &breath->thoracic));
    SKG_TRY(read_number(object, "Diaphragmatic", &breath->diaphragmatic));
    return read_number(object, "ThoracicLag", &breath->thoracic_lag);
}

/* How far the diaphragm's links reach. */
static skg_status read_reach(const skg_json_object *object, const char *name, double *mm) {
    skg_json_node node = skg_json_member(object, name);
    if (!node.value) return SKG_OK;
    SKG_TRY(skg_json_lengths(&node, "[12, \"mm\"]", 1, mm));
    if (*mm > 0 && *mm <= 1000) return SKG_OK;
    return skg_json_fail(&node, SKG_ERR_BREATHING, "is %g mm; the range is above 0 to 1000 mm", *mm);
}

/* Reads the options of the anatomical coupling. Values out of range are refused here, where the file can be named. */
static skg_status read_anatomy(const skg_json_object *object, skg_body_options *body) {
    const double degree = SKG_PI / 180;
    const struct {
        const char *name;
        double *value, low, high;
    } fraction[] = {{"MuscleLength", &body->muscle_length, 0.1, 1},
                    {"LiverFollows", &body->liver_follows, 0, 2},
                    {"LiverHeld", &body->liver_held, 0, 1},
                    {"Hysteresis", &body->hysteresis, 0, 1}};
    double domes[3] = {0}, angles[2] = {0};
    const skg_json_node dome = skg_json_member(object, "Domes"), rib = skg_json_member(object, "RibAngles");
    for (size_t f = 0; f < sizeof fraction / sizeof *fraction; f++) {
        const skg_json_node node = skg_json_member(object, fraction[f].name);
        if (!node.value) continue;
        SKG_TRY(skg_json_number(&node, fraction[f].value));
        if (!(*fraction[f].value >= fraction[f].low && *fraction[f].value <= fraction[f].high))
            return skg_json_fail(&node, SKG_ERR_BREATHING, "is %g; the range is %g to %g", *fraction[f].value,
                                 fraction[f].low, fraction[f].high);
    }
    if (dome.value) {
        SKG_TRY(skg_json_lengths(&dome, "[4, -2, 0, \"mm\"]: left, right, back", 3, domes));
        for (int k = 0; k < 3; k++)
            if (!(fabs(domes[k]) <= 57))
                return skg_json_fail(&dome, SKG_ERR_BREATHING, "has %g mm; the range is -57 to 57 mm",
                                     domes[k]);
        body->dome_left_mm = domes[0], body->dome_right_mm = domes[1], body->dome_back_mm = domes[2];
    }
    if (!rib.value) return SKG_OK;
    SKG_TRY(skg_json_numbers(&rib, "[14.6, 0]: degrees of rib 5, and how much more they fall per rib", 2,
                             angles));
    if (!(angles[0] >= 0 && angles[0] <= 45 && fabs(angles[1]) <= 5))
        return skg_json_fail(&rib, SKG_ERR_BREATHING,
                             "is [%g, %g]; the first is 0 to 45 degrees, the second -5 to 5 degrees",
                             angles[0], angles[1]);
    body->rib_angle_rad = degree * angles[0], body->rib_fall_rad = degree * angles[1];
    return SKG_OK;
}

static skg_status read_body(skg_breathing_section *section, const skg_json_object *object) {
    skg_body_options *body = &section->body;
    skg_json_node tendon = skg_json_member(object, "Tendon"), plane = skg_json_member(object, "TendonPlane");
    skg_json_node relaxation = skg_json_member(object, "Relaxation");
    skg_json_node density = skg_json_member(object, "LungDensity");
    skg_json_node reference = skg_json_member(object, "Reference");
    static const char *const rib_axes[] = {"Literature", "Bones"};  /* as SKG_RIB_AXES_ */
    static const char *const couplings[] = {"Anatomical", "Paper"}; /* as SKG_COUPLING_ */
    skg_json_node axes = skg_json_member(object, "RibAxes"), coupling = skg_json_member(object, "Coupling");
    int64_t passes = 0, choice = SKG_RIB_AXES_LITERATURE, coupled = SKG_COUPLING_ANATOMICAL;
    double amplitude = 0;
    if (reference.value) SKG_TRY(skg_json_number(&reference, &amplitude));
    if (!(amplitude >= 0 && amplitude <= 1))
        return skg_json_fail(
            &reference, SKG_ERR_BREATHING,
            "is %g; give the amplitude at which the meshes were made, 0 (end-expiration) to 1", amplitude);
    body->reference_thoracic = amplitude * section->breath.thoracic;
    body->reference_diaphragmatic = amplitude * section->breath.diaphragmatic;
    if (tendon.value) SKG_TRY(skg_json_lengths(&tendon, "[0, 0, -15, \"mm\"]", 3, body->tendon_mm));
    SKG_TRY(read_anatomy(object, body));
    SKG_TRY(read_reach(object, "DiaphragmRibs", &body->diaphragm_ribs_mm));
    SKG_TRY(read_reach(object, "DiaphragmLiver", &body->diaphragm_liver_mm));
    if (plane.value) SKG_TRY(skg_json_numbers(&plane, "[0, 1, 1, 20]", 4, body->tendon_plane));
    if (relaxation.value) SKG_TRY(skg_json_integer(&relaxation, 0, 20, &passes));
    body->relaxation = (int32_t)passes;
    if (axes.value) SKG_TRY(skg_json_choice(&axes, "kind of rib axes", rib_axes, 2, &choice));
    body->rib_axes = (int32_t)choice;
    if (coupling.value)
        SKG_TRY(skg_json_choice(&coupling, "coupling of ribs and diaphragm", couplings, 2, &coupled));
    body->coupling = (int32_t)coupled;
    section->lung_density = 1;
    if (density.value) SKG_TRY(skg_json_flag(&density, &section->lung_density));
    return SKG_OK;
}

static skg_status read_curve(const skg_json_node *node, double lowest, double highest, skg_curve *curve) {
    int64_t count = 0;
    double last = -HUGE_VAL;
    if (curve->count) return skg_json_fail(node, SKG_ERR_FORMAT, "is given twice");
    SKG_TRY(skg_json_array(node, points_example, &count));
    if (count == 0) return skg_json_fail(node, SKG_ERR_FORMAT, "is empty; give %s", points_example);
    SKG_TRY(skg_alloc(2 * count, sizeof *curve->points, "event", &curve->points));
    for (int64_t i = 0; i < count; i++) {
        skg_json_node point = skg_json_element(node, i);
        double *at = curve->points + 2 * i;
        SKG_TRY(skg_json_numbers(&point, "[2.5, 110]", 2, at));
        if (!(at[0] > last))
            return skg_json_fail(&point, SKG_ERR_FORMAT,
                                 "is at %g s, the one before at %g s; times have to rise", at[0], last);
        if (!(at[1] >= lowest && at[1] <= highest))
            return skg_json_fail(&point, SKG_ERR_FORMAT, "is %g; the range is %g to %g", at[1], lowest,
                                 highest);
        last = at[0];
    }
    curve->count = count;
    return SKG_OK;
}

static skg_status read_event(skg_setup_reader *reader, const skg_json_node *node) {
    skg_breathing_section *section = &reader->setup->breathing;
    skg_json_object event;
    SKG_TRY(skg_json_read_object(node, &skg_keys_event, &event));
    skg_json_node hold = skg_json_member(&event, "Hold"), weight = skg_json_member(&event, "Weight");
    skg_json_node needle = skg_json_member(&event, "Needle"), contrast = skg_json_member(&event, "Contrast");
    skg_json_node share = skg_json_member(&event, "Share");
    if ((hold.value != NULL) + (weight.value != NULL) + (needle.value != NULL) + (contrast.value != NULL) !=
            1 ||
        (contrast.value == NULL) != (share.value == NULL))
        return skg_json_fail(
            node, SKG_ERR_FORMAT,
            "is no event; give one of {\"Hold\": [1, 5]}, {\"Weight\": [[5, 1], [6, 0.3]]}, "
            "{\"Needle\": [[1, 0], [4, 110]]}, {\"Contrast\": \"bile ducts\", \"Share\": [[5, "
            "0], [7, 1]]}");
    if (hold.value) {
        double span[2];
        SKG_TRY(skg_json_numbers(&hold, "[1, 5]", 2, span));
        section->holds[section->breath.hold_count++] =
            (skg_breath_hold){.size = (int32_t)sizeof(skg_breath_hold), .start_s = span[0], .end_s = span[1]};
        return SKG_OK;
    }
    if (weight.value) return read_curve(&weight, 0, 4, &section->weight);
    if (needle.value) return read_curve(&needle, -1000, 1000, &section->needle);
    const char *label = NULL;
    struct skg_breathing_contrast *filling = &section->contrasts[section->contrast_count++];
    SKG_TRY(skg_json_text(&contrast, &label));
    SKG_TRY(skg_setup_find_part(reader, &contrast, label, &filling->part));
    return read_curve(&share, 0, 1, &filling->fill_fraction);
}

static skg_status read_events(skg_setup_reader *reader, const skg_json_node *node) {
    skg_breathing_section *section = &reader->setup->breathing;
    int64_t count = 0;
    SKG_TRY(skg_json_array(node, "[{\"Hold\": [1, 5]}]", &count));
    SKG_TRY(skg_alloc(count, sizeof *section->holds, "events", &section->holds));
    SKG_TRY(skg_alloc(count, sizeof *section->contrasts, "events", &section->contrasts));
    section->breath.holds = section->holds;
    for (int64_t i = 0; i < count; i++) {
        skg_json_node event = skg_json_element(node, i);
        SKG_TRY(read_event(reader, &event));
    }
    if (section->weight.count && section->body.hysteresis > 0)
        return skg_json_fail(node, SKG_ERR_UNSUPPORTED,
                             "has a Weight, which changes the breath; it needs Hysteresis 0");
    return SKG_OK;
}

/* Reads the recorded breath of a patient from its file. */
static skg_status read_signal(skg_setup_reader *reader, const skg_json_node *node) {
    skg_breathing_section *section = &reader->setup->breathing;
    const char *name = NULL, *path = NULL;
    SKG_TRY(skg_json_text(node, &name));
    SKG_TRY(skg_setup_find_file(reader, name, &path));
    SKG_TRY(skg_json_at(node, skg_signal_load(path, &section->signal, &section->breath.signal_count)));
    section->breath.signal = section->signal;
    if (section->body.hysteresis > 0)
        return skg_json_fail(node, SKG_ERR_UNSUPPORTED, "is no periodic breath; it needs Hysteresis 0");
    return SKG_OK;
}

skg_status skg_setup_read_breathing(skg_setup_reader *reader, const skg_json_node *node) {
    skg_breathing_section *section = &reader->setup->breathing;
    skg_json_object object;
    skg_breath_init(&section->breath);
    SKG_TRY(skg_breath_pattern_get("quiet", &section->breath));
    skg_body_options_init(&section->body);
    section->lung_density = 1;
    if (!node->value || json_is_null(node->value)) return SKG_OK;
    section->is_given = 1;
    SKG_TRY(skg_json_read_object(node, &skg_keys_breathing, &object));
    SKG_TRY(read_waveform(section, &object));
    SKG_TRY(read_body(section, &object));
    skg_json_node organs = skg_json_member(&object, "Organs"), events = skg_json_member(&object, "Events");
    if (organs.value) SKG_TRY(skg_setup_read_organs(reader, &organs));
    if (events.value) SKG_TRY(read_events(reader, &events));
    skg_json_node signal = skg_json_member(&object, "Signal");
    if (signal.value) SKG_TRY(read_signal(reader, &signal));
    skg_json_node fit = skg_json_member(&object, "Fit");
    if (fit.value) SKG_TRY(skg_setup_read_body_fit(&fit, &section->fit));
    skg_status status = skg_breath_check(&section->breath);
    return skg_json_at(node, status);
}
