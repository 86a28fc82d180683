/* Shades: what thins a beam over the detector independently of the parts. Private. */
#ifndef SKG_SHADING_H
#define SKG_SHADING_H

#include "beam/spectrum.h"
#include "geometry/optics.h"

#include <skiagraph/plan.h>

/* --- The few directions that span how a beam is thinned in many states, such as angles. */

enum { SKG_DIRECTIONS_MAX = 4 };

typedef struct {
    int64_t states, bins;
    int32_t count, reserved; /* of directions that were taken */
    double *weight;          /* [bins] roots of shares of the beam's energy */
    double *losses;          /* [states][bins] by the caller: -ln of what a state leaves of the photons */
    double *scale;           /* [states] by the caller: errors of a state count by this much; 1 at first */
    double *amounts;         /* [SKG_DIRECTIONS_MAX][states] */
    double *unit;            /* [SKG_DIRECTIONS_MAX][bins] losses for an amount of 1 */
    double error; /* that is left of the logarithm, by the least squares of the beam's energies, scaled */
} skg_directions;

skg_status skg_directions_create(const skg_spectrum *spectrum, int64_t states, skg_directions *directions);
void skg_directions_release(skg_directions *directions);

/* Finds directions, units and amounts, until what is left of every state is negligible or the most are taken. The losses are
 * used up. */
void skg_directions_find(skg_directions *directions);

/* Points between -1 and 1 at which a function is needed for skg_directions_fit: Chebyshev's, as states 0, 1, ... */
enum { SKG_FIT_POINTS = 24, SKG_FIT_TERMS = 12 };
double skg_fit_point(int state);

/* Sets terms to the coefficients of 1, z, z^2, ... of a polynomial through values at the points, by least squares. Returns the
 * largest error there. */
double skg_polynomial_fit(const double values[SKG_FIT_POINTS], double terms[SKG_FIT_TERMS]);

/* --- The list of a plan's shades, and what the effects that have shades share. */

enum {
    SKG_SHADE_TERMS = SKG_FIT_TERMS,
    /* Of the table of a grid: rows by tilt, and terms of polynomials of the obliquity. */
    SKG_GRID_TILTS = 257,
    SKG_GRID_TERMS = 3
};

_Static_assert(SKG_SHADES_MAX == 3 * SKG_DIRECTIONS_MAX + 2, "shades of all effects");

/* The z of polynomials. */
typedef struct {
    double middle, half;
} skg_shade_extent;

typedef struct {
    int32_t count; /* all */
    int32_t heel, oblique, bowtie, grid, reserved;
    double *losses;                                   /* [count][bins] */
    double low[SKG_SHADES_MAX], high[SKG_SHADES_MAX]; /* of the amounts */
    double polynomials[2 * SKG_DIRECTIONS_MAX]
                      [SKG_SHADE_TERMS]; /* heel, oblique: coefficients of 1, z, z^2, ... */
    skg_shade_extent heel_extent, oblique_extent;
    double heel_error, oblique_error,
        grid_error;          /* of the logarithm of what is transmitted, by least squares */
    double heel_angle;       /* of the anode, radians */
    double heel_toward[3];   /* of the anode, in the detector's frame: along columns, rows and across */
    double fan_toward[3];    /* in which the bow-tie's angles grow, likewise */
    double strips_toward[3]; /* across the strips of the grid, likewise */
    double fan_angle[2];     /* that rays have, radians */
    double grid_height, grid_focus; /* mm; focus 0: parallel strips */
    double grid_lean, grid_tilt;    /* the greatest tilt of rays, and of the tables */
    double grid_path[2];            /* least and greatest obliquity of the tables */
    int64_t rows;                   /* of the bow-tie's table */
    int64_t table_count;
    double *tables; /* [rows] tangents, [rows] mm; then [SKG_GRID_TILTS][grid - 1][SKG_GRID_TERMS] */
} skg_shades;

/* Input of the search for shades. */
typedef struct {
    const skg_view *view;
    const skg_spectrum *spectrum;
    const skg_plan_options *options;
} skg_shading;

/* Rays between those that were looked at, and views that differ in the last digits, may lie a little beyond. */
static const double SKG_SHADE_MARGIN = 0.02;

/* The unit vectors along a camera's columns and rows, and the one across both. */
void skg_detector_frame(const double *column, const double *row, double frame[3][3]);

/* Coordinates of a direction in the frame of the view's detector. Fails with SKG_ERR_SCENE if it has no length. name: for the
 * message; mend: what to give. */
skg_status skg_shade_direction(const skg_view *view, const double *direction, const char *name,
                               const char *mend, double toward[3]);

/* Sets central to the unit vector from the source to the detector's centre, and across to the unit vector of what is left of a
 * direction of the detector's frame across it. 0 if nothing is left. */
int skg_shade_axes(const skg_camera *camera, const double toward[3], double central[3], double across[3]);

/* Called for each ray of a grid over a detector; the ray is in mm. column, row: of its pixel. */
typedef skg_status skg_shade_ray(void *user, const skg_camera *camera, const double ray[3], double column,
                                 double row);

/* Calls seen for rays over the detectors of all views, from the middle of the source and from its ends. */
skg_status skg_shade_rays(const skg_shading *shading, skg_shade_ray *seen, void *user);

/* Likewise calls seen for few rays of one view, those to its corners included. */
skg_status skg_shade_rays_of(const skg_view *view, const skg_plan_options *options, skg_shade_ray *seen,
                             void *user);

/* Fails with SKG_STALE if rays of another view than those that the shades were made from lie beyond their tables. */
skg_status skg_grid_covers(const skg_shades *shades, const skg_view *view, const skg_plan_options *options);
skg_status skg_heel_covers(const skg_shades *shades, const skg_view *view, const skg_plan_options *options);
skg_status skg_bowtie_covers(const skg_shades *shades, const skg_view *view, const skg_plan_options *options);
skg_status skg_oblique_covers(const skg_shades *shades, const skg_view *view,
                              const skg_plan_options *options);

/* Makes the extent of q between low and high, with a margin. */
skg_shade_extent skg_shade_extent_of(double low, double high);

/* Appends directions whose amounts, at the points of skg_fit_point, become polynomials. error: of the logarithm. */
skg_status skg_shades_append_fitted(skg_directions *directions, skg_shades *shades, double *error);

/* Appends one shade with its losses [bins]. */
skg_status skg_shades_append(int64_t bins, const double *losses, double low, double high, skg_shades *shades);

/* Appends to the tables. */
skg_status skg_shades_append_table(int64_t count, skg_shades *shades, double **table);

/* --- The shades of the heel effect. */

/* Appends them. The options ask for them. */
skg_status skg_heel_shades(const skg_shading *shading, skg_shades *shades);

/* The normal of the anode's face, towards the beam. */
void skg_heel_axis(const skg_shades *shades, const skg_camera *camera, double axis[3]);

/* --- The shade of a bow-tie filter. */

/* Appends it. The options have a checked bow-tie. */
skg_status skg_bowtie_shade(const skg_shading *shading, skg_shades *shades);

/* --- The shades of an anti-scatter grid. */

/* Appends them. The options have a checked grid. */
skg_status skg_grid_shades(const skg_shading *shading, skg_shades *shades);

/* Sets tilt so that the tilt of the ray to pixel (i, j) against the strips is tilt[0] + tilt[1] i + tilt[2] j. */
void skg_grid_tilt(const skg_shades *shades, const skg_camera *camera, double tilt[3]);

/* The unit vector across the strips, in the plane of the detector. 0 if there is none. */
int skg_grid_across(const skg_shades *shades, const skg_camera *camera, double across[3]);

/* --- The shades of a scintillator that rays cross obliquely. */

/* Appends them. The options ask for them, and their response is that of a layer. */
skg_status skg_oblique_shades(const skg_shading *shading, skg_shades *shades);

/* --- Shades: what thins a beam over the detector independently of the parts. *
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

/* Finds the shades of the options' heel, oblique scintillator, bow-tie and grid over the detectors of the view and of the options'
 * further views. Where one energy is divided by its flat field, there are none. Free with skg_shades_release. */
skg_status skg_shades_find(const skg_view *view, const skg_spectrum *spectrum,
                           const skg_plan_options *options, skg_shades *shades);
void skg_shades_release(skg_shades *shades);

/* Fills the arguments by which a kernel evaluates the shades for a camera. */
void skg_shades_see(const skg_shades *shades, const skg_camera *camera, skg_shade_double *args);

#endif
