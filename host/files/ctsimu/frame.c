/* One frame of a CTSimU scenario: where everything stands. */
#include "ctsimu/parts.h"

#include "core/maths.h"

#include <stdio.h>
#include <string.h>

static void vector_free(skg_scene_vector *vector) {
    for (int k = 0; k < 3; k++) skg_parameter_free(&vector->components[k]);
}

void skg_placement_free(skg_placement *placement) {
    vector_free(&placement->centre);
    vector_free(&placement->u);
    vector_free(&placement->w);
    for (int64_t d = 0; d < placement->deviation_count; d++) {
        vector_free(&placement->deviations[d].axis);
        vector_free(&placement->deviations[d].pivot);
        skg_parameter_free(&placement->deviations[d].amount);
    }
    skg_free(&placement->deviations);
}

static const char *const component_names[3][3] = {[SKG_AXES_WORLD] = {"x", "y", "z"},
                                                  [SKG_AXES_LOCAL] = {"u", "v", "w"},
                                                  [SKG_AXES_SAMPLE] = {"r", "s", "t"}};

static skg_status read_vector(const skg_item *item, skg_item_unit unit, skg_scene_vector *vector) {
    for (int axes = SKG_AXES_WORLD; axes <= SKG_AXES_SAMPLE; axes++) {
        const skg_item first = skg_item_at(item, component_names[axes][0]);
        if (!first.value) continue;
        vector->axes = (skg_vector_axes)axes;
        for (int k = 0; k < 3; k++) {
            const skg_item component = skg_item_at(item, component_names[axes][k]);
            if (!skg_item_given(&component))
                return skg_item_fail(&component, SKG_ERR_FORMAT, "is missing; a vector has three components");
            SKG_TRY(skg_parameter_read(&component, unit, 0, &vector->components[k]));
        }
        return SKG_OK;
    }
    return skg_item_fail(item, SKG_ERR_FORMAT,
                         item->value ? "has neither x, y, z nor u, v, w nor r, s, t" : "is missing");
}

/* An axis by its name, "w". */
static skg_status read_axis_name(const skg_item *item, skg_scene_vector *vector) {
    const char *name = json_string_value(item->value);
    for (int axes = 0; axes < 3; axes++)
        for (int k = 0; k < 3; k++)
            if (strcmp(name, component_names[axes][k]) == 0) {
                vector->axes = (skg_vector_axes)axes;
                vector->components[k].value = 1;
                return SKG_OK;
            }
    return skg_item_fail(item, SKG_ERR_FORMAT, "\"%s\" is no axis; give x, y, z, u, v, w, r, s or t", name);
}

static skg_status read_deviation(const skg_item *item, skg_deviation *deviation) {
    const skg_item type = skg_item_at(item, "type"), axis = skg_item_at(item, "axis");
    const skg_item pivot = skg_item_at(item, "pivot"), amount = skg_item_at(item, "amount");
    const skg_item known = skg_item_at(item, "known_to_reconstruction");
    const char *name = NULL;
    SKG_TRY(skg_item_text(&type, &name));
    if (!name || (strcmp(name, "rotation") != 0 && strcmp(name, "translation") != 0))
        return skg_item_fail(&type, SKG_ERR_FORMAT, "is neither \"rotation\" nor \"translation\"");
    deviation->is_rotation = strcmp(name, "rotation") == 0;
    deviation->is_known = 1;
    SKG_TRY(skg_item_flag(&known, &deviation->is_known));
    SKG_TRY(json_is_string(axis.value) ? read_axis_name(&axis, &deviation->axis)
                                       : read_vector(&axis, SKG_UNIT_NONE, &deviation->axis));
    deviation->pivot.axes = SKG_AXES_SAMPLE; /* by default its own centre */
    if (pivot.value) SKG_TRY(read_vector(&pivot, SKG_UNIT_MM, &deviation->pivot));
    if (!skg_item_given(&amount)) return skg_item_fail(&amount, SKG_ERR_FORMAT, "is missing");
    return skg_parameter_read(&amount, deviation->is_rotation ? SKG_UNIT_RAD : SKG_UNIT_MM, 0,
                              &deviation->amount);
}

static skg_status read_deviations(const skg_item *item, skg_placement *placement) {
    const skg_item list = skg_item_at(item, "deviations");
    const int64_t count =
        json_is_array(list.value) ? (int64_t)json_array_size(list.value) : list.value != NULL;
    if (skg_item_at(item, "deviation").value)
        return skg_item_fail(item, SKG_ERR_UNSUPPORTED,
                             "has a \"deviation\" of formats before 1.0; give \"deviations\"");
    SKG_TRY(skg_alloc(count, sizeof *placement->deviations, "deviations", &placement->deviations));
    for (int64_t d = 0; d < count; d++) {
        const skg_item one = json_is_array(list.value) ? skg_item_element(&list, d) : list;
        placement->deviation_count = d + 1;
        SKG_TRY(read_deviation(&one, &placement->deviations[d]));
    }
    return SKG_OK;
}

skg_status skg_placement_read(const skg_item *item, skg_placement *placement) {
    const skg_item centre = skg_item_at(item, "center|centre"), u = skg_item_at(item, "vector_u|vector_r");
    const skg_item w = skg_item_at(item, "vector_w|vector_t");
    *placement = (skg_placement){0};
    SKG_TRY(read_vector(&centre, SKG_UNIT_MM, &placement->centre));
    SKG_TRY(read_vector(&u, SKG_UNIT_NONE, &placement->u));
    SKG_TRY(read_vector(&w, SKG_UNIT_NONE, &placement->w));
    placement->is_on_stage = placement->centre.axes != SKG_AXES_WORLD;
    if (placement->u.axes != placement->centre.axes || placement->w.axes != placement->centre.axes)
        return skg_item_fail(item, SKG_ERR_FORMAT, "has a centre and vectors of different axes");
    return read_deviations(item, placement);
}

static void vector_at(const skg_scene_vector *vector, int64_t frame, int known, double *values) {
    for (int k = 0; k < 3; k++) values[k] = skg_parameter_at(&vector->components[k], frame, known);
}

/* From the axes of a system into those around it. */
static void out_of(const skg_system *system, const double *local, double *direction) {
    double sum[3];
    for (int k = 0; k < 3; k++) sum[k] = skg_dot(system->axes + 3 * k, local);
    memcpy(direction, sum, sizeof sum);
}

void skg_system_direction(const skg_system *system, const double *direction, double *local) {
    double sum[3] = {0};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) sum[k] += system->axes[3 * j + k] * direction[j];
    memcpy(local, sum, sizeof sum);
}

void skg_system_point(const skg_system *system, const double *point, double *local) {
    double from[3];
    skg_add_scaled(point, -1, system->centre, from);
    skg_system_direction(system, from, local);
}

/* Turns the axes, and the centre about a pivot. axis: of any length but 0 */
static void turn_system(const double *axis, double angle, const double *pivot, skg_system *system) {
    const double length = skg_length(axis);
    double turn[16], unit[3], column[3];
    const double fixed[3] = {pivot[0], pivot[1], pivot[2]}; /* the pivot may be the centre */
    if (!(length > 0) || angle == 0) return;
    skg_scale_vector(1 / length, axis, unit);
    skg_pose_rotation(angle, unit, turn);
    skg_add_scaled(system->centre, -1, fixed, system->centre);
    skg_pose_point(turn, system->centre, system->centre);
    skg_add_scaled(system->centre, 1, fixed, system->centre);
    for (int k = 0; k < 3; k++) {
        for (int j = 0; j < 3; j++) column[j] = system->axes[3 * j + k];
        skg_pose_point(turn, column, column);
        for (int j = 0; j < 3; j++) system->axes[3 * j + k] = column[j];
    }
}

/* A direction (or a point) of a deviation in the axes in which the system stands. */
static void resolve(const skg_scene_vector *vector, int64_t frame, int known, const skg_system *stage,
                    const skg_system *own, int is_point, double *result) {
    vector_at(vector, frame, known, result);
    const int is_own = stage ? vector->axes == SKG_AXES_SAMPLE : vector->axes != SKG_AXES_WORLD;
    if (is_own) {
        out_of(own, result, result);
        if (is_point) skg_add_scaled(result, 1, own->centre, result);
    } else if (stage && vector->axes == SKG_AXES_WORLD) {
        if (is_point)
            skg_system_point(stage, result, result);
        else
            skg_system_direction(stage, result, result);
    }
}

static void deviate(const skg_deviation *deviation, int64_t frame, const skg_system *stage, int known,
                    skg_system *system) {
    double axis[3], pivot[3];
    if (known && !deviation->is_known) return;
    const double amount = skg_parameter_at(&deviation->amount, frame, known);
    resolve(&deviation->axis, frame, known, stage, system, 0, axis);
    if (deviation->is_rotation) {
        resolve(&deviation->pivot, frame, known, stage, system, 1, pivot);
        turn_system(axis, amount, pivot, system);
    } else if (skg_length(axis) > 0) {
        skg_add_scaled(system->centre, amount / skg_length(axis), axis, system->centre);
    }
}

/* The centre drifts last, as in the toolbox of the format; drifting axes are those before the stage turns. */
void skg_placement_at(const skg_placement *placement, int64_t frame, double turn, const skg_system *stage,
                      int known, skg_system *system) {
    double u[3], v[3], w[3], drifted[3];
    vector_at(&placement->u, frame, known, u);
    vector_at(&placement->w, frame, known, w);
    vector_at(&placement->centre, frame, known, drifted);
    for (int k = 0; k < 3; k++) system->centre[k] = placement->centre.components[k].value;
    skg_scale_vector(1 / skg_length(u), u, u);
    skg_scale_vector(1 / skg_length(w), w, w);
    skg_cross(w, u, v);
    skg_scale_vector(1 / skg_length(v), v, v);
    for (int j = 0; j < 3; j++) {
        system->axes[3 * j] = u[j];
        system->axes[3 * j + 1] = v[j];
        system->axes[3 * j + 2] = w[j];
    }
    turn_system(w, turn, system->centre, system);
    for (int64_t d = 0; d < placement->deviation_count; d++)
        deviate(&placement->deviations[d], frame, stage, known, system);
    for (int k = 0; k < 3; k++) system->centre[k] += drifted[k] - placement->centre.components[k].value;
}
