/* Surfaces of parts with fewer triangles, by meshoptimizer. */
#ifndef SKG_CLI_THIN_H
#define SKG_CLI_THIN_H

#include <skiagraph/skiagraph.h>

typedef struct {
    int64_t vertices, triangles;
    int64_t of;       /* triangles that the part has */
    int32_t *origin;  /* [vertices] numbers of the part's own vertices, which are kept where they are */
    int32_t *corners; /* [triangles][3] */
} view_surface;

/* Whether this build has meshoptimizer. Without it surfaces keep all triangles. */
extern const int view_can_thin;

/* Joins vertices at the same place and removes edges until there are about `wanted` triangles; it may stop before, where the
 * surface would change its kind. A part with fewer triangles keeps them all. Returns an exit status and prints the error;
 * the caller calls view_surface_free, also after a failure. */
int view_thin(const skg_part *part, int64_t wanted, view_surface *surface);
void view_surface_free(view_surface *surface);

#endif
