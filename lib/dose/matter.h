/* Interactions of photons in each material, for histories on the host. Private. */
#ifndef SKG_DOSE_MATTER_H
#define SKG_DOSE_MATTER_H

#include "scatter/interactions.h"

/* One material, by the tables of scatter (interactions.h), which are exact for it alone. */
typedef struct {
    skg_material *material; /* borrowed; NULL: nothing, which is met by no photon */
    skg_emitters emitters;
    skg_scatter_physics physics;
    /* [energies] keV/mm that stay where photons interact: of electrons, less the photons that are emitted */
    double *transfer;
    double *coherent; /* [momenta] integral of F^2 over the square of the momentum transfer */
} skg_dose_matter;

/* The lowest energy that is followed; a photon below leaves all of it where it is. */
#define SKG_DOSE_LOWEST_KEV 1.0

/* high_kev: of the beam. Free the matter also after a failure. */
skg_status skg_dose_matter_make(skg_material *material, int32_t fluorescence, double high_kev,
                                skg_dose_matter *matter);
void skg_dose_matter_free(skg_dose_matter *matter);

/* Where an energy stands in the tables. */
typedef struct {
    int64_t row;
    double share; /* of the way to the next row */
} skg_dose_place;
skg_dose_place skg_dose_place_of(const skg_dose_matter *matter, double kev);

/* Cross sections of the interactions at an energy, in 1/mm, and `transfer` in keV/mm; the shapes normalise the distributions of angles. */
typedef struct {
    double total, compton, rayleigh, emitted, transfer;
    double compton_shape, rayleigh_shape;
} skg_dose_meeting;
double skg_dose_total(const skg_dose_matter *matter, skg_dose_place place);
double skg_dose_transfer(const skg_dose_matter *matter, skg_dose_place place);
skg_dose_meeting skg_dose_meet(const skg_dose_matter *matter, double kev);

/* How likely a photon that interacts is scattered to an angle, per sr: by Compton scattering, which leaves *left keV, and by Rayleigh
 * scattering. */
void skg_dose_scattered(const skg_dose_matter *matter, const skg_dose_meeting *meeting, double kev,
                        double cosine, double *compton, double *rayleigh, double *left);

/* Draws the cosine of such an angle. */
double skg_dose_draw_compton(const skg_dose_matter *matter, double kev, uint64_t *seed);
double skg_dose_draw_rayleigh(const skg_dose_matter *matter, double kev, uint64_t *seed);

/* Emission of a shell at a place of the tables, 1/mm, and the energy of one of its lines, keV, drawn. */
double skg_dose_emitted(const skg_dose_matter *matter, skg_dose_place place, int64_t shell);
double skg_dose_draw_line(const skg_dose_matter *matter, int64_t shell, uint64_t *seed);

#endif
