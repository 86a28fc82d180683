/* Solid angles of pixels, and the photons that reach them. */
#include "beam/spectrum.h"
#include "core/maths.h"
#include "core/text.h"
#include "geometry/optics.h"

#include <skiagraph/plan.h>

#include <math.h>

double skg_view_exposure(const skg_view *view) {
    double normal[3], way[3];
    if (view->projection != SKG_PROJECTION_POINT) return 1;
    skg_cross(view->column_step, view->row_step, normal);
    const double area = skg_length(normal);
    skg_add_scaled(view->centre, -1, view->source, way);
    return skg_microsteradians(area, fabs(skg_dot(way, normal)) / area);
}

skg_status skg_spectrum_create_resolved(const skg_spectrum *spectrum, const skg_view *view,
                                        skg_spectrum **resolved) {
    SKG_PLAIN;
    skg_view seen;
    SKG_NEEDS(resolved);
    *resolved = NULL;
    SKG_NEEDS(spectrum);
    SKG_TRY(skg_view_check(view));
    skg_view_init(&seen);
    SKG_TRY(skg_struct_read(view, "skg_view", &seen, sizeof seen));
    return skg_spectrum_create_counts(spectrum, spectrum->absolute ? skg_view_exposure(&seen) : 1, resolved);
}

skg_status skg_flat_field_quality_get(const skg_spectrum *spectrum, const skg_view *view,
                                      skg_quality *quality) {
    SKG_PLAIN;
    double across[3];
    skg_quality found;
    skg_spectrum *resolved = NULL;
    SKG_TRY(skg_spectrum_create_resolved(spectrum, view, &resolved));
    skg_quality_init(&found);
    const skg_status status = skg_spectrum_quality_get(resolved, &found);
    skg_spectrum_release(&resolved);
    SKG_TRY(status);
    skg_cross(view->column_step, view->row_step, across);
    found.air_kerma_ugy /= hypot(hypot(across[0], across[1]),
                                 across[2]); /* it counts the spectrum's photons as if they were per mm2 */
    return skg_struct_write(&found, sizeof found, "skg_quality", quality);
}
