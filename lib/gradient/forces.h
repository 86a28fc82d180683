/* Derivatives of a loss by what moves, from the moments of faces (kernels/gradient/gradient.cl). Private.
 *
 * The derivative by corner k of a face is a vector F_k along the face's normal, as a force would be. A part's twist gets the sum of
 * F_k and of x_k x F_k. A ray that moves by v at x changes the loss by -F . v, and what moves a ray is affine in x, so that the
 * corners stand for all hits of the face (docs/numerics.md, Derivatives). */
#ifndef SKG_FORCES_H
#define SKG_FORCES_H

#include "gradient/steep.h"
#include "mesh/mesh.h"

/* The faces of a part. Slopes (gradient/slopes.h) use neither the moments nor their unit and pixel. */
typedef struct {
    const skg_camera *camera;
    const skg_mesh *mesh;
    const double *pose;     /* 4x4 */
    const int32_t *corners; /* [triangles][3] in the device's numbering of vertices */
    const int32_t *source;  /* the mesh's number of each; NULL: the same */
    const double *planes;   /* [triangles][4] of skg_face_planes_find; slopes do not use them */
    /* [triangles][4] sums over hits of weight t^2, of that times the column, and times the row; NULL: none are added */
    const int64_t *moments;
    double unit;           /* of a moment */
    int32_t pixel[2];      /* from which columns and rows of the device count */
    skg_steep_weigh weigh; /* of faces whose first moment is SKG_EDGE_ON; may be NULL if there are none */
    const void *weigh_user;
} skg_face_moments;

/* Sums over faces, about the world's origin. t: the path parameter of a corner. */
typedef struct {
    double force[3], torque[3]; /* of F, of x x F */
    double length; /* of weight t; with a parallel beam of weight (t - 1). Faces that contain rays add none */
    double along[3];        /* of t F; with a parallel beam of (t - 1) F */
    double pixel_torque[3]; /* of t p x F, p the pixel that sees the corner; with a parallel beam of p x F */
} skg_force_sums;

/* The normal of a face, twice its area long, turned outward: the mesh grows where it moves along it. at: corners in the world */
void skg_face_outward(const skg_face_moments *faces, double at[3][3], double normal[3]);

/* The planes of all faces in the axes of a mesh: normals, twice the area long, and their products with a corner. corners, source: as of
 * skg_face_moments. planes: [triangles][4] */
void skg_face_planes_find(const skg_mesh *mesh, const int32_t *corners, const int32_t *source,
                          double *planes);

/* Adds up the faces of parts. vertices: [count] NULL or [mesh->vertices][3] the derivatives by the positions of the mesh, which are
 * added to; all of those at one place go to the first of them. NULL: of no part. sums: [count] result */
skg_status skg_forces_find(int64_t count, const skg_face_moments *parts, double *const *vertices,
                           skg_force_sums *sums);

/* Divides the derivative of vertices at one place evenly among them. */
skg_status skg_forces_share(const skg_mesh *mesh, double *vertices);

#endif
