/* Structs that the kernels of the 3D view share with the host: scalars only, the same layout on both sides. */
#ifndef SKG_SHOW_SHARED_H
#define SKG_SHOW_SHARED_H

#ifdef __OPENCL_C_VERSION__
#define SKG_SHOW_INT int
#else
#include <stdint.h>
#define SKG_SHOW_INT int32_t
#endif

/* A tile is a square of this many samples a side; a pixel has 2 x 2 samples. */
#define SKG_SHOW_TILE 32

/* The lists of a tile, in the order in which they are drawn: opaque triangles that turn the outside of a closed mesh to the
 * eye, the other opaque ones (mostly hidden by the former, which is found out at once), translucent ones. */
#define SKG_SHOW_FACING 0
#define SKG_SHOW_AWAY 1
#define SKG_SHOW_CLEAR 2
#define SKG_SHOW_LISTS 3

/* How a triangle looks: lit, showing the detector's image, or in one colour. */
#define SKG_SHOW_LIT 0
#define SKG_SHOW_IMAGE 1
#define SKG_SHOW_PLAIN 2

/* How many translucent surfaces over each other are drawn; more would hardly be seen. */
#define SKG_SHOW_LAYERS 8

typedef struct {
    float matrix[16]; /* from mm, relative to the scene's centre, to clip coordinates; column after column */
    float turn[9];  /* from the world's axes to the eye's (right, up, towards the eye); column after column */
    float light[3]; /* towards the light, in the eye's axes, length 1 */
    float background[3];
    SKG_SHOW_INT columns, rows; /* pixels */
    SKG_SHOW_INT across, down;  /* tiles */
    SKG_SHOW_INT triangles;
    SKG_SHOW_INT sections; /* the first triangles, whose inside is plain */
    SKG_SHOW_INT images;   /* the last triangles, which are the detector's */
    SKG_SHOW_INT image_columns, image_rows;
} skg_show_args;

/* A triangle in the picture. Each plane p has the value p[0] x + p[1] y + p[2] at the sample that lies x columns and y
 * rows from the first of the box. */
typedef struct {
    float edges
        [12]; /* of each edge its normal and its first end, in samples; the same for both triangles of an edge */
    float depth[3];
    float values[9]; /* three planes: the normal in the eye's axes; of the detector u / w, v / w, 1 / w */
    float colour[4]; /* red, green, blue, opacity: 0 to 1 */
    SKG_SHOW_INT
    box[4]; /* first column, first row, last column, last row of samples; empty if the first exceeds
                          * the last */
    SKG_SHOW_INT
    sides; /* bit k: the triangle is where the normal of edge k points to, edge included; otherwise it is on
                          * the other side, edge excluded */
    SKG_SHOW_INT surface; /* SKG_SHOW_LIT, SKG_SHOW_IMAGE or SKG_SHOW_PLAIN */
    SKG_SHOW_INT list;    /* SKG_SHOW_FACING, SKG_SHOW_AWAY or SKG_SHOW_CLEAR */
    float nearest;        /* least depth of its corners; no sample of it is nearer */
} skg_show_face;

#ifndef __OPENCL_C_VERSION__
_Static_assert(sizeof(skg_show_args) == 31 * 4 + 9 * 4, "layout of the 3D view's arguments");
_Static_assert(sizeof(skg_show_face) == 36 * 4, "layout of a triangle of the 3D view");
#endif
#endif
