/* Frees the tables of what photons may meet in materials. */
#include "scatter/interactions.h"

void skg_scatter_physics_free(skg_scatter_physics *physics) {
    skg_free(&physics->total);
    skg_free(&physics->compton);
    skg_free(&physics->rayleigh);
    skg_free(&physics->compton_shape);
    skg_free(&physics->rayleigh_shape);
    skg_free(&physics->incoherent);
    skg_free(&physics->coherent);
    skg_free(&physics->coefficients);
    skg_free(&physics->emission);
    physics->shells = physics->energies = physics->momenta = physics->materials = 0;
}
