/* Stage `volume`: what the cells of volumes add to the sums of a raster (kernels/raster/volume.cl). Private. */
#ifndef SKG_VOLUMES_H
#define SKG_VOLUMES_H

#include "stage/hits.h"
#include "stage/volume_lines.h"

/* A volume on the device. */
typedef struct {
    int64_t part;
    const skg_volume *volume; /* of the scene */
    skg_buffer cells, weights, displacing;
    skg_cell_lines lines;
    int64_t plane_count;
    int32_t *planes;  /* [plane_count] that its cells add to */
    int32_t lanes;    /* planes of a launch: 1, 4 or 8 */
    int32_t exponent; /* weights are multiplied by two to the power of this, and rounded */
    double most;      /* the largest weight of a cell */
} skg_placed_volume;

/* All zero: no volumes. */
typedef struct skg_volumes {
    int64_t count;
    skg_placed_volume *volumes;
    skg_placed_volume alone; /* of skg_volumes_add_alone: its cells are borrowed */
} skg_volumes;

/* Uploads the cells of a scene's volumes. SKG_ERR_DEVICE_MEMORY if they are larger than the device allows. */
skg_status skg_volumes_create(skg_context *context, const skg_scene *scene, skg_volumes *volumes);

/* Uploads what the cells add to the planes of a model, in place of what was there. */
skg_status skg_volumes_weigh(skg_context *context, const skg_scene *scene, const skg_model *model,
                             skg_volumes *volumes);
void skg_volumes_release(skg_volumes *volumes);

/* Bytes on the device. */
int64_t skg_volumes_bytes(const skg_volumes *volumes);

/* The volume that a part is; NULL: it is none. */
const skg_placed_volume *skg_volumes_find(const skg_volumes *volumes, int64_t part);

/* The largest weight of a cell of a part; 0: it is no volume. */
double skg_volumes_most(const skg_volumes *volumes, int64_t part);

/* Finds the rays of a camera in the axes of a volume. to_cells: from mm of the world */
void skg_cell_rays_find(const skg_camera *camera, const double *to_cells, skg_cell_rays *rays);

/* Fills what kernels know of a volume's rays in a pass, and uploads which parts displace it: all but window, unit and planes. */
skg_status skg_volume_args_fill(skg_placed_volume *placed, const skg_pass *pass, const skg_hits_memory *hits,
                                skg_staging *staging, skg_volume_args *args);

/* Takes the planes of a launch, from `first` on. */
void skg_volume_args_planes(const skg_placed_volume *placed, int64_t first, skg_volume_args *args);

/* Gets a program that reads the cells of a volume. */
skg_status skg_volume_program(const skg_placed_volume *placed, const skg_pass *pass, skg_context *context,
                              int32_t count, const char *const *files, cl_program *program);

/* Enqueues the sums of all volumes behind the raster and the hits of a pass. */
skg_status skg_volumes_add(const skg_volumes *volumes, const skg_pass *pass, const skg_hits_memory *hits,
                           skg_staging *staging);

/* Enqueues what the cells of one part add to a plane of the model as the sums of a pass of one plane. */
skg_status skg_volumes_add_alone(skg_volumes *volumes, const skg_model *model, int64_t part, int32_t plane,
                                 const skg_pass *pass, const skg_hits_memory *hits, skg_staging *staging);

#endif
