/* Ebel's model of a reflection target: H. Ebel, X-ray tube spectra, X-Ray Spectrom. 28 (1999) 255-266.
 *
 * All constants are those of the publication, for a continuum and K lines per mAs and steradian; calibration.c
 * calibrates both, and the L lines, for which this file has the overvoltage's function alone. */
#include "beam/spectrum.h"
#include "core/maths.h"
#include "material/material.h"
#include "material/shells.h"

#include <math.h>

/* The solid angle of one mm2 at 1 m, steradian. */
static const double MM2_AT_1M = 1e-6;

/* The mean depth in g/cm2 at which photons are made. u: overvoltage, the tube voltage over the energy of the
 * photon or the edge. */
static double mean_depth(const skg_anode *anode, double u) {
    double z = anode->z, kv = anode->kvp, j = 0.0135 * z; /* mean ionisation energy, keV */
    double lz = log(z), lu = log(u);
    double m = 0.1382 - 0.9211 / sqrt(z);
    double eta = pow(kv, m) * (0.1904 - 0.2236 * lz + 0.1292 * lz * lz - 0.0149 * lz * lz * lz);
    double deepest =
        skg_elements[anode->z].weight / z * (0.787e-5 * sqrt(j) * pow(kv, 1.5) + 0.735e-6 * kv * kv);
    return deepest * lu * (0.49269 - 1.0987 * eta + 0.78557 * eta * eta) /
           (0.70256 - 1.09865 * eta + 1.0046 * eta * eta + lu);
}

/* The share of the photons made in the target that leave it: (1 - exp(-chi)) / chi. The electrons arrive at 90
 * degrees less the angle of the anode, and the photons leave at that angle. */
static double escape(const skg_anode *anode, double energy_kev, double u, double deeper) {
    double sections[SKG_PROCESSES], angle = anode->angle_deg * (SKG_PI / 180);
    skg_element_sections(anode->z, energy_kev, sections);
    double chi = 2 * sections[SKG_PHOTO] * deeper * mean_depth(anode, u) * cos(angle) / sin(angle);
    /* Below 1e-8 the share is 1 in double precision, and 0/0 is avoided. */
    return chi < 1e-8 ? 1 : -expm1(-chi) / chi;
}

double skg_ebel_continuum(const skg_anode *anode, double energy_kev, double deeper) {
    double u = anode->kvp / energy_kev;
    if (!(u > 1)) return 0;
    double x = 1.109 - 0.00435 * anode->z + 0.00175 * anode->kvp;
    return 1.35e9 * MM2_AT_1M * anode->z * pow(u - 1, x) * escape(anode, energy_kev, u, deeper);
}

double skg_ebel_overvoltage(const skg_anode *anode, int32_t shell) {
    const skg_shell_row *row = skg_shell_lines(anode->z, shell);
    return row ? anode->kvp / row->edge_kev : 0;
}

/* Vacancies times their yield, without calibration for L. */
static double excited(const skg_anode *anode, const skg_shell_row *row, int32_t shell) {
    double z = anode->z, kv = anode->kvp, u = kv / row->edge_kev, j = 0.0135 * z;
    double stopping = u * log(u) + 1 - u; /* of the inverse stopping power */
    if (shell == SKG_SHELL_L) return stopping;
    double inverse =
        2 * 0.35 / z * stopping * /* 2 electrons and a shell factor of 0.35 */
        (1 + 16.05 * sqrt(j / row->edge_kev) * (sqrt(u) * log(u) + 2 * (1 - sqrt(u))) / stopping);
    double backscatter = 1 - 0.0081517 * z + 3.613e-5 * z * z + 0.009583 * z * exp(-u) + 0.001141 * kv;
    return 5e13 * MM2_AT_1M * inverse * backscatter * row->yield;
}

double skg_ebel_line(const skg_anode *anode, int32_t shell, int line, double deeper, double *energy_kev) {
    const skg_shell_row *row = skg_shell_lines(anode->z, shell);
    *energy_kev = row ? row->line_kev[line] : 0;
    if (!row || !(row->share[line] > 0) || !(anode->kvp > row->edge_kev)) return 0;
    return excited(anode, row, shell) * row->share[line] *
           escape(anode, row->line_kev[line], anode->kvp / row->edge_kev, deeper);
}
