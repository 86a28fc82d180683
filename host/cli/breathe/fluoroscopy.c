/* Images of a scene that moves. */
#include "breathe/fluoroscopy.h"

#include "common/say.h"
#include "session/frames.h"

#include <float.h>
#include <math.h>

int fluoroscopy_start_image(fluoroscopy *f, int which, skg_job **job) {
    skg_output output;
    skg_frame frame;
    skg_output_init(&output);
    skg_frame_init(&frame);
    output.data = f->image[which];
    skg_status status = skg_motion_fill(f->motion, &frame);
    if (status == SKG_OK) status = skg_plan_submit(f->plan, 1, &frame, 1, &output, job);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

int fluoroscopy_wait_image(fluoroscopy *f, skg_job **job) {
    return cli_end_image(skg_job_wait(job), &f->range_warned);
}

int fluoroscopy_open_lag(fluoroscopy *f) {
    skg_readout readout;
    skg_readout_init(&readout);
    skg_status status = skg_setup_readout_get(f->session.setup, &readout);
    if (status == SKG_OK && (readout.lag_count > 0 || readout.ghosting_count > 0))
        status = skg_lag_create(f->pixels, readout.lag_count, readout.lag, &f->lag);
    if (status == SKG_OK && readout.ghosting_count > 0) /* of transmissions */
        status = skg_lag_ghosting_set(f->lag, 1, readout.ghosting_count, readout.ghosting);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}

/* A pixel's flat field is the same in all frames, so that what is held of signals is held of transmissions. */
void fluoroscopy_hold(fluoroscopy *f, int which) {
    float *image = f->image[which];
    if (!f->lag) return;
    for (int64_t i = 0; i < f->pixels; i++) image[i] = expf(-image[i]);
    skg_lag_apply(f->lag, SKG_TYPE_FLOAT32, image, 1, image);
    for (int64_t i = 0; i < f->pixels; i++) image[i] = -logf(fmaxf(image[i], FLT_MIN));
}

void fluoroscopy_picture(const fluoroscopy *f, int64_t columns, int64_t rows, const float *values,
                         skg_picture *picture) {
    skg_picture_init(picture);
    picture->type = SKG_TYPE_FLOAT32;
    picture->columns = columns;
    picture->rows = rows;
    picture->channels = 1;
    picture->data = values;
    picture->name = "attenuation";
    picture->unit = "-ln(I/I0)";
    picture->quantity = SKG_QUANTITY_ATTENUATION;
    picture->low = f->low;
    picture->high = f->high;
}

static void draw_outline(fluoroscopy *f, int which) {
    for (int64_t i = 0; f->outline && i < f->pixels; i++)
        if (f->outline[i]) f->image[which][i] = (float)f->high;
}

void fluoroscopy_greys(fluoroscopy *f, int which, unsigned char *greys) {
    draw_outline(f, which);
    for (int64_t i = 0; i < f->pixels; i++) {
        const double grey = ((double)f->image[which][i] - f->low) / (f->high - f->low);
        /* A value that is not a number is black. */
        greys[i] = (unsigned char)(!(grey > 0) ? 0 : grey >= 1 ? 255 : lround(grey * 255));
    }
}

int fluoroscopy_write(fluoroscopy *f, int which, const char *path) {
    skg_picture picture;
    draw_outline(f, which);
    fluoroscopy_picture(f, f->session.view.columns, f->session.view.rows, f->image[which], &picture);
    picture.view = &f->session.view;
    skg_status status = skg_picture_save(&picture, path);
    return status == SKG_OK ? CLI_DONE : cli_fail(status);
}
