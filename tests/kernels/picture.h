/* Shared code of tests of the kernels: meshes as plain arrays, one frame from them, and a slow referee. */
#ifndef SKG_TESTS_PICTURE_H
#define SKG_TESTS_PICTURE_H

#include "stage/raster.h"

#include <skiagraph/plan.h>

typedef struct {
    int64_t vertices, triangles;
    double *positions; /* [vertices][3] mm */
    int32_t *corners;  /* [triangles][3] */
} shape;

/* Closed, outward shapes; free with shape_free. */
shape shape_sphere(double radius, int around, int down);
shape shape_box(double x, double y, double z); /* edges along the axes, centred */
shape shape_octahedra(int count, unsigned seed, const skg_view *view,
                      int ulps);                       /* corners near rays of pixels */
shape shape_unweld(const shape *from);                 /* every triangle has corners of its own */
shape shape_shuffle(const shape *from, unsigned seed); /* triangles in another order */
void shape_free(shape *s);
double shape_random(unsigned *seed); /* 0 to 1 */

/* A detector of columns x rows pixels of `pitch` mm around the z axis at z = 200, source at z = -1000. */
skg_view view_make(int64_t columns, int64_t rows, double pitch);

typedef struct {
    const shape *shape;
    double pose[16];
    int plane;
    double weight, bias;
} body; /* a part of a picture; weight 0 and bias 1: counts */

body body_make(const shape *s, int plane); /* identity pose, weight 1 */

typedef struct {
    int64_t columns, rows, planes;
    double *values;                        /* [planes][rows][columns] lengths, mm */
    uint64_t *sums;                        /* the same, exact sums, sign-extended */
    uint64_t hash;                         /* of the sums */
    int32_t bad;                           /* lowest vertex that is not finite, or INT32_MAX */
    int32_t bad_pixels[1 + SKG_FIRST_BAD]; /* of plane 0, taken as a count plane */
} picture;
void picture_free(picture *p);

/* One frame. scale: of the accumulators. */
skg_status picture_take(skg_context *context, const skg_raster_options *options, const skg_view *view,
                        int bodies, const body *of, double scale, picture *result);

/* Signed lengths in long double, each pixel against each triangle; [rows][columns], to be freed. Rays that
 * pass within 1e-9 of an edge may go either way there. */
double *referee(const skg_view *view, int bodies, const body *of);

#endif
