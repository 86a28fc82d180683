/* Reads a volume from a folder of DICOM slices of one series, in the order of their places. */
#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"
#include "image/dicom_slice.h"
#include "image/image.h"

#include <dirent.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* By what direction cosines and spacings of slices may differ, which files give with some decimals; and, of the step between slices, by what
 * places may. */
static const double SAME = 1e-4, EVEN = 0.01;

/* By what the lengths of direction cosines may differ from 1, and their product from 0: they have three decimals in some files. */
static const double UPRIGHT = 1e-3;

/* A folder, and its slices with places: in the order of their names, then of their places. */
typedef struct {
    const char *folder;
    int64_t count, name_count, other_count;
    skg_dicom_slice *slices, *others; /* others: files of DICOM without pixels or without a place */
    char **names;
    double normal[3];
} series;

static int by_name(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static skg_status add_name(series *s, const char *name) {
    const size_t length = strlen(s->folder) + strlen(name) + 2;
    SKG_TRY(skg_realloc(s->name_count + 1, sizeof *s->names, "files of a folder", &s->names));
    SKG_TRY(skg_alloc((int64_t)length, 1, "files of a folder", &s->names[s->name_count]));
    const size_t end = strlen(s->folder);
    snprintf(s->names[s->name_count++], length, "%s%s%s", s->folder,
             end > 0 && s->folder[end - 1] == '/' ? "" : "/", name);
    return SKG_OK;
}

/* Lists the regular files. */
static skg_status list_names(series *s) {
    DIR *entries = opendir(s->folder);
    skg_status status = SKG_OK;
    if (!entries) return skg_fail(SKG_ERR_FILE, "%s: cannot be read: %s", s->folder, strerror(errno));
    for (struct dirent *entry; status == SKG_OK && (entry = readdir(entries));) {
        struct stat there;
        status = add_name(s, entry->d_name);
        if (status == SKG_OK && (stat(s->names[s->name_count - 1], &there) != 0 || !S_ISREG(there.st_mode)))
            skg_free(&s->names[--s->name_count]);
    }
    closedir(entries);
    if (s->name_count > 0) qsort(s->names, (size_t)s->name_count, sizeof *s->names, by_name);
    return status;
}

/* Refuses a file that is not one of DICOM, and whose name says that it is. Those with a point in front are of the system. */
static skg_status check_name(const char *path) {
    const char *name = strrchr(path, '/') + 1, *dot = strrchr(name, '.');
    if (!dot || dot == name || *name == '.' || !skg_same_name(dot, ".dcm")) return SKG_OK;
    return skg_fail(
        SKG_ERR_FORMAT,
        "%s: does not begin as a file of DICOM; is it the whole file? Replace it, or move it away", path);
}

static skg_status append(const skg_dicom_slice *slice, int64_t *count, skg_dicom_slice **slices) {
    SKG_TRY(skg_realloc(*count + 1, sizeof **slices, "slices", slices));
    (*slices)[(*count)++] = *slice;
    return SKG_OK;
}

/* Takes a file if it is a slice with a place: others may lie beside them. */
static skg_status add_slice(series *s, int64_t name) {
    skg_dicom_slice slice;
    int is_dicom = 0;
    SKG_TRY(skg_dicom_slice_read(s->names[name], &is_dicom, &slice));
    if (!is_dicom) return check_name(s->names[name]);
    slice.path = s->names[name];
    if (slice.is_directory) return SKG_OK;
    if (slice.pixels == 0) return append(&slice, &s->other_count, &s->others);
    const double frames = skg_dicom_number(&slice, SKG_DICOM_FRAMES, 1);
    if (frames > 1)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "%s: holds %g frames; convert it to .mha or .nii, or to a file a slice",
                        s->names[name], frames);
    const int has_place = slice.count[SKG_DICOM_PLACE] && slice.count[SKG_DICOM_ORIENTATION];
    return has_place ? append(&slice, &s->count, &s->slices) : append(&slice, &s->other_count, &s->others);
}

/* Refuses what the series would lack: a file of the same series that is no slice, and one that ends before it says its series. */
static skg_status check_others(const series *s) {
    for (int64_t k = 0; k < s->other_count; k++) {
        const skg_dicom_slice *other = &s->others[k];
        if (*other->series && strcmp(other->series, s->slices[0].series) != 0) continue;
        if (*other->series)
            return skg_fail(
                SKG_ERR_FORMAT,
                "%s: is of the series of the slices, and has no %s; is it the whole file? Replace "
                "it, or move it away",
                other->path,
                other->pixels == 0               ? "PixelData"
                : !other->count[SKG_DICOM_PLACE] ? "ImagePositionPatient"
                                                 : "ImageOrientationPatient");
        return skg_fail(
            SKG_ERR_FORMAT,
            "%s: says no series (SeriesInstanceUID); is it the whole file? Replace it, or move it "
            "away",
            other->path);
    }
    return SKG_OK;
}

/* Refuses a folder of no series, or of several, which it names in the order of their first slices. */
static skg_status check_series(const series *s) {
    char text[768] = "";
    int64_t different = 0;
    size_t length = 0;
    if (s->count == 0)
        return skg_fail(SKG_ERR_FORMAT, "%s: holds no DICOM slice with a place (ImagePositionPatient)",
                        s->folder);
    for (int64_t k = 0; k < s->count; k++) {
        const skg_dicom_slice *first = &s->slices[k];
        int64_t its = 0, known = 0;
        for (int64_t j = 0; j < s->count; j++) {
            const int same = strcmp(s->slices[j].series, first->series) == 0;
            its += same, known += same && j < k;
        }
        if (known) continue;
        different++;
        if (length + 1 < sizeof text)
            length += (size_t)snprintf(text + length, sizeof text - length, "%s%" PRId64 " slices of '%s'",
                                       different > 1 ? ", " : "", its,
                                       *first->description ? first->description : first->series);
    }
    if (different == 1) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT, "%s: holds %" PRId64 " series: %s; give a folder of one", s->folder,
                    different, text);
}

/* Whether all slices have in common what a volume has once. */
static skg_status check_common(const series *s, enum skg_dicom_numbers which, const char *name) {
    const skg_dicom_slice *first = &s->slices[0];
    for (int64_t k = 1; k < s->count; k++) {
        const skg_dicom_slice *slice = &s->slices[k];
        int same = slice->count[which] == first->count[which];
        for (int n = 0; same && n < slice->count[which]; n++) {
            const double of_first = first->numbers[which][n];
            same = fabs(slice->numbers[which][n] - of_first) <= SAME * fmax(1, fabs(of_first));
        }
        if (same) continue;
        char its[160], ours[160];
        skg_picture_numbers(slice->numbers[which], slice->count[which], its, sizeof its);
        skg_picture_numbers(first->numbers[which], first->count[which], ours, sizeof ours);
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: %s of slice %" PRId64 " is [%s], of the first [%s]; a volume has one", s->folder,
                        name, k, its, ours);
    }
    return SKG_OK;
}

/* The rows and columns of a volume are at right angles. */
static skg_status check_turns(const skg_dicom_slice *slice) {
    const double *turns = slice->numbers[SKG_DICOM_ORIENTATION];
    const double across = skg_length(turns), down = skg_length(turns + 3),
                 product = skg_dot(turns, turns + 3);
    char its[160];
    if (fabs(across - 1) <= UPRIGHT && fabs(down - 1) <= UPRIGHT && fabs(product) <= UPRIGHT) return SKG_OK;
    skg_picture_numbers(turns, 6, its, sizeof its);
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: its ImageOrientationPatient is [%s], vectors of the lengths %.6g and %.6g with the "
                    "product %.6g; they are of length 1 and at right angles, so that the product is 0",
                    slice->path, its, across, down, product);
}

static skg_status check_slices(const series *s) {
    SKG_TRY(check_series(s));
    SKG_TRY(check_others(s));
    const skg_dicom_slice *first = &s->slices[0];
    const double *spacing = first->numbers[SKG_DICOM_SPACING];
    SKG_TRY(check_common(s, SKG_DICOM_ORIENTATION, "ImageOrientationPatient"));
    SKG_TRY(check_common(s, SKG_DICOM_SPACING, "PixelSpacing"));
    SKG_TRY(check_common(s, SKG_DICOM_ROWS, "Rows"));
    SKG_TRY(check_common(s, SKG_DICOM_COLUMNS, "Columns"));
    if (first->count[SKG_DICOM_ORIENTATION] != 6 || first->count[SKG_DICOM_SPACING] != 2 ||
        !(spacing[0] > 0 && spacing[1] > 0))
        return skg_fail(SKG_ERR_FORMAT, "%s: its slices have no PixelSpacing or ImageOrientationPatient",
                        s->folder);
    SKG_TRY(check_turns(first));
    for (int64_t k = 0; k < s->count; k++)
        if (s->slices[k].count[SKG_DICOM_PLACE] != 3)
            return skg_fail(SKG_ERR_FORMAT, "%s: its ImagePositionPatient is not three numbers",
                            s->slices[k].path);
    for (int64_t k = 0; k < s->count; k++) SKG_TRY(skg_dicom_slice_check(&s->slices[k]));
    return skg_picture_size_check(s->folder, skg_dicom_number(first, SKG_DICOM_COLUMNS, 0),
                                  skg_dicom_number(first, SKG_DICOM_ROWS, 0), (double)s->count);
}

/* Sorts by the places along the normal; where these are the same, by the names. */
static void sort_slices(series *s) {
    for (int64_t k = 1; k < s->count; k++) {
        const skg_dicom_slice moving = s->slices[k];
        const double at = skg_dot(moving.numbers[SKG_DICOM_PLACE], s->normal);
        int64_t to = k;
        for (; to > 0 && skg_dot(s->slices[to - 1].numbers[SKG_DICOM_PLACE], s->normal) > at; to--)
            s->slices[to] = s->slices[to - 1];
        s->slices[to] = moving;
    }
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* mm from each slice to the next along the normal, and the median of them. */
static skg_status find_steps(const series *s, double *along, double *usual) {
    const int64_t count = s->count - 1;
    double *sorted = NULL;
    SKG_TRY(skg_alloc(count, sizeof *sorted, "steps between slices", &sorted));
    for (int64_t k = 0; k < count; k++)
        along[k] = skg_dot(s->slices[k + 1].numbers[SKG_DICOM_PLACE], s->normal) -
                   skg_dot(s->slices[k].numbers[SKG_DICOM_PLACE], s->normal);
    memcpy(sorted, along, (size_t)count * sizeof *along);
    qsort(sorted, (size_t)count, sizeof *sorted, by_size);
    *usual = 0.5 * (sorted[count / 2] + sorted[(count - 1) / 2]);
    skg_free(&sorted);
    return SKG_OK;
}

/* Refuses slices at one place, and steps of which one is another. */
static skg_status check_steps(const series *s, const double *along, double usual) {
    int64_t least = 0, worst = 0;
    for (int64_t k = 1; k + 1 < s->count; k++) {
        if (along[k] < along[least]) least = k;
        if (fabs(along[k] - usual) > fabs(along[worst] - usual)) worst = k;
    }
    if (along[least] <= EVEN * usual)
        return skg_fail(SKG_ERR_FORMAT, "%s: slices %" PRId64 " and %" PRId64 " lie at one place", s->folder,
                        least, least + 1);
    if (fabs(along[worst] - usual) <= EVEN * usual) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT,
                    "%s: %.6g mm lie between slices %" PRId64 " and %" PRId64
                    ", %.6g mm between others; is one missing?",
                    s->folder, along[worst], worst, worst + 1, usual);
}

/* From a slice to the next one, aslant where the gantry was tilted. */
static skg_status find_step(const series *s, double step[3]) {
    const double *first = s->slices[0].numbers[SKG_DICOM_PLACE],
                 *last = s->slices[s->count - 1].numbers[SKG_DICOM_PLACE];
    double *along = NULL, usual = 0, most = 0;
    int64_t farthest = 0;
    if (s->count < 2)
        return skg_fail(SKG_ERR_FORMAT, "%s: holds 1 slice; its thickness as a volume is not known",
                        s->folder);
    SKG_TRY(skg_alloc(s->count - 1, sizeof *along, "steps between slices", &along));
    skg_status status = find_steps(s, along, &usual);
    if (status == SKG_OK) status = check_steps(s, along, usual);
    skg_free(&along);
    SKG_TRY(status);
    for (int k = 0; k < 3; k++) step[k] = (last[k] - first[k]) / (double)(s->count - 1);
    for (int64_t k = 0; k < s->count; k++) {
        double off[3];
        for (int n = 0; n < 3; n++)
            off[n] = s->slices[k].numbers[SKG_DICOM_PLACE][n] - first[n] - (double)k * step[n];
        if (skg_length(off) > most) most = skg_length(off), farthest = k;
    }
    if (most <= EVEN * usual) return SKG_OK;
    return skg_fail(SKG_ERR_FORMAT, "%s: slice %" PRId64 " is shifted sideways by %.3g mm", s->folder,
                    farthest, most);
}

static skg_status place(series *s, skg_grid *grid) {
    const skg_dicom_slice *first = &s->slices[0];
    const double *turns = first->numbers[SKG_DICOM_ORIENTATION], *spacing = first->numbers[SKG_DICOM_SPACING];
    double step[3];
    skg_cross(turns, turns + 3, s->normal);
    sort_slices(s);
    first = &s->slices[0];
    SKG_TRY(find_step(s, step));
    for (int k = 0; k < 3; k++) {
        grid->affine[4 * k] = turns[k] * spacing[1];
        grid->affine[4 * k + 1] = turns[3 + k] * spacing[0];
        grid->affine[4 * k + 2] = step[k];
        grid->affine[4 * k + 3] = first->numbers[SKG_DICOM_PLACE][k];
        grid->unit_mm[k] = 1;
    }
    grid->affine[15] = 1;
    grid->size[0] = (int64_t)first->numbers[SKG_DICOM_COLUMNS][0];
    grid->size[1] = (int64_t)first->numbers[SKG_DICOM_ROWS][0];
    grid->size[2] = s->count;
    return SKG_OK;
}

/* Goes on with floats: `count` cells are whole numbers so far. */
static skg_status widen(int64_t count, skg_grid *grid) {
    float *wide = NULL;
    SKG_TRY(
        skg_alloc(grid->size[0] * grid->size[1] * grid->size[2], sizeof *wide, "cells of a volume", &wide));
    for (int64_t k = 0; k < count; k++) wide[k] = ((const int16_t *)grid->cells)[k];
    skg_free(&grid->cells);
    grid->cells = wide, grid->type = SKG_VOLUME_FLOAT32;
    return SKG_OK;
}

/* The cells of all slices: whole numbers of 16 bits where they are such, otherwise floats. */
static skg_status read_cells(const series *s, skg_grid *grid) {
    const int64_t plane = grid->size[0] * grid->size[1];
    double *values = NULL;
    skg_status status = SKG_OK;
    grid->type = SKG_VOLUME_INT16;
    SKG_TRY_CLEANUP(skg_alloc(plane * s->count, sizeof(int16_t), "cells of a volume", &grid->cells));
    SKG_TRY_CLEANUP(skg_alloc(plane, sizeof *values, "pixels of a slice", &values));
    for (int64_t z = 0; z < s->count; z++) {
        SKG_TRY_CLEANUP(skg_dicom_slice_values(&s->slices[z], values));
        int whole = 1;
        for (int64_t k = 0; k < plane; k++)
            whole &= values[k] >= INT16_MIN && values[k] <= INT16_MAX && values[k] == rint(values[k]);
        if (!whole && grid->type == SKG_VOLUME_INT16) SKG_TRY_CLEANUP(widen(z * plane, grid));
        for (int64_t k = 0; k < plane; k++)
            if (grid->type == SKG_VOLUME_INT16)
                ((int16_t *)grid->cells)[z * plane + k] = (int16_t)values[k];
            else
                ((float *)grid->cells)[z * plane + k] = (float)values[k];
    }
cleanup:
    skg_free(&values);
    if (status != SKG_OK) skg_free(&grid->cells);
    return status;
}

/* CT images hold Hounsfield numbers unless they say otherwise; images of other kinds where they say so (PS3.3, C.8.2.1 and C.11.1). */
static void find_scale(const series *s, skg_grid *grid) {
    const skg_dicom_slice *first = &s->slices[0];
    const int is_said = *first->scale != '\0';
    if (is_said ? strcmp(first->scale, "HU") == 0 : !*first->modality || strcmp(first->modality, "CT") == 0)
        return;
    snprintf(grid->no_hounsfield, sizeof grid->no_hounsfield, "%s is '%s'",
             is_said ? "RescaleType" : "Modality", is_said ? first->scale : first->modality);
}

int skg_dicom_is_folder(const char *path) {
    struct stat there;
    return stat(path, &there) == 0 && S_ISDIR(there.st_mode);
}

skg_status skg_dicom_read_grid(const char *path, skg_grid *grid) {
    series s = {.folder = path};
    skg_status status = SKG_OK;
    *grid = (skg_grid){.type = 0};
    SKG_TRY_CLEANUP(list_names(&s));
    for (int64_t k = 0; k < s.name_count; k++) SKG_TRY_CLEANUP(add_slice(&s, k));
    SKG_TRY_CLEANUP(check_slices(&s));
    SKG_TRY_CLEANUP(place(&s, grid));
    find_scale(&s, grid);
    status = read_cells(&s, grid);
cleanup:
    for (int64_t k = 0; k < s.name_count; k++) skg_free(&s.names[k]);
    skg_free(&s.names);
    skg_free(&s.slices);
    skg_free(&s.others);
    return status;
}
