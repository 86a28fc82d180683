/* Tubes: elliptic rings along a line or a curve. Private. */
#ifndef SKG_TUBE_H
#define SKG_TUBE_H

#include "phantom/rings.h"

/* One place along a tube: its centre and the half axes of its elliptic section, in mm. */
typedef struct {
    double centre[3];
    double height; /* half axis along z, as far as the tube's direction allows */
    double width;  /* half axis across both */
} skg_tube_ring;

/* Adds a tube through the rings, of `around` points each, closed by a pole `pole` mm beyond each end. */
skg_status skg_shape_tube(const char *name, int64_t rings, const skg_tube_ring *ring, double pole,
                          int64_t around, skg_mesh_arrays *arrays);

/* Adds a tube of one section along a curve, with rounded ends. side: 1, or -1 for its mirror image at x = 0. */
skg_status skg_shape_cord(const char *name, const double (*curve)[3], int64_t points, double height,
                          double width, double side, int64_t rings, int64_t around, skg_mesh_arrays *arrays);

/* Adds a tube of round section along a curve, with rounded ends, whose radius goes evenly from `first` to `last` mm.
 * Unlike a cord it may turn to any direction. side: as above. */
skg_status skg_shape_hose(const char *name, const double (*curve)[3], int64_t points, double first,
                          double last, double side, int64_t rings, int64_t around, skg_mesh_arrays *arrays);

#endif
