/* Tables of a frame's photons as the device has them. Private. */
#ifndef SKG_SCATTER_TABLES_H
#define SKG_SCATTER_TABLES_H

#include "scatter/beam_profile.h"

typedef struct {
    float (*energies)[SKG_SCATTER_RANK]; /* [energies][SKG_SCATTER_COLUMNS] */
    float (*momenta)[SKG_SCATTER_RANK];  /* [momenta][2] S, F^2 */
    float *angles;                       /* [SKG_ANGLE_ROWS][SKG_SCATTER_ANGLES + 1] */
    float (*beam)
        [4]; /* [bins] keV, share of the photons that are followed up to here, weight, 1/mm of a bow-tie filter */
    int64_t bins;
    skg_beam_profile profile;
    float *profiles; /* [profile_count] as kernels/profile.clh has them; NULL: none */
    int64_t profile_count;
    float *
        detector; /* [detector_count] as kernels/scatter.cl has it; NULL: neither bands, nor layers, nor oblique */
    int64_t detector_count;
    int32_t bands, layers, cosines, oblique; /* images of a frame; of the table of layers: 0: none */
    double photons;                          /* of the spectrum, those that leave towards the field */
    double signal, variance;                 /* what 1 in the columns of what a photon adds stands for */
} skg_scatter_tables;

/* More photons are followed of energies that add more to the image. Free the tables also after a failure. */
skg_status skg_scatter_tables_make(const skg_scatter_work *work, const skg_scatter_object *object,
                                   skg_scatter_tables *tables);
void skg_scatter_tables_free(skg_scatter_tables *tables);

#endif
