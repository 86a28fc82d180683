/** @file
 * Distances between surfaces, as MESH (Aspert, Santa-Cruz and Ebrahimi, ICME 2002) and METRO (Cignoni, Rocchini and
 * Scopigno, Comput. Graph. Forum 17 (1998) 167) define them. The distance of a point p from a surface S is that to the
 * point of S's triangles which is nearest to p. From one surface to another, its mean, its root mean square and its 95th
 * percentile are integrals over the first one's area, and its maximum is the one-sided (non-symmetric) Hausdorff
 * distance. The larger of the two one-sided maxima is the Hausdorff distance.
 *
 * Results do not depend on the number of threads, bit for bit. Lengths are in mm.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_DISTANCE_H
#define SKIAGRAPH_DISTANCE_H

#include <skiagraph/mesh.h>
#include <skiagraph/progress.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Where a surface is sampled. */
enum skg_distance_sampling {
    /** Every triangle is divided into k x k equal ones whose sides are at most spacing_mm long. The centre of each
     * stands for its area. Vertices count in the maximum, but have no area. */
    SKG_DISTANCE_SURFACE = 0,
    /** At the vertices alone, each with the same weight. Faster, and usual in older work; where triangles are small, the
     * surface counts for more. */
    SKG_DISTANCE_VERTICES = 1
};

/** How distances are sampled. Prepare with skg_distance_options_init: over the surface, automatic spacing. */
typedef struct {
    /** Set by skg_distance_options_init. */
    int32_t size;
    /** enum skg_distance_sampling */
    int32_t sampling;
    /** Largest side of the triangles of SKG_DISTANCE_SURFACE, mm, above 0. 0: such that there are about 200,000. The
     * error of the mean is about spacing_mm^2 times the curvature. */
    double spacing_mm;
    /** Steps are samples. NULL: nobody wants to know. */
    skg_progress *progress;
} skg_distance_options;

SKG_INIT(skg_distance_options)

/** Distance from one surface to another. The library fills it; prepare with skg_distance_init. */
typedef struct {
    /** Set by skg_distance_init. */
    int32_t size;
    /** enum skg_distance_sampling */
    int32_t sampling;
    /** Number of points whose distance was computed. */
    int64_t samples;
    /** Longest side of the triangles that the samples stand for, mm; 0 at vertices. */
    double spacing_mm;
    /** Mean distance, mm. */
    double mean_mm;
    /** Root mean square distance, mm. */
    double rms_mm;
    /** 95 % of the area, or of the vertices, is this near or nearer, mm. */
    double p95_mm;
    /** Greatest distance of a sample, mm: the one-sided Hausdorff distance. */
    double max_mm;
    /** Where that sample lies, mm. */
    double max_position_mm[3];
} skg_distance;

SKG_INIT(skg_distance)

/** Measures the distance from one surface to another. The other direction is a second call; it differs.
 *
 *     from       the surface over which is integrated
 *     to         the surface on which the nearest points lie
 *     options    NULL: the defaults
 *     distance   result
 *     errors     SKG_ERR_ARGUMENT (an option, or more than 1e9 samples), SKG_ERR_MESH if a vertex is not finite,
 *                SKG_ERR_MEMORY, SKG_ERR_CANCELLED */
SKG_API skg_status skg_distance_measure(const skg_mesh *from, const skg_mesh *to,
                                        const skg_distance_options *options, skg_distance *distance);

/** Distances of points from a surface.
 *
 *     points      rows of x, y, z, mm
 *     distances   result: [count] mm
 *     errors      SKG_ERR_MESH if a vertex, SKG_ERR_ARGUMENT if a point is not finite */
SKG_API skg_status skg_distance_of_points(const skg_mesh *to, int64_t count, const double *points,
                                          double *distances);

/** The colour of a value between 0 and 1 on the scale of maps: dark violet, blue, green, yellow, evenly brighter. Values
 * outside take the colours of the ends, and what is no number that of 0.
 *
 *     rgb   result: [3] 0 to 255 */
SKG_API skg_status skg_distance_colour(double value, uint8_t *rgb);

/** Writes a mesh as binary PLY with a value and a colour at each vertex: properties `distance` in mm, and `red`,
 * `green`, `blue`. The file appears whole or not at all.
 *
 *     distances   [vertices] mm
 *     high_mm     the value at the bright end of the colours, above 0; the dark end is 0
 *     errors      SKG_ERR_ARGUMENT, SKG_ERR_MESH, SKG_ERR_OUTPUT */
SKG_API skg_status skg_distance_map_save(const skg_mesh *mesh, const double *distances, double high_mm,
                                         const char *path);

#ifdef __cplusplus
}
#endif
#endif
