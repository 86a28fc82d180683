/* Scatter for failing_test: predicted, of a series of frames, and its orders apart; and the variance of noise. */
#include "hard/failing_series.h"

#include <string.h>

enum { FRAMES = 96, PIXELS = 24 * 18, CHANNELS = 2 };

#define TRY(call)                                                                                            \
    do {                                                                                                     \
        skg_status try_status = (call);                                                                      \
        if (try_status < 0) return try_status;                                                               \
    } while (0)

typedef struct {
    const skg_view *first;
    skg_view view;
} path;

/* The detector slides along its columns. */
static skg_status describe(int64_t index, skg_frame *frame, void *user) {
    path *p = user;
    p->view = *p->first;
    for (int k = 0; k < 3; k++) p->view.centre[k] += 0.1 * (double)index * p->view.column_step[k];
    frame->view = &p->view;
    return SKG_OK;
}

static skg_status draw(skg_plan *plan, const skg_frame *frame, int32_t kind, float *image) {
    skg_output output;
    skg_job *job = NULL;
    skg_output_init(&output);
    output.data = image;
    output.kind = kind;
    output.component = SKG_SCATTER_COMPONENT_COMPTON_SECOND;
    TRY(skg_plan_submit(plan, 1, frame, 1, &output, &job));
    return skg_job_wait(&job);
}

static skg_status draw_series(skg_plan *plan, path *p, float *image) {
    skg_scatter_series *series = NULL;
    skg_frame frame;
    TRY(skg_scatter_series_create(plan, FRAMES, describe, p, &series));
    if (!series) return SKG_ERR_ARGUMENT; /* these frames must not be too many for a series */
    skg_frame_init(&frame);
    skg_status status = describe(3, &frame, p);
    frame.scatter_series = series;
    frame.series_place = 3;
    if (status == SKG_OK) status = draw(plan, &frame, SKG_OUTPUT_IMAGE, image);
    skg_scatter_series_release(&series);
    return status;
}

skg_status failing_series(skg_plan *plan, const skg_view *view, float *image, float *components) {
    static float channels[CHANNELS * PIXELS]; /* Check would allocate */
    path p = {.first = view};
    skg_scatter_prediction prediction;
    skg_scatter_prediction_init(&prediction);
    TRY(skg_plan_scatter_predict(plan, &prediction));
    TRY(draw_series(plan, &p, image));
    TRY(draw(plan, NULL, SKG_OUTPUT_SCATTER_COMPONENT, channels));
    memcpy(components, channels, PIXELS * sizeof *components); /* of the first channel */
    return SKG_OK;
}

skg_status failing_noise(skg_plan *plan, float *variance) {
    static float mean[PIXELS]; /* Check would allocate */
    skg_output outputs[2];
    skg_job *job = NULL;
    for (int k = 0; k < 2; k++) {
        skg_output_init(&outputs[k]);
        outputs[k].kind = k ? SKG_OUTPUT_VARIANCE : SKG_OUTPUT_MEAN;
        outputs[k].data = k ? variance : mean;
    }
    TRY(skg_plan_submit(plan, 1, NULL, 2, outputs, &job));
    return skg_job_wait(&job);
}
