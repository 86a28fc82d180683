/* Scatter of a series of frames, from few of them. Private. */
#ifndef SKG_SCATTER_SERIES_H
#define SKG_SCATTER_SERIES_H

#include "scatter/joint.h"
#include "scatter/trace.h"

#include <skiagraph/scatter_series.h>

struct skg_scatter_series {
    skg_refs refs;
    skg_recipe *recipe;       /* retained */
    int64_t number;           /* no other series of the process has it */
    int64_t owner;            /* of the plan's scatterer */
    skg_joint mean, variance; /* in photons of the spectrum; variance: with noise alone */
    double signal, power;     /* as of skg_shown_scatter */
    skg_scatter_series_report report;
};

/* Describes frame `index` of a series; what *work points to must stay until the next call. */
typedef skg_status (*skg_series_frame)(int64_t index, skg_scatter_work *work, void *user);

/* Fills a series whose recipe is set. *is_smooth: 0: neighbouring frames differ too much, and nothing was filled in */
skg_status skg_series_make(skg_context *context, int64_t count, skg_series_frame frame, void *user,
                           skg_scatter_series *series, int32_t *is_smooth);
void skg_series_drop(skg_scatter_series *series);

#endif
