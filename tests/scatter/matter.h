/* Interactions of photons in a material, in tables that are even in energy and in the root of the momentum transfer. */
#ifndef SKG_TESTS_SCATTER_MATTER_H
#define SKG_TESTS_SCATTER_MATTER_H

#include <stdint.h>

enum { MATTER_ENERGIES = 4000, MATTER_MOMENTA = 4000, MATTER_NORMS = 200 };

/* Photons below are forgotten. */
#define MATTER_LOWEST_KEV 2.0

/* Of annihilation. */
#define MATTER_ANNIHILATION_KEV 510.99895

typedef struct {
    double kev, momentum;              /* the greatest, keV and 1/Angstrom */
    double total[MATTER_ENERGIES + 1]; /* 1/mm */
    double compton[MATTER_ENERGIES + 1], rayleigh[MATTER_ENERGIES + 1],
        pairs[MATTER_ENERGIES + 1];        /* shares of the total */
    double incoherent[MATTER_MOMENTA + 1]; /* over its greatest value; of rows even in the root */
    double coherent[MATTER_MOMENTA + 1];   /* likewise */
    double sum[MATTER_MOMENTA + 1];        /* of `coherent` over the square of the momentum, from 0 on */
    /* of the chances below, over the cosine */
    double compton_norm[MATTER_NORMS + 1], rayleigh_norm[MATTER_NORMS + 1];
} matter;

/* material: of skg_material_create_named; density: g/cm3; 0: its own */
void matter_make(const char *material, double density, double kev, matter *m);

double matter_at_energy(const double *table, const matter *m, double kev);

/* Energy after Compton scattering over that before. */
double matter_ratio(double kev, double cosine);

/* Probability of an angle, by the cosine: its integral from -1 to 1 is 1. */
double matter_compton(const matter *m, double kev, double cosine);
double matter_rayleigh(const matter *m, double kev, double cosine);

/* Draws the cosine. */
double matter_draw(const matter *m, double kev, int is_compton, uint64_t *seed);

/* A direction of length 1, all alike. */
void matter_anywhere(double way[3], uint64_t *seed);

/* Turns a direction of length 1. */
void matter_turn(double way[3], double cosine, double azimuth);

#endif
