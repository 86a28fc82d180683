/* The calibration of both models to spectra that SpekPy 2.5.4 computes (G. Poludniowski, A. Omar, R. Bujila, P. Andreo,
 * Technical Note: SpekPy v2.0, Medical Physics 48 (2021) 3630-3637), whose electrons follow Monte Carlo simulations.
 *
 * As published, Ebel's continuum is 45 to 60 % too high for tungsten, and the K lines, which both models share, are 3 to 4
 * times too weak; the L lines and Birch's continuum have no scale at all. The factors were fitted by least squares to
 * unfiltered spectra, continua and lines separately, each energy weighted by its share of the air kerma behind 0.5 and 2.5 mm
 * of aluminium (bench/validate/calibrate):
 *
 *     tungsten     20, 25, 30, 35, 40, 50, 60, 70, 80, 90, 100, 120, 150 kV at 6, 8, 12, 16, 20 degrees
 *     tungsten     160, 180, 200, 225, 250, 275, 300 kV at the same, behind 2.5 mm of aluminium, 0.5 and 2 mm of copper
 *     molybdenum   20, 25, 28, 30, 32, 35, 40, 49 kV at 12, 16, 20 degrees
 *     rhodium      the same
 *
 * SpekPy ends at 300 kV. From there to 400 kV the continuum of tungsten changes as that of xpecgen 1.3.1 does (G. Hernandez, F. Fernandez,
 * Medical Physics 43 (2016) 4655; electrons as simulated by FLUKA), at 12 and 20 degrees, weighted behind 2.5 mm of aluminium and 0, 0.5, 2
 * and 8 mm of copper (bench/validate/beyond.py).
 */
#include "beam/spectrum.h"
#include "material/material.h"
#include "material/shells.h"

#include <math.h>

enum { TUNGSTEN = 74 };

/* With x = energy / tube voltage and v = ln(tube voltage / 80 kV), u = tube voltage / edge, t = ln(u - 1), w = ln(tube voltage / seam):
 *
 *     continuum   factor exp(sum of c[i][j] x^i v^j), depth factor exp(d[0] + d[1] x + d[2] v + d[3] x v)
 *     continuum   above the seam also: factor exp(sum of h[i][j] x^i w^(j + 1)), depth factor exp((g[0] + g[1] x) w)
 *     continuum   beyond the range also: factor exp(sum of e[i] x^i ln(tube voltage / end of the range))
 *     K lines     factor exp(k[0] + k[1] t + k[3] t^2), depth factor exp(k[2] + k[4] t)
 *     K lines     above the seam also: factor exp((k_high[0] + k_high[1] w) w), depth factor exp(k_high[2] w)
 *     L lines     factor 1e6 exp(l[0] + l[1] t + l[4] t^2), depth factor exp(l[2] + l[3] ln u); 0: none */
static const skg_tube_calibration calibrations[] = {
    {.range = {.z = TUNGSTEN, .kvp = {20, 300}, .angle_deg = {6, 20}},
     .seam_kvp = 150,
     .last_kvp = 400,
     .continuum =
         {[SKG_TUBE_MODEL_EBEL] =
              {.c = {{-0.26528, -0.57181, -0.16581},
                     {-0.63719, 1.82084, 0.70077},
                     {0.52869, -2.93735, -1.34558},
                     {0.05661, 1.71574, 0.88452}},
               .d = {-0.29947, 0.37146, -0.17210, 0.18890},
               .h = {{-0.13369, -0.89064}, {-2.31199, 3.86295}, {4.00020, -4.97012}, {-1.18446, 2.10099}},
               .g = {0.15850, -1.60806},
               .e = {-1.72793, 6.32674, -10.77686, 7.69090}},
          [SKG_TUBE_MODEL_BIRCH] =
              {.c = {{17.95876, 0.40644, -0.15790},
                     {5.72188, -1.21525, 1.08842},
                     {-8.33552, 1.63493, -2.11539},
                     {4.01228, -1.10565, 1.17225}},
               .d = {-1.02967, 0.76355, -0.06929, 0.05092},
               .h = {{1.07614, -0.04556}, {-4.43441, -1.11170}, {5.37455, 4.61532}, {-2.17859, -4.04920}},
               .g = {0.60334, -1.77872},
               .e = {0.23505, 0.43538, -2.18388, 1.28500}}},
     .k = {1.13267, -0.20704, 1.27924, -0.01750, -0.84165},
     .k_high = {-0.23551, -0.23381, -1.41698},
     .l = {1.52205, -0.21778, 0.16689, -0.23292, -0.03205}},
    {.range = {.z = 42, .kvp = {20, 49}, .angle_deg = {12, 20}},
     .seam_kvp = 49,
     .continuum = {[SKG_TUBE_MODEL_EBEL] = {.c = {{0.03377, 0.52226, 0},
                                                  {-1.68634, -3.16945, 0},
                                                  {2.02033, 4.72521, 0},
                                                  {-0.63528, -2.35261, 0}},
                                            .d = {0.24664, 0.09472, 0.85451, -0.92444}},
                   [SKG_TUBE_MODEL_BIRCH] = {.c = {{18.37883, 1.53195, 0},
                                                   {1.81948, -6.72314, 0},
                                                   {-3.19278, 9.62122, 0},
                                                   {1.46136, -4.80493, 0}},
                                             .d = {0.16328, -0.91164, 1.89703, -2.83117}}},
     .k = {0.26222, -0.07114, 0.70916, 0.01645, -0.74285}},
    {.range = {.z = 45, .kvp = {20, 49}, .angle_deg = {12, 20}},
     .seam_kvp = 49,
     .continuum = {[SKG_TUBE_MODEL_EBEL] = {.c = {{-0.10035, 0.62262, 0},
                                                  {-0.81777, -3.13757, 0},
                                                  {0.56088, 4.29824, 0},
                                                  {0.10237, -2.04155, 0}},
                                            .d = {0.07149, 0.86071, 1.16895, -0.53798}},
                   [SKG_TUBE_MODEL_BIRCH] = {.c = {{18.37465, 1.76653, 0},
                                                   {2.35126, -7.37030, 0},
                                                   {-4.12197, 10.26741, 0},
                                                   {1.97802, -5.03888, 0}},
                                             .d = {0.22828, -0.72867, 2.49486, -3.15304}}},
     .k = {0.32165, -0.09980, 0.82460, 0.00940, -0.77039}},
};

const skg_tube_calibration *skg_tube_calibration_of(int32_t z) {
    for (size_t i = 1; i < sizeof calibrations / sizeof *calibrations; i++)
        if (calibrations[i].range.z == z) return &calibrations[i];
    return &calibrations[0];
}

/* Beyond its range, the fit continues as at the end of it: its powers would grow without bounds. */
static double below_seam(double kvp, const skg_tube_calibration *calibration) {
    return fmin(fmax(kvp, calibration->range.kvp[0]), calibration->seam_kvp);
}

/* The logarithm of the voltage over that of the seam, 0 below. */
static double above_seam(double kvp, const skg_tube_calibration *calibration) {
    return log(fmax(fmin(kvp, calibration->range.kvp[1]) / calibration->seam_kvp, 1));
}

/* The logarithm of the voltage over the end of the range, 0 within it. */
static double beyond_range(double kvp, const skg_tube_calibration *calibration) {
    return log(fmax(fmin(kvp, calibration->last_kvp) / calibration->range.kvp[1], 1));
}

double skg_tube_continuum(const skg_tube_calibration *calibration, int32_t model, const skg_anode *anode,
                          double energy_kev) {
    const skg_continuum_factors *f = &calibration->continuum[model];
    const double x = energy_kev / anode->kvp, v = log(below_seam(anode->kvp, calibration) / 80);
    const double w = above_seam(anode->kvp, calibration), beyond = beyond_range(anode->kvp, calibration);
    double logarithm = 0;
    for (int i = 3; i >= 0; i--)
        logarithm = logarithm * x + f->c[i][0] + v * (f->c[i][1] + v * f->c[i][2]) +
                    w * (f->h[i][0] + w * f->h[i][1]) + beyond * f->e[i];
    const double deeper =
        exp(f->d[0] + f->d[1] * x + (f->d[2] + f->d[3] * x) * v + (f->g[0] + f->g[1] * x) * w);
    return exp(logarithm) * (model == SKG_TUBE_MODEL_BIRCH ? skg_birch_continuum(anode, energy_kev, deeper)
                                                           : skg_ebel_continuum(anode, energy_kev, deeper));
}

double skg_tube_line(const skg_tube_calibration *calibration, const skg_anode *anode, int32_t shell, int line,
                     double *energy_kev) {
    const double *k = calibration->k, *l = calibration->l, *high = calibration->k_high;
    const double w = above_seam(anode->kvp, calibration);
    const double u = skg_ebel_overvoltage(anode, shell) * below_seam(anode->kvp, calibration) / anode->kvp;
    /* The fit begins 6 % above the edge; below, there are hardly any lines. */
    const double t = log(fmax(u - 1, 0.06));
    if (shell == SKG_SHELL_K)
        return exp(k[0] + (k[1] + k[3] * t) * t + (high[0] + high[1] * w) * w) *
               skg_ebel_line(anode, shell, line, exp(k[2] + k[4] * t + high[2] * w), energy_kev);
    *energy_kev = 0;
    if (l[0] == 0) return 0; /* 2 to 3 keV, which no window lets pass */
    return 1e6 * exp(l[0] + (l[1] + l[4] * t) * t) *
           skg_ebel_line(anode, shell, line, exp(l[2] + l[3] * log(fmax(u, 1))), energy_kev);
}
