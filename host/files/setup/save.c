/* Writes a scene file anew: with parts that were moved, and with other views. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "setup/save.h"

#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "scene/scene.h"
#include "json/json.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void skg_setup_changes_init_sized(void *changes, int32_t size) {
    const skg_setup_changes defaults = {0};
    skg_struct_init(changes, size, &defaults, sizeof defaults);
}

/* The name by which a scene at `path` finds a file: its own, if that leads there, otherwise its absolute path. */
static void name_file(const skg_setup_file *file, const char *path, char *name, size_t size) {
    const char *slash = strrchr(path, '/');
    struct stat there, here;
    snprintf(name, size, "%.*s%s", slash ? (int)(slash - path) + 1 : 0, path, file->name);
    if (file->name[0] == '/') snprintf(name, size, "%s", file->name);
    const int same = stat(file->path, &there) == 0 && stat(name, &here) == 0 && there.st_ino == here.st_ino &&
                     there.st_dev == here.st_dev;
    char *absolute = same ? NULL : realpath(file->path, NULL);
    snprintf(name, size, "%s", absolute ? absolute : file->name);
    free(absolute);
}

void skg_setup_rename_files(const skg_setup *setup, const char *path, json_t *value) {
    const char *key;
    json_t *below;
    size_t index;
    json_object_foreach(value, key, below) skg_setup_rename_files(setup, path, below);
    json_array_foreach(value, index, below) skg_setup_rename_files(setup, path, below);
    if (!json_is_string(value)) return;
    for (int64_t f = 0; f < setup->file_count; f++) {
        char name[4096];
        if (strcmp(json_string_value(value), setup->files[f].name) != 0) continue;
        name_file(setup->files + f, path, name, sizeof name);
        json_string_set(value, name);
        return;
    }
}

skg_status skg_setup_write_text(json_t *scene, const char *path) {
    json_t *named = json_pack("{s:s}", "$schema", "scene.schema.json");
    const skg_status status = json_object_update_missing(named, scene)
                                  ? skg_fail(SKG_ERR_MEMORY, "%s: no memory for its text", path)
                                  : skg_setup_write_json(named, path);
    json_decref(named);
    return status;
}

skg_status skg_setup_write_json(const json_t *object, const char *path) {
    skg_output_file file;
    char *text = json_dumps(object, JSON_INDENT(1) | JSON_REAL_PRECISION(17));
    if (!text) return skg_fail(SKG_ERR_MEMORY, "%s: no memory for its text", path);
    skg_status status = skg_output_open(path, &file);
    if (status == SKG_OK) {
        fprintf(file.stream, "%s\n", text);
        status = skg_output_commit(&file);
    }
    free(text);
    return status;
}

/* The name that a key has in an object; NULL: there is none. */
static const char *own_name(json_t *object, const char *name) {
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value) if (skg_json_same_key(key, name)) return key;
    return NULL;
}

static json_t *get(json_t *object, const char *name) {
    const char *key = own_name(object, name);
    return key ? json_object_get(object, key) : NULL;
}

static void drop(json_t *object, const char *name) {
    const char *key = own_name(object, name);
    char copy[256];
    if (!key) return;
    snprintf(copy, sizeof copy, "%s", key); /* the key lives in the object that is changed */
    json_object_del(object, copy);
}

/* Replaces a member. The value is released in any case. */
static int put(json_t *object, const char *name, json_t *value) {
    drop(object, name);
    return json_object_set_new(object, name, value) == 0;
}

static json_t *numbers(int64_t count, const double *values, const char *unit) {
    json_t *array = json_array();
    for (int64_t k = 0; k < count; k++) json_array_append_new(array, json_real(values[k]));
    if (unit) json_array_append_new(array, json_string(unit));
    return array;
}

/* The sample of a part; SceneGraph is the last one. NULL: its samples have a command that places all of them together. */
static json_t *sample_of(json_t *scene, int64_t part) {
    json_t *sample, *found = NULL, *graph = get(scene, "SceneGraph");
    size_t index;
    int64_t number = 0;
    json_array_foreach(get(scene, "Samples"), index, sample) {
        if (!json_is_object(sample)) return NULL;
        if (number++ == part) found = sample;
    }
    return found ? found : number == part && json_is_object(graph) ? graph : NULL;
}

/* The last entry of Transform acts on the vertices first, so a motion goes before all others. */
static int move_sample(json_t *sample, const double *motion) {
    double columns[16];
    json_t *list = get(sample, "Transform"), *entry = json_array();
    for (int row = 0; row < 4; row++)
        for (int column = 0; column < 4; column++) columns[4 * column + row] = motion[4 * row + column];
    json_array_append_new(entry, json_string("Matrix"));
    json_array_append_new(entry, numbers(16, columns, NULL));
    if (json_is_array(list)) return json_array_insert_new(list, 0, entry) == 0;
    list = json_array();
    json_array_append_new(list, entry);
    return put(sample, "Transform", list);
}

static int write_view(const skg_setup *setup, json_t *scene, const skg_view *view) {
    static const char *const of_source[] = {"From", "Direction", "Position"};
    static const char *const of_detector[] = {"UpVector", "RightVector", "Size", "Spacing", "Curved"};
    json_t *source = get(scene, "Source"), *detector = get(scene, "Detector");
    const int64_t pixels[2] = {view->columns * setup->bins[0], view->rows * setup->bins[1]};
    double steps[2][3]; /* of the sensor's pixels, as files have them */
    if (!source || !detector) return 0;
    for (size_t k = 0; k < sizeof of_source / sizeof *of_source; k++) drop(source, of_source[k]);
    for (size_t k = 0; k < sizeof of_detector / sizeof *of_detector; k++) drop(detector, of_detector[k]);
    skg_scale_vector(1 / (double)setup->bins[0], view->column_step, steps[0]);
    skg_scale_vector(1 / (double)setup->bins[1], view->row_step, steps[1]);
    const int infinite = view->projection == SKG_PROJECTION_PARALLEL_FROM_INFINITY;
    json_t *size = json_pack("[I, I]", (json_int_t)pixels[0], (json_int_t)pixels[1]);
    return put(source, infinite ? "Direction" : "Position",
               numbers(3, view->source, infinite ? NULL : "mm")) &&
           put(detector, "Position", numbers(3, view->centre, "mm")) &&
           put(detector, "ColumnStep", numbers(3, steps[0], "mm")) &&
           put(detector, "RowStep", numbers(3, steps[1], "mm")) && put(detector, "NumberOfPixels", size) &&
           (view->radius == 0 ||
            put(detector, "Curved", json_pack("{s:o}", "Radius", numbers(1, &view->radius, "mm"))));
}

/* A scan becomes a table of the poses that it has. */
static skg_status write_scan(const skg_setup *setup, json_t *scene, const skg_setup_changes *changes) {
    static const char *const motion[] = {
        "NumberOfProjections", "FinalAngle",    "IncludeLastAngle", "IncludeFinalAngle", "Short", "Pitch",
        "SourceTravel",        "FixedDetector", "DetectorOffset",   "DetectorTilt",      "Drift", "Jitter",
        "DetectorSkew"};
    json_t *object = get(scene, "Scan"), *rows = json_array();
    int64_t count = 0;
    skg_status status = skg_scan_projection_count(setup->scan.scan, &count);
    for (int64_t k = 0; k < count && status == SKG_OK; k++) {
        skg_view view;
        double row[12];
        skg_view_init(&view);
        status = skg_scan_view_get(setup->scan.scan, k, &view);
        for (int64_t v = 0; v < changes->view_count; v++)
            if (changes->projections[v] == k) view = changes->views[v];
        memcpy(row, view.source, sizeof view.source);
        memcpy(row + 3, view.centre, sizeof view.centre);
        memcpy(row + 6, view.column_step, sizeof view.column_step);
        memcpy(row + 9, view.row_step, sizeof view.row_step);
        json_array_append_new(rows, numbers(12, row, NULL));
    }
    for (size_t k = 0; k < sizeof motion / sizeof *motion; k++) drop(object, motion[k]);
    if (!put(object, "Table", rows) && status == SKG_OK)
        status = skg_fail(SKG_ERR_MEMORY, "scene: no memory for a table of views");
    return status;
}

/* Says who wrote the file, beside what its author says, so that it is known as one that may be written again. */
static int sign(json_t *scene) {
    const char *said = json_string_value(get(scene, "Comment"));
    char text[1024];
    if (said && strstr(said, "skiagraph")) return 1;
    snprintf(text, sizeof text, "%s%swritten by skiagraph", said ? said : "", said ? "; " : "");
    return put(scene, "Comment", json_string(text));
}

static skg_status change(const skg_setup *setup, const skg_setup_changes *changes, const char *path,
                         json_t *scene) {
    int64_t of_scan = 0;
    for (int64_t p = 0; p < changes->part_count; p++) {
        json_t *sample = sample_of(scene, changes->parts[p]);
        if (!sample)
            return skg_fail(SKG_ERR_UNSUPPORTED,
                            "%s: part %" PRId64
                            " cannot be moved in the text of the scene: the command MoveToCentre among the "
                            "samples places all of them together; give each its place by Transform",
                            path, changes->parts[p]);
        if (!move_sample(sample, changes->motions + 16 * p))
            return skg_fail(SKG_ERR_MEMORY, "%s: no memory for its text", path);
    }
    for (int64_t v = 0; v < changes->view_count; v++) {
        if (changes->projections && changes->projections[v] >= 0) {
            of_scan++;
        } else if (!write_view(setup, scene, &changes->views[v])) {
            return skg_fail(SKG_ERR_UNSUPPORTED, "%s: the scene has no Source and Detector to be changed",
                            path);
        }
    }
    if (!sign(scene)) return skg_fail(SKG_ERR_MEMORY, "%s: no memory for its text", path);
    if (of_scan > 0 && !setup->scan.scan)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: views of a scan are given, and the scene has none", path);
    return of_scan > 0 ? write_scan(setup, scene, changes) : SKG_OK;
}

skg_status skg_setup_save(const skg_setup *setup, const skg_setup_changes *theirs, const char *path) {
    SKG_PLAIN;
    skg_setup_changes changes;
    SKG_NEEDS(setup);
    SKG_NEEDS(path);
    skg_setup_changes_init(&changes);
    if (theirs) SKG_TRY(skg_struct_read(theirs, "skg_setup_changes", &changes, sizeof changes));
    json_t *scene = json_loads(setup->text, 0, NULL);
    if (!scene) return skg_fail(SKG_ERR_MEMORY, "%s: no memory for its text", path);
    skg_status status = change(setup, &changes, path, scene);
    if (status == SKG_OK) {
        skg_setup_rename_files(setup, path, scene);
        status = skg_setup_write_text(scene, path);
    }
    json_decref(scene);
    return status;
}
