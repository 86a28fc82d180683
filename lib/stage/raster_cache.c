/* The rasterisers of a plan: which strategy, and one for each set of abilities that its frames have called
 * for. */
#include "frame/plan.h"
#include "geometry/extent.h"

#include <math.h>
#include <string.h>

/* Mean pixels of a triangle's box in the plan's view. A closed part covers its rectangle about twice, and a
 * box has twice the area of its triangle. */
static double mean_box(const skg_plan *plan, const skg_camera *camera) {
    double pixels = 0, triangles = 0;
    for (int64_t p = 0; p < plan->scene->count; p++) {
        const skg_scene_part_data *part = &plan->scene->parts[p];
        skg_extent extent;
        skg_extent_find(camera, part->mesh, part->pose, &extent);
        if (!extent.on_detector) continue;
        const skg_scale_part *r = &extent.scale;
        const double width = fmin(r->high_column, (double)camera->columns) - fmax(r->low_column, 0);
        const double height = fmin(r->high_row, (double)camera->rows) - fmax(r->low_row, 0);
        pixels += 4 * width * height;
        triangles += (double)part->mesh->triangles;
    }
    return triangles > 0 ? pixels / triangles : 0;
}

skg_status skg_plan_choose_mix(skg_plan *plan) {
    const skg_model *model = &plan->model;
    plan->mixed = 0;
    skg_free(&plan->mix_sent);                                        /* the next frame sends its own */
    if (plan->options.precision == SKG_PRECISION_HALF) return SKG_OK; /* as the paper's buffers */
    return skg_mix_choose(plan->scene->count, model->planes, model->contributions, model->first_contribution,
                          &plan->mixed);
}

skg_status skg_plan_choose_strategy(skg_plan *plan) {
    const skg_device_info *info = &plan->context->device->info;
    skg_camera camera;
    SKG_TRY(skg_camera_make(&plan->view, NULL, 0, 0, &camera));
    const skg_raster_facts facts = {
        .is_gpu = info->is_gpu,
        .workers = info->compute_units,
        .image_bytes = plan->view.rows * plan->view.columns *
                       (plan->mixed ? plan->mixed : plan->model.planes) *
                       (plan->options.precision == SKG_PRECISION_DOUBLE ? 8 : 4),
        .triangles = plan->geometry.triangles,
        .triangle_pixels = mean_box(plan, &camera),
    };
    plan->strategy = plan->options.strategy;
    plan->strategy_reason = "asked for";
    if (plan->options.precision == SKG_PRECISION_HALF) {
        plan->strategy = SKG_STRATEGY_ATOMICS;
        plan->strategy_reason = "precision half has no other";
    }
    if (plan->strategy == SKG_STRATEGY_AUTO)
        plan->strategy = skg_raster_choose(&facts, &plan->strategy_reason);
    return SKG_OK;
}

skg_status skg_plan_raster(skg_plan *plan, const skg_kernel_options *kernels, int32_t strategy,
                           int64_t planes, int32_t more_sums, skg_raster **raster) {
    skg_raster_options options;
    memset(&options, 0, sizeof options); /* compared as bytes */
    options.kernels = *kernels;
    options.strategy = strategy;
    options.tile = strategy == SKG_STRATEGY_TILES ? plan->options.tile : 0;
    options.columns = plan->view.columns;
    options.rows = plan->view.rows;
    options.planes = planes;
    options.triangles = plan->geometry.triangles;
    options.more_sums = more_sums;
    for (int32_t i = 0; i < plan->raster_count; i++)
        if (memcmp(&options, &plan->raster_options[i], sizeof options) == 0) {
            *raster = plan->rasters[i];
            return SKG_OK;
        }
    SKG_TRY(skg_raster_create(plan->context, &options, raster));
    /* Full: the oldest goes. OpenCL keeps its memory until what is enqueued is done. */
    const int32_t slot = plan->raster_count < SKG_MOST_RASTERS ? plan->raster_count++ : plan->next_raster;
    skg_raster_release(&plan->rasters[slot]);
    plan->next_raster = (slot + 1) % SKG_MOST_RASTERS;
    plan->rasters[slot] = *raster;
    plan->raster_options[slot] = options;
    return SKG_OK;
}
