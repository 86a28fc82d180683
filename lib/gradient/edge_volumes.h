/* Volumes of cells along rays that lie in a face: which cells there are, and what they are worth. Private. */
#ifndef SKG_EDGE_VOLUMES_H
#define SKG_EDGE_VOLUMES_H

#include "gradient/steep.h"
#include "gradient/work.h"
#include "stage/volumes.h"

/* The weights of a pass on the host. */
typedef struct {
    const skg_pass *pass;
    skg_weight_layout layout;
    skg_host_view *planes; /* [layout.planes] not open: not read */
} skg_edge_planes;

/* Makes a plane known on the host, if it is not. */
skg_status skg_edge_plane_read(skg_job *job, int64_t plane, skg_edge_planes *planes);

/* A weight of a plane at a pixel. */
double skg_edge_plane_at(const skg_edge_planes *planes, int64_t plane, int64_t column, int64_t row);

/* A volume among the competitors of a pass. */
typedef struct {
    const skg_volume *volume;
    int64_t slot;
    int64_t first; /* of its curves, among the contributors of the model */
    skg_cell_rays rays;
    int32_t *displacing; /* [words] the set of slots inside it */
} skg_edge_volume;

/* All zero: none. */
typedef struct {
    const skg_model *model;
    int64_t count;
    skg_edge_volume *of; /* [count] */
} skg_edge_volumes;

/* Finds those of a pass, unless they are known, and reads the planes of their cells. */
skg_status skg_edge_volumes_find(skg_job *job, skg_edge_planes *planes, skg_edge_volumes *volumes);
void skg_edge_volumes_release(skg_edge_volumes *volumes);

/* Appends where the ray to a place of the detector passes from cell to cell, with an owner of -1. */
skg_status skg_edge_volumes_cross(const skg_edge_volumes *volumes, const skg_camera *camera,
                                  const double middle[2], skg_crossing_list *list);

/* d loss / d t of what the cell of volume number v adds at a depth of the ray to a place of the detector. */
double skg_edge_volume_worth(const skg_edge_volumes *volumes, int64_t v, const skg_edge_planes *planes,
                             const double middle[2], double depth, int64_t column, int64_t row);

#endif
