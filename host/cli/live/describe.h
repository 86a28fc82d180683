/* What pages are told of a scene and its frames. */
#ifndef CLI_LIVE_DESCRIBE_H
#define CLI_LIVE_DESCRIBE_H

#include "live/scene.h"

/* {"scene": ...}: the scene file as it is now, what the plan has decided, device, limits of the controls. */
json_t *live_describe_scene(const live_base *base, live_scene *scene, const live_wish *wish,
                            int64_t geometry);

/* {"shot": ...}: times of the stages of a frame, what it found, and source and detector. */
json_t *live_describe_shot(live_scene *scene, const live_wish *wish, const skg_view *view, int64_t number,
                           double ms);

/* {"shot": ...}: number, wish, ms and phase alone, of a frame that differs from the one before by its phase. */
json_t *live_describe_phase(const live_wish *wish, int64_t number, double ms);

/* A number that differs where the surfaces of two scenes do. */
int64_t live_geometry_of(const live_scene *scene);

#endif
