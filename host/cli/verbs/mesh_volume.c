/* The verb `mesh` for a volume of cells: size, place, range, and shares of compositions. */
#include "verbs/mesh_volume.h"

#include "common/encode.h"
#include "common/file.h"
#include "common/say.h"
#include "core/maths.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <sys/stat.h>

enum { TEXT = 64 };

/* Of DICOM slices. */
static int is_folder(const char *path) {
    struct stat there;
    return stat(path, &there) == 0 && S_ISDIR(there.st_mode);
}

int cli_is_volume(const char *path) {
    return is_folder(path) || cli_has_extension(path, ".mha") || cli_has_extension(path, ".mhd") ||
           cli_has_extension(path, ".nrrd") || cli_has_extension(path, ".nhdr") ||
           cli_has_extension(path, ".nii") || cli_has_extension(path, ".nii.gz");
}

/* Values that may be negative are Hounsfield numbers; what others are, the file does not say. */
static skg_status load(const char *path, double unit_mm, skg_volume **volume) {
    skg_volume_source source;
    skg_volume_source_init(&source);
    source.values = SKG_VOLUME_MU;
    if (skg_volume_load(path, unit_mm, &source, volume) == SKG_OK) return SKG_OK;
    return skg_volume_load(path, unit_mm, NULL, volume);
}

/* The axis of the world that cells of one axis follow most: "+x", or with the angle to it, "+x, 12.3 degrees off". */
static void describe_axis(const skg_volume_contents *c, int axis, char text[TEXT]) {
    const double v[3] = {c->affine[axis], c->affine[4 + axis], c->affine[8 + axis]};
    int most = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(v[k]) > fabs(v[most])) most = k;
    const double cosine = fabs(v[most]) / skg_length(v);
    const int length = snprintf(text, TEXT, "%c%c", v[most] < 0 ? '-' : '+', 'x' + most);
    if (cosine < 1 - 1e-9)
        snprintf(text + length, TEXT - (size_t)length, ", %.3g degrees off", acos(cosine) * 180 / SKG_PI);
}

static void find_bounds(const skg_volume_contents *c, double bounds[6]) {
    const double size[3] = {(double)c->columns, (double)c->rows, (double)c->slices};
    for (int k = 0; k < 3; k++) bounds[k] = HUGE_VAL, bounds[3 + k] = -HUGE_VAL;
    for (int corner = 0; corner < 8; corner++) {
        double cell[3], at[3];
        for (int a = 0; a < 3; a++) cell[a] = (corner >> a & 1 ? size[a] : 0) - 0.5;
        skg_pose_point(c->affine, cell, at);
        for (int k = 0; k < 3; k++)
            bounds[k] = fmin(bounds[k], at[k]), bounds[3 + k] = fmax(bounds[3 + k], at[k]);
    }
}

static json_t *volume_json(const char *path, const skg_volume *volume, const skg_volume_contents *c) {
    const int is_hu = c->values == SKG_VOLUME_HU;
    json_t *object = json_object(), *axes = json_array(), *classes = json_array();
    double bounds[6];
    find_bounds(c, bounds);
    for (int k = 0; k < 3; k++) {
        char text[TEXT];
        describe_axis(c, k, text);
        json_array_append_new(axes, cli_json_text(text));
    }
    for (int32_t k = 0; is_hu && k < c->classes; k++) {
        const char *name = "";
        double share = 0;
        if (skg_volume_class_get(volume, k, &name, &share) != SKG_OK) continue;
        json_array_append_new(classes, json_pack("{s:s,s:f}", "name", name, "share", share));
    }
    json_object_set_new(object, "file", cli_json_text(path));
    json_object_set_new(
        object, "cells",
        json_pack("[I,I,I]", (json_int_t)c->columns, (json_int_t)c->rows, (json_int_t)c->slices));
    json_object_set_new(object, "bits", json_integer(c->bits));
    json_object_set_new(object, "spacing_mm", cli_json_numbers(c->spacing, 3));
    json_object_set_new(object, "axes", axes);
    json_object_set_new(object, "bounds", cli_json_numbers(bounds, 6));
    json_object_set_new(object, "low", cli_json_number(c->low));
    json_object_set_new(object, "high", cli_json_number(c->high));
    json_object_set_new(object, "mass_g", is_hu ? cli_json_number(c->mass) : json_null());
    json_object_set_new(object, "classes", classes);
    return object;
}

static void print_volume(const char *path, const skg_volume *volume, const skg_volume_contents *c) {
    static const char *const names[3] = {"columns", "rows", "slices"};
    double b[6];
    find_bounds(c, b);
    cli_print("%s: a volume of %" PRId64 " x %" PRId64 " x %" PRId64 " cells of %d bits, %.4g MB\n", path,
              c->columns, c->rows, c->slices, (int)c->bits, (double)c->bytes * 1e-6);
    printf("  cells of %.6g x %.6g x %.6g mm;", c->spacing[0], c->spacing[1], c->spacing[2]);
    for (int k = 0; k < 3; k++) {
        char text[TEXT];
        describe_axis(c, k, text);
        printf(" %s along %s%s", names[k], text, k < 2 ? ";" : "\n");
    }
    printf("  x %.6g to %.6g, y %.6g to %.6g, z %.6g to %.6g mm\n", b[0], b[3], b[1], b[4], b[2], b[5]);
    printf("  values %.6g to %.6g%s\n", c->low, c->high,
           c->values == SKG_VOLUME_HU
               ? "; as Hounsfield numbers, by Schneider's table:"
               : "; none is negative, so that they may be densities or coefficients (Values)");
    for (int32_t k = 0; c->values == SKG_VOLUME_HU && k < c->classes; k++) {
        const char *name = "";
        double share = 0;
        if (skg_volume_class_get(volume, k, &name, &share) == SKG_OK)
            cli_print("  %7.3f %%  %s\n", 100 * share, name);
    }
    if (c->beyond) printf("  %" PRId64 " cells are above HU 3000\n", c->beyond);
    if (c->values == SKG_VOLUME_HU) printf("  mass %.6g g\n", c->mass);
}

/* On standard error, as what a scene says of it. */
static skg_status pass_remarks(const char *path, const skg_volume *volume, int64_t count) {
    for (int64_t k = 0; k < count; k++) {
        const char *sentence = NULL;
        int32_t level = 0;
        const skg_status status = skg_volume_remark_get(volume, k, &level, &sentence);
        if (status != SKG_OK) return status;
        if (level == SKG_LOG_WARNING)
            cli_warn("%s: %s", path, sentence);
        else
            cli_note("%s: %s", path, sentence);
    }
    return SKG_OK;
}

skg_status cli_mesh_volume(const char *path, double unit_mm, json_t *list) {
    skg_volume *volume = NULL;
    skg_volume_contents contents;
    skg_volume_contents_init(&contents);
    skg_status status = load(path, unit_mm, &volume);
    if (status == SKG_OK) status = skg_volume_contents_get(volume, &contents);
    if (status == SKG_OK) status = pass_remarks(path, volume, contents.remarks);
    if (status == SKG_OK && list) json_array_append_new(list, volume_json(path, volume, &contents));
    if (status == SKG_OK && !list && !cli_is_quiet()) print_volume(path, volume, &contents);
    skg_volume_release(&volume);
    return status;
}
