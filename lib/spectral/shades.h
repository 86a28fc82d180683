/* Shades: what thins a beam over the detector independently of the parts. Private.
 *
 * Energy E of a pixel is multiplied by exp(-sum over k of amount_k loss_k(E)). Each shade k is a plane of its own, whose amount is
 * not accumulated but computed from the ray, so that compression, ranges and logarithms treat shades as they treat materials.
 * Of each effect, in this order:
 *
 *   heel      few directions that the changes of the spectrum span; amounts are polynomials of z = (q - middle) / half, where q
 *             is the cosine between the ray and the normal of the anode's face (heel_shades.c)
 *   oblique   the same for what a scintillator records, with the normal of the detector (oblique_shades.c)
 *   bowtie    one, mm of the filter (bowtie_shade.c)
 *   grid      mm of the interspace along the ray, then few directions that strips span; amounts are tables by the tilt of the ray
 *             against the strips and by its obliquity (grid_shades.c) */
#ifndef SKG_SHADES_H
#define SKG_SHADES_H

#include "spectral/shade_list.h"

/* Finds the shades of the options' heel, oblique scintillator, bow-tie and grid over the detectors of the view and of the options'
 * further views. Where one energy is divided by its flat field, there are none. Free with skg_shades_release. */
skg_status skg_shades_find(const skg_view *view, const skg_spectrum *spectrum,
                           const skg_plan_options *options, skg_shades *shades);
void skg_shades_release(skg_shades *shades);

/* What the kernel needs to know of a camera. */
void skg_shades_see(const skg_shades *shades, const skg_camera *camera, skg_shade_double *args);

#endif
