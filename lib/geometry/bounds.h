/* Bounds of parts in the picture: extents, and the scale of the sums that follows. Private. */
#ifndef SKG_BOUNDS_H
#define SKG_BOUNDS_H

#include "core/core.h"
#include "geometry/optics.h"
#include "mesh/mesh.h"

/* --- The scale of an integer plane: the number of units for a weighted path parameter of 1. *
 * Sums are exact integers and must not wrap. The scale is the largest power of two with bound * scale < 2^30,
 * where `bound` is the largest sum that any pixel may have: the maximum over coarse cells of the detector of the
 * sums that all parts whose projected rectangles meet the cell can add. It follows from the bounds of one frame
 * alone, so that earlier frames change no bit. */

/* The side of a coarse cell in pixels. */
enum { SKG_SCALE_CELL = 32 };

/* The most that one part can add to a plane, and where. */
typedef struct {
    double low_column, high_column, low_row,
        high_row;                 /* projected rectangle in pixels; may leave the detector */
    double low_depth, high_depth; /* path parameter, from and to */
    double weight;                /* largest |weight| */
    double multiplicity;          /* layers of the part that may lie over each other, >= 1 */
} skg_scale_part;

typedef struct {
    int64_t columns, rows; /* of coarse cells */
    double *sums;          /* workspace: (columns + 1) * (rows + 1) */
} skg_scale_grid;

skg_status skg_scale_grid_create(int64_t columns, int64_t rows, skg_scale_grid *grid);

/* The part of a grid that a smaller detector takes. It borrows the memory. */
skg_scale_grid skg_scale_grid_of(const skg_scale_grid *grid, int64_t columns, int64_t rows);
void skg_scale_grid_release(skg_scale_grid *grid);

typedef struct {
    double bound; /* no pixel's sum exceeds it */
    /* The bound of a scene whose parts do not overlap: its whole depth at the largest weight. */
    double plausible;
    double scale; /* power of two; 1 if nothing is on the detector */
    int32_t bits; /* 32, or 64 if the last bit of 32 would exceed 2^-24 of `plausible` */
} skg_scale;

/* The scale for these parts; bits_wanted: 32 (64 where needed) or 64. */
void skg_scale_find(const skg_scale_grid *grid, int64_t count, const skg_scale_part *parts,
                    int32_t bits_wanted, skg_scale *scale);

/* --- The bounds of a part on the detector and along the rays. Scale, extents of planes and warnings follow from them.
 * */

typedef struct {
    skg_scale_part scale; /* the caller fills its weight */
    int32_t near_source; /* 1: it may reach the plane of the source, or the plane where parallel rays start */
    int32_t on_way;      /* 1: some of it, or a flat part, lies between the start and the end of the rays */
    int32_t on_detector; /* 1: its rectangle meets the detector, between the start and the end of the rays */
} skg_extent;

/* The extent of a mesh at a pose, from the present bounds of the mesh.
 *
 * last_bit   of the device's numbers relative to 1: FLT_EPSILON or DBL_EPSILON. Depths are widened by what these numbers
 *            round where that matters for the sums: of parts that are as thin, or reach as little into the path */
void skg_extent_find(const skg_camera *camera, const skg_mesh *mesh, const double *pose, double last_bit,
                     skg_extent *extent);

/* Finds the extent from other bounds, mm from the mesh's origin, and another number of layers. */
void skg_extent_find_within(const skg_camera *camera, const skg_mesh *mesh, const float lowest[3],
                            const float highest[3], const double *pose, double last_bit, int64_t layers,
                            skg_extent *extent);

/* --- Parts that touch each other in flat faces (lib/mesh/flat.c). */

typedef struct {
    int32_t part;
    int32_t root; /* workspace */
    const skg_mesh *mesh;
    const skg_mesh_layout *layout;
    const double *pose;
    double low[3], high[3]; /* mm, world; workspace */
} skg_touching;

/* Finds which parts touch. groups: [parts] result: the number of one part of its group, which is the same for all. */
void skg_touching_find(int64_t count, skg_touching *boxes, int32_t *groups);

/* A group in the picture. */
typedef struct {
    int32_t members;
    int32_t pixel[2];       /* from which its parts count */
    double low[2], high[2]; /* columns and rows */
    double farthest;        /* coordinate, from that pixel */
    double noise;           /* pixels that rounding the positions of meshes to doubles moves them */
} skg_touching_group;

int skg_touching_is_huge(const skg_camera *camera, const double columns[2], const double rows[2]);
void skg_touching_join(skg_touching_group *group, const double columns[2], const double rows[2],
                       double noise);
void skg_touching_measure(const skg_camera *camera, skg_touching_group *group);

/* The pixels by which kernels move the edges of a group for coverage (kernels/raster/triangle.clh). */
double skg_touching_shift(const skg_touching_group *group, int32_t is_double);

/* The pixels that rounding the positions of a mesh to doubles moves them. at: its extent. */
double skg_touching_noise(const skg_camera *camera, const skg_mesh *mesh, const double *pose,
                          const skg_scale_part *at);

/* The pixels that its rectangle and 2 pixels more for rounding cover: rows from, to, columns from, to, rounded
 * outward as skg_shared.h wants them. The last row may lie beyond the detector. */
void skg_extent_pixels(const skg_camera *camera, const skg_extent *extent, int32_t pixels[4]);

/* Widens pixels by those of another extent. All 0: there are none so far. */
void skg_extent_join(int32_t pixels[4], const int32_t more[4]);

#endif
