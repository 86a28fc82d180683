/** @file
 * Options of a plan: precision, quantity, source, detector, repair, tolerances.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_OPTIONS_H
#define SKIAGRAPH_OPTIONS_H

#include <skiagraph/beam.h>
#include <skiagraph/blur.h>
#include <skiagraph/collimation.h>
#include <skiagraph/counting.h>
#include <skiagraph/scatter.h>
#include <skiagraph/source.h>
#include <skiagraph/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How hits are added to pixels. Every strategy gives the same bits. */
enum skg_strategy {
    /** The plan chooses for the device and the scene. */
    SKG_STRATEGY_AUTO = 0,
    /** Each worker adds to a detector of its own. */
    SKG_STRATEGY_COPIES = 1,
    /** Triangles are sorted into tiles of the detector. */
    SKG_STRATEGY_TILES = 2,
    /** All workers add to one detector by atomic operations. */
    SKG_STRATEGY_ATOMICS = 3
};

/** Repair of the bad pixels of a leaky mesh, where a ray does not leave the mesh as often as it enters
 * it.
 *
 * A ray that enters through one hole and leaves through another is not bad by this count: NEIGHBOURS cannot
 * detect it and leaves the part out there; EXACT can. */
enum skg_repair {
    /** The part is left out at its bad pixels. */
    SKG_REPAIR_NONE = 0,
    /** The part's path parameters are the mean over the pixel's neighbourhood, which grows until it contains
     * valid pixels (Vidal and Villard 2016, section 3.2.7). Without any valid pixel the part is left out. */
    SKG_REPAIR_NEIGHBOURS = 1,
    /** The ray is traced again on the host, in double precision, through the mesh with every loop of open
     * edges closed by a fan about the loop's mean; so is every ray that passes such a cap. Cracks are bridged
     * first, up to .002 of the diagonal of the box of all open edges and a quarter of their mean length: plane
     * patches that nobody welded are one surface. Exact if the loops are plane: missing triangles, plane holes,
     * cracks at T-junctions, single inverted triangles. Otherwise it is one of many possible surfaces; a warning
     * tells of pieces that then enclose nothing. Submitting waits until the leaky parts are rastered. */
    SKG_REPAIR_EXACT = 2
};

/** Options of a plan. Prepare with skg_plan_options_init: single precision, energy per pixel, every energy of
 * the spectrum, point source, ideal detector, no noise. Arrays and structs that it points to are copied by
 * skg_plan_create, handles are retained. */
typedef struct {
    /** Set by skg_plan_options_init. */
    int32_t size;
    /** enum skg_precision; SKG_PRECISION_HALF needs closed meshes */
    int32_t precision;
    /** enum skg_strategy */
    int32_t strategy;
    /** enum skg_quantity */
    int32_t quantity;
    /** Rows of a band, or side of a square tile, in pixels; 0: the plan chooses. */
    int32_t tile;
    /** 1: time the stages of each job, which makes frames a little slower. */
    int32_t profile;
    /** 0 (default): every energy of the spectrum, one plane per material. Above 0 to below 1: the error that
     * fewer energies and planes may make. It is relative where more than 1e-6 of the flat field arrives, and
     * in units of 1e-6 of the flat field where less does. It holds for the path lengths that the plan's views
     * meet and for a quarter more, and with noise for the variance too. */
    double tolerance;
    /** Number of further views, 0 to 1024. */
    int64_t view_count;
    /** [view_count] a sample of the views that frames will have, so that the error bound of `tolerance` holds
     * for them too. Without effect if tolerance is 0. */
    const skg_view *views;
    /** 1 (default): find parts that overlap or leave their parent, and warn. 0: do not look. */
    int32_t overlaps;
    /** enum skg_repair, for leaky meshes; SKG_REPAIR_NEIGHBOURS by default */
    int32_t repair;
    /** 1: a part counts only inside its parent. 0 (default): where it leaves its parent, the parent's
     * attenuation is subtracted. */
    int32_t clip;
    /** 1: of a closed mesh whose components overlap, or whose triangles are listed more than once, the lengths are those of the union
     * of what it encloses: where the winding number is above 0. The hits of all closed parts are listed, which costs what priorities
     * cost. The lengths SKG_LENGTHS_SURFACE stay sums, and there are no derivatives. 0 (default): lengths of components add, and a warning names them. */
    int32_t unite;
    /** Around the parts; NULL: vacuum. */
    skg_material *world;
    /** enum skg_falloff; SKG_FALLOFF_AUTO by default */
    int32_t falloff;
    /** n x n rays per pixel, at the middles of its n x n pieces; 1 (default) to 16. The reason of the effect
     * "supersampling" says whether one pass makes all of them or each has a pass of its own. */
    int32_t supersampling;
    /** The focal spot; NULL: a point. Without effect in a parallel beam. */
    const skg_spot *spot;
    /** The heel effect; NULL: the spectrum is the same everywhere. Without effect in a parallel beam, and on
     * ratios to the flat field of one energy. */
    const skg_heel *heel;
    /** A bow-tie filter at the source; NULL: none. Without effect in a parallel beam, and on ratios to the flat
     * field of one energy. */
    const skg_bowtie *bowtie;
    /** Jaws in the beam; NULL: nothing limits it. */
    const skg_collimation *collimation;
    /** enum skg_band_weight, of transmission and attenuation of bands; SKG_BAND_WEIGHT_PHOTONS by default */
    int32_t band_weight;
    /** 1: the path through the layer of the response grows with the angle of a ray to the detector's normal. 0
     * (default): every photon crosses it straight. Needs a response of a scintillator, not a table. */
    int32_t oblique;
    /** Energy response of the detector; NULL: ideal. */
    skg_response *response;
    /** Photon-counting bands, 1 to SKG_CHANNELS_MAX, each a channel. 0: one channel of everything. Energy and
     * fluence of a band are in keV; its other quantities count photons, unless band_weight says otherwise. */
    int64_t bands;
    /** [bands + 1] rising edges in keV: band c has the energies from edge c to below edge c + 1. */
    const double *band_kev;
    /** NULL: none */
    const skg_detector_blur *blur;
    /** Instead of `blur`, one that depends on the depth of interaction; NULL: none. Needs a response of a
     * scintillator, not a table. */
    const skg_depth_blur *depth_blur;
    /** An anti-scatter grid on the detector; NULL: none. Without effect on ratios to the flat field of one energy. */
    const skg_grid *grid;
    /** A detector that counts; NULL: one that integrates energy. Each window is a channel, of photons, transmission or attenuation. In place
     * of response, bands, blurs and DQE; not with scatter, half precision or derivatives. Its pixels are those of the view. */
    skg_counter *counter;
    /** Scattered photons, which are added to images before noise and blur; NULL: none. Frames whose scene or view
     * differs from the last one's take seconds, and submitting waits for them. Needs closed meshes, materials of known
     * composition and density; not with half precision, nor a world that scatters more
     * than 20 % of the beam by itself. The field of the beam may not be wider than the heel's anode and the bow-tie's
     * profile allow. */
    const skg_scatter *scatter;
    /** 1: the photons of `scatter` do not meet the world at all; the primary does. 0 (default): the world scatters and stops them,
     * everywhere between source and detector. */
    int32_t world_scatter_off;
    /** 1: quantum noise of the photons that each pixel detects; exact where they are few. */
    int32_t noise;
    /** Swank factor of the detector at all energies, above 0 to 1, times that of the response: pulse heights
     * multiply the variance of the noise by 1 / swank. 1 (default): none. No effect where photons are
     * counted. */
    double swank;
    /** Added to the seed of each frame. */
    int64_t noise_seed;
    /** Standard deviation of the electronic noise, keV per pixel; 0: none. */
    double electronic_kev;
    /** Values are rounded to whole multiples of this, keV per pixel; 0: not rounded. */
    double quantum_step_kev;
    /** Noise power by spatial frequency; NULL: quantum noise is blurred as the signal is. Needs noise, and neither bands
     * nor depth_blur. */
    const skg_dqe *dqe;
} skg_plan_options;

/** Gets the name and the unit of a quantity.
 *
 *     quantity   enum skg_quantity
 *     name       result: "energy", "fluence", "photons", "transmission" or "attenuation"; may be NULL
 *     unit       result: "keV per pixel", "keV/mm2", "photons per pixel", "I/I0" or "-ln(I/I0)"; may be NULL.
 *                Both are constant
 *     errors     SKG_ERR_ARGUMENT if there is no such quantity
 *
 * Path lengths (SKG_OUTPUT_LENGTHS) are in mm. */
SKG_API skg_status skg_quantity_get(int32_t quantity, const char **name, const char **unit);

SKG_INIT(skg_plan_options)

#ifdef __cplusplus
}
#endif
#endif
