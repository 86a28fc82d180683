/** @file
 * Reports of a plan: its decisions and their reasons, and the findings of its last job. Texts are valid as long as the plan.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_REPORT_H
#define SKIAGRAPH_REPORT_H

#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A channel of a plan's images. The library fills it; prepare with skg_channel_init. */
typedef struct {
    /** Set by skg_channel_init. */
    int32_t size;
    /** 1: without parts, pixels get other values than flat_field, because of falloff, a world, the heel effect, a bow-tie, oblique
     * rays, a grid or jaws. 0: all get flat_field, or the values are ratios to what they get. */
    int32_t uneven;
    /** Name of the channel, such as "energy", "photons from 20 to 40 keV". */
    const char *name;
    /** Unit of its values, such as "keV per pixel". */
    const char *unit;
    /** I0 in this unit: what the beam gives without parts and world, before it is weakened by falloff. 1 for
     * transmission, 0 for attenuation. */
    double flat_field;
} skg_channel;

SKG_INIT(skg_channel)

/** Number of channels of a plan's images. */
SKG_API skg_status skg_plan_channel_count(const skg_plan *plan, int64_t *count);

/** Gets channel 0 <= index < count. */
SKG_API skg_status skg_plan_channel_get(const skg_plan *plan, int64_t index, skg_channel *channel);

/** The plan's decisions, and the findings of its last frame and job. The library fills it; prepare with
 * skg_plan_report_init. */
typedef struct {
    /** Set by skg_plan_report_init. */
    int32_t size;
    /** enum skg_precision */
    int32_t precision;
    /** enum skg_strategy, as chosen */
    int32_t strategy;
    /** enum skg_quantity */
    int32_t quantity;
    /** Number of parts. */
    int64_t parts;
    /** Number of their triangles. */
    int64_t triangles;
    /** Number of the vertices of their meshes, each mesh counted once. */
    int64_t vertices;
    /** Number of leaky parts. Each has planes of its own. */
    int64_t leaky_parts;
    /** Number of planes of which exponents are made. */
    int64_t planes;
    /** Bits of an accumulator: 32 or 64. */
    int64_t plane_bits;
    /** Columns of a tile in pixels, or in rays if one pass makes all rays of a pixel; all of them for
     * SKG_STRATEGY_COPIES and SKG_STRATEGY_ATOMICS. */
    int64_t tile_columns;
    /** Rows of a tile in pixels; likewise. */
    int64_t tile_rows;
    /** Number of tiles. */
    int64_t tiles;
    /** Mean over the tiles of the last frame; 0 before the first. */
    double triangles_per_tile;
    /** Bytes that this plan has allocated on the device. */
    int64_t device_bytes;
    /** Rays per pixel: samples of the source times those of the pixel. */
    int64_t samples;
    /** Change of the image by the last doubling of the samples in adaptive sampling, as a fraction of the flat field; 0: not known. */
    double sample_error;
    /** Pixels of the last frame at which the signed hits of a leaky mesh do not cancel. */
    int64_t bad_pixels;
    /** Pixels of the last frame with a negative exponent. */
    int64_t negative_pixels;
    /** Number of energies that are used. */
    int64_t nodes;
    /** Number of energies at which the spectrum has photons. */
    int64_t bins;
    /** Bound of the error that fewer nodes and planes make, in the sense of skg_plan_options.tolerance: twice
     * the largest that was found; 0 if every bin is used. */
    double bound;
    /** Number of points, each a length of every material, at which the error was computed. */
    int64_t verified;
    /** Bad pixels that were repaired. At the others the part is left out. */
    int64_t repaired_pixels;
    /** Pixels of the last job whose lengths lie outside the range for which the bound was verified. */
    int64_t outside_pixels;
    /** Number of planes that hits are added to. It differs from `planes` where the planes are made
     * afterwards, from one accumulator for all parts of the same material in the same material, because that
     * needs fewer additions. */
    int64_t accumulators;
    /** Values of the last job's images that were not finite, in every channel and sample: more than the
     * precision holds. */
    int64_t infinite_pixels;
} skg_plan_report;

SKG_INIT(skg_plan_report)

/** Gets the report of a plan. */
SKG_API skg_status skg_plan_report_get(const skg_plan *plan, skg_plan_report *report);

/** Amount, error and composition of the scatter of the last frame. The library fills it; prepare with skg_scatter_report_init. */
typedef struct {
    /** Set by skg_scatter_report_init. */
    int32_t size;
    /** Cosines over the detector that the smoothing has kept. */
    int32_t cosines;
    /** Mean over the detector and all channels, in the unit of SKG_OUTPUT_SCATTER. */
    double mean;
    /** Standard error of the mean: root mean square over detector and channels, smoothing included, in the same unit. */
    double sigma;
    /** Photons from the source. */
    int64_t histories;
    /** Wall time, from the cells to the smoothed image. */
    double seconds;
    /** Share of photons with one, two, and three or more interactions; 0 for a frame of a series (scatter_series.h). */
    double orders[3];
    /** Share of Rayleigh scattering alone; the rest had at least one Compton scattering or fluorescence. 0 for a frame of a series. */
    double rayleigh;
    /** Cells along x, y and z. */
    int64_t cells[3];
    /** Greatest relative error of attenuation, angles and fluorescence that four, eight or twelve coefficients for all materials make. */
    double mixture_error;
    /** How far the cells are from the surfaces, by what scatters straight on once, t exp(-t) at an optical depth of t: the sum of the
     * absolute differences over 144 blocks of the detector, over the sum. In the scatter itself 28 rooms were off by .35 to 1.8 of it; it
     * is in the stated error, with the materials instead of coefficients through the surfaces. 0 for a frame of a series, and where a part
     * reaches behind the source. */
    double cells_error;
    /** Parts of `sigma`, in its unit, whose squares add up to its own: that of the number of histories; that of cells and materials,
     * which no number of histories takes away; and what the smoothing may have lost. A frame of a series has them in the first. */
    double errors[3];
} skg_scatter_report;

SKG_INIT(skg_scatter_report)

/** Gets what the scatter of the last frame was.
 *
 *     errors   SKG_ERR_ARGUMENT if the plan has no scatter, or no frame was submitted yet */
SKG_API skg_status skg_plan_scatter_report_get(const skg_plan *plan, skg_scatter_report *report);

/** Estimate of the scatter in a plan's images, from few histories. The library fills it; prepare with
 * skg_scatter_prediction_init. */
typedef struct {
    /** Set by skg_scatter_prediction_init. */
    int32_t size;
    /** 1: without scatter images err by more than skg_plan_options.tolerance; 0: they do not. */
    int32_t called_for;
    /** Scatter over primary in the shadow of the parts: sum over sum of the pixels where the primary is less than 0.99 of the
     * open beam; 0 if there are none. Right to about 15 %. */
    double ratio;
    /** Root mean square of the scatter over the detector, as a fraction of the open beam: the error of images without it. */
    double rms;
    /** Maximum of the scatter over the detector, likewise. */
    double max;
    /** Transmission of the anti-scatter grid for primary radiation, averaged over the detector in this scene instead of behind the
     * phantom of IEC 60627; its selectivity is grid_primary / grid_scatter. 1 without a grid. */
    double grid_primary;
    /** Transmission of the grid for scatter, likewise. */
    double grid_scatter;
    /** Transmission of the grid for primary radiation and scatter together, likewise. */
    double grid_total;
    /** Wall time. */
    double seconds;
} skg_scatter_prediction;

SKG_INIT(skg_scatter_prediction)

/** Predicts the scatter of a plan's scene, view and beam, whether the plan has scatter or not: about 8,000 histories on a
 * detector of at most 64 pixels along each side, with energies as they are measured. Left out are noise, blur, the extent of the source,
 * heel effect, bow-tie filter, oblique response, bands and World. No skg_plan_ call makes it by itself.
 *
 *     errors   those of a plan with scatter that nothing can change: leaky meshes, materials without a composition
 *     stale    SKG_STALE as skg_plan_submit */
SKG_API skg_status skg_plan_scatter_predict(skg_plan *plan, skg_scatter_prediction *prediction);

/** Computes a bound of the error that the precision makes: the rounding of path lengths, exponents and
 * exponentials. It adds to skg_plan_report.bound, the error of fewer energies and planes.
 *
 *     bound    result: of intensities, in the sense of skg_plan_options.tolerance: relative where more than
 *              1e-6 of the flat field arrives, else in units of 1e-6 of the flat field. With the quantity
 *              attenuation, -ln(I/I0), of its error by itself and as a share of the greatest value, whichever
 *              is larger. The rounding of what is shown to float is not part of it.
 *     method   rays from the plan's view to 64 x 64 points of its detector. Each part that a ray meets may
 *              be wrong by what docs/numerics.md states for the precision: a share of its longest path, or
 *              of its extent along the rays where that is more; with SKG_PRECISION_HALF by half a step of
 *              the distance in metres for each surface, and images are rounded, too.
 *              The bound is verified, not proved. At pixels whose ray lies in a face or passes a silhouette
 *              so closely that rounding decides on which side, it holds for a ray that is shifted by 4 units
 *              in the last place of a coordinate. Takes as long as tracing these rays on the host. */
SKG_API skg_status skg_plan_precision_bound_get(const skg_plan *plan, double *bound);

/** Number of energies that a plan uses. */
SKG_API skg_status skg_plan_node_count(const skg_plan *plan, int64_t *count);

/** Gets node 0 <= index < count. Each result may be NULL.
 *
 *     energy_kev   keV
 *     photons      photons per pixel of the flat field that this energy stands for; those of the spectrum if
 *                  every bin is used; 0 if the detector records nothing at this energy
 *     weights      [channels] its contribution to each channel: photons or keV per pixel, or a fraction of
 *                  the flat field for transmission and attenuation
 *
 * With one channel and no noise, these energies and photons are a beam (skg_spectrum_create_bins) of which a
 * plan with tolerance 0 makes the same image, but for the error of fewer planes. A program can so keep its
 * nodes, whatever is planned later. */
SKG_API skg_status skg_plan_node_get(const skg_plan *plan, int64_t index, double *energy_kev, double *photons,
                                     double *weights);

/** An effect that a plan knows. The library fills it; prepare with skg_effect_init. */
typedef struct {
    /** Set by skg_effect_init. */
    int32_t size;
    /** 1: the scene calls for it; 0: absent, and it costs nothing. */
    int32_t on;
    /** Name of the effect, such as "scatter". */
    const char *name;
    /** Why it is on or off. */
    const char *reason;
    /** Estimate of what it adds to a frame, in frames of the same scene without any effect; below 0: what it
     * saves. From counts of operations, so rough. 0 also if its cost is not in the frame. */
    double cost;
} skg_effect;

SKG_INIT(skg_effect)

/** Number of effects that a plan knows. */
SKG_API skg_status skg_plan_effect_count(const skg_plan *plan, int64_t *count);

/** Gets effect 0 <= index < count. */
SKG_API skg_status skg_plan_effect_get(const skg_plan *plan, int64_t index, skg_effect *effect);

/** Two parts that overlap, or a part that leaves its parent, as found when the plan was made. The library
 * fills it; prepare with skg_overlap_init. Method: a grid of 256 x 256 columns along z over the scene, so
 * volumes have its resolution. */
typedef struct {
    /** Set by skg_overlap_init. */
    int32_t size;
    /** 1: the part leaves its parent `other`; 0: they overlap. */
    int32_t protrudes;
    /** Number in the scene. */
    int64_t part;
    /** Number in the scene. */
    int64_t other;
    /** mm3 */
    double volume;
    /** Longest chord along z, mm. */
    double longest;
    /** Middle of that chord, mm. */
    double place[3];
} skg_overlap;

SKG_INIT(skg_overlap)

/** Number of overlaps that were found. */
SKG_API skg_status skg_plan_overlap_count(const skg_plan *plan, int64_t *count);

/** Gets overlap 0 <= index < count, in order of falling volume. */
SKG_API skg_status skg_plan_overlap_get(const skg_plan *plan, int64_t index, skg_overlap *overlap);

/** The time of a stage in the last job that was waited for. The library fills it; prepare with
 * skg_stage_init. */
typedef struct {
    /** Set by skg_stage_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Name of the stage, such as "raster". */
    const char *name;
    /** Time on the device in ns, over all frames of the job. */
    double ns;
} skg_stage;

SKG_INIT(skg_stage)

/** Number of stages that were timed; 0 unless skg_plan_options.profile is 1. */
SKG_API skg_status skg_plan_stage_count(const skg_plan *plan, int64_t *count);

/** Gets stage 0 <= index < count. */
SKG_API skg_status skg_plan_stage_get(const skg_plan *plan, int64_t index, skg_stage *stage);

#ifdef __cplusplus
}
#endif
#endif
