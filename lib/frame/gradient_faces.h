/* The faces of a pass's parts, from the moments that the device has gathered to sums for each part. Private. */
#ifndef SKG_GRADIENT_FACES_H
#define SKG_GRADIENT_FACES_H

#include "frame/gradient_work.h"
#include "frame/job.h"
#include "geometry/forces.h"

/* Says where the faces of a part are in a pass. */
skg_status skg_gradient_place_faces(skg_job *job, const skg_pass *pass, int64_t part,
                                    skg_face_moments *faces);

/* The weights of a pass on the host, for faces that are seen as lines. */
typedef struct {
    const skg_pass *pass;
    skg_weight_layout layout;
    skg_reals *planes; /* [layout.planes] without memory: not read */
} skg_pixel_weights;

/* The same for one part: what `weight_user` of its faces points to. */
typedef struct {
    const skg_pixel_weights *all;
    int64_t part;
} skg_part_weights;

/* Makes place for the weights of a pass. */
skg_status skg_pixel_weights_create(const skg_pass *pass, skg_pixel_weights *w);

/* Forgets the weights that were read. */
void skg_pixel_weights_clear(skg_pixel_weights *w);
void skg_pixel_weights_release(skg_pixel_weights *w);

/* Reads the planes that a part contributes to, if they are not read. */
skg_status skg_pixel_weights_read(skg_job *job, int64_t part, skg_pixel_weights *w);

/* d loss / d t of a ray, for skg_part_weights: what parts that compete take off is left out. */
double skg_pixel_weigh(const void *user, int64_t column, int64_t row);

/* Adds up the faces of the parts. vertices: [parts] as of skg_forces_find; sums: [parts] result */
skg_status skg_gradient_add_faces(skg_job *job, const skg_pass *pass, const skg_gathered *gathered,
                                  double *const *vertices, skg_force_sums *sums);

#endif
