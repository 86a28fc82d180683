/* geometry and acquisition: where source and detector are in each projection. */
#include "core/maths.h"
#include "ctsimu/parts.h"

#include <math.h>
#include <string.h>

json_t *skg_ctsimu_numbers(int64_t count, const double *numbers) {
    json_t *array = json_array();
    for (int64_t i = 0; i < count && array; i++)
        if (json_array_append_new(array, json_real(numbers[i])) != 0) {
            json_decref(array);
            array = NULL;
        }
    return array;
}

skg_status skg_ctsimu_put(json_t *object, const char *key, json_t *value) {
    const int failed = json_is_array(object) ? json_array_append_new(object, value)
                                             : json_object_set_new(object, key, value);
    return failed ? skg_fail(SKG_ERR_MEMORY, "scenario: no memory for %s", key ? key : "a list") : SKG_OK;
}

static skg_status read_detector(skg_ctsimu *scenario, skg_ctsimu_geometry *g) {
    const skg_item root = skg_item_root(scenario);
    const skg_item columns = skg_item_at(&root, "detector.columns"),
                   rows = skg_item_at(&root, "detector.rows");
    SKG_TRY(skg_item_integer(&columns, 1, 32768, &g->columns));
    SKG_TRY(skg_item_integer(&rows, 1, 32768, &g->rows));
    for (int k = 0; k < 2; k++) {
        const skg_item pitch =
            skg_item_at(&root, k == 0 ? "detector.pixel_pitch.u" : "detector.pixel_pitch.v");
        SKG_TRY(skg_item_number(&pitch, SKG_UNIT_MM, &g->pitch[k]));
        if (!(g->pitch[k] > 0)) return skg_item_fail(&pitch, SKG_ERR_FORMAT, "is missing or not above 0");
    }
    return SKG_OK;
}

/* The angle of the stage in each projection. */
static skg_status read_angles(skg_ctsimu *scenario, skg_ctsimu_geometry *g) {
    const skg_item root = skg_item_root(scenario), acquisition = skg_item_at(&root, "acquisition");
    const skg_item start = skg_item_at(&acquisition, "start_angle"),
                   stop = skg_item_at(&acquisition, "stop_angle");
    const skg_item direction = skg_item_at(&acquisition, "direction");
    const skg_item last = skg_item_at(&acquisition, "include_final_angle");
    double from = 0, to = 0;
    int32_t includes_last = 0;
    const char *way = NULL;
    SKG_TRY(skg_item_number(&start, SKG_UNIT_RAD, &from));
    SKG_TRY(skg_item_number(&stop, SKG_UNIT_RAD, &to));
    SKG_TRY(skg_item_flag(&last, &includes_last));
    SKG_TRY(skg_item_text(&direction, &way));
    if (way && strcmp(way, "CCW") != 0 && strcmp(way, "CW") != 0)
        return skg_item_fail(&direction, SKG_ERR_FORMAT, "is neither \"CCW\" nor \"CW\"");
    if (from > to)
        return skg_item_fail(&stop, SKG_ERR_FORMAT,
                             "is less than start_angle; \"direction\" says which way the stage turns");
    const int64_t steps = scenario->frames - (includes_last ? 1 : 0);
    const double sign = way && strcmp(way, "CW") == 0 ? -1 : 1;
    SKG_TRY(skg_alloc(scenario->frames, sizeof(double), "angles", &g->angles));
    for (int64_t k = 0; k < scenario->frames; k++)
        g->angles[k] = sign * (from + (steps > 0 ? (double)k * (to - from) / (double)steps : 0));
    return SKG_OK;
}

static skg_status read_source(skg_ctsimu *scenario, skg_ctsimu_geometry *g) {
    const skg_item root = skg_item_root(scenario), type = skg_item_at(&root, "geometry.source.type");
    const char *name = NULL;
    SKG_TRY(skg_item_text(&type, &name));
    if (name && strcmp(name, "cone") != 0 && strcmp(name, "parallel") != 0)
        return skg_item_fail(&type, SKG_ERR_FORMAT, "is neither \"cone\" nor \"parallel\"");
    g->is_parallel = name && strcmp(name, "parallel") == 0;
    return SKG_OK;
}

/* The systems of the stage, and the distance of the detector's plane from the source. */
static skg_status find_stages(skg_ctsimu *scenario, skg_ctsimu_geometry *g) {
    skg_system source, detector;
    double way[3], normal[3];
    SKG_TRY(skg_alloc(scenario->frames, sizeof *g->stages, "poses", &g->stages));
    SKG_TRY(skg_alloc(scenario->frames, sizeof *g->known, "poses", &g->known));
    for (int64_t k = 0; k < scenario->frames; k++) {
        skg_placement_at(&g->stage, k, g->angles[k], NULL, 0, &g->stages[k]);
        skg_placement_at(&g->stage, k, g->angles[k], NULL, 1, &g->known[k]);
    }
    skg_placement_at(&g->source, 0, 0, NULL, 0, &source);
    skg_placement_at(&g->detector, 0, 0, NULL, 0, &detector);
    for (int j = 0; j < 3; j++) normal[j] = detector.axes[3 * j + 2];
    skg_add_scaled(detector.centre, -1, source.centre, way);
    g->distance_mm = fabs(skg_dot(way, normal));
    return SKG_OK;
}

/* Vectors that are no directions, or not across each other. */
static skg_status check_vectors(const skg_item *item, const skg_placement *placement) {
    double u[3], w[3];
    for (int k = 0; k < 3; k++)
        u[k] = placement->u.components[k].value, w[k] = placement->w.components[k].value;
    const double lengths = skg_length(u) * skg_length(w);
    if (!(lengths > 0) || !isfinite(lengths))
        return skg_item_fail(item, SKG_ERR_SCENE, "has a vector of length 0, which is no direction");
    if (fabs(skg_dot(u, w)) > 1e-3 * lengths)
        return skg_item_fail(item, SKG_ERR_SCENE, "has vectors that are not perpendicular to each other");
    return SKG_OK;
}

skg_status skg_ctsimu_read_geometry(skg_ctsimu *scenario, skg_ctsimu_geometry *g) {
    static const char *const names[] = {"geometry.source", "geometry.detector", "geometry.stage"};
    skg_placement *const placements[] = {&g->source, &g->detector, &g->stage};
    const skg_item root = skg_item_root(scenario);
    const skg_item count = skg_item_at(&root, "acquisition.number_of_projections");
    scenario->frames = 1;
    SKG_TRY(skg_item_integer(&count, 1, 10000000, &scenario->frames));
    for (int p = 0; p < 3; p++) {
        const skg_item item = skg_item_at(&root, names[p]);
        SKG_TRY(skg_placement_read(&item, placements[p]));
        if (placements[p]->is_on_stage)
            return skg_item_fail(&item, SKG_ERR_UNSUPPORTED, "is not given by x, y and z of the world");
        SKG_TRY(check_vectors(&item, placements[p]));
    }
    SKG_TRY(read_source(scenario, g));
    SKG_TRY(read_detector(scenario, g));
    SKG_TRY(read_angles(scenario, g));
    return find_stages(scenario, g);
}

void skg_ctsimu_geometry_free(skg_ctsimu_geometry *g) {
    skg_placement_free(&g->source);
    skg_placement_free(&g->detector);
    skg_placement_free(&g->stage);
    skg_free(&g->angles);
    skg_free(&g->stages);
    skg_free(&g->known);
}

/* Source, centre, column step and row step of a projection in the axes of the stage. Of a parallel beam the source is
 * its direction, which leads from the source to the detector. */
static void find_pose(const skg_ctsimu_geometry *g, int64_t frame, int known, double *pose) {
    skg_system source, detector;
    const skg_system *stage = known ? &g->known[frame] : &g->stages[frame];
    double axis[3];
    skg_placement_at(&g->source, frame, 0, NULL, known, &source);
    skg_placement_at(&g->detector, frame, 0, NULL, known, &detector);
    if (g->is_parallel) {
        double way[3], beam[3];
        for (int j = 0; j < 3; j++) beam[j] = source.axes[3 * j + 2];
        skg_add_scaled(detector.centre, -1, source.centre, way);
        if (skg_dot(beam, way) < 0) skg_scale_vector(-1, beam, beam);
        skg_system_direction(stage, beam, pose);
    } else {
        skg_system_point(stage, source.centre, pose);
    }
    skg_system_point(stage, detector.centre, pose + 3);
    for (int k = 0; k < 2; k++) {
        for (int j = 0; j < 3; j++) axis[j] = g->pitch[k] * detector.axes[3 * j + k];
        skg_system_direction(stage, axis, pose + 6 + 3 * k);
    }
}

static skg_status put_table(const skg_ctsimu *scenario, const skg_ctsimu_geometry *g, int known,
                            const char *key, json_t *scan) {
    json_t *table = json_array();
    for (int64_t k = 0; k < scenario->frames && table; k++) {
        double pose[12];
        find_pose(g, k, known, pose);
        json_array_append_new(table, skg_ctsimu_numbers(12, pose));
    }
    return skg_ctsimu_put(scan, key, table);
}

/* Whether the reconstruction knows another geometry than that of the scan. */
static int differs(const skg_ctsimu *scenario, const skg_ctsimu_geometry *g) {
    for (int64_t k = 0; k < scenario->frames; k++) {
        double real[12], known[12];
        find_pose(g, k, 0, real);
        find_pose(g, k, 1, known);
        if (memcmp(real, known, sizeof real) != 0) return 1;
    }
    return 0;
}

static json_t *lengths(int count, const double *mm) {
    json_t *array = skg_ctsimu_numbers(count, mm);
    if (array) json_array_append_new(array, json_string("mm"));
    return array;
}

skg_status skg_ctsimu_put_views(skg_ctsimu *scenario, const skg_ctsimu_geometry *g, json_t *scene) {
    const double pixels[2] = {(double)g->columns, (double)g->rows}, axis[3] = {0, 0, 1}, origin[3] = {0};
    json_t *source = json_object_get(scene, "Source"), *detector = json_object_get(scene, "Detector");
    json_t *scan = json_object_get(scene, "Scan");
    double pose[12];
    find_pose(g, 0, 0, pose);
    SKG_TRY(g->is_parallel ? skg_ctsimu_put(source, "Direction", skg_ctsimu_numbers(3, pose))
                           : skg_ctsimu_put(source, "Position", lengths(3, pose)));
    SKG_TRY(skg_ctsimu_put(detector, "Position", lengths(3, pose + 3)));
    SKG_TRY(skg_ctsimu_put(detector, "RightVector", skg_ctsimu_numbers(3, pose + 6)));
    SKG_TRY(skg_ctsimu_put(detector, "UpVector", skg_ctsimu_numbers(3, pose + 9)));
    SKG_TRY(skg_ctsimu_put(detector, "NumberOfPixels", skg_ctsimu_numbers(2, pixels)));
    SKG_TRY(skg_ctsimu_put(detector, "Spacing", lengths(2, g->pitch)));
    SKG_TRY(put_table(scenario, g, 0, "Table", scan));
    if (differs(scenario, g)) SKG_TRY(put_table(scenario, g, 1, "KnownTable", scan));
    if (scenario->frames > 1) {
        const double step = g->angles[1] - g->angles[0];
        SKG_TRY(skg_ctsimu_put(scan, "StartAngle", json_real(g->angles[0] * 180 / SKG_PI)));
        SKG_TRY(skg_ctsimu_put(scan, "AngleStep", json_real(step * 180 / SKG_PI)));
    }
    SKG_TRY(skg_ctsimu_put(scan, "CentreOfRotation", lengths(3, origin)));
    return skg_ctsimu_put(scan, "RotationAxis", skg_ctsimu_numbers(3, axis));
}
