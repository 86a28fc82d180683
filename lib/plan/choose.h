/* Which strategy rasters a scene, and how the rays of a pixel are made. Private. */
#ifndef SKG_CHOOSE_H
#define SKG_CHOOSE_H

#include "scene/scene.h"
#include "spectral/contribution.h"

#include <skiagraph/plan.h>

/* What a strategy is chosen by. */
typedef struct {
    int32_t gpu;
    int32_t workers;        /* compute units */
    int64_t image_bytes;    /* of all accumulators, within the rectangles that their parts reach */
    int64_t triangles;      /* of a frame */
    double triangle_pixels; /* mean number of pixels of a triangle's box */
} skg_strategy_facts;

/* Triangles of a frame. */
int64_t skg_scene_triangles(const skg_scene *scene);

/* The strategy for these facts, and why in a few words (static storage). */
int32_t skg_strategy_choose(const skg_strategy_facts *facts, const char **why);

/* A scene, a view and what was asked for. */
typedef struct {
    const skg_device_info *device;
    const skg_scene *scene;
    const skg_view *view;
    int32_t precision;    /* SKG_PRECISION_... */
    int32_t wanted;       /* SKG_STRATEGY_... */
    int64_t accumulators; /* planes of the raster; what the parts add to them */
    const skg_contribution *contributions;
    const int64_t *first_contribution; /* [parts + 1] */
} skg_strategy_request;

/* The strategy that is asked for, that the precision needs, or that the facts call for. */
skg_status skg_strategy_decide(const skg_strategy_request *request, int32_t *strategy, const char **why);

/* What decides how the rays of a pixel are made: not the device and not the strategy, because images have the same bits on
 * every one of them. */
typedef struct {
    int64_t shifts;        /* rays along each side of a pixel */
    int64_t columns, rows; /* of the image */
    int64_t accumulators;  /* planes of the raster */
    int64_t triangles;     /* of a frame */
    int32_t precision;     /* SKG_PRECISION_... */
    int32_t leaky;         /* 1: some mesh is leaky */
} skg_fine_request;

/* How many pixels the passes have along each side of a pixel of the image: `shifts`, so that one pass makes all rays of a
 * point of the source, or 1, with a pass for each ray. why: in a few words (static storage). */
int64_t skg_fine_choose(const skg_fine_request *request, const char **why);

/* The most accumulators that so many planes are mixed from (spectral/mix.h). The request's own number does not count. */
int32_t skg_max_mixed(const skg_fine_request *request, int32_t planes);

/* What decides how many passes of a frame are drawn together. */
typedef struct {
    int32_t strategy;    /* SKG_STRATEGY_... */
    int32_t workers;     /* compute units */
    int64_t passes;      /* of a frame */
    int64_t image_bytes; /* of all accumulator planes of a pass */
    int64_t triangles;   /* of a pass */
} skg_passes_request;

/* How many passes are drawn together, each by one worker in accumulators of its own: a multiple of the workers, or 1, with all
 * workers at each pass. side: of these, how many a worker draws side by side. */
int32_t skg_passes_choose(const skg_passes_request *request, int32_t *side);

#endif
