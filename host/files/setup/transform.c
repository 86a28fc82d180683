/* The key Transform of a sample. */
#include "core/maths.h"
#include "setup/sections.h"

#include <inttypes.h>

enum { ROTATION, TRANSLATION, SCALING, MATRIX };
static const char *const kinds[] = {"Rotation", "Translation", "Scaling", "Matrix"};
static const char *const forms[] = {"[\"Rotation\", degrees, x, y, z]", "[\"Translation\", x, y, z, \"mm\"]",
                                    "[\"Scaling\", x, y, z]", "[\"Matrix\", [16 numbers, column by column]]"};
static const int64_t lengths[] = {5, 5, 4, 2};

/* `count` numbers of an entry from element `first` on. */
static skg_status read_from(const skg_json_node *entry, int64_t first, int64_t count, double *numbers) {
    for (int64_t i = 0; i < count; i++) {
        skg_json_node element = skg_json_element(entry, first + i);
        SKG_TRY(skg_json_number(&element, &numbers[i]));
    }
    return SKG_OK;
}

static skg_status read_rotation(const skg_json_node *entry, double *matrix) {
    double degrees = 0, axis[3], length = 0;
    SKG_TRY(read_from(entry, 1, 1, &degrees));
    SKG_TRY(read_from(entry, 2, 3, axis));
    length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    if (!(length > 0))
        return skg_json_fail(entry, SKG_ERR_SCENE, "the axis of a rotation is (0, 0, 0); give %s",
                             forms[ROTATION]);
    for (int k = 0; k < 3; k++) axis[k] /= length;
    skg_pose_rotation(degrees * (SKG_PI / 180), axis, matrix);
    return SKG_OK;
}

static skg_status read_translation(const skg_json_node *entry, double *matrix) {
    double v[3], mm = 1;
    SKG_TRY(read_from(entry, 1, 3, v));
    skg_json_node unit = skg_json_element(entry, 4);
    SKG_TRY(skg_json_unit_of_length(&unit, &mm));
    skg_pose_translation(v[0] * mm, v[1] * mm, v[2] * mm, matrix);
    return SKG_OK;
}

static skg_status read_scaling(const skg_json_node *entry, double *matrix) {
    double v[3];
    SKG_TRY(read_from(entry, 1, 3, v));
    if (v[0] == 0 || v[1] == 0 || v[2] == 0)
        return skg_json_fail(entry, SKG_ERR_SCENE, "a scaling by 0 flattens the sample");
    skg_pose_scaling(v[0], v[1], v[2], matrix);
    return SKG_OK;
}

static skg_status read_matrix(const skg_json_node *entry, double *matrix) {
    double columns[16];
    skg_json_node numbers = skg_json_element(entry, 1);
    SKG_TRY(skg_json_numbers(&numbers, "16 numbers, column by column", 16, columns));
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) matrix[4 * r + c] = columns[4 * c + r];
    if (matrix[12] != 0 || matrix[13] != 0 || matrix[14] != 0 || matrix[15] != 1)
        return skg_json_fail(&numbers, SKG_ERR_SCENE,
                             "its last row is (%g, %g, %g, %g) instead of (0, 0, 0, 1); the 16 numbers go "
                             "column by column, so that the translation is numbers 13 to 15",
                             matrix[12], matrix[13], matrix[14], matrix[15]);
    return SKG_OK;
}

static skg_status read_entry(const skg_json_node *entry, double *matrix) {
    static skg_status (*const readers[])(const skg_json_node *, double *) = {read_rotation, read_translation,
                                                                             read_scaling, read_matrix};
    int64_t count = 0, kind = 0;
    SKG_TRY(skg_json_array(entry, "an array such as [\"Translation\", 0, 0, 10, \"mm\"]", &count));
    skg_json_node name = skg_json_element(entry, 0);
    SKG_TRY(skg_json_choice(&name, "transformation", kinds, 4, &kind));
    if (count != lengths[kind])
        return skg_json_fail(entry, SKG_ERR_FORMAT, "has %" PRId64 " elements; give %s", count, forms[kind]);
    return readers[kind](entry, matrix);
}

skg_status skg_setup_read_transform(const skg_json_node *node, double *pose) {
    int64_t count = 0;
    SKG_TRY(skg_json_array(node, "an array of transformations, such as [[\"Translation\", 0, 0, 10, \"mm\"]]",
                           &count));
    for (int64_t i = 0; i < count; i++) {
        double matrix[16];
        skg_json_node entry = skg_json_element(node, i);
        SKG_TRY(read_entry(&entry, matrix));
        skg_pose_multiply(pose, matrix, pose);
    }
    return SKG_OK;
}
