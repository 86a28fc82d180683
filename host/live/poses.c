/* Where the parts of a page's scene stand. */
#include "live/plans.h"

#include "core/maths.h"
#include "core/text.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Whose poses differ from one projection to the next, if the wish has one of them. */
static skg_status read_record(const skg_live_subject *subject, const skg_live_message *wish,
                              skg_scan_record *record) {
    int64_t projections = 0;
    skg_scan_record_init(record);
    if (!subject->setup || wish->asked.projection < 0) return SKG_OK;
    SKG_TRY(skg_setup_projection_count_get(subject->setup, &projections));
    return wish->asked.projection < projections ? skg_setup_record_get(subject->setup, record) : SKG_OK;
}

/* The pose of a part before the page moves it. */
static skg_status find_pose(const skg_live_subject *subject, const skg_live_message *wish,
                            const skg_scan_record *record, int64_t part, double *pose) {
    skg_part its;
    skg_part_init(&its);
    SKG_TRY(skg_scene_part_get(subject->scene, part, &its));
    memcpy(pose, subject->poses ? subject->poses + 16 * part : its.pose, 16 * sizeof *pose);
    for (int64_t i = 0; i < record->moving_count; i++)
        if (record->moving_parts[i] == part)
            memcpy(pose, record->moving_poses + (wish->asked.projection * record->moving_count + i) * 16,
                   16 * sizeof *pose);
    return SKG_OK;
}

static int has_part(const skg_live_moves *moves, int64_t part) {
    for (int64_t i = 0; i < moves->count; i++)
        if (moves->parts[i] == part) return 1;
    return 0;
}

skg_status skg_live_moves_list(const skg_live_subject *subject, const skg_live_message *wish,
                               skg_live_moves *moves) {
    const skg_live_asked *asked = &wish->asked;
    skg_scan_record record;
    int64_t parts = 0;
    *moves = (skg_live_moves){.count = 0};
    SKG_TRY(read_record(subject, wish, &record));
    SKG_TRY(skg_scene_part_count(subject->scene, &parts));
    const int64_t most = asked->pose_count + record.moving_count + 1;
    SKG_TRY(skg_alloc(most, sizeof *moves->parts, "poses", &moves->parts));
    SKG_TRY(skg_alloc(16 * most, sizeof *moves->poses, "poses", &moves->poses));
    for (int64_t i = 0; i < asked->pose_count; i++) {
        double pose[16];
        if (asked->parts[i] >= parts)
            return skg_fail(SKG_ERR_SCENE, "the scene has no part %" PRId64, asked->parts[i]);
        if (has_part(moves, asked->parts[i])) continue;
        SKG_TRY(find_pose(subject, wish, &record, asked->parts[i], pose));
        skg_pose_multiply(asked->poses + 16 * i, pose, moves->poses + 16 * moves->count);
        moves->parts[moves->count++] = asked->parts[i];
    }
    for (int64_t i = 0; i < record.moving_count; i++) {
        const int64_t part = record.moving_parts[i];
        if (part >= parts || has_part(moves, part)) continue;
        SKG_TRY(find_pose(subject, wish, &record, part, moves->poses + 16 * moves->count));
        moves->parts[moves->count++] = part;
    }
    return SKG_OK;
}

void skg_live_moves_free(skg_live_moves *moves) {
    skg_free(&moves->parts);
    skg_free(&moves->poses);
}

skg_status skg_live_breathe(const skg_live_subject *subject, const skg_live_message *wish) {
    if (isnan(wish->asked.phase) || subject->posed) return SKG_OK;
    if (!subject->motion)
        return skg_fail(SKG_ERR_SCENE, "the scene does not breathe: it has no key Breathing");
    return skg_motion_pose_at_phase(subject->motion, wish->asked.phase);
}

static skg_status fill_poses(const skg_live_subject *subject, const skg_live_message *wish,
                             const skg_live_moves *moves, double *poses) {
    const skg_scan_record none = {.moving_count = 0};
    int64_t parts = 0;
    SKG_TRY(skg_scene_part_count(subject->scene, &parts));
    for (int64_t i = 0; i < parts; i++) SKG_TRY(find_pose(subject, wish, &none, i, poses + 16 * i));
    for (int64_t i = 0; i < moves->count; i++)
        memcpy(poses + 16 * moves->parts[i], moves->poses + 16 * i, 16 * sizeof *poses);
    return SKG_OK;
}

skg_status skg_live_poses_get(const skg_live_subject *theirs, const skg_live_message *wish, double *poses) {
    SKG_PLAIN;
    skg_live_subject subject;
    skg_live_moves moves;
    SKG_NEEDS(wish);
    SKG_NEEDS(poses);
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    skg_status status = skg_live_moves_list(&subject, wish, &moves);
    if (status == SKG_OK) status = fill_poses(&subject, wish, &moves, poses);
    skg_live_moves_free(&moves);
    return status;
}

skg_status skg_live_place(const skg_live_subject *theirs, const skg_live_message *wish) {
    SKG_PLAIN;
    skg_live_subject subject;
    double *poses = NULL;
    int64_t parts = 0;
    SKG_NEEDS(wish);
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    SKG_TRY(skg_scene_part_count(subject.scene, &parts));
    SKG_TRY(skg_live_breathe(&subject, wish));
    SKG_TRY(skg_alloc(16 * parts + 1, sizeof *poses, "poses", &poses));
    skg_status status = skg_live_poses_get(&subject, wish, poses);
    for (int64_t i = 0; status == SKG_OK && i < parts; i++)
        status = skg_scene_part_pose_set(subject.scene, i, poses + 16 * i);
    skg_free(&poses);
    return status;
}

/* Widens a box by the vertices of a part. */
static skg_status widen(const skg_part *part, const double *pose, double box[6]) {
    int64_t vertices = 0, triangles = 0;
    double *positions = NULL;
    SKG_TRY(skg_mesh_count(part->mesh, &vertices, &triangles));
    SKG_TRY(skg_alloc(3 * vertices + 1, sizeof *positions, "vertices", &positions));
    const skg_status status = skg_mesh_positions_get(part->mesh, positions, 3);
    for (int64_t v = 0; status == SKG_OK && v < vertices; v++) {
        double at[3];
        skg_pose_point(pose, positions + 3 * v, at);
        for (int k = 0; k < 3; k++)
            box[k] = skg_lesser(box[k], at[k]), box[3 + k] = skg_greater(box[3 + k], at[k]);
    }
    skg_free(&positions);
    return status;
}

skg_status skg_live_box_get(const skg_live_subject *theirs, double *box) {
    SKG_PLAIN;
    skg_live_subject subject;
    int64_t parts = 0;
    double made[6] = {HUGE_VAL, HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    SKG_NEEDS(box);
    SKG_TRY(skg_live_subject_read(theirs, &subject));
    SKG_TRY(skg_scene_part_count(subject.scene, &parts));
    for (int64_t i = 0; i < parts; i++) {
        skg_part part;
        skg_part_init(&part);
        SKG_TRY(skg_scene_part_get(subject.scene, i, &part));
        SKG_TRY(widen(&part, subject.poses ? subject.poses + 16 * i : part.pose, made));
    }
    memcpy(box, made, sizeof made);
    return SKG_OK;
}

skg_status skg_live_box_find(skg_live_plans *plans, const skg_live_subject *subject) {
    if (plans->has_box) return SKG_OK;
    SKG_TRY(skg_live_box_get(subject, plans->box));
    plans->has_box = 1;
    return SKG_OK;
}
