/* Tables of parts for the kernels. Private. */
#ifndef SKG_TABLES_H
#define SKG_TABLES_H

#include "geometry/optics.h"
#include "mesh/mesh.h"
#include "spectral/model.h"
#include "stage/kernels.h"
#include "stage/staging.h"

/* --- The lists by which an image's planes are mixed from accumulators (spectral/model.h), on the device. */

/* All zero: nothing was sent so far. */
typedef struct {
    skg_buffer memory; /* [accumulators][planes] float or double */
    double *sent;      /* as the device has them; NULL: nothing was sent */
    int64_t count;     /* of the numbers sent */
} skg_mix_lists;

/* Enqueues the upload of `count` numbers if they differ from those on the device. */
skg_status skg_mix_lists_send(skg_mix_lists *lists, const double *numbers, int64_t count, int32_t is_double,
                              skg_staging *staging);
void skg_mix_lists_release(skg_mix_lists *lists);

/* --- The tables of a frame's parts, and of what they contribute, on their way to the device. */

/* A part in one frame. */
typedef struct {
    const double *pose;   /* 4x4, row by row */
    const double *origin; /* of its mesh's offsets, mm */
    int32_t flipped;      /* 1: the mesh is drawn with its triangles turned round */
    /* The path parameter that the part's depths are measured from: the middle of those that lie on paths, so that no
     * term is larger than the part's extent. Above 0 with a point source. */
    double reference;
    double depth;               /* the difference between its greatest and least path parameter */
    double columns[2], rows[2]; /* its rectangle on the detector, from and to; may be infinite */
    double shift;    /* pixels by which edges are moved for coverage (geometry/touching.c); 0: none */
    int32_t touches; /* 1: it may touch others, and counts pixels from `shared` as they do */
    int32_t shared[2];
    int32_t contributions; /* how many; 0: the part is not drawn, but keeps its place in the tables */
    const skg_contribution *contribution;
} skg_geometry_part;

static inline skg_camera_place skg_geometry_place(const skg_geometry_part *part, int32_t exact) {
    return (skg_camera_place){.pose = part->pose,
                              .origin = part->origin,
                              .reference = part->reference,
                              .flipped = part->flipped,
                              .exact = exact || part->touches,
                              .shared = part->touches ? part->shared : NULL};
}

/* Host copies of the part and contribution tables. Each stays until the device has read it, so that writing a frame's
 * tables does not wait for the frames before it: as many frames can be enqueued ahead as there are copies. */
enum { SKG_TABLE_SLOTS = 64 };

/* How many copies of `bytes` there are, at most SKG_TABLE_SLOTS: together they have 4 MiB, but there are at least four of them. */
int32_t skg_table_slots(int64_t bytes);
typedef struct {
    void *entries;       /* skg_part_float or skg_part_double [parts]; then the lines of a curved detector */
    int64_t lines_bytes; /* for which there is memory */
    void *contributions; /* skg_contribution_float or skg_contribution_double [contribution_count] */
    int64_t contribution_count, capacity;
    cl_event read; /* of the last write from this slot; NULL: none */
} skg_table_slot;

typedef struct {
    int64_t meshes, parts;
    int64_t vertices, triangles; /* over all parts, with the copies of merged vertices */
    int64_t mesh_vertices;       /* over all meshes, with them */
    int32_t precision;           /* SKG_PRECISION_SINGLE or SKG_PRECISION_DOUBLE: of offsets and tables */
    int32_t slot_count;          /* of `slots`: fewer if there are many parts */
    int64_t *mesh_vertex;        /* [meshes + 1] first vertex of each mesh in the vertex buffer */
    int64_t *mesh_of_part;       /* [parts] */
    int64_t *mesh_triangle;      /* [meshes + 1] first triangle of each mesh in the buffer of corners */
    skg_mesh_layout *layouts;    /* [meshes]; corners: NULL once they are on the device */
    int64_t *versions;           /* [meshes] of the vertices as the device has them; 0: it has none */
    int64_t *first_vertex;       /* [parts + 1] in the numbering over all parts */
    int32_t slot;                /* that holds the tables as the device has them */
    int32_t uploaded;            /* 1: the device has tables */
    int64_t state; /* changes with the tables and vertices on the device; never 0 once they are there */
    int64_t projected_state; /* the state of which `projected` is; 0: not known */
    cl_kernel projected_by;
    int32_t projections; /* since skg_geometry_begin_frame or skg_geometry_reset_bad */
    int32_t bad_stands;  /* 1: `bad` is of the frame before, and is reset by the next projection */
    int32_t frame;       /* of the job, from which on `bad` is written */
    int32_t each;        /* 1: passes that are drawn together are frames */
    skg_table_slot slots[SKG_TABLE_SLOTS];
    skg_buffer offsets, corners, part_table, contribution_table, vertex_blocks, triangle_blocks;
    /* x, y, z, t of each vertex over all parts; t: or rests (kernels/raster/fine.clh) */
    skg_buffer projected;
    /* int [frames of a job]: the lowest vertex over all parts that was not finite since the last reset; INT32_MAX: none */
    skg_buffer bad;
} skg_geometry;

static inline int skg_geometry_is_double(const skg_geometry *geometry) {
    return geometry->precision == SKG_PRECISION_DOUBLE;
}

/* Bytes of a part's entry in a table. */
static inline size_t skg_geometry_entry_size(const skg_geometry *geometry) {
    return skg_geometry_is_double(geometry) ? sizeof(skg_part_double) : sizeof(skg_part_float);
}

/* Frees the host copies of the tables, once the device has read them. */
void skg_geometry_release_tables(skg_geometry *geometry);

/* Enqueues another part table for a frame that is projected: the same parts with other contributions. */
skg_status skg_geometry_weigh(skg_context *context, skg_geometry *geometry, const skg_camera *camera,
                              const skg_geometry_part *part, double scale);

/* The tables of passes that are drawn together, on the host. All zero: of none. */
typedef struct {
    int64_t passes, contribution_count; /* of each pass */
    int64_t lines_bytes;           /* of the lines of a curved detector, behind the entries; 0: it is flat */
    void *entries, *contributions; /* staged; one pass behind the other */
} skg_pass_tables;

/* Adds the tables of one pass to those of others that differ in their cameras and scales. There are at most `room`. */
skg_status skg_geometry_weigh_pass(skg_geometry *geometry, const skg_camera *camera,
                                   const skg_geometry_part *part, double scale, int32_t room,
                                   skg_pass_tables *tables, skg_staging *staging);

/* Enqueues the upload of the tables of all of them. */
skg_status skg_geometry_send_passes(skg_context *context, skg_geometry *geometry,
                                    const skg_pass_tables *tables);

#endif
