/* A set-up that breathes. */
#include "body/posed.h"
#include "body/types.h"
#include "core/context.h"
#include "core/text.h"
#include "scene/scene.h"
#include "setup/types.h"

#include <skiagraph/motion.h>

#include <inttypes.h>
#include <math.h>
#include <string.h>

struct skg_motion {
    const skg_setup *setup;
    skg_body *body;
    int64_t *organ;         /* [parts] number in the body */
    double needle_mm;       /* depth as the meshes have it; NaN: no needle */
    skg_motion_state state; /* but for its breath, which is: */
    skg_breath_state breath;
    int64_t override_count;  /* lungs, then parts with contrast */
    int64_t *override_parts; /* [override_count] */
    double *density_ratios;  /* [override_count] */
    double *fill_fractions;  /* [override_count] */
    double lung_hu;          /* as the meshes have it */
};

/* Energy at which Hounsfield units are reported, keV: about the mean of a beam of 120 kV. */
static const double hu_kev = 70;

void skg_motion_state_init_sized(void *state, int32_t size) {
    const skg_motion_state defaults = {.phase = 0.5};
    skg_struct_init(state, size, &defaults, sizeof defaults);
}

static skg_status add_organ(skg_motion *motion, int64_t part) {
    const skg_scene_part_data *from = &motion->setup->scene->parts[part];
    skg_organ organ;
    skg_organ_init(&organ);
    organ.mesh = from->mesh;
    organ.label = from->label;
    organ.inside = from->inside < 0 ? -1 : motion->organ[from->inside];
    skg_setup_describe_organ(&motion->setup->breathing, part, &organ);
    return skg_body_add(motion->body, &organ, &motion->organ[part]);
}

/* Adds parents before what lies in them. A scene has no circle of parents. */
static skg_status add_organs(skg_motion *motion) {
    const skg_scene *scene = motion->setup->scene;
    int64_t added = 0;
    for (int64_t p = 0; p < scene->count; p++) motion->organ[p] = -1;
    while (added < scene->count)
        for (int64_t p = 0; p < scene->count; p++) {
            const int64_t inside = scene->parts[p].inside;
            if (motion->organ[p] >= 0 || (inside >= 0 && motion->organ[inside] < 0)) continue;
            SKG_TRY(add_organ(motion, p));
            added++;
        }
    return SKG_OK;
}

static const skg_body_organ *organ_of(const skg_motion *motion, int64_t part) {
    return &motion->body->organ[motion->organ[part]];
}

/* The body writes positions into meshes. So a mesh that moves belongs to one part only, and that part has no pose. */
static skg_status check_parts(const skg_motion *motion) {
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const skg_scene *scene = motion->setup->scene;
    for (int64_t p = 0; p < scene->count; p++) {
        if (organ_of(motion, p)->role == ROLE_STATIC) continue;
        if (scene->parts[p].volume)
            return skg_fail(
                SKG_ERR_BREATHING,
                "%s: is a volume of cells, which does not breathe; give it a label that is none of an organ's",
                scene->parts[p].label);
        for (int k = 0; k < 16; k++)
            if (scene->parts[p].pose[k] != identity[k])
                return skg_fail(
                    SKG_ERR_BREATHING,
                    "%s: breathes, but has a Transform; give it a file with its vertices in place (x to the "
                    "left, y to the back, z to the head, mm)",
                    scene->parts[p].label);
        for (int64_t q = 0; q < scene->count; q++)
            if (q != p && scene->parts[q].mesh == scene->parts[p].mesh)
                return skg_fail(SKG_ERR_BREATHING,
                                "%s: breathes, so it cannot share its mesh with %s; give each its own file",
                                scene->parts[p].label, scene->parts[q].label);
    }
    return SKG_OK;
}

static skg_status find_lung(skg_motion *motion) {
    const skg_scene *scene = motion->setup->scene;
    motion->lung_hu = (double)NAN;
    for (int64_t p = 0; p < scene->count && isnan(motion->lung_hu); p++)
        if (skg_label_begins(organ_of(motion, p)->label, "lung"))
            SKG_TRY(skg_material_hounsfield_get(scene->parts[p].material, hu_kev, &motion->lung_hu));
    return SKG_OK;
}

static skg_status list_overrides(skg_motion *motion) {
    const skg_breathing_section *section = &motion->setup->breathing;
    const int64_t parts = motion->setup->scene->count, most = parts + section->contrast_count;
    SKG_TRY(skg_alloc(most, sizeof *motion->override_parts, "motion", &motion->override_parts));
    SKG_TRY(skg_alloc(most, sizeof *motion->density_ratios, "motion", &motion->density_ratios));
    SKG_TRY(skg_alloc(most, sizeof *motion->fill_fractions, "motion", &motion->fill_fractions));
    for (int64_t p = 0; p < parts && section->lung_density; p++)
        if (organ_of(motion, p)->role == ROLE_LINKED && skg_label_begins(organ_of(motion, p)->label, "lung"))
            motion->override_parts[motion->override_count++] = p;
    for (int64_t c = 0; c < section->contrast_count; c++)
        motion->override_parts[motion->override_count++] = section->contrasts[c].part;
    for (int64_t k = 0; k < motion->override_count; k++)
        motion->density_ratios[k] = motion->fill_fractions[k] = 1;
    return SKG_OK;
}

static skg_status make(skg_context *context, skg_motion *motion) {
    const skg_breathing_section *section = &motion->setup->breathing;
    SKG_TRY(skg_alloc(motion->setup->scene->count, sizeof *motion->organ, "motion", &motion->organ));
    SKG_TRY(skg_body_create(context, &section->body, &motion->body));
    SKG_TRY(add_organs(motion));
    SKG_TRY(skg_body_link(motion->body));
    SKG_TRY(check_parts(motion));
    SKG_TRY(list_overrides(motion));
    SKG_TRY(find_lung(motion));
    motion->needle_mm = skg_body_needle_depth(motion->body);
    if (section->needle.count && isnan(motion->needle_mm))
        return skg_fail(
            SKG_ERR_BREATHING,
            "Breathing.Events: there is no needle to insert; it needs samples \"needle\", \"liver\" and \"skin\"");
    if (section->body.hysteresis > 0) SKG_TRY(skg_body_breathe(motion->body, &section->breath));
    return SKG_OK;
}

static skg_status create(skg_context *context, const skg_setup *setup, skg_motion **result) {
    SKG_PLAIN;
    skg_motion *motion = NULL;
    SKG_NEEDS_OF("skg_motion_create", setup);
    SKG_NEEDS_OF("skg_motion_create", result);
    *result = NULL;
    SKG_TRY(skg_alloc(1, sizeof *motion, "motion", &motion));
    motion->setup = setup;
    skg_motion_state_init(&motion->state);
    skg_breath_state_init(&motion->breath);
    skg_status status = make(context, motion);
    if (status != SKG_OK)
        skg_motion_release(&motion);
    else
        *result = motion;
    return status;
}

skg_status skg_motion_create(skg_context *context, const skg_setup *setup, skg_motion **result) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create(context, setup, result));
}

void skg_motion_release(skg_motion **motion) {
    if (!motion || !*motion) return;
    skg_body_release(&(*motion)->body);
    skg_free(&(*motion)->organ);
    skg_free(&(*motion)->override_parts);
    skg_free(&(*motion)->density_ratios);
    skg_free(&(*motion)->fill_fractions);
    skg_free(motion);
}

static double value_at(const skg_curve *curve, double time) {
    const double *p = curve->points;
    int64_t i = 0;
    while (i < curve->count && p[2 * i] <= time) i++;
    if (i == 0) return p[1];
    if (i == curve->count) return p[2 * i - 1];
    const double fraction = (time - p[2 * i - 2]) / (p[2 * i] - p[2 * i - 2]);
    return p[2 * i - 1] + fraction * (p[2 * i + 1] - p[2 * i - 1]);
}

/* Poses the meshes by the breath and the needle of motion->state. */
static skg_status pose(skg_motion *motion) {
    const skg_breathing_section *section = &motion->setup->breathing;
    if (!isnan(motion->needle_mm))
        SKG_TRY(skg_body_needle_set(motion->body, motion->needle_mm - motion->state.needle_mm));
    SKG_TRY(skg_body_pose(motion->body, &motion->breath));
    motion->state.lung_density_ratio = section->lung_density ? skg_body_lung_ratio(motion->body) : 1;
    motion->state.lung_hu = skg_lung_hounsfield(motion->lung_hu, motion->state.lung_density_ratio);
    for (int64_t k = 0; k < motion->override_count - section->contrast_count; k++)
        motion->density_ratios[k] = motion->state.lung_density_ratio;
    return SKG_OK;
}

skg_status skg_motion_pose_at_time(skg_motion *motion, double time_s) {
    SKG_PLAIN;
    SKG_NEEDS(motion);
    const skg_breathing_section *section = &motion->setup->breathing;
    skg_motion_state *state = &motion->state;
    SKG_TRY(skg_breath_state_at_time(&section->breath, time_s, &motion->breath));
    state->time_s = time_s;
    state->needle_mm = section->needle.count ? value_at(&section->needle, time_s) : motion->needle_mm;
    if (section->weight.count) {
        const double weight = value_at(&section->weight, time_s);
        motion->breath.thoracic *= weight;
        motion->breath.diaphragmatic *= weight;
    }
    const int64_t first = motion->override_count - section->contrast_count;
    for (int64_t c = 0; c < section->contrast_count; c++)
        motion->fill_fractions[first + c] = value_at(&section->contrasts[c].fill_fraction, time_s);
    return pose(motion);
}

skg_status skg_motion_pose_at_phase(skg_motion *motion, double phase) {
    SKG_PLAIN;
    SKG_NEEDS(motion);
    SKG_TRY(skg_breath_state_at_phase(&motion->setup->breathing.breath, phase, &motion->breath));
    motion->state.time_s = (double)NAN;
    motion->state.needle_mm = motion->needle_mm;
    for (int64_t k = 0; k < motion->override_count; k++) motion->fill_fractions[k] = 1;
    return pose(motion);
}

skg_status skg_motion_fill(const skg_motion *motion, skg_frame *frame) {
    SKG_PLAIN;
    SKG_NEEDS(motion);
    SKG_NEEDS(frame);
    skg_frame ours;
    skg_frame_init(&ours);
    SKG_TRY(skg_struct_read(frame, "skg_frame", &ours, sizeof ours));
    ours.override_count = motion->override_count;
    ours.override_parts = motion->override_parts;
    ours.density_ratios = motion->density_ratios;
    ours.fill_fractions = motion->fill_fractions;
    return skg_struct_write(&ours, sizeof ours, "skg_frame", frame);
}

skg_status skg_motion_state_get(const skg_motion *motion, skg_motion_state *state) {
    SKG_NEEDS(motion);
    skg_motion_state ours = motion->state;
    ours.phase = motion->breath.phase;
    ours.amplitude = motion->breath.amplitude;
    ours.thoracic = motion->breath.thoracic;
    ours.diaphragmatic = motion->breath.diaphragmatic;
    return skg_struct_write(&ours, sizeof ours, "skg_motion_state", state);
}

skg_status skg_motion_period_get(const skg_motion *motion, double *period_s) {
    SKG_NEEDS(motion);
    SKG_NEEDS(period_s);
    *period_s = motion->setup->breathing.breath.period_s;
    return SKG_OK;
}

skg_status skg_motion_body_get(const skg_motion *motion, skg_body **body) {
    SKG_NEEDS(motion);
    SKG_NEEDS(body);
    *body = motion->body;
    return SKG_OK;
}

skg_status skg_setup_body_options_get(const skg_setup *setup, int32_t *breathes, skg_body_options *options) {
    SKG_NEEDS(setup);
    SKG_NEEDS(breathes);
    SKG_TRY(
        skg_struct_write(&setup->breathing.body, sizeof setup->breathing.body, "skg_body_options", options));
    *breathes = setup->breathing.is_given;
    return SKG_OK;
}

static skg_status check_part(const skg_motion *motion, int64_t part) {
    const int64_t count = motion->setup->scene->count;
    if (part >= 0 && part < count) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "motion: no part %" PRId64 "; parts are 0 to %" PRId64, part,
                    count - 1);
}

skg_status skg_motion_part_moves(const skg_motion *motion, int64_t part, int32_t *moves) {
    SKG_NEEDS(motion);
    SKG_NEEDS(moves);
    SKG_TRY(check_part(motion, part));
    *moves = organ_of(motion, part)->role != ROLE_STATIC;
    return SKG_OK;
}

skg_status skg_motion_rest_get(const skg_motion *motion, int64_t part, double *positions) {
    SKG_NEEDS(motion);
    SKG_NEEDS(positions);
    SKG_TRY(check_part(motion, part));
    const skg_body_organ *organ = organ_of(motion, part);
    memcpy(positions, organ->rest, (size_t)(3 * organ->vertices) * sizeof *positions);
    return SKG_OK;
}
