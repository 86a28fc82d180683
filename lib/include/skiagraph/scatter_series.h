/** @file
 * Scatter of a series of frames, such as the projections of a scan: followed in few of them, and smooth over the detector and along
 * the series.
 *
 * @since 0.1.0 */
#ifndef SKIAGRAPH_SCATTER_SERIES_H
#define SKIAGRAPH_SCATTER_SERIES_H

#include <skiagraph/frame.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Describes a frame of a series.
 *
 *     index    number of the frame
 *     frame    prepared; to be filled in. What it points to must stay until the next call. The scene's poses and vertices
 *              may be changed as well: they hold when the function returns
 *     user     as given to skg_scatter_series_create
 *     returns  SKG_OK; another status ends skg_scatter_series_create, which returns it */
typedef skg_status (*skg_scatter_series_function)(int64_t index, skg_frame *frame, void *user);

/** Follows photons in some frames of a series.
 *
 * At first in 17 of them, at equal distances, and in 5 others between them. What arrives is written as cosines over the
 * detector times smooth functions of the frame's number (1, t, t^2 and cosines). If the 5 differ from that by more than their noise and half
 * of the error, twice as many frames are followed; if a quarter of all is not enough, the series is given up. Then more
 * photons, until the error is what skg_scatter.tolerance asks for: root mean square over detector and series, smoothing and the
 * difference of the 5 included. skg_scatter.histories: in each frame that is followed.
 *
 *     plan      its frames alone can use the series; it may be released before
 *     count     number of frames
 *     function  called for frames in any order, some of them several times
 *     series    result; the caller releases it. NULL: the plan has no scatter, the series has fewer than 32 frames, or its
 *               frames differ too much from one to the next. Each frame then has scatter of its own
 *     errors    those of skg_plan_submit with scatter; what the function returns */
SKG_API skg_status skg_scatter_series_create(skg_plan *plan, int64_t count,
                                             skg_scatter_series_function function, void *user,
                                             skg_scatter_series **series);

/** Adds an owner, who releases it. */
SKG_API skg_status skg_scatter_series_retain(skg_scatter_series *series);

/** Releases the handle, and sets it to NULL. */
SKG_API void skg_scatter_series_release(skg_scatter_series **series);

/** Frames, histories and error of a series. The library fills it; prepare with skg_scatter_series_report_init. */
typedef struct {
    /** Set by skg_scatter_series_report_init. */
    int32_t size;
    /** 0 */
    int32_t reserved;
    /** Number of frames. */
    int64_t frames;
    /** Number of frames that were followed and smoothed. */
    int64_t followed;
    /** Photons from the source, in all frames that were followed. */
    int64_t histories;
    /** Standard error over mean: root mean square over detector and series. */
    double error;
    /** Wall time. */
    double seconds;
} skg_scatter_series_report;

SKG_INIT(skg_scatter_series_report)

/** Gets the report of a series. */
SKG_API skg_status skg_scatter_series_report_get(const skg_scatter_series *series,
                                                 skg_scatter_series_report *report);

#ifdef __cplusplus
}
#endif
#endif
