/* Volumes of cells: their values become codes of a table, or whole numbers of 32 bits. */
#include "scene/volume.h"

#include "core/context.h"
#include "core/maths.h"
#include "core/text.h"
#include "material/material.h"
#include "scene/pose.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { CODES_MAX = 65536, SIDE_MAX = 32768, CLASSES_MAX = 256 };

/* Where 12-bit scanners end. */
static const double HU_MAX = 3000;

/* The largest cell of 32 bits. */
static const double WIDE_MAX = 0x1p30;

void skg_volume_source_init_sized(void *source, int32_t size) {
    skg_volume_source defaults = {0};
    skg_pose_identity(defaults.affine);
    skg_struct_init(source, size, &defaults, sizeof defaults);
}

void skg_volume_contents_init_sized(void *contents, int32_t size) {
    const skg_volume_contents defaults = {0};
    skg_struct_init(contents, size, &defaults, sizeof defaults);
}

skg_status skg_volume_retain(skg_volume *volume) {
    SKG_NEEDS(volume);
    skg_ref(&volume->refs);
    return SKG_OK;
}

void skg_volume_release(skg_volume **volume) {
    if (!volume || !*volume) return;
    skg_volume *v = *volume;
    if (skg_unref(&v->refs)) {
        for (int64_t c = 0; v->curves && c < v->curve_count; c++) skg_material_release(&v->curves[c]);
        skg_free(&v->curves);
        skg_free(&v->curve_of);
        skg_free(&v->amounts);
        skg_free(&v->shares);
        skg_free(&v->cells);
        skg_free(&v->name);
        skg_mesh_release(&v->hull);
        skg_material_release(&v->nothing);
        skg_free(&v);
    }
    *volume = NULL;
}

/* A volume that is made from a source. */
typedef struct {
    const skg_volume_source *source;
    skg_volume *volume;
    int64_t count;   /* of cells */
    int64_t classes; /* of the source, or rows of Schneider's table */
    double step;     /* codes: values from one to the next */
    int64_t *used;   /* [codes] cells that have this code */
} making;

static double value_at(const skg_volume_source *source, int64_t at) {
    switch (source->type) {
    case SKG_VOLUME_INT16:
        return (double)((const int16_t *)source->cells)[at];
    case SKG_VOLUME_UINT16:
        return (double)((const uint16_t *)source->cells)[at];
    case SKG_VOLUME_FLOAT32:
        return (double)((const float *)source->cells)[at];
    default:
        return ((const double *)source->cells)[at];
    }
}

static skg_status check_source(const skg_volume_source *s, const char *name) {
    const int64_t size[3] = {s->columns, s->rows, s->slices};
    for (int k = 0; k < 3; k++)
        if (size[k] < 1 || size[k] > SIDE_MAX)
            return skg_fail(SKG_ERR_ARGUMENT,
                            "%s: %" PRId64 " x %" PRId64 " x %" PRId64 " cells; 1 to %d along each axis",
                            name, size[0], size[1], size[2], (int)SIDE_MAX);
    if (s->values < SKG_VOLUME_HU || s->values > SKG_VOLUME_MU)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: values %d; SKG_VOLUME_HU, _DENSITY or _MU", name,
                        (int)s->values);
    if (s->interpolation < SKG_VOLUME_CELLS || s->interpolation > SKG_VOLUME_LINEAR)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: interpolation %d; SKG_VOLUME_CELLS or _LINEAR", name,
                        (int)s->interpolation);
    if (s->type < SKG_VOLUME_INT16 || s->type > SKG_VOLUME_FLOAT64)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: type %d; SKG_VOLUME_INT16, _UINT16, _FLOAT32 or _FLOAT64",
                        name, (int)s->type);
    if (!s->cells) return skg_fail(SKG_ERR_ARGUMENT, "%s: there are no cells", name);
    const skg_status status = skg_scene_check_pose(name, s->affine);
    return status == SKG_OK ? SKG_OK
                            : skg_fail(status, "%s: the place of its cells: %s", name, skg_last_error());
}

static skg_status check_classes(const skg_volume_source *s, const char *name) {
    if (s->class_count < 0 || s->class_count > CLASSES_MAX ||
        (s->class_count > 0 && (!s->class_from || !s->class_materials)))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: %" PRId64 " classes; 0 to %d, with their limits and materials",
                        name, s->class_count, (int)CLASSES_MAX);
    if (s->values == SKG_VOLUME_MU && (s->material || s->class_count))
        return skg_fail(
            SKG_ERR_MATERIAL,
            "%s: its values are attenuation coefficients, which need no material; leave out Material and "
            "Classes, or give densities or Hounsfield numbers",
            name);
    if (s->material && s->class_count)
        return skg_fail(SKG_ERR_MATERIAL, "%s: has a material and classes; give one of them", name);
    if (s->values == SKG_VOLUME_DENSITY && !s->material && !s->class_count)
        return skg_fail(SKG_ERR_MATERIAL, "%s: its values are densities, so give it a material or classes",
                        name);
    for (int64_t c = 0; c < s->class_count; c++) {
        if (!s->class_materials[c])
            return skg_fail(SKG_ERR_MATERIAL, "%s: class %" PRId64 " has no material", name, c);
        if (!isfinite(s->class_from[c]) || (c > 0 && !(s->class_from[c] > s->class_from[c - 1])))
            return skg_fail(SKG_ERR_ARGUMENT, "%s: class %" PRId64 " begins at %g; limits have to rise", name,
                            c, s->class_from[c]);
    }
    return SKG_OK;
}

void skg_volume_say(skg_volume *volume, int32_t level, const char *format, ...) {
    skg_volume_remark *one = &volume->remarks[volume->remark_count++];
    va_list values;
    va_start(values, format);
    one->level = level;
    vsnprintf(one->text, sizeof one->text, format, values);
    va_end(values);
}

/* Densities and coefficients of a reconstruction are below 0 where noise or ripples take air there; more than that is another kind of
 * values, such as Hounsfield numbers. As a share of the largest: an assumption. */
static const double NOISE_MAX = 0.25;

static double counted(const making *m, double value) {
    return m->volume->values == SKG_VOLUME_HU || value > 0 ? value : 0;
}

static skg_status fail_at(const making *m, int64_t at, const char *why) {
    const int64_t columns = m->volume->size[0], rows = m->volume->size[1];
    return skg_fail(SKG_ERR_ARGUMENT,
                    "%s: the value of the cell in column %" PRId64 ", row %" PRId64 ", slice %" PRId64
                    " is %g; %s",
                    m->volume->name, at % columns, at / columns % rows, at / columns / rows,
                    value_at(m->source, at), why);
}

/* The range of the values; whether all are whole numbers. */
static skg_status look(const making *m, int *whole) {
    skg_volume *v = m->volume;
    int64_t lowest = 0, below = 0;
    *whole = 1;
    v->low = HUGE_VAL, v->high = -HUGE_VAL;
    for (int64_t at = 0; at < m->count; at++) {
        const double value = value_at(m->source, at);
        if (!isfinite(value)) return fail_at(m, at, "values have to be finite");
        if (value < v->low) v->low = value, lowest = at;
        v->high = fmax(v->high, value);
        *whole &= floor(value) == value;
        below += value < 0;
    }
    if (v->values == SKG_VOLUME_HU || below == 0) return SKG_OK;
    if (v->low < -NOISE_MAX * v->high)
        return fail_at(
            m, lowest,
            "densities and attenuation coefficients are at least 0, but for noise of a quarter of the largest; "
            "set what is below 0 to 0, or say by Values what the numbers are");
    skg_volume_say(v, SKG_LOG_WARNING, "%" PRId64 " of its values are below 0, down to %g, and count as 0",
                   below, v->low);
    v->low = 0;
    return SKG_OK;
}

/* The class of a value: of the source, or a row of Schneider's table. */
static int64_t class_of(const making *m, double value) {
    const skg_volume_source *s = m->source;
    int64_t c = 0;
    if (s->values == SKG_VOLUME_MU || s->material) return 0;
    if (!s->class_count) return skg_hounsfield_row_of(value);
    while (c + 1 < s->class_count && value >= s->class_from[c + 1]) c++;
    return c;
}

static skg_status make_curve(const making *m, int64_t class, skg_material **curve) {
    const skg_volume_source *s = m->source;
    skg_material *made = NULL;
    const char *name = "";
    int64_t elements = 0;
    if (s->values == SKG_VOLUME_MU) return skg_material_create_mu("1/cm", 1, curve);
    if (s->material || s->class_count) {
        const skg_material *given = s->material ? s->material : s->class_materials[class];
        SKG_TRY(skg_material_name_get(given, &name));
        SKG_TRY(skg_material_element_count(given, &elements));
        if (elements == 0)
            return skg_fail(
                SKG_ERR_MATERIAL,
                "%s: %s is given by its attenuation, so no density can change it; give a material with "
                "elements",
                m->volume->name, name);
        return skg_material_create_at_density(given, 1, curve);
    }
    SKG_TRY(skg_hounsfield_row_create(class, &made));
    const skg_status status = skg_material_create_at_density(made, 1, curve);
    skg_material_release(&made);
    return status;
}

/* Makes the curves of the classes that are in use. number: [classes] result: the curve of a class. counts: [classes] cells */
static skg_status make_curves(const making *m, const int64_t *counts, int32_t *number) {
    skg_volume *v = m->volume;
    SKG_TRY(skg_alloc(m->classes, sizeof *v->curves, "classes of a volume", &v->curves));
    SKG_TRY(skg_alloc(m->classes, sizeof *v->shares, "classes of a volume", &v->shares));
    for (int64_t c = 0; c < m->classes; c++) {
        if (counts[c] == 0) continue;
        number[c] = (int32_t)v->curve_count;
        SKG_TRY(make_curve(m, c, &v->curves[v->curve_count]));
        v->shares[v->curve_count++] = (double)counts[c] / (double)m->count;
    }
    return SKG_OK;
}

static double amount_of(const making *m, double value) {
    return m->source->values == SKG_VOLUME_HU ? skg_hounsfield_density(value) : value;
}

/* Fills the table of the codes, and the curves. */
static skg_status make_table(making *m) {
    skg_volume *v = m->volume;
    int64_t *counts = NULL;
    int32_t *number = NULL;
    skg_status status = SKG_OK;
    SKG_TRY_CLEANUP(skg_alloc(m->classes, sizeof *counts, "classes of a volume", &counts));
    SKG_TRY_CLEANUP(skg_alloc(m->classes, sizeof *number, "classes of a volume", &number));
    SKG_TRY_CLEANUP(skg_alloc(v->codes, sizeof *v->curve_of, "table of a volume", &v->curve_of));
    SKG_TRY_CLEANUP(skg_alloc(v->codes, sizeof *v->amounts, "table of a volume", &v->amounts));
    for (int64_t k = 0; k < v->codes; k++) counts[class_of(m, v->low + m->step * (double)k)] += m->used[k];
    SKG_TRY_CLEANUP(make_curves(m, counts, number));
    for (int64_t k = 0; k < v->codes; k++) {
        const double value = v->low + m->step * (double)k;
        v->curve_of[k] = number[class_of(m, value)];
        v->amounts[k] = m->used[k] ? amount_of(m, value) : 0;
        v->mean_amount += v->amounts[k] * ((double)m->used[k] / (double)m->count);
        if (v->values == SKG_VOLUME_HU && value > HU_MAX) v->beyond += m->used[k];
    }
cleanup:
    skg_free(&counts);
    skg_free(&number);
    return status;
}

/* Cells of 16 bits. */
static skg_status encode(making *m) {
    skg_volume *v = m->volume;
    const int is_hu = v->values == SKG_VOLUME_HU;
    uint16_t *cells = NULL;
    if (is_hu) v->low = rint(v->low), v->high = rint(v->high);
    SKG_TRY(skg_alloc(v->codes, sizeof *m->used, "table of a volume", &m->used));
    SKG_TRY(skg_alloc(m->count, sizeof *cells, "cells of a volume", &cells));
    v->cells = cells;
    for (int64_t at = 0; at < m->count; at++) {
        const double value = counted(m, value_at(m->source, at));
        const int64_t code = (int64_t)rint(((is_hu ? rint(value) : value) - v->low) / m->step);
        cells[at] = (uint16_t)code;
        m->used[code]++;
    }
    return make_table(m);
}

/* Cells of 32 bits. */
static skg_status widen(making *m) {
    skg_volume *v = m->volume;
    int64_t counts[1] = {m->count};
    int32_t *cells = NULL, number[1];
    double sum = 0;
    v->wide = 1;
    v->unit = v->high > 0 ? v->high / WIDE_MAX : 1;
    SKG_TRY(skg_alloc(m->count, sizeof *cells, "cells of a volume", &cells));
    v->cells = cells;
    for (int64_t at = 0; at < m->count; at++) {
        const double value = counted(m, value_at(m->source, at));
        cells[at] = (int32_t)rint(value / v->unit);
        sum += value;
    }
    v->mean_amount = sum / (double)m->count;
    return make_curves(m, counts, number);
}

/* The box of all cells. Its faces turn outward whether the axes are right-handed or not. */
static skg_status make_hull(skg_volume *v) {
    static const int32_t faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    const int mirrored = skg_pose_determinant(v->affine) < 0;
    double positions[8][3];
    int32_t corners[12][3];
    for (int k = 0; k < 8; k++) {
        double cell[3];
        for (int a = 0; a < 3; a++) cell[a] = (k >> a & 1 ? (double)v->size[a] : 0) - 0.5;
        skg_pose_point(v->affine, cell, positions[k]);
    }
    for (int t = 0; t < 12; t++)
        for (int c = 0; c < 3; c++) corners[t][c] = faces[t][mirrored && c ? 3 - c : c];
    skg_mesh_source source;
    skg_mesh_source_init(&source);
    source.vertices = 8, source.positions = positions[0];
    source.triangles = 12, source.corners = corners[0];
    source.unit_mm = 1;
    SKG_TRY(skg_mesh_create(NULL, v->name, &source, &v->hull));
    return skg_material_create_mu("cells of a volume", 0, &v->nothing);
}

static skg_status make(making *m) {
    const skg_volume_source *s = m->source;
    skg_volume *v = m->volume;
    int whole = 0;
    const int alone = s->values == SKG_VOLUME_MU || s->material;
    SKG_TRY(check_source(s, v->name));
    SKG_TRY(check_classes(s, v->name));
    v->values = s->values;
    v->linear = s->interpolation == SKG_VOLUME_LINEAR;
    v->size[0] = s->columns, v->size[1] = s->rows, v->size[2] = s->slices;
    memcpy(v->affine, s->affine, sizeof v->affine);
    m->count = s->columns * s->rows * s->slices;
    m->classes = alone ? 1 : s->class_count ? s->class_count : skg_hounsfield_count;
    SKG_TRY(look(m, &whole));
    const double range = rint(v->high) - rint(v->low) + 1;
    if (v->values == SKG_VOLUME_HU && range > CODES_MAX)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: Hounsfield numbers from %g to %g; they may differ by %d at most", v->name,
                        v->low, v->high, CODES_MAX - 1);
    m->step = 1;
    v->codes = (int64_t)range;
    SKG_TRY(make_hull(v));
    if (v->values == SKG_VOLUME_HU || (whole && range <= CODES_MAX)) return encode(m);
    if (alone) return widen(m);
    v->codes = CODES_MAX;
    m->step = v->high > v->low ? (v->high - v->low) / (CODES_MAX - 1) : 1;
    return encode(m);
}

skg_status skg_volume_create(const skg_volume_source *source, skg_volume **volume) {
    SKG_PLAIN;
    skg_volume_source ours;
    skg_volume *made = NULL;
    making m = {.source = &ours};
    SKG_NEEDS(source);
    SKG_NEEDS(volume);
    *volume = NULL;
    skg_volume_source_init(&ours);
    SKG_TRY(skg_struct_read(source, "skg_volume_source", &ours, sizeof ours));
    SKG_TRY(skg_alloc(1, sizeof *made, "volume", &made));
    skg_refs_init(&made->refs);
    m.volume = made;
    skg_status status = skg_copy_text(ours.name ? ours.name : "volume", &made->name);
    if (status == SKG_OK) status = make(&m);
    skg_free(&m.used);
    if (status != SKG_OK) skg_volume_release(&made);
    *volume = made;
    return status;
}

int64_t skg_volume_bytes(const skg_volume *v) {
    return v->size[0] * v->size[1] * v->size[2] * (int64_t)(v->wide ? sizeof(int32_t) : sizeof(uint16_t));
}

skg_status skg_volume_contents_get(const skg_volume *volume, skg_volume_contents *contents) {
    SKG_NEEDS(volume);
    SKG_NEEDS(contents);
    const skg_volume *v = volume;
    skg_volume_contents ours = {.size = sizeof ours,
                                .values = v->values,
                                .bits = v->wide ? 32 : 16,
                                .classes = (int32_t)v->curve_count,
                                .columns = v->size[0],
                                .rows = v->size[1],
                                .slices = v->size[2],
                                .bytes = skg_volume_bytes(v),
                                .low = v->low,
                                .high = v->high,
                                .beyond = v->beyond,
                                .remarks = v->remark_count};
    for (int k = 0; k < 3; k++)
        ours.spacing[k] = skg_length((const double[3]){v->affine[k], v->affine[4 + k], v->affine[8 + k]});
    memcpy(ours.affine, v->affine, sizeof ours.affine);
    if (v->values != SKG_VOLUME_MU)
        ours.mass = v->mean_amount * 1e-3 * fabs(skg_pose_determinant(v->affine)) * (double)v->size[0] *
                    (double)v->size[1] * (double)v->size[2];
    return skg_struct_write(&ours, sizeof ours, "skg_volume_contents", contents);
}

skg_status skg_volume_class_get(const skg_volume *volume, int64_t index, const char **name, double *share) {
    SKG_NEEDS(volume);
    SKG_NEEDS(name);
    SKG_NEEDS(share);
    if (index < 0 || index >= volume->curve_count)
        return skg_fail(SKG_ERR_ARGUMENT, "%s: class %" PRId64 " of %" PRId64, volume->name, index,
                        volume->curve_count);
    *share = volume->shares[index];
    return skg_material_name_get(volume->curves[index], name);
}
