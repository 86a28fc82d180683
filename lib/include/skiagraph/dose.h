/** @file
 * Dose: what a scene gives to people and things. Air kerma at places and over the field, energy that stays in each part, air kerma at the
 * detector and its exposure index, half-value layers of the beam. One exposure of the plan's view.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_DOSE_H
#define SKIAGRAPH_DOSE_H

#include <skiagraph/plan.h>
#include <skiagraph/progress.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Air kerma, absorbed doses and detector exposure of one exposure of a scene. */
typedef struct skg_dose skg_dose;

/** Options of skg_dose_create. Prepare with skg_dose_options_init: 200,000 photons, and air kerma at one place, where the middle ray of
 * the field enters the first part. */
typedef struct {
    /** Set by skg_dose_options_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Photons that are followed through the parts, 1 to 2^40, in 32 batches; 0: none, and doses and backscatter are not known. */
    int64_t histories;
    /** Seed of these photons. The same seed gives the same figures, whatever the number of threads. */
    int64_t seed;
    /** Number of places. 0: one, where the ray to the middle of the field enters the first part; where it meets none, that middle on
     * the detector or, with jaws, on their plane, which a warning says. */
    int64_t point_count;
    /** [point_count][3] mm, world */
    const double *points;
    /** Told of the photons, before them of those of the detector's scatter, and may cancel; NULL: none. */
    skg_progress *progress;
} skg_dose_options;

SKG_INIT(skg_dose_options)

/** Finds the dose of one exposure.
 *
 *     plan      of which scene, view, spectrum, options; nothing of it changes
 *     options   NULL: the defaults
 *     dose      result; the caller releases it
 *     errors    SKG_ERR_BEAM if the number of photons is not known: a tube without mAs, or a parallel beam with them;
 *               SKG_ERR_SCENE if the field reaches no pixel; SKG_ERR_ARGUMENT; SKG_ERR_CANCELLED; those of plans and frames
 *
 * method   Air kerma is that of the beam behind its filters, with heel effect and bow-tie, by the inverse square of the distance from
 *          the middle of the focal spot, times the energy transfer of dry air (skg_quality says how it is known). The world
 *          attenuates on the way. The field is limited as for scatter: by the jaws, or else by the detector's outer edges; outside,
 *          kerma is 0. Photons are followed on the host from surface to surface of the parts, with the physics of skg_scatter; what
 *          they leave is counted in expectation along every flight, and errors are from the spread of 32 batches. Electrons stay
 *          where they are set free, bremsstrahlung is left out. The detector stops photons. Kerma, signal and index of the detector
 *          have scatter if the plan has. */
SKG_API skg_status skg_dose_create(skg_plan *plan, const skg_dose_options *options, skg_dose **dose);

/** Adds up exposures of one scene: the projections of a scan, the frames of a film.
 *
 *     count       number of exposures, at least 1
 *     exposures   [count], with the same parts and the same places (skg_dose_options.points)
 *     times       [count] how many exposures each stands for, at least 0; NULL: 1
 *     sum         result; the caller releases it
 *     errors      SKG_ERR_ARGUMENT
 *
 * method   Kerma, area product, energies and doses add, errors as their squares. A backscatter factor is that of all the kerma together, and
 *          not known where it is not of one of them. Half-value layers are those of the first exposure. Of several there is neither an
 *          exposure index nor a darkest pixel. */
SKG_API skg_status skg_dose_sum(int64_t count, skg_dose *const *exposures, const double *times,
                                skg_dose **sum);

/** Adds an owner, who releases it. */
SKG_API skg_status skg_dose_retain(skg_dose *dose);

/** Releases the handle, and sets it to NULL. */
SKG_API void skg_dose_release(skg_dose **dose);

/** Figures of beam and detector. The library fills it; prepare with skg_dose_report_init. */
typedef struct {
    /** Set by skg_dose_report_init. */
    int32_t size;
    /** 1: photons were followed. 0: none were asked for, or the scene does not let them: a volume of attenuation coefficients, a mesh that
     * is not closed, a material of unknown composition or density; a warning said which. */
    int32_t followed;
    /** Kerma-area product of the field, uGy cm2: air kerma over an area across the middle ray of the field. It is the same at each
     * distance. Without what the world attenuates. */
    double kap_ugy_cm2;
    /** Air kerma at the detector behind the parts and the grid, mean over the pixels of the field, uGy. What is scattered is counted
     * as if it came straight. */
    double detector_air_kerma_ugy;
    /** Exposure index of IEC 62494-1: 100 per uGy times the air kerma of RQA5 (70 kV, 23.5 mm Al) that gives the median signal of the
     * middle tenth of the field. NAN: the response of the detector does not know these energies. */
    double exposure_index;
    /** First half-value layer of air kerma on the ray to the middle of the field, mm of aluminium. */
    double hvl1_mm_al;
    /** Second one. */
    double hvl2_mm_al;
    /** Photons that were followed. */
    int64_t histories;
    /** Energy of the field's photons, keV. */
    double incident_kev;
    /** Energy of those that leave the parts, scattered or not, keV. */
    double escaped_kev;
    /** Energy that stays in the world, keV. */
    double world_kev;
    /** Standard error of incident_kev less what escapes and what stays anywhere: the balance, which is 0 but for it. */
    double balance_sigma_kev;
    /** 1: the plan has noise and one channel, and the five fields that follow are known. */
    int32_t has_darkest;
    /** 1: the detector's figures have scatter. */
    int32_t scattered;
    /** The pixel of the field with the least signal. */
    int64_t darkest_row;
    /** Column of this pixel. */
    int64_t darkest_column;
    /** The mean there, in the plan's quantity. */
    double darkest_signal;
    /** Signal over noise there: mean over standard deviation; of an attenuation, that of the transmission. */
    double darkest_snr;
    /** Wall time. */
    double seconds;
} skg_dose_report;

SKG_INIT(skg_dose_report)

/** Gets the figures of beam and detector. */
SKG_API skg_status skg_dose_report_get(const skg_dose *dose, skg_dose_report *report);

/** Air kerma at a place. The library fills it; prepare with skg_dose_point_init. */
typedef struct {
    /** Set by skg_dose_point_init. */
    int32_t size;
    /** 1: the field reaches the place; 0: it does not, or the beam begins behind it, and kerma is 0. */
    int32_t in_field;
    /** mm, world */
    double at[3];
    /** Free in air: as if the parts were not there, uGy. */
    double air_kerma_ugy;
    /** Backscatter factor: air kerma with what the parts scatter over air kerma free in air. NAN: photons were not followed, the
     * place is outside the field, or parts stand between it and the source. Interactions nearest to the
     * place count as they do on average there. */
    double backscatter;
    /** Standard error of the backscatter factor. */
    double backscatter_sigma;
} skg_dose_point;

SKG_INIT(skg_dose_point)

/** Number of places. */
SKG_API skg_status skg_dose_point_count(const skg_dose *dose, int64_t *count);

/** Gets place 0 <= index < count, in the order of the options. */
SKG_API skg_status skg_dose_point_get(const skg_dose *dose, int64_t index, skg_dose_point *point);

/** Energy and dose that a part absorbs. The library fills it; prepare with skg_dose_part_init. */
typedef struct {
    /** Set by skg_dose_part_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Mean absorbed dose: energy over mass, uGy. NAN: photons were not followed, or the part has no mass. */
    double dose_ugy;
    /** Standard error of dose_ugy, uGy. NAN likewise, and where no photon came near the part. */
    double sigma_ugy;
    /** Energy that stays in the part, without those that lie inside it, keV. NAN as dose_ugy. */
    double energy_kev;
    /** Mass without what lies inside it, g. NAN: its mesh is not closed, or its density is not known. */
    double mass_g;
} skg_dose_part;

SKG_INIT(skg_dose_part)

/** Gets energy and dose of part 0 <= part < number of parts of the scene. */
SKG_API skg_status skg_dose_part_get(const skg_dose *dose, int64_t part, skg_dose_part *result);

#ifdef __cplusplus
}
#endif
#endif
