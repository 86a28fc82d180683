/* The description of a scene for pages. */
#ifndef CLI_LIVE_DESCRIBE_H
#define CLI_LIVE_DESCRIBE_H

#include "live/scene.h"

/* {"scene": ...}; NULL: the library says why not. */
skg_live_letter *live_describe_scene(const live_base *base, live_scene *scene, const live_wish *wish,
                                     int64_t geometry);

/* A number that differs where the surfaces of two scenes do. */
int64_t live_geometry_of(const live_scene *scene);

#endif
