/* One photon at a time on the host, and what a batch of them gave. Private. */
#ifndef SKG_DOSE_PHOTONS_H
#define SKG_DOSE_PHOTONS_H

#include "dose/figures.h"

/* Photons of fluorescence and annihilation that wait for the one that is followed. */
enum { SKG_DOSE_WAITING = 16 };

/* The ray to a place where backscatter is asked for, in the plane of the field. */
typedef struct {
    double place[2]; /* mm from the field's centre along its column and row */
    double radius;   /* within which the density of photons stays the same */
} skg_dose_aim;

/* Data that all batches share and only read. */
typedef struct {
    const skg_dose_walk *walk;
    skg_rules rules;
    int64_t matter_count;
    skg_dose_matter *matter; /* [matter_count] each material once */
    int32_t *of_part;        /* [parts] number of its matter; of a volume, of its first curve */
    int32_t of_world;        /* -1: none */
    int32_t reserved;
    int64_t aim_count;
    skg_dose_aim *aims; /* [aim_count] */
    double reach;       /* mm: the field's diagonal */
    double *bins;       /* [bins] share of the photons up to each */
    skg_kerma_table kerma;
    double low[3], high[3]; /* the box of source and parts, beyond which nothing is met */
} skg_dose_hall;

typedef struct {
    double at[3], direction[3];
    double kev, weight;
} skg_dose_photon;

/* State and scores of a batch. Energies in keV, of photons of weight 1; kerma in uGy likewise. */
typedef struct {
    const skg_dose_hall *hall;
    uint64_t seed;
    skg_way way, sight; /* of the photon; to the points */
    skg_dose_photon waiting[SKG_DOSE_WAITING];
    int32_t waiting_count, reserved;
    double *energy; /* [parts] */
    double *kerma;  /* [points] */
    double incident, escaped, around;
} skg_dose_batch;

/* Finds the rays to the places where backscatter is asked for. */
skg_status skg_dose_aims_find(skg_dose_hall *hall);

/* Draws a photon of the beam, with the weight of all those that it stands for. Returns 0 for one that the jaws stop. */
int skg_dose_emit(const skg_dose_hall *hall, uint64_t *seed, skg_dose_photon *photon);

/* Follows one photon of the beam and all that it sets free. */
skg_status skg_dose_follow(skg_dose_batch *batch);

/* Adds what an interaction sends to the points, in expectation. in: what is at the place of the photon; is_first: it came straight
 * from the source */
skg_status skg_dose_send(skg_dose_batch *batch, const skg_dose_photon *photon, const skg_presence *in,
                         const skg_dose_meeting *meeting, int is_first);

/* The matter of a presence; NULL: nothing is met there. */
static inline const skg_dose_matter *skg_dose_matter_of(const skg_dose_hall *hall,
                                                        const skg_presence *presence) {
    const int32_t number =
        presence->part < 0 ? hall->of_world : hall->of_part[presence->part] + presence->curve;
    return number < 0 || !hall->matter[number].material ? NULL : &hall->matter[number];
}

#endif
