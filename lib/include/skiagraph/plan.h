/** @file
 * Plans. A plan looks at scene, view, spectrum and options once: it decides how images are computed, compiles
 * what they need and allocates memory. Frames are then submitted to it (frame.h), and it reports what it
 * decided (report.h).
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_PLAN_H
#define SKIAGRAPH_PLAN_H

#include <skiagraph/frame.h>
#include <skiagraph/gradient.h>
#include <skiagraph/options.h>
#include <skiagraph/report.h>
#include <skiagraph/scatter_series.h>
#include <skiagraph/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Makes a plan.
 *
 *     scene      retained; parts may get other poses and materials afterwards, and their meshes other
 *                positions
 *     view       copied. Its numbers of rows and columns are fixed; frames may have other positions of source
 *                and detector
 *     spectrum   retained. If it is absolute, the plan finds the photons of a pixel from the view, and for frames of
 *                other views, from theirs. A parallel beam has no distance: its photons per mm2 at 1 m count as those
 *                of a pixel, with a warning
 *     options    NULL: the defaults of skg_plan_options_init
 *     plan       result; the caller releases it
 *     errors     SKG_ERR_SCENE (no parts, a view that cannot be imaged), SKG_ERR_UNSUPPORTED (double
 *                precision on a device without fp64), SKG_ERR_DEVICE_MEMORY, SKG_ERR_BUILD and others, with
 *                the reason */
SKG_API skg_status skg_plan_create(skg_context *context, skg_scene *scene, const skg_view *view,
                                   skg_spectrum *spectrum, const skg_plan_options *options, skg_plan **plan);

/** Adds an owner to a plan. */
SKG_API skg_status skg_plan_retain(skg_plan *plan);

/** Removes an owner. The plan is freed with the last owner and the last of its jobs. */
SKG_API void skg_plan_release(skg_plan **plan);

/** Makes the spectrum of photons per pixel with which a plan of a view computes. Where the spectrum is absolute, the
 * photons are those of a pixel at the foot of the perpendicular from the source to the plane of the detector.
 *
 *     spectrum   one that is not absolute, or of a parallel beam, keeps its numbers
 *     view       where the source and the pixels are
 *     resolved   result; it is not absolute; the caller releases it
 *     errors     SKG_ERR_SCENE if the view cannot be imaged, SKG_ERR_BEAM */
SKG_API skg_status skg_spectrum_create_resolved(const skg_spectrum *spectrum, const skg_view *view,
                                                skg_spectrum **resolved);

/** Gets the quality of the flat field in a pixel that faces the beam: photons and energy per pixel, air kerma at the detector.
 *
 *     errors     as skg_spectrum_create_resolved */
SKG_API skg_status skg_flat_field_quality_get(const skg_spectrum *spectrum, const skg_view *view,
                                              skg_quality *quality);

/** Sets the view of frames without their own. Returns SKG_STALE, and changes nothing, if the view has another size than the
 * plan's, if the spectrum is absolute and one of the two is parallel and the other is not, if rays leave
 * the anode (heel), pass a bow-tie filter, lean across a grid or cross an oblique scintillator at angles beyond those of the plan's views, or if its
 * pixels are not those of a detector that counts or of a blur that says its pixels. */
SKG_API skg_status skg_plan_view_set(skg_plan *plan, const skg_view *view);

#ifdef __cplusplus
}
#endif
#endif
