/* Display curves, and what a file says about its picture in words. */
#include "image/image.h"

#include <math.h>
#include <stdio.h>

double skg_picture_value(const skg_picture *picture, int64_t index) {
    return picture->type == SKG_FLOAT64 ? ((const double *)picture->data)[index]
                                        : (double)((const float *)picture->data)[index];
}

/* Whether I/I0 can be formed. */
static int is_relative(const skg_picture *picture) {
    return picture->quantity == SKG_TRANSMISSION || picture->quantity == SKG_ATTENUATION || picture->open > 0;
}

double skg_picture_shown(const skg_picture *picture, double value) {
    if (!is_relative(picture)) return value;
    int radiograph = picture->display == SKG_DISPLAY_RADIOGRAPH;
    if (picture->quantity == SKG_ATTENUATION) return radiograph ? value : exp(-value);
    double transmission = picture->quantity == SKG_TRANSMISSION ? value : value / picture->open;
    if (!radiograph) return transmission;
    /* Nothing comes through (or noise says less than nothing): infinitely dense. 0 - keeps -0 away. */
    return transmission <= 0 ? HUGE_VAL : 0 - log(transmission);
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

/* Exactly as many digits as bring the double back. */
void skg_picture_describe(const skg_picture *picture, char *text, size_t length) {
    static const char *const sources[] = {"point source at", "parallel beam from", "parallel beam along"};
    const skg_view *view = picture->view;
    char title[256];
    skg_picture_title(picture, title, sizeof title);
    if (!view) {
        snprintf(text, length, "%s", title);
        return;
    }
    snprintf(text, length,
             "%s; %s %.17g %.17g %.17g; detector centre %.17g %.17g %.17g mm; column step %.17g %.17g %.17g "
             "mm; row step %.17g %.17g %.17g mm",
             title, sources[view->projection >= 0 && view->projection <= 2 ? view->projection : 0],
             view->source[0], view->source[1], view->source[2], view->centre[0], view->centre[1],
             view->centre[2], view->column_step[0], view->column_step[1], view->column_step[2],
             view->row_step[0], view->row_step[1], view->row_step[2]);
}
