/* Parts of a dose calculation: the beam at points, photons through the parts, exposure of the detector. Private. */
#ifndef SKG_DOSE_FIGURES_H
#define SKG_DOSE_FIGURES_H

#include "dose/matter.h"
#include "dose/pieces.h"
#include "frame/plans.h"
#include "scatter/beams.h"

#include <skiagraph/dose.h>

/* --- Results */

struct skg_dose {
    skg_refs refs;
    int64_t points, parts;
    skg_dose_point *point; /* [points] */
    skg_dose_part *part;   /* [parts] */
    skg_dose_report report;
};

/* One without figures. */
skg_status skg_dose_make(int64_t points, int64_t parts, skg_dose **dose);

/* --- Air kerma by energy. */

enum { SKG_KERMA_ROWS = 2048 };

/* Of one photon per mm2, uGy, even in ln E from SKG_DOSE_LOWEST_KEV to high_kev. */
typedef struct {
    double high_kev, of[SKG_KERMA_ROWS];
} skg_kerma_table;
void skg_kerma_table_fill(double high_kev, skg_kerma_table *table);
double skg_kerma_at(const skg_kerma_table *table, double kev);

/* --- The beam in the room. */

/* Release it also after a failure. */
typedef struct {
    const skg_recipe *recipe;
    skg_scatter_work work; /* of the recipe, as the beam's profile wants it */
    skg_field field;
    skg_beam_profile profile;
    int32_t parallel, reserved;
    double direction[3]; /* of a parallel beam */
    double normal[3];    /* of the field's plane, along the beam */
    double middle[3];    /* of the field */
    double depth;        /* mm from the source to the field's plane */
    double area;         /* mm2 of the field */
    double photons; /* of the spectrum, per sr, or per mm2 of the plane of the field in a parallel beam */
    skg_material *world; /* NULL: none */
    double high_kev;
    double *kerma; /* [bins] of one photon per mm2, uGy */
} skg_dose_beam;

/* errors   SKG_ERR_BEAM if the number of photons is not known; those of skg_beam_profile_make */
skg_status skg_dose_beam_make(const skg_recipe *recipe, skg_dose_beam *beam);
void skg_dose_beam_free(skg_dose_beam *beam);

/* The way from the source to a place: its direction, and how long it is; of a parallel beam 0. Returns 0 if the field does not reach it. */
int skg_dose_beam_way(const skg_dose_beam *beam, const double place[3], double way[3], double *mm);

/* Where the ray to a place begins: at the source, in its plane, or, of a beam from infinity, before all parts. Returns the distance. */
double skg_dose_beam_begin(const skg_dose_beam *beam, const skg_forest *tree, const double place[3],
                           double from[3]);

/* Air kerma in uGy that the beam would have at a place without the parts; 0 outside the field. */
skg_status skg_dose_beam_kerma(const skg_dose_beam *beam, const double place[3], double *kerma);

/* The integral of air kerma over the field, uGy cm2, before the world. */
double skg_dose_beam_kap(const skg_dose_beam *beam);

/* The energy of all photons of the field, keV. */
double skg_dose_beam_energy(const skg_dose_beam *beam);

/* Half-value layers on the ray to the middle of the field. */
skg_status skg_dose_beam_layers(const skg_dose_beam *beam, double *first, double *second);

/* --- Photons through the parts. */

enum { SKG_DOSE_BATCHES = 32 };

/* A place where scattered kerma is counted. */
typedef struct {
    double at[3];
    int32_t wanted; /* 0: no factor is asked for there */
    int32_t reserved;
} skg_dose_spot;

/* Scores of all photons, each with the standard error from the spread of the batches. */
typedef struct {
    int64_t histories;
    double *energy, *sigma;                                  /* [parts] keV */
    double *kerma, *kerma_sigma;                             /* [points] uGy of scattered photons */
    double incident, escaped, escaped_sigma, absorbed_sigma; /* keV */
    double around;                                           /* keV that stay in the world */
} skg_dose_found;

typedef struct {
    const skg_dose_beam *beam;
    const skg_forest *tree;
    int64_t histories, points;
    int64_t seed;
    const skg_dose_spot *spots; /* [points] */
    skg_progress *progress;
} skg_dose_walk;

/* Why photons cannot be followed through the scene: the sentence of the failure that it would be. */
skg_status skg_dose_walk_check(const skg_recipe *recipe);

/* Free what was found also after a failure. */
skg_status skg_dose_walk_run(const skg_dose_walk *walk, skg_dose_found *found);
void skg_dose_found_free(skg_dose_found *found);

/* --- Masses. */

/* The volume of each part, without those inside it, mm3; of leaky parts NAN; of cells of a volume, times g/cm3.
 *
 * errors   [parts] result: what the volumes may be off by, where parts compete */
skg_status skg_dose_volumes(const skg_recipe *recipe, const skg_forest *tree, skg_progress *progress,
                            double *volumes, double *errors);

/* A box in which the rules may leave parts other volumes than those of their surfaces less those of the parts inside. */
typedef struct {
    double low[3], high[3];
} skg_dose_window;

/* Finds the boxes, the thinnest first. The caller frees *windows. */
skg_status skg_dose_windows_find(const skg_rules *rules, const skg_forest *tree, int64_t *count,
                                 skg_dose_window **windows);

/* Adds to the volumes what the rules make of them in the boxes, each place once, by parallel lines through each box; and to `errors` the
 * squares of what that may be off by. */
skg_status skg_dose_windows_add(const skg_rules *rules, const skg_forest *tree, int64_t count,
                                const skg_dose_window *windows, skg_progress *progress, double *volumes,
                                double *errors);

/* --- Exposure of the detector */

typedef struct {
    double kerma;          /* uGy, mean over the field */
    double exposure_index; /* IEC 62494-1 */
    int32_t has_darkest, reserved;
    int64_t row, column;  /* of the pixel with the least signal */
    double signal, noise; /* there, in the unit of the plan; noise: standard deviation */
    double relative;      /* noise over signal, also of an attenuation */
} skg_dose_receptor;
skg_status skg_dose_receptor_find(skg_plan *plan, const skg_dose_beam *beam, skg_progress *progress,
                                  skg_dose_receptor *receptor);

#endif
