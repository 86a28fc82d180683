/** @file
 * What a plan is asked for: precision, quantity, source, detector, repair, tolerances.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_OPTIONS_H
#define SKIAGRAPH_OPTIONS_H

#include <skiagraph/beam.h>
#include <skiagraph/collimation.h>
#include <skiagraph/counting.h>
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

/** Limits of the interface. */
enum skg_limit {
    /** Most channels of an image. */
    SKG_CHANNELS_MAX = 16,
    /** Most depths of a scintillator that have a blur of their own. */
    SKG_DEPTHS_MAX = 8,
    /** Most samples of a line spread function that is made from a table of frequencies. */
    SKG_LINE_SAMPLES_MAX = 255
};

/** What happens at the bad pixels of a leaky mesh, where a ray does not leave the mesh as often as it enters
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
     * edges closed by a fan about the loop's mean; so is every ray that passes such a cap. Exact if the loops
     * are plane: missing triangles, plane holes, cracks at T-junctions, single inverted triangles. Otherwise
     * it is one of many possible surfaces. Submitting waits until the leaky parts are rastered. */
    SKG_REPAIR_EXACT = 2
};

/** The detector's blur: what a point or a line becomes, sampled one pixel apart. Prepare with
 * skg_detector_blur_init.
 *
 * Give two line spread functions, whose product is the point spread function, or the point spread function
 * itself. Numbers of samples are odd, 1 to 4095; sample k of n is the share of a pixel's value that is found
 * k - n/2 pixels further on. Samples are scaled to the sum 1. A pixel beyond the edge of the image has the
 * value of the nearest edge pixel. Samples that were made for pixels of a certain size say so in pixel_mm: a plan for
 * others is refused, and a view that has others makes a plan SKG_STALE. */
typedef struct {
    /** Set by skg_detector_blur_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of samples along a row. */
    int64_t columns;
    /** Number of samples along a column. */
    int64_t rows;
    /** [columns] line spread function along a row */
    const double *along_row;
    /** [rows] line spread function along a column */
    const double *along_column;
    /** [rows][columns] point spread function; NULL: the two line spread functions */
    const double *point;
    /** mm between pixels along a row and along a column for which the samples were made, as by skg_line_spread_get; 0
     * (default): they are of pixels of any size */
    double pixel_mm[2];
} skg_detector_blur;

SKG_INIT(skg_detector_blur)

/** Gets the line spread function of a modulation transfer function, for skg_detector_blur: the fewest samples whose
 * transfer function is within 0.005 of the table at all frequencies that the pixels show. Rows are joined by curves of
 * third degree that rise or fall as the rows do.
 *
 *     count      number of frequencies, at least 2
 *     per_mm     [count] line pairs per mm, rising from 0 to at least 1 / (2 pixel_mm)
 *     mtf        [count] 1 at frequency 0, values from -2 to 2
 *     pixel_mm   distance of the pixels along the line
 *     line       result: [SKG_LINE_SAMPLES_MAX], of which the first `samples` are set
 *     samples    result: odd
 *     errors     SKG_ERR_ARGUMENT, with the row of the table
 *
 * A presampling MTF (IEC 62220-1) holds the aperture of the pixels. With supersampling, the image has this aperture
 * already: divide by it then. */
SKG_API skg_status skg_line_spread_get(int64_t count, const double *per_mm, const double *mtf,
                                       double pixel_mm, double *line, int64_t *samples);

/** Blur that depends on the depth at which photons interact in a scintillator: light from far off the sensor spreads
 * most. Photons that interact in a depth make an image of their own, with their own noise, and this is blurred as the
 * depth says; the images are added. So the blur depends on the energy, and noise power falls less with the frequency
 * than the square of the MTF (G. Lubberts, Random noise produced by x-ray fluorescent screens, Journal of the Optical
 * Society of America 58 (1968) 1475-1483). Prepare with skg_depth_blur_init.
 *
 * method   exp(-mu z) along the straight path, for the first interaction; neither obliquity nor fluorescence
 *          changes the shares of the depths */
typedef struct {
    /** Set by skg_depth_blur_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of depths, 1 to SKG_DEPTHS_MAX. Depths times channels are at most SKG_CHANNELS_MAX. */
    int64_t count;
    /** [count] where each depth ends, from the side on which photons enter: shares of the thickness, rising, the
     * last is 1 */
    const double *to;
    /** [count] the blur of each depth */
    const skg_detector_blur *blur;
} skg_depth_blur;

SKG_INIT(skg_depth_blur)

/** A measured detective quantum efficiency by spatial frequency, for the power of the noise. Prepare with
 * skg_dqe_init.
 *
 * The noise of a flat field of the plan's beam has, along rows and columns, the power
 * NPS(f) = mean^2 MTF(f)^2 / (q DQE(f)) with q photons per mm2 and the MTF of the plan's blur; off the axes DQE(f) /
 * DQE(0) is the product of both directions. DQE(0) determines the variance, so it replaces the Swank factors; behind
 * a part, the variance of each energy changes as its intensity does. */
typedef struct {
    /** Set by skg_dqe_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of frequencies, at least 2. */
    int64_t count;
    /** [count] line pairs per mm, rising from 0 to at least 1 / (2 pixel size) */
    const double *per_mm;
    /** [count] above 0 to 1; that at 0 is at most what the response allows for the beam */
    const double *dqe;
} skg_dqe;

SKG_INIT(skg_dqe)

/** Shapes of the focal spot. A flat one lies across the line from the source to the detector's centre, with
 * its width along the projected column step. */
enum skg_spot_shape {
    /** A point. */
    SKG_SPOT_POINT = 0,
    /** extent[0] along the width */
    SKG_SPOT_LINE = 1,
    /** extent[0] x extent[1] */
    SKG_SPOT_RECTANGLE = 2,
    /** extent[0] x extent[1] x extent[2], the last along the line to the detector */
    SKG_SPOT_CUBE = 3,
    /** diameter extent[0] */
    SKG_SPOT_DISC = 4,
    /** a filled sphere of diameter extent[0] */
    SKG_SPOT_SPHERE = 5,
    /** full widths at half maximum extent[0] x extent[1], the effective sizes of IEC 60336 */
    SKG_SPOT_GAUSSIAN = 6
};

/** The focal spot. Prepare with skg_spot_init: a point.
 *
 * Its samples have equal weights, so that the flat field depends neither on the shape nor on their number.
 * They follow Sobol's sequence: more samples continue fewer. */
typedef struct {
    /** Set by skg_spot_init. */
    int32_t size;
    /** enum skg_spot_shape */
    int32_t shape;
    /** Full widths, mm. */
    double extent[3];
    /** Normal of a flat shape; all 0: the line to the detector's centre. */
    double axis[3];
    /** Number of samples, 1 to 65536. 0: adaptive sampling. The number is doubled while the plan is made, for
     * the plan's view, until two doublings in a row change 99.9 % of the pixels by less than `tolerance`. */
    int64_t samples;
    /** n > 0: instead, the middles of n (line), n x n (rectangle) or n x n x n (cube) equal pieces, as in
     * Vidal and Villard 2016. */
    int64_t grid;
    /** Of adaptive sampling, as a fraction of the flat field; 5e-3 by default. */
    double tolerance;
    /** Adaptive sampling stops at this number of samples; 1024 by default. */
    int64_t samples_max;
    /** Off-focal radiation: the share of the photons that leave the anode beside the focal spot, from a disc of diameter off_focal_mm around
     * its middle, with the same spectrum; 0 to below 1. 0 (default): none. Needs a focal spot that is no point, and no grid. */
    double off_focal;
    /** Diameter of that disc, mm, above 0 to 1000; without effect if off_focal is 0. */
    double off_focal_mm;
} skg_spot;

SKG_INIT(skg_spot)

/** The heel effect: photons leave the anode at an angle that differs over the detector, and the shallower it
 * is, the more of them the anode absorbs, the soft ones above all. Prepare with skg_heel_init; set kvp and
 * direction. The spectrum of the plan is that of the ray from the source to the detector's centre.
 *
 * method   the ratio of the spectra of Ebel's tube model at the angle of a ray and at angle_deg, for each
 *          energy. Filters are crossed straight, whatever the ray. */
typedef struct {
    /** Set by skg_heel_init. */
    int32_t size;
    /** Atomic number of the anode; 74 by default. */
    int32_t anode;
    /** Tube voltage in kV; no photon of the spectrum may have more energy. */
    double kvp;
    /** Angle between the anode's face and the ray to the detector's centre, degrees; 12 by default. */
    double angle_deg;
    /** Width of the bins of the spectrum, keV; 1 by default. */
    double bin_kev;
    /** From the detector's centre towards the side of the anode, where the image is darkest; any length. What
     * lies along the central ray does not count. It turns with the detector when frames have other views. */
    double direction[3];
} skg_heel;

SKG_INIT(skg_heel)

/** A bow-tie filter: a body at the source whose thickness changes along the fan of rays and not across it. Prepare
 * with skg_bowtie_init; set material, count, angle_deg and path_mm.
 *
 * The fan's plane contains the ray to the detector's centre. The path of a ray in this plane is linear in the
 * tangent of its angle between rows; that of a ray which leaves the plane by an angle k is longer by 1 / cos k,
 * as the body is the same all along the direction across the fan. The filter moves with source and detector. */
typedef struct {
    /** Set by skg_bowtie_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Of known density; retained. */
    skg_material *material;
    /** Number of rows, 2 to 4096. */
    int64_t count;
    /** [count] angle to the ray to the detector's centre, degrees, -89 to 89, rising. No ray of the plan's views
     * may lie outside. */
    const double *angle_deg;
    /** [count] path of the ray at this angle through the filter, mm, at least 0 */
    const double *path_mm;
    /** In which angles grow; any length. What lies along the ray to the detector's centre does not count. All 0:
     * along the detector's rows. It turns with the detector when frames have other views. */
    double direction[3];
} skg_bowtie;

SKG_INIT(skg_bowtie)

/** An anti-scatter grid on the detector: strips that stand on it, with an interspace between them. Prepare with
 * skg_grid_init; set ratio, lines_per_cm and strip_mm.
 *
 * Its effect is the share of the primary photons that it lets pass, averaged over the place where a ray meets the
 * pattern of strips: the pattern itself is not shown, as with a grid that moves. Strips stop rays that are not
 * along them (cut-off), when the source is not at the focus or the beam is parallel. */
typedef struct {
    /** Set by skg_grid_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Height of the strips over the width of an interspace, above 0 to 100. */
    double ratio;
    /** Strips per cm. */
    double lines_per_cm;
    /** Thickness of a strip, mm, above 0 and less than its share of a cm. */
    double strip_mm;
    /** Of the strips; retained. NULL: lead. */
    skg_material *strip;
    /** Between the strips; retained. NULL: vacuum. */
    skg_material *interspace;
    /** Distance in mm from the grid to the line in which the planes of all strips meet, above the detector's
     * centre; 0: the strips are parallel. */
    double focus_mm;
    /** Across the strips; any length. What lies along the detector's normal does not count. All 0: along the
     * detector's rows. It turns with the detector when frames have other views. */
    double direction[3];
} skg_grid;

SKG_INIT(skg_grid)

/** Gets the share of the photons of an energy that pass a grid without interaction.
 *
 *     oblique        path of the ray between the faces of the grid divided by their distance, at least 1
 *     tilt           distance that the ray moves across the strips divided by the height of these; 0: along the
 *                    strips
 *     transmission   result: above 0 to 1
 *     method         mean over the period of exp(-mu_strip l - mu_interspace (H - l)) with the length l in strips
 *                    of the ray's path H, in closed form. Strips are plates without curvature, whose distance is
 *                    that on the detector.
 *     errors         SKG_ERR_SCENE for unusable dimensions; SKG_ERR_MATERIAL if a density is unknown */
SKG_API skg_status skg_grid_transmission_get(const skg_grid *grid, double energy_kev, double oblique,
                                             double tilt, double *transmission);

/** Fluorescence of the parts, with scatter: K and L lines after photo absorption. */
enum skg_fluorescence {
    /** Of elements from Z = 30 on whose edge is below the beam's highest energy. */
    SKG_FLUORESCENCE_AUTO = 0,
    /** Of lighter ones from Z = 20 on, too. */
    SKG_FLUORESCENCE_ON = 1,
    /** None: what is absorbed is gone. */
    SKG_FLUORESCENCE_OFF = 2
};

/** Scattered photons: what the object sends to the detector after one or more interactions. Prepare with
 * skg_scatter_init: to 1 % of the mean.
 *
 * method   Monte Carlo on the device, through cells that hold a medium, or the faces of the parts in them. Photons are made
 *          to interact and to survive; from each interaction they contribute to directions to the detector. The first
 *          interactions follow a lattice of points in place of random numbers. What arrives is counted on a coarse grid of
 *          the detector and smoothed by cosines, as many as independent batches show to pay.
 * physics  photo absorption, Compton scattering (Klein and Nishina, times the scattering functions of free atoms),
 *          Rayleigh scattering (form factors of free atoms); cross sections of XCOM, as for the primary; fluorescence in any
 *          direction (K and L lines; yields and rates of xraylib; of L shells the mean of their lines); pair production, whose positron
 *          stops where it is and sends two photons of 511 keV. Left out: Doppler broadening, the order of molecules unless materials have tables of it (skg_material_create_form_factor), bremsstrahlung, what the
 *          detector itself scatters.
 * field    without skg_plan_options.collimation the beam that scatters is limited to the detector, from its pixels'
 *          outer edges on */
typedef struct {
    /** Set by skg_scatter_init. */
    int32_t size;
    /** enum skg_fluorescence; SKG_FLUORESCENCE_AUTO by default */
    int32_t fluorescence;
    /** Standard error aimed at, smoothing included, over the mean of the scatter: root mean square over the detector. 0.01
     * by default; 0: `histories` decides. */
    double tolerance;
    /** Photons from the source, 0 to 2^30; 0 (default): as many as the tolerance needs. */
    int64_t histories;
    /** Of the histories. Frames with the same scene, view and seed have the same scatter. */
    int64_t seed;
    /** Sides of the cells, mm, about; 0 (default): 64 cells along each side of the box of all parts. Cells in
     * which parts differ hold their faces, however large they are. At most 128 along each side. */
    double voxel_mm;
    /** Places of the detector, along its rows and columns, that arriving photons are counted in; 0 (default): 32 along the
     * longer side, at most one for a pixel. At most 256. */
    int64_t columns;
    /** Likewise, along its columns. */
    int64_t rows;
} skg_scatter;

SKG_INIT(skg_scatter)

/** Falloff: intensity falls with the cube of the distance from the source (inverse square and obliquity). Photons per
 * pixel of the spectrum are then those at the foot of the perpendicular from the source to the plane of the detector,
 * whether or not a pixel lies there. */
enum skg_falloff {
    /** On if the spectrum is absolute (beam.h), off otherwise. */
    SKG_FALLOFF_AUTO = -1,
    /** Every pixel of the open beam receives the same. */
    SKG_FALLOFF_OFF = 0,
    /** On. */
    SKG_FALLOFF_ON = 1
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
    /** 1 (default): find parts that overlap or leave their parent, and warn. 0: do not look. */
    int32_t overlaps;
    /** 1: time the stages of each job, which makes frames a little slower. */
    int32_t profile;
    /** enum skg_falloff; SKG_FALLOFF_AUTO by default */
    int32_t falloff;
    /** Of the detector; NULL: ideal. */
    skg_response *response;
    /** Around the parts; NULL: vacuum. */
    skg_material *world;
    /** Photon-counting bands, 1 to SKG_CHANNELS_MAX, each a channel. 0: one channel of everything. Energy and
     * fluence of a band are in keV; its other quantities count photons, unless band_weight says otherwise. */
    int64_t bands;
    /** The focal spot; NULL: a point. Without effect in a parallel beam. */
    const skg_spot *spot;
    /** n x n rays per pixel, at the middles of its n x n pieces; 1 (default) to 16. The reason of the effect
     * "supersampling" says whether one pass makes all of them or each has a pass of its own. */
    int32_t supersampling;
    /** 1: quantum noise of the photons that each pixel detects; exact where they are few. */
    int32_t noise;
    /** [bands + 1] rising edges in keV: band c has the energies from edge c to below edge c + 1. */
    const double *band_kev;
    /** 0 (default): every energy of the spectrum, one plane per material. Above 0 to below 1: the error that
     * fewer energies and planes may make. It is relative where more than 1e-6 of the flat field arrives, and
     * in units of 1e-6 of the flat field where less does. It holds for the path lengths that the plan's views
     * meet and for a quarter more, and with noise for the variance too. */
    double tolerance;
    /** NULL: none */
    const skg_detector_blur *blur;
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
    /** enum skg_repair, for leaky meshes; SKG_REPAIR_NEIGHBOURS by default */
    int32_t repair;
    /** 1: a part counts only inside its parent. 0 (default): where it leaves its parent, the parent's
     * attenuation is subtracted. */
    int32_t clip;
    /** Number of further views, 0 to 1024. */
    int64_t view_count;
    /** [view_count] a sample of the views that frames will have, so that the error bound of `tolerance` holds
     * for them too. Without effect if tolerance is 0. */
    const skg_view *views;
    /** enum skg_band_weight, of transmission and attenuation of bands; SKG_BAND_WEIGHT_PHOTONS by default */
    int32_t band_weight;
    /** 1: the path through the layer of the response grows with the angle of a ray to the detector's normal. 0
     * (default): every photon crosses it straight. Needs a response of a scintillator, not a table. */
    int32_t oblique;
    /** The heel effect; NULL: the spectrum is the same everywhere. Without effect in a parallel beam, and on
     * ratios to the flat field of one energy. */
    const skg_heel *heel;
    /** A bow-tie filter at the source; NULL: none. Without effect in a parallel beam, and on ratios to the flat
     * field of one energy. */
    const skg_bowtie *bowtie;
    /** An anti-scatter grid on the detector; NULL: none. Without effect on ratios to the flat field of one energy. */
    const skg_grid *grid;
    /** Instead of `blur`, one that depends on the depth of interaction; NULL: none. Needs a response of a
     * scintillator, not a table. */
    const skg_depth_blur *depth_blur;
    /** Noise power by spatial frequency; NULL: quantum noise is blurred as the signal is. Needs noise, and neither bands
     * nor depth_blur. */
    const skg_dqe *dqe;
    /** Jaws in the beam; NULL: nothing limits it. */
    const skg_collimation *collimation;
    /** Scattered photons, which are added to images before noise and blur; NULL: none. Frames whose scene or view
     * differs from the last one's take seconds, and submitting waits for them. Needs closed meshes, materials of known
     * composition and density; not with half precision, nor a world that scatters more
     * than 20 % of the beam by itself. The field of the beam may not be wider than the heel's anode and the bow-tie's
     * profile allow. */
    const skg_scatter *scatter;
    /** 1: of a closed mesh whose components overlap, or whose triangles are listed more than once, the lengths are those of the union
     * of what it encloses: where the winding number is above 0. The hits of all closed parts are listed, which costs what priorities
     * cost. The lengths SKG_LENGTHS_SURFACE stay sums, and there are no derivatives. 0 (default): lengths of components add, and a warning names them. */
    int32_t unite;
    /** 1: the photons of `scatter` do not meet the world at all; the primary does. 0 (default): the world scatters and stops them,
     * everywhere between source and detector. */
    int32_t world_scatter_off;
    /** A detector that counts; NULL: one that integrates energy. Each window is a channel, of photons, transmission or attenuation. In place
     * of response, bands, blurs and DQE; not with scatter, half precision or derivatives. Its pixels are those of the view. */
    skg_counter *counter;
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
