/* Birch and Marshall's continuum: R. Birch, M. Marshall, Computation of bremsstrahlung X-ray spectra and
 * comparison with spectra measured with a Ge(Li) detector, Phys. Med. Biol. 24 (1979) 505-517.
 *
 * Electrons slow down by the Thomson-Whiddington law T0^2 - T^2 = b x. At each depth x (g/cm2) they radiate with the
 * cross section (1 + mc2/T) Q(E/T) / E, where Q is a polynomial, and the target absorbs along x cot(angle).
 * calibration.c multiplies x by a factor. */
#include "beam/spectrum.h"
#include "core/maths.h"
#include "material/material.h"

#include <math.h>

/* Of Simpson's rule over the energy T of the electron; an even number. The integrand is smooth. */
enum { STEPS = 64 };

/* Rest energy of the electron in keV, as the publication has it. */
static const double REST_KEV = 510.999;

static double radiated(const skg_anode *anode, double energy_kev, double t, double absorbed_per_depth,
                       double b) {
    /* Coefficients of Q and the constants of b are those of the publication. */
    static const double q[5] = {0.503, -0.946, 0.155, 1.163, -0.682};
    double r = energy_kev / t, sum = 0;
    for (int i = 4; i >= 0; i--) sum = sum * r + q[i];
    double depth = (anode->kvp * anode->kvp - t * t) / b;
    /* dx = 2 T dT / b */
    return sum * (1 + REST_KEV / t) * 2 * t / b * exp(-absorbed_per_depth * depth);
}

double skg_birch_continuum(const skg_anode *anode, double energy_kev, double deeper) {
    double kv = anode->kvp, sections[SKG_PROCESSES];
    if (!(energy_kev < kv)) return 0;
    double b = (0.0029 * kv + 0.41) * 1e6; /* keV2 cm2/g */
    double angle = anode->angle_deg * (SKG_PI / 180);
    skg_element_sections(anode->z, energy_kev, sections);
    double per_depth = deeper * skg_total_section(sections) / tan(angle), h = (kv - energy_kev) / STEPS;
    double sum =
        radiated(anode, energy_kev, energy_kev, per_depth, b) + radiated(anode, energy_kev, kv, per_depth, b);
    for (int i = 1; i < STEPS; i++)
        sum += (i % 2 ? 4 : 2) * radiated(anode, energy_kev, energy_kev + i * h, per_depth, b);
    return sum * h / 3 / energy_kev;
}
