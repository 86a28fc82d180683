/* Radiographs that a registration is given. */
#include "registration/types.h"

#include "core/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static skg_status check_values(const char *name, const char *what, const skg_view *view,
                               const double *values) {
    for (int64_t p = 0; p < view->rows * view->columns; p++)
        if (!isfinite(values[p]))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "%s: the %s of row %" PRId64 ", column %" PRId64
                            " is not finite; mend it, or hide it by a mask and give any number",
                            name, what, p / view->columns, p % view->columns);
    return SKG_OK;
}

static void find_range(int64_t count, const double *values, double *low, double *high) {
    *low = HUGE_VAL, *high = -HUGE_VAL;
    for (int64_t p = 0; p < count; p++) {
        *low = fmin(*low, values[p]);
        *high = fmax(*high, values[p]);
    }
}

/* Intensities over their flat field. */
static skg_status normalize(const skg_radiograph *given, reg_image *image) {
    enum {
        MOST = 1000
    }; /* of an implant some hundred; bytes as grey values pass, as attenuations of metal do */
    const int64_t count = image->view.rows * image->view.columns;
    double low, high;
    find_range(count, given->values, &low, &high);
    if (!(low < high))
        return skg_fail(SKG_ERR_ARGUMENT, "%s: every value is %g; a radiograph shows something", image->name,
                        low);
    if (given->quantity == SKG_QUANTITY_ATTENUATION && high > MOST)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: an attenuation of %g lets nothing pass; if these are grey values, give them as "
                        "intensities, or divide them by what an attenuation of 1 has",
                        image->name, high);
    const double flat = given->flat_field != 0 ? given->flat_field : high;
    const int is_intensity =
        given->quantity != SKG_QUANTITY_TRANSMISSION && given->quantity != SKG_QUANTITY_ATTENUATION;
    if (is_intensity && !given->flat && !(flat > 0 && isfinite(flat)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: the flat field is %g; intensities need one above 0, or another quantity",
                        image->name, flat);
    for (int64_t p = 0; p < count; p++) {
        const double value = given->values[p];
        image->transmission[p] = value;
        if (given->quantity == SKG_QUANTITY_ATTENUATION) image->transmission[p] = exp(-value);
        if (!is_intensity) continue;
        if (given->flat && !(given->flat[p] > 0))
            return skg_fail(SKG_ERR_ARGUMENT,
                            "%s: the flat field is %g in row %" PRId64 ", column %" PRId64
                            "; it has to be above 0",
                            image->name, given->flat[p], p / image->view.columns, p % image->view.columns);
        image->transmission[p] = value / (given->flat ? given->flat[p] : flat);
    }
    return SKG_OK;
}

static skg_status set_mask(const skg_radiograph *given, reg_image *image) {
    const int64_t count = image->view.rows * image->view.columns;
    int64_t left = 0;
    for (int64_t p = 0; p < count; p++) {
        image->given[p] = !given->mask || given->mask[p] != 0;
        left += image->given[p] > 0;
    }
    if (left > 0) return SKG_OK;
    return skg_fail(SKG_ERR_ARGUMENT, "%s: the mask hides every pixel", image->name);
}

enum { ARRAYS = 6 + REG_SHARES };

static void list_arrays(reg_image *image, double **arrays[ARRAYS]) {
    double **const all[ARRAYS - REG_SHARES] = {&image->transmission, &image->mask,   &image->given,
                                               &image->rest,         &image->shadow, &image->before};
    memcpy(arrays, all, sizeof all);
    for (int k = 0; k < REG_SHARES; k++) arrays[ARRAYS - REG_SHARES + k] = &image->shares[k];
}

void reg_image_free(reg_image *image) {
    double **arrays[ARRAYS];
    list_arrays(image, arrays);
    for (int k = 0; k < ARRAYS; k++) skg_free(arrays[k]);
}

static skg_status fill(const skg_radiograph *given, reg_image *image) {
    const int64_t count = image->view.rows * image->view.columns;
    double **arrays[ARRAYS];
    list_arrays(image, arrays);
    for (int k = 0; k < ARRAYS; k++) SKG_TRY(skg_alloc(count, sizeof(double), "radiograph", arrays[k]));
    SKG_TRY(check_values(image->name, "value", &image->view, given->values));
    if (given->flat) SKG_TRY(check_values(image->name, "flat field", &image->view, given->flat));
    SKG_TRY(normalize(given, image));
    return set_mask(given, image);
}

skg_status skg_registration_image_add(skg_registration *registration, const skg_radiograph *theirs) {
    SKG_PLAIN;
    enum { LEAST_SIDE = 8 };
    skg_registration *r = registration;
    skg_radiograph given;
    SKG_NEEDS(registration);
    skg_radiograph_init(&given);
    SKG_TRY(skg_struct_read(theirs, "skg_radiograph", &given, sizeof given));
    if (!given.view || !given.values)
        return skg_fail(SKG_ERR_ARGUMENT, "registration: a radiograph needs a view and values");
    if (r->image_count == REG_IMAGES)
        return skg_fail(SKG_ERR_UNSUPPORTED, "registration: at most %d radiographs can be registered at once",
                        REG_IMAGES);
    reg_image image = {0};
    skg_view_init(&image.view);
    snprintf(image.name, sizeof image.name, "%s", given.name ? given.name : "");
    if (!given.name) snprintf(image.name, sizeof image.name, "radiograph %" PRId64, r->image_count + 1);
    SKG_TRY(skg_view_check(given.view));
    SKG_TRY(skg_struct_read(given.view, "skg_view", &image.view, sizeof image.view));
    if (image.view.radius > 0)
        return skg_fail(SKG_ERR_UNSUPPORTED,
                        "a radiograph on a curved detector is not registered; give one on a flat detector");
    if (image.view.rows < LEAST_SIDE || image.view.columns < LEAST_SIDE)
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: %" PRId64 " x %" PRId64 " pixels; a registration needs %d along each side",
                        image.name, image.view.columns, image.view.rows, LEAST_SIDE);
    skg_status status = fill(&given, &image);
    if (status == SKG_OK)
        status = skg_realloc(r->image_count + 1, sizeof *r->images, "radiographs", &r->images);
    if (status == SKG_OK) {
        r->images[r->image_count++] = image;
        return SKG_OK;
    }
    reg_image_free(&image);
    return status;
}
