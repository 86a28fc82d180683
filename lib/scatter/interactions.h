/* Interactions of photons: shapes, cross sections, angles. Private. */
#ifndef SKG_INTERACTIONS_H
#define SKG_INTERACTIONS_H

#include "core/core.h"

#include "material/shells.h"
#include "skg_shared.h"

#include <skiagraph/material.h>
#include <skiagraph/options.h>

#include <math.h>

/* --- Emission: photons in any direction where another is absorbed. *
 * Fluorescence: lines of a shell after photo absorption (K and L shells; yields and shares of materials/k_lines.txt and l_lines.txt).
 * Annihilation: two photons of 511 keV, back to back, for each pair, of all elements together. The positron stops where it was made. Each
 * of the two flies in any direction with the same chance, so that a mean asks for no more than two photons in any direction. */

typedef struct {
    /* deeper: of L, the K shell, whose K alpha leaves vacancies there; has_deeper: it is known */
    skg_shell shell, deeper;
    int32_t has_deeper, pairs;         /* 1: annihilation, which has no shell */
    double photons;                    /* per vacancy, of the lines that are followed; per pair */
    float lines[SKG_SCATTER_LINES][2]; /* share of the photons up to this one, keV */
} skg_emitter;

/* All zero: none. */
typedef struct {
    int64_t count;
    skg_emitter *of;   /* [count] */
    double lowest_kev; /* photons are followed down to here */
} skg_emitters;

/* Finds what matters: its edge is in the beam, and it emits 1e-4 of what interacts in some material or more.
 *
 * fluorescence   enum skg_fluorescence; by default of elements from Z = 30 on. Annihilation does not ask for it
 * low_kev        lines below it are left out
 * high_kev       of the beam
 *
 * Free the result also after a failure. */
skg_status skg_emitters_find(int64_t count, skg_material *const *materials, int32_t fluorescence,
                             double low_kev, double high_kev, skg_emitters *emitters);
void skg_emitters_free(skg_emitters *emitters);

/* --- Interactions of photons: attenuation and the angles of scattering, for mixtures of all materials of a scene. *
 * A cell of the object holds four, eight or twelve coefficients. Every function of energy or of momentum transfer is linear in them: mu of a cell
 * is the sum over k of coefficient[k] * total[energy][k]. A cell without matter has zeros. With at most as
 * many compositions each coefficient is the length of one composition, and the functions are exact. With more, they are a
 * joint basis fitted to all functions of all materials (smoothing.h), whose error is measured. From 15 to 120 keV the total
 * of 12 tissues is right within 0.1 % and their distributions of angles within 0.3 %; with steel and iodine beside them
 * within 1.5 % (steel; tissues 0.8 %) and 9 % (Rayleigh of bone).
 *
 * Interactions are photo absorption, Compton and Rayleigh scattering, and pair production from 1,022 keV on. Their
 * numbers are XCOM's, the same as the primary's. Angles are distributed like Klein and Nishina's cross section
 * times S, and like Thomson's times F^2, of free atoms (material/scattering.h). */

enum { SKG_SCATTER_RANK = 12, SKG_SCATTER_FOUR = 4 }; /* the most coefficients; they are taken in fours */
typedef float skg_mixture[SKG_SCATTER_RANK];

typedef struct {
    int32_t rank, reserved; /* coefficients that are not always 0: 4, 8 or 12 */
    /* Points even in ln E from low_kev to high_kev. Tables are linear between them. */
    int64_t energies;
    double low_kev, high_kev;
    /* [energies] 1/mm per coefficient; total: photo + Compton + Rayleigh + pairs. With more compositions than coefficients Compton
     * + Rayleigh may exceed the total within the errors. */
    skg_mixture *total, *compton, *rayleigh;
    /* [energies] 1/mm per coefficient: integrals over the sphere of klein_nishina(E, theta) * incoherent(x) and of
     * (1 + cos^2 theta) / 2 * coherent(x). They normalise the distributions of angles. */
    skg_mixture *compton_shape, *rayleigh_shape;
    /* Points even in ln(1 + x / momentum_scale) from x = 0 to momentum_high, that of a photon of high_kev turned back,
     * 1/Angstrom. Tables are linear between them. */
    int64_t momenta;
    double momentum_scale, momentum_high;
    /* [momenta] 1/mm per coefficient: r_e^2 times the number of atoms per volume times S and times F^2. */
    skg_mixture *incoherent, *coherent;
    int64_t shells; /* that emit; annihilation counts as one */
    /* [energies][shells] photons per mm and coefficient that a photon's absorption emits */
    skg_mixture *emission;
    int64_t materials;
    double (*coefficients)[SKG_SCATTER_RANK]; /* [materials] of 1 mm of each at its density, per mm */
    /* The greatest relative error over the materials of total, Compton and Rayleigh at the energies; and of these and of both
     * distributions of angles (integral of the absolute difference over the integral). At least 1e-6, for the
     * rounding of floats. Interpolation is apart: below 2e-4 away from edges. */
    double attenuation_error, error;
    /* the greatest difference of what a material emits over the most that any does, of lines and of annihilation; in `error`, too */
    double emission_error;
} skg_scatter_physics;

/* Makes the tables.
 *
 * materials   [count] at their densities
 * emitters    of these materials; NULL: none
 * low_kev     of the photons that are tracked, >= 1
 * errors      SKG_ERR_MATERIAL for a material without composition or density, below 1 keV or above 20 MeV; SKG_ERR_ARGUMENT
 *             unless low_kev < high_kev */
skg_status skg_scatter_physics_make(int64_t count, skg_material *const *materials,
                                    const skg_emitters *emitters, double low_kev, double high_kev,
                                    skg_scatter_physics *physics);
/* Fills what mixtures emit, for the coefficients that the materials have: by least squares, exact if there are no more compositions than
 * coefficients. */
skg_status skg_emission_make(int64_t count, skg_material *const *materials, const skg_emitters *emitters,
                             skg_scatter_physics *physics);
void skg_scatter_physics_free(skg_scatter_physics *physics);

/* The energy of a point in keV. */
static inline double skg_scatter_energy(const skg_scatter_physics *physics, int64_t point) {
    return physics->low_kev *
           exp(log(physics->high_kev / physics->low_kev) * (double)point / (double)(physics->energies - 1));
}

/* The momentum transfer of a point in 1/Angstrom. */
static inline double skg_scatter_momentum(const skg_scatter_physics *physics, int64_t point) {
    const double range = log1p(physics->momentum_high / physics->momentum_scale);
    return physics->momentum_scale * expm1(range * (double)point / (double)(physics->momenta - 1));
}

/* --- Integrals over the sphere of the distributions of angles. */

/* Klein and Nishina's cross section of a free electron per solid angle, in r_e^2. cosine: of the angle of scattering */
double skg_klein_nishina(double kev, double cosine);

/* Thomson's, likewise. */
double skg_thomson(double cosine);

/* The weights of the momenta's points in the integral over the sphere at an energy: the sum of weight[i] * table[i]
 * is the integral of cross_section * table, where the table is linear between its points.
 *
 * compton, rayleigh   [momenta]
 * returns             the number of points up to the momentum transfer of a photon that is turned back; the weights of the
 *                     others are not set */
int64_t skg_shape_weights(const skg_scatter_physics *grid, double kev, double *compton, double *rayleigh);

/* --- A table of angles of scattering from which photons are sent on. */

enum { SKG_ANGLE_ROWS = 48 };

/* Fills table [SKG_ANGLE_ROWS][SKG_SCATTER_ANGLES + 1], rising cosines between which scattering is equally likely, for energies
 * even in ln E. The distribution is the mean of that of `mixture` and those of all materials, so that no material's own
 * is far above it; weights of photons make good for the difference. mixture: coefficients, with all 0 not counted. */
skg_status skg_angles_make(const skg_scatter_physics *physics, const double mixture[SKG_SCATTER_RANK],
                           float *table);

/* --- A joint basis for columns of numbers. *
 * Tissues differ little, and a material that is another one with a different density does not differ at all. Every
 * column is written as a mixture of SKG_SCATTER_RANK columns, so that relative errors are small: each row is fitted to all
 * materials by least squares of (mixture - value) / value, and so are the coefficients of each material, alternately.
 * The coefficients of the SKG_SCATTER_RANK materials that differ most are 1 and 0s, which loses nothing, because
 * a basis is only defined up to a linear map. */

/* most           the rank at most, up to SKG_SCATTER_RANK
 * weight         [rows] of a relative error in the search for coefficients
 * columns        [count][rows] values > 0, or 0 in a row where all are
 * coefficients   [count]
 * basis          [rows]
 *
 * With at most `most` columns that are no multiples of each other the result is exact. */
skg_status skg_reduce(int32_t most, int64_t count, int64_t rows, const double *weight, const double *columns,
                      double (*coefficients)[SKG_SCATTER_RANK], double (*basis)[SKG_SCATTER_RANK]);

#endif
