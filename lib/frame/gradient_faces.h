/* The faces of a pass's parts, from the moments that the device has gathered to sums for each part. Private. */
#ifndef SKG_GRADIENT_FACES_H
#define SKG_GRADIENT_FACES_H

#include "frame/gradient_work.h"
#include "frame/job.h"
#include "geometry/forces.h"

/* Says where the faces of a part are in a pass. */
skg_status skg_gradient_place_faces(skg_job *job, const skg_pass *pass, int64_t part,
                                    skg_face_moments *faces);

/* Adds up the faces of the parts. vertices: [parts] as of skg_forces_find; sums: [parts] result */
skg_status skg_gradient_add_faces(skg_job *job, const skg_pass *pass, const skg_gathered *gathered,
                                  double *const *vertices, skg_force_sums *sums);

#endif
