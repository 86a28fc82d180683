/* Stage `gradient`: the derivatives of a loss by the faces of all parts, from those by the sums of a raster. Private.
 *
 * Four integers a face are gathered by one kernel (kernels/gradient/gradient.cl), whatever strategy has drawn the faces; the same
 * coverage gives the same hits. */
#ifndef SKG_GRADIENT_STAGE_H
#define SKG_GRADIENT_STAGE_H

#include "stage/attenuate.h"
#include "stage/hits.h"
#include "stage/host_view.h"
#include "stage/machine.h"

/* Memory, kept from call to call (memory.c). All zero: nothing is allocated. */
typedef struct {
    skg_buffer adjoint, weights, most, of_rays, wanted, scales, moments, slopes, lengths, faces, node, around,
        first_around, lines;
    int32_t *wanted_now; /* [wanted_count] what the device has in `wanted` */
    int64_t wanted_count;
    skg_host_view sums; /* of `moments` */
    void *reals;        /* [triangles][3] slopes on their way to the device */
    int32_t *corners;   /* [triangles of all meshes][3] as the device has them */
    /* [triangles of all meshes][4] of skg_face_planes_find; their meshes' versions; 0: not found yet */
    double *planes;
    int64_t *versions;
} skg_gradient_memory;

/* The memory of a plan, which its machine owns; allocated with the first call. */
skg_status skg_gradient_memory_get(skg_machine *machine, skg_gradient_memory **memory);

/* The surroundings of each part: the contributions of all parts that it is inside; or what the part is made of, with its own. */
typedef struct {
    const int32_t *first; /* [parts + 1] those of part p are list[first[p]] to list[first[p + 1] - 1] */
    const skg_contribution *list;
    /* [parts] 1: the part is of the material around it. It has one of those contributions so that it is drawn, and only its
     * fourth moments count. */
    const uint8_t *same;
    const uint8_t *of_own; /* [parts] 1: what the part itself is made of is listed */
} skg_surroundings;

/* The results of the gather of a pass. */
typedef struct {
    const int64_t *moments; /* [triangles][4] in the device's order of triangles, until skg_gradient_close */
    const double *units;    /* [parts] staged: what a moment of 1 is worth; 0: the part has none */
    /* [parts] of the fourth moments: sums of length times weight by what stands around */
    const double *around_units;
    skg_weight_layout layout;
    int32_t has_edges; /* 1: some faces are seen as lines */
    int32_t reserved;
} skg_gathered;

/* Bytes of a real of weights, moments and slopes. precision: of the pass */
static inline int64_t skg_gradient_real_size(int32_t precision) {
    return (int64_t)(precision == SKG_PRECISION_DOUBLE ? sizeof(double) : sizeof(float));
}

/* The subjects of weights. */
enum {
    SKG_WEIGHTS_OF_PARTS,  /* what hits of parts are worth */
    SKG_WEIGHTS_OF_PLANES, /* the mm of the planes that exponents are made of */
    SKG_WEIGHTS_OF_RAYS    /* rays alone */
};

/* The derivatives by the sums of a pass that are wanted. */
typedef struct {
    double factor; /* of the intensities of the pass */
    /* of the intensities whose derivatives they are; -1: those of a loss, by memory->adjoint */
    int32_t channel;
    int32_t of;       /* SKG_WEIGHTS_OF_... */
    int32_t rays;     /* SKG_RAYS_... */
    int32_t relative; /* 1: see skg_transposition */
    int32_t reserved;
    /* [parts] 0: what hits of this part are worth is not wanted; NULL: that of all is */
    const uint8_t *parts;
} skg_weights_wanted;

/* Enqueues them. attenuation: of the image, with the window of the pass */
skg_status skg_gradient_transpose(skg_attenuator *attenuator, const skg_pass *pass, const skg_sums *sums,
                                  const skg_attenuation *attenuation, const skg_weights_wanted *wanted,
                                  skg_gradient_memory *memory, skg_staging *staging);

/* Reads the sums over rays that SKG_RAYS_SUMS has made, and waits. */
skg_status skg_gradient_read_ray_sums(const skg_pass *pass, const skg_gradient_memory *memory,
                                      skg_staging *staging, double sums[SKG_RAY_SUMS]);

/* Makes sure of memory for the derivatives of a pass by its sums, or by the mm of `planes` planes. */
skg_status skg_gradient_reserve(const skg_pass *pass, int64_t planes, skg_gradient_memory *memory);

/* Gathers the moments of a pass whose sums are made, and waits for them. around: NULL: without the fourth. memory->weights: of skg_attenuate_transpose */
skg_status skg_gradient_gather(const skg_pass *pass, const skg_geometry *geometry,
                               const skg_hits_memory *hits, const skg_surroundings *around,
                               skg_gradient_memory *memory, skg_staging *staging, skg_gathered *gathered);

/* Reals in the precision of a pass. */
typedef struct {
    void *memory;
    int32_t is_double;
} skg_reals;

/* Memory for the slopes of a geometry's faces, on their way to the device: [triangles][3] of the path parameter over the square of t, at the
 * corners, times the part's reference; in the device's order. */
skg_status skg_gradient_reserve_slopes(const skg_geometry *geometry, skg_gradient_memory *memory,
                                       skg_reals *slopes);

/* Ends the use of moments. */
void skg_gradient_close(const skg_pass *pass, skg_gradient_memory *memory);

/* Faces of parts that move which the device sees as lines. */
typedef struct {
    uint8_t *faces; /* [triangles] in the device's order: 1: it is one; left alone if none is */
    int32_t any, reserved;
} skg_seen_lines;

/* Adds up the derivatives of the rays of a pass by these slopes, and waits for them.
 *
 * moves     [parts] 0: the part does not, and its slopes are not looked at
 * largest   the largest magnitude of the slopes of parts that move
 * lines     result: faces that are seen as lines, which add nothing
 * values    [rows][columns] to which they are added */
skg_status skg_gradient_scatter(const skg_pass *pass, const skg_geometry *geometry,
                                const skg_hits_memory *hits, skg_gradient_memory *memory,
                                skg_staging *staging, const uint8_t *moves, double largest,
                                skg_seen_lines *lines, double *values);

/* Reads reals in the precision of the pass as doubles, from number `first` on, and waits. */
skg_status skg_gradient_read(const skg_pass *pass, cl_mem memory, int64_t first, int64_t count,
                             double *numbers);

/* The corners of a mesh's triangles, [triangles][3] in the device's order and numbering of vertices; read once. */
skg_status skg_gradient_find_corners(skg_context *context, const skg_geometry *geometry, int64_t mesh,
                                     skg_gradient_memory *memory, const int32_t **corners);

/* The planes of a mesh's faces (gradient/forces.h), found anew when its vertices have moved. */
skg_status skg_gradient_find_planes(const skg_geometry *geometry, const skg_mesh *mesh, int64_t number,
                                    skg_gradient_memory *memory, const double **planes);

#endif
