/* The inside of a scene. */
#include "scene/scene.h"

#include "core/context.h"
#include "core/maths.h"
#include "core/text.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void skg_part_init_sized(void *part, int32_t size) {
    skg_part defaults = {.inside = -1};
    skg_pose_identity(defaults.pose);
    skg_struct_init(part, size, &defaults, sizeof defaults);
}

static skg_status create(skg_context *context, skg_scene **scene) {
    SKG_NEEDS_OF("skg_scene_create", scene);
    *scene = NULL;
    skg_scene *made = NULL;
    SKG_TRY(skg_alloc(1, sizeof *made, "scene", &made));
    skg_refs_init(&made->refs);
    made->structure = made->materials = made->poses = 1;
    if (context) {
        skg_status status = skg_context_retain(context);
        if (status != SKG_OK) {
            skg_free(&made);
            return status;
        }
        made->context = context;
    }
    *scene = made;
    return SKG_OK;
}

skg_status skg_scene_create(skg_context *context, skg_scene **scene) {
    const skg_call begun = skg_call_begin(context);
    return skg_call_end(begun, create(context, scene));
}

skg_status skg_scene_retain(skg_scene *scene) {
    SKG_NEEDS(scene);
    skg_ref(&scene->refs);
    return SKG_OK;
}

static void release_part(skg_scene_part_data *part) {
    skg_mesh_release(&part->mesh);
    skg_material_release(&part->material);
    skg_volume_release(&part->volume);
    skg_free(&part->label);
}

void skg_scene_release(skg_scene **scene) {
    if (!scene || !*scene) return;
    if (skg_unref(&(*scene)->refs)) {
        for (int64_t i = 0; i < (*scene)->count; i++) release_part(&(*scene)->parts[i]);
        skg_free(&(*scene)->parts);
        skg_free(&(*scene)->labels.slots);
        skg_free(&(*scene)->places.slots);
        skg_context_release(&(*scene)->context);
        skg_free(scene);
    }
    *scene = NULL;
}

static uint64_t label_hash(const char *label) {
    return skg_hash_bytes(0, label, strlen(label));
}

static int64_t label_index(const skg_scene *scene, const char *label) {
    int64_t at = 0, part;
    while ((part = skg_part_index_next(&scene->labels, label_hash(label), &at)) >= 0)
        if (strcmp(scene->parts[part].label, label) == 0) return part;
    return -1;
}

static uint64_t place_hash(const skg_scene_part_data *part) {
    return skg_hash_bytes(skg_hash_bytes(0, &part->mesh, sizeof part->mesh), part->pose, sizeof part->pose);
}

/* Adds the part to the index of places, or warns if one like it is already there. */
static void note_place(skg_scene *scene, const skg_scene_part_data *part) {
    const uint64_t hash = place_hash(part);
    int64_t at = 0, other;
    while ((other = skg_part_index_next(&scene->places, hash, &at)) >= 0) {
        const skg_scene_part_data *twin = &scene->parts[other];
        if (twin->mesh != part->mesh || memcmp(twin->pose, part->pose, sizeof part->pose) != 0) continue;
        skg_log(scene->context, SKG_LOG_WARNING,
                "parts %s and %s are the same mesh in the same place; their lengths add", twin->label,
                part->label);
        return;
    }
    skg_part_index_add(&scene->places, hash, scene->count);
}

static skg_status check_part(const skg_scene *scene, const skg_part *part, const char *label) {
    if (!*label) return skg_fail(SKG_ERR_SCENE, "part %" PRId64 " has an empty label", scene->count);
    if (!part->material) return skg_fail(SKG_ERR_ARGUMENT, "part %s has no material; give it one", label);
    if (label_index(scene, label) >= 0)
        return skg_fail(SKG_ERR_SCENE, "two parts have the label %s; give each part its own", label);
    if (part->inside == scene->count)
        return skg_fail(SKG_ERR_SCENE, "part %s lies inside itself; its parent has to be another part",
                        label);
    if (part->inside < -1 || part->inside > scene->count)
        return skg_fail(SKG_ERR_SCENE,
                        "part %s lies inside part %" PRId64 ", which is not there (%" PRId64
                        " parts so far); add the parent first",
                        label, part->inside, scene->count);
    return skg_scene_check_pose(label, part->pose);
}

/* The box of a volume stands for it as a mesh. */
static skg_status take_volume(skg_part *part) {
    if (!part->volume) return SKG_OK;
    if ((part->mesh && part->mesh != part->volume->hull) ||
        (part->material && part->material != part->volume->nothing))
        return skg_fail(SKG_ERR_ARGUMENT, "part %s has a volume, so give it no mesh and no material",
                        part->label ? part->label : part->volume->name);
    part->mesh = part->volume->hull;
    part->material = part->volume->nothing;
    return SKG_OK;
}

skg_status skg_scene_part_add(skg_scene *scene, const skg_part *part, int64_t *id) {
    SKG_PLAIN;
    SKG_NEEDS(scene);
    skg_part ours;
    skg_part_init(&ours);
    SKG_TRY(skg_struct_read(part, "skg_part", &ours, sizeof ours));
    SKG_TRY(take_volume(&ours));
    if (!ours.mesh)
        return skg_fail(SKG_ERR_ARGUMENT, "part %s has no mesh; give it one",
                        ours.label ? ours.label : "without label");
    const char *label = ours.label;
    if (!label) SKG_TRY(skg_mesh_name_get(ours.mesh, &label));
    SKG_TRY(check_part(scene, &ours, label));
    if (scene->count == scene->capacity) {
        int64_t capacity = 2 * scene->capacity + 8;
        SKG_TRY(skg_realloc(capacity, sizeof *scene->parts, "parts", &scene->parts));
        scene->capacity = capacity;
    }
    SKG_TRY(skg_part_index_reserve(&scene->labels));
    SKG_TRY(skg_part_index_reserve(&scene->places));
    skg_scene_part_data made = {.inside = ours.inside, .priority = ours.priority};
    memcpy(made.pose, ours.pose, sizeof made.pose);
    SKG_TRY(skg_copy_text(label, &made.label));
    skg_mesh_retain(ours.mesh);
    made.mesh = ours.mesh;
    skg_material_retain(ours.material);
    made.material = ours.material;
    made.volume = ours.volume;
    if (made.volume) skg_ref(&made.volume->refs), scene->volumes++;
    note_place(scene, &made);
    skg_part_index_add(&scene->labels, label_hash(label), scene->count);
    scene->parts[scene->count] = made;
    if (id) *id = scene->count;
    scene->count++;
    scene->structure++;
    return SKG_OK;
}

static skg_status check_id(const skg_scene *scene, int64_t id, const char *call) {
    if (id < 0 || id >= scene->count)
        return skg_fail(SKG_ERR_SCENE, "%s: part %" PRId64 " of %" PRId64 " is not there", call, id,
                        scene->count);
    return SKG_OK;
}

int64_t skg_scene_volumes(const skg_scene *scene) {
    return scene->volumes;
}

int64_t skg_scene_curves(const skg_scene *scene, int64_t part) {
    int64_t curves = 0;
    /* Asked for every part; scenes may have a hundred thousand, and no volume. */
    for (int64_t p = 0; p < part && scene->volumes > 0; p++)
        if (scene->parts[p].volume) curves += scene->parts[p].volume->curve_count;
    return curves;
}

skg_status skg_scene_set_inside(skg_scene *scene, int64_t id, int64_t inside) {
    SKG_NEEDS(scene);
    SKG_TRY(check_id(scene, id, __func__));
    if (inside != -1) SKG_TRY(check_id(scene, inside, __func__));
    if (inside == id)
        return skg_fail(SKG_ERR_SCENE, "part %s lies inside itself; its parent has to be another part",
                        scene->parts[id].label);
    for (int64_t up = inside; up != -1; up = scene->parts[up].inside)
        if (up == id)
            return skg_fail(
                SKG_ERR_SCENE,
                "part %s lies inside itself, by way of its parent %s; parents must not go in a circle",
                scene->parts[id].label, scene->parts[inside].label);
    scene->parts[id].inside = inside;
    scene->structure++;
    return SKG_OK;
}

skg_status skg_scene_part_count(const skg_scene *scene, int64_t *count) {
    SKG_NEEDS(scene);
    SKG_NEEDS(count);
    *count = scene->count;
    return SKG_OK;
}

skg_status skg_scene_part_get(const skg_scene *scene, int64_t id, skg_part *part) {
    SKG_NEEDS(scene);
    SKG_TRY(check_id(scene, id, __func__));
    const skg_scene_part_data *data = &scene->parts[id];
    skg_part ours = {.size = sizeof ours,
                     .priority = data->priority,
                     .inside = data->inside,
                     .mesh = data->mesh,
                     .material = data->material,
                     .label = data->label,
                     .volume = data->volume};
    memcpy(ours.pose, data->pose, sizeof ours.pose);
    return skg_struct_write(&ours, sizeof ours, "skg_part", part);
}

skg_status skg_scene_part_label_get(const skg_scene *scene, int64_t id, const char **label) {
    SKG_NEEDS(scene);
    SKG_NEEDS(label);
    *label = NULL;
    SKG_TRY(check_id(scene, id, __func__));
    *label = scene->parts[id].label;
    return SKG_OK;
}

/* The first labels of a scene, as many as fit: "; the scene has skin, bone and 3 others". */
static void list_labels(const skg_scene *scene, size_t size, char *text) {
    size_t length = 0;
    int64_t i = 0;
    text[0] = '\0';
    for (; i < scene->count; i++) {
        const char *label = scene->parts[i].label;
        if (length + strlen(label) + 32 > size) break;
        length +=
            (size_t)snprintf(text + length, size - length, "%s%s", i ? ", " : "; the scene has ", label);
    }
    if (i > 0 && i < scene->count)
        snprintf(text + length, size - length, " and %" PRId64 " others", scene->count - i);
}

skg_status skg_scene_part_find(const skg_scene *scene, const char *label, int64_t *id) {
    SKG_NEEDS(scene);
    SKG_NEEDS(label);
    SKG_NEEDS(id);
    int64_t found = label_index(scene, label), alike = 0;
    for (int64_t i = 0; found < 0 && i < scene->count; i++)
        if (skg_same_name(scene->parts[i].label, label)) alike++;
    for (int64_t i = 0; found < 0 && alike == 1 && i < scene->count; i++)
        if (skg_same_name(scene->parts[i].label, label)) found = i;
    if (found >= 0) {
        *id = found;
        return SKG_OK;
    }
    const char **labels = NULL;
    SKG_TRY(skg_alloc(scene->count, sizeof *labels, "labels", &labels));
    for (int64_t i = 0; i < scene->count; i++) labels[i] = scene->parts[i].label;
    const char *near = skg_nearest_name(label, labels, scene->count);
    char all[256];
    list_labels(scene, sizeof all, all);
    skg_fail(SKG_ERR_SCENE, "no part has the label %s%s%s", label, near ? "; did you mean " : all,
             near ? near : "");
    skg_free(&labels);
    return SKG_ERR_SCENE;
}

skg_status skg_scene_part_pose_set(skg_scene *scene, int64_t id, const double *pose) {
    SKG_PLAIN;
    SKG_NEEDS(scene);
    SKG_NEEDS(pose);
    SKG_TRY(check_id(scene, id, __func__));
    SKG_TRY(skg_scene_check_pose(scene->parts[id].label, pose));
    memcpy(scene->parts[id].pose, pose, sizeof scene->parts[id].pose);
    scene->poses++;
    return SKG_OK;
}

skg_status skg_scene_part_material_set(skg_scene *scene, int64_t id, skg_material *material) {
    SKG_NEEDS(scene);
    SKG_TRY(check_id(scene, id, __func__));
    if (!material)
        return skg_fail(SKG_ERR_ARGUMENT, "part %s has no material; give it one", scene->parts[id].label);
    if (scene->parts[id].volume)
        return skg_fail(
            SKG_ERR_UNSUPPORTED,
            "part %s is a volume, whose cells say what it is made of; add a part with another volume",
            scene->parts[id].label);
    skg_material_retain(material);
    skg_material_release(&scene->parts[id].material);
    scene->parts[id].material = material;
    scene->materials++;
    return SKG_OK;
}
