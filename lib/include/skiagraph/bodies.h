/** @file
 * Bodies by their parameters: foam, fibres, gyroids, surfaces of a volume, line pairs and stars, each as one closed mesh
 * that points outward and is centred at the origin. Lengths are in mm. The same parameters give the same mesh.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_BODIES_H
#define SKIAGRAPH_BODIES_H

#include <skiagraph/mesh.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Makes spheres as one mesh. Vertices lie on the spheres.
 *
 *     count      at least 1
 *     centres    [count][3] mm
 *     radii      [count] mm, above 0
 *     segments   around the axis of each, at least 3; half as many, at least 2, from pole to pole
 *     errors     SKG_ERR_ARGUMENT, SKG_ERR_MEMORY
 *
 * Spheres that overlap count twice where they do. */
SKG_API skg_status skg_mesh_create_spheres(int64_t count, const double *centres, const double *radii,
                                           int64_t segments, skg_mesh **mesh);

/** Spheres in a box that do not overlap. Prepare with skg_foam_init: a tenth of a cube of 20 mm in spheres of 1 mm. */
typedef struct {
    /** Set by skg_foam_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Edges of the box, which holds all spheres, mm. */
    double box[3];
    /** Mean radius, mm. */
    double radius_mm;
    /** Standard deviation of the radius as a share of it, 0 to 0.5; radii are 0.2 to 2 times the mean. */
    double spread;
    /** Share of the box that the spheres fill, above 0 to 0.6; without effect if count is above 0. */
    double fraction;
    /** Least distance between spheres, and between a sphere and a face of the box, mm. */
    double gap_mm;
    /** Number of spheres; 0: as many as fill `fraction`. */
    int64_t count;
    /** Another seed gives another foam. */
    int64_t seed;
    /** As of skg_mesh_create_spheres; 12 by default. */
    int64_t segments;
} skg_foam;

SKG_INIT(skg_foam)

/** Makes the spheres of a foam as one mesh: its pores, or grains. The largest are placed first, each at random where it
 * fits. Errors: SKG_ERR_ARGUMENT (a parameter); SKG_ERR_MESH if no place is found for a sphere, with the share that was
 * filled. */
SKG_API skg_status skg_mesh_create_foam(const skg_foam *foam, skg_mesh **mesh);

/** Straight fibres through a box that do not touch. Prepare with skg_fibres_init: 50 of radius 0.5 mm along z in a cube of
 * 20 mm. */
typedef struct {
    /** Set by skg_fibres_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Edges of the box, mm. Every fibre runs from its lower to its upper face across z, and lies inside. */
    double box[3];
    /** mm */
    double radius_mm;
    /** Least distance between fibres, mm. */
    double gap_mm;
    /** Greatest angle to z, degrees, 0 to 60. */
    double tilt_deg;
    /** Number of fibres, 1 to 100000. */
    int64_t count;
    /** Another seed gives other fibres. */
    int64_t seed;
    /** Around a fibre, at least 3; 16 by default. */
    int64_t segments;
} skg_fibres;

SKG_INIT(skg_fibres)

/** Makes fibres as one mesh. Errors: SKG_ERR_ARGUMENT (a parameter); SKG_ERR_MESH if no place is found for a fibre, with
 * the number that were placed. */
SKG_API skg_status skg_mesh_create_fibres(const skg_fibres *fibres, skg_mesh **mesh);

/** Makes the surface of a volume where it crosses a level, by marching tetrahedra. What is at or above the level is
 * inside. Beyond the volume nothing is inside, so that the mesh is closed.
 *
 *     counts    [3] numbers of values along x, y and z, at least 2
 *     spacing   [3] from one value to the next, mm
 *     values    [counts[2]][counts[1]][counts[0]]
 *     errors    SKG_ERR_ARGUMENT; SKG_ERR_MESH if no value, or one that is not finite, is at or above the level */
SKG_API skg_status skg_mesh_create_isosurface(const int64_t *counts, const double *spacing,
                                              const float *values, double level, skg_mesh **mesh);

/** Makes a sheet of a gyroid in a box: where |sin x cos y + sin y cos z + sin z cos x| is below `level`, with x, y and z
 * in periods.
 *
 *     box       [3] edges, mm
 *     period    mm
 *     level     above 0 to 1.4; 0.3 fills about a fifth of the box
 *     cells     of the grid along a period, 4 to 256, and at least 3 pi / level, so that the sheet has no holes that it should not have; 0: so
 *               many, and at least 24
 *     errors    SKG_ERR_ARGUMENT, SKG_ERR_MEMORY */
SKG_API skg_status skg_mesh_create_gyroid(const double *box, double period, double level, int64_t cells,
                                          skg_mesh **mesh);

/** Makes groups of bars, side by side along x, as of a test of resolution. The bars of a group are as wide as the spaces
 * between them; groups are apart by twice the width of the wider one.
 *
 *     groups      at least 1
 *     per_mm      [groups] line pairs per mm, above 0
 *     bars        of each group, at least 1
 *     length      of a bar along y, mm
 *     thickness   along z, mm */
SKG_API skg_status skg_mesh_create_line_pairs(int64_t groups, const double *per_mm, int64_t bars,
                                              double length, double thickness, skg_mesh **mesh);

/** Makes a Siemens star about z: spokes that are as wide as the spaces between them.
 *
 *     radius      outer, mm
 *     inner       radius where the spokes begin, above 0 and below the outer one, mm
 *     spokes      at least 2
 *     thickness   along z, mm */
SKG_API skg_status skg_mesh_create_star(double radius, double inner, int64_t spokes, double thickness,
                                        skg_mesh **mesh);

#ifdef __cplusplus
}
#endif
#endif
