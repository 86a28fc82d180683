/* Scattered photons of the frames of a plan. Private. */
#ifndef SKG_SCATTERER_H
#define SKG_SCATTERER_H

#include "core/digest.h"
#include "scatter/tracing.h"
#include "stage/readout.h"

/* All zero: nothing was computed yet. */
typedef struct {
    skg_tracing tracing;
    skg_scattered stage;
    skg_scatter_images images;
    /* [channels][SKG_SCATTER_KINDS] enum skg_scatter_component; NULL: nothing scatters */
    skg_cosines *components;
    double photons, signal; /* as of skg_shown_scatter */
    skg_digest key;         /* of the frame they hold for */
    int64_t number;         /* no other one of the process has it; 0: it has made no series yet */
    int32_t channels;       /* of components */
    int32_t known;          /* 1: they hold for it */
    int32_t warned;         /* 1: of materials that four coefficients mix badly */
    int32_t cells_warned;   /* 1: of cells that are too large */
    skg_scatter_report report;
} skg_scatterer;

/* Computes the scatter of a frame, unless it is that of the last one, and waits for it. After a failure nothing is known. */
skg_status skg_scatterer_run(skg_context *context, skg_scatterer *scatterer, const skg_scatter_work *work);

/* Takes the scatter of a frame from a series that has it. place: in frames */
skg_status skg_scatterer_take(skg_context *context, skg_scatterer *scatterer, const skg_scatter_work *work,
                              const skg_scatter_series *series, double place);

/* Fills images.component. work: that of the last run */
skg_status skg_scatterer_component(skg_context *context, skg_scatterer *scatterer,
                                   const skg_scatter_work *work, int component);

void skg_scatterer_release(skg_scatterer *scatterer);
int64_t skg_scatterer_bytes(const skg_scatterer *scatterer);

/* --- Prediction of the scatter before it is computed */

/* Images of a scene that the callback of skg_scatter_predict renders with a plan of its own. */
typedef struct {
    float *image, *scatter; /* [rows][columns] all photons, and the scattered ones */
    double open;            /* the open beam, in their unit */
} skg_scatter_rendering;

/* Renders a view with other options than the plan's. user: as given to skg_scatter_predict */
typedef skg_status (*skg_scatter_render)(void *user, const skg_view *view, const skg_plan_options *options,
                                         skg_scatter_rendering *rendering);

/* Fills a prediction but for its seconds: from one rendering, or from two where there is a grid. */
skg_status skg_scatter_predict(const skg_recipe *recipe, skg_scatter_render render, void *user,
                               skg_scatter_prediction *prediction);

#endif
