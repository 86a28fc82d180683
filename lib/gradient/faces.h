/* The faces of a pass's parts, from the moments that the device has gathered to sums for each part. Private. */
#ifndef SKG_GRADIENT_FACES_H
#define SKG_GRADIENT_FACES_H

#include "gradient/forces.h"
#include "gradient/work.h"

/* Says where the faces of a part are in a pass. */
skg_status skg_gradient_place_faces(skg_job *job, const skg_pass *pass, int64_t part,
                                    skg_face_moments *faces);

/* Lets the kernels gather parts that contribute nothing but compete by priority, such as a hole: they have one contribution of weight 0.
 * drawn: in and out: the parts of the pass, or a staged copy */
skg_status skg_gradient_draw_competitors(skg_job *job, const skg_pass *pass, skg_geometry_part **drawn);

/* Adds up the faces of the parts. vertices: [parts] as of skg_forces_find; sums: [parts] result */
skg_status skg_gradient_add_faces(skg_job *job, const skg_pass *pass, const skg_gathered *gathered,
                                  double *const *vertices, skg_force_sums *sums);

#endif
