/* Display curves, and the texts that a file holds on its picture. */
#include "image/image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

double skg_picture_value(const skg_picture *picture, int64_t index) {
    SKG_ASSERT(0 <= index && index < picture->channels * picture->rows * picture->columns);
    switch (picture->type) {
    case SKG_TYPE_FLOAT64:
        return ((const double *)picture->data)[index];
    case SKG_TYPE_UINT16:
        return (double)((const uint16_t *)picture->data)[index];
    default:
        return (double)((const float *)picture->data)[index];
    }
}

/* Whether the picture is I/I0 or can be divided by its flat field I0. */
static int is_relative(const skg_picture *picture) {
    return picture->quantity == SKG_QUANTITY_TRANSMISSION || picture->quantity == SKG_QUANTITY_ATTENUATION ||
           picture->flat_field > 0;
}

double skg_picture_shown(const skg_picture *picture, double value) {
    if (!is_relative(picture)) return value;
    int radiograph = picture->display == SKG_DISPLAY_RADIOGRAPH;
    if (picture->quantity == SKG_QUANTITY_ATTENUATION) return radiograph ? value : exp(-value);
    double transmission =
        picture->quantity == SKG_QUANTITY_TRANSMISSION ? value : value / picture->flat_field;
    if (!radiograph) return transmission;
    /* Without transmission, or with a negative one by noise, the object is infinitely dense. 0 - x gives 0, not
     * -0. */
    return transmission <= 0 ? HUGE_VAL : 0 - log(transmission);
}

/* Whether a value as shown belongs to a range: it is finite, and some photon can have made it. Behind jaws an attenuation is the
 * logarithm of the smallest normal float (skiagraph/collimation.h), which would leave no contrast to the others. */
static int has_photons(const skg_picture *picture, double shown) {
    const double none = 126 * log(2) * (1 - 1e-6); /* the attenuation is rounded to single precision */
    const int is_logarithm =
        picture->quantity == SKG_QUANTITY_ATTENUATION && picture->display == SKG_DISPLAY_RADIOGRAPH;
    return isfinite(shown) && !(is_logarithm && shown >= none);
}

void skg_picture_shown_range(const skg_picture *picture, double *low, double *high) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    int64_t pixels = picture->columns * picture->rows;
    for (int64_t i = 0; i < pixels; i++) {
        double shown = skg_picture_shown(picture, skg_picture_value(picture, i));
        if (!has_photons(picture, shown)) continue;
        if (shown < least) least = shown;
        if (shown > most) most = shown;
    }
    if (least > most) least = 0, most = 1; /* there is no such value */
    /* A picture of one value is shown between 0 and 1, or between 0 and that value. */
    if (least == most) {
        if (least > 0) least = 0;
        if (most < 1) most = most < 0 ? 0 : 1;
    }
    *low = least;
    *high = most;
}

/* Moves the values until that of rank `rank` is in its place, none before it is larger and none behind it smaller
 * (Hoare's selection). */
static double select_rank(double *values, int64_t count, int64_t rank) {
    int64_t first = 0, last = count - 1;
    while (first < last) {
        const double pivot = values[first + (last - first) / 2];
        int64_t i = first, j = last;
        while (i <= j) {
            while (values[i] < pivot) i++;
            while (values[j] > pivot) j--;
            if (i > j) break;
            const double swapped = values[i];
            values[i++] = values[j];
            values[j--] = swapped;
        }
        if (rank <= j)
            last = j;
        else if (rank >= i)
            first = i;
        else
            break;
    }
    return values[rank];
}

skg_status skg_picture_shown_window(const skg_picture *picture, double below, double above, double *low,
                                    double *high) {
    const int64_t pixels = picture->columns * picture->rows;
    double *values = NULL;
    int64_t count = 0;
    SKG_TRY(skg_alloc(pixels, sizeof *values, "range of a picture", &values));
    for (int64_t i = 0; i < pixels; i++) {
        const double shown = skg_picture_shown(picture, skg_picture_value(picture, i));
        if (has_photons(picture, shown)) values[count++] = shown;
    }
    *low = *high = 0;
    if (count > 0) {
        *low = select_rank(values, count, (int64_t)floor(below * (double)(count - 1) + 0.5));
        *high = select_rank(values, count, (int64_t)floor((1 - above) * (double)(count - 1) + 0.5));
    }
    if (!(*low < *high)) skg_picture_shown_range(picture, low, high);
    skg_free(&values);
    return SKG_OK;
}

void skg_picture_curve(const skg_picture *picture, char *text, size_t length) {
    if (!is_relative(picture))
        skg_picture_title(picture, text, length);
    else
        snprintf(text, length, "%s",
                 picture->display == SKG_DISPLAY_RADIOGRAPH ? "radiograph: -ln(I/I0)" : "transmission: I/I0");
}

void skg_picture_title(const skg_picture *picture, char *text, size_t length) {
    const char *name = picture->name ? picture->name : "", *unit = picture->unit ? picture->unit : "";
    snprintf(text, length, *unit ? "%s (%s)" : "%s%s", name, unit);
}

void skg_picture_numbers(const double *numbers, int count, char *text, size_t length) {
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < count && used < length; i++) {
        char number[32];
        for (int digits = 15; digits <= 17; digits++) {
            snprintf(number, sizeof number, "%.*g", digits, numbers[i] + 0.0); /* + 0 makes 0 of -0 */
            if (strtod(number, NULL) == numbers[i]) break;
        }
        used += (size_t)snprintf(text + used, length - used, "%s%s", i ? " " : "", number);
    }
}

void skg_picture_describe(const skg_picture *picture, char *text, size_t length) {
    static const char *const sources[] = {"point source at", "parallel beam from", "parallel beam along"};
    const skg_view *view = picture->view;
    char title[256], source[96], centre[96], column[96], row[96];
    skg_picture_title(picture, title, sizeof title);
    if (!view) {
        snprintf(text, length, "%s", title);
        return;
    }
    skg_picture_numbers(view->source, 3, source, sizeof source);
    skg_picture_numbers(view->centre, 3, centre, sizeof centre);
    skg_picture_numbers(view->column_step, 3, column, sizeof column);
    skg_picture_numbers(view->row_step, 3, row, sizeof row);
    snprintf(text, length, "%s; %s %s; detector centre %s mm; column step %s mm; row step %s mm", title,
             sources[view->projection >= 0 && view->projection <= 2 ? view->projection : 0], source, centre,
             column, row);
}
