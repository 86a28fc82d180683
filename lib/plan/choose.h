/* Which strategy rasters a scene. Private. */
#ifndef SKG_CHOOSE_H
#define SKG_CHOOSE_H

#include "scene/scene.h"

#include <skiagraph/plan.h>

/* What a strategy is chosen by. */
typedef struct {
    int32_t is_gpu;
    int32_t workers;        /* compute units */
    int64_t image_bytes;    /* of all accumulator planes */
    int64_t triangles;      /* of a frame */
    double triangle_pixels; /* mean number of pixels of a triangle's box */
} skg_strategy_facts;

/* The strategy for these facts, and why in a few words (static storage). */
int32_t skg_strategy_choose(const skg_strategy_facts *facts, const char **why);

/* A scene, a view and what was asked for. */
typedef struct {
    const skg_device_info *device;
    const skg_scene *scene;
    const skg_view *view;
    int32_t precision;    /* SKG_PRECISION_... */
    int32_t wanted;       /* SKG_STRATEGY_... */
    int64_t accumulators; /* planes of the raster */
} skg_strategy_request;

/* The strategy that is asked for, that the precision needs, or that the facts call for. */
skg_status skg_strategy_decide(const skg_strategy_request *request, int32_t *strategy, const char **why);

#endif
