/* Solids as plain arrays: closed, outward, unless said otherwise. Lengths in mm. Free with solid_free. */
#ifndef SKG_TESTS_SHAPES_H
#define SKG_TESTS_SHAPES_H

#include <skiagraph/scene.h>

typedef struct {
    int64_t vertices, triangles;
    double *positions; /* [vertices][3] */
    int32_t *corners;  /* [triangles][3] */
} solid;

void solid_free(solid *s);

/* Around the origin. around, down >= 3: how many quads around and from pole to pole; poles on z. */
solid solid_box(double x, double y, double z);
solid solid_sphere(double radius, int around, int down);
solid solid_blob(double radius, int around, int down, uint64_t seed); /* a sphere with bumps and dents */
solid solid_torus(double ring, double tube, int around, int across);  /* axis z */
solid solid_star(int points, int step, double radius,
                 double height); /* a prism along z that winds `step` times */
solid solid_shell(double outer, double inner, int around, int down); /* two spheres, the inner one inverted */

/* `count` tetrahedra of about `size`, anywhere in a box of half sides `box`; they may overlap. */
solid solid_tetrahedra(int64_t count, double size, const double box[3], uint64_t seed);

/* `count` octahedra in a layer around half-way from source to detector; every corner is within `ulps` float
 * ulps of the ray of a pixel.
 * least: pixels from the middle to a corner; 2: no edge or face lies along a ray; 1: some do, but for the
 * ulps. */
solid solid_octahedra(int64_t count, const skg_view *view, int ulps, int least, uint64_t seed);

/* `count` plates x by y across z, each `thickness` thick, `gap` between them. */
solid solid_plates(int count, double x, double y, double thickness, double gap);

void solid_move(solid *s, const double affine[12]);       /* positions <- affine * positions, row by row */
void solid_shift(solid *s, double x, double y, double z); /* mm */
void solid_round(solid *s);                               /* positions become floats */
void solid_add(solid *to, const solid *other);            /* both in one */
solid solid_copy(const solid *from);
solid solid_shuffled(const solid *from, uint64_t seed); /* triangles in another order */
solid solid_unwelded(const solid *from);                /* every triangle has corners of its own */
double solid_volume(const solid *s);                    /* mm3 */

#endif
