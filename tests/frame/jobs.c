/* A scene of many frames, and the jobs that make them. */
#include "jobs.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

skg_view jobs_view;
skg_scene *jobs_scene;
skg_mesh *jobs_ball;
skg_plan *jobs_plan;
int64_t jobs_frames;
float *jobs_pixels, jobs_reference[PIXELS];

skg_output jobs_output(float *to) {
    skg_output output;
    skg_output_init(&output);
    output.data = to;
    return output;
}

skg_plan *jobs_plan_of(int32_t samples, int32_t noise) {
    skg_plan *made = NULL;
    skg_plan_options options;
    skg_spot spot;
    skg_spectrum *beam = NULL;
    skg_plan_options_init(&options);
    skg_spot_init(&spot);
    spot.shape = SKG_SPOT_DISC;
    spot.extent[0] = 1;
    spot.samples = samples;
    if (samples) options.spot = &spot;
    options.noise = noise;
    if (noise) options.quantity = SKG_QUANTITY_ATTENUATION;
    options.supersampling = FINE;
    options.overlaps = 0;
    ck_skg(skg_spectrum_create_mono(60, 1000, &beam));
    ck_skg(skg_plan_create(run_context, jobs_scene, &jobs_view, beam, &options, &made));
    skg_spectrum_release(&beam);
    return made;
}

skg_plan *jobs_fine_plan(void) {
    return jobs_plan_of(0, 0);
}

void jobs_open(void) {
    skg_device_info device;
    run_open();
    jobs_view = run_view(SIDE, 2);
    solid s = solid_sphere(15, 24, 12);
    jobs_ball = run_mesh(&s);
    solid_free(&s);
    ck_skg(skg_scene_create(run_context, &jobs_scene));
    run_part(jobs_scene, "ball", jobs_ball, 0.5, NULL, -1);
    jobs_plan = jobs_fine_plan();
    const skg_output output = jobs_output(jobs_reference);
    ck_skg(skg_plan_image(jobs_plan, &output));
    skg_device_info_init(&device);
    ck_skg(skg_context_device_get(run_context, &device));
    jobs_frames = FRAMES_PER_CORE * (device.cpu ? device.compute_units : 1);
    jobs_pixels = malloc((size_t)(jobs_frames * PIXELS) * sizeof *jobs_pixels);
    for (int64_t i = 0; i < jobs_frames * PIXELS; i++) jobs_pixels[i] = UNTOUCHED;
}

void jobs_close(void) {
    free(jobs_pixels);
    skg_plan_release(&jobs_plan);
    skg_mesh_release(&jobs_ball);
    skg_scene_release(&jobs_scene);
    run_close();
}

skg_job *jobs_submit(void) {
    const skg_output output = jobs_output(jobs_pixels);
    skg_job *job = NULL;
    ck_skg(skg_plan_submit(jobs_plan, jobs_frames, NULL, 1, &output, &job));
    return job;
}

void jobs_check(int64_t count) {
    for (int64_t f = 0; f < jobs_frames; f++) {
        const float *image = jobs_pixels + f * PIXELS;
        if (f < count)
            ck_assert_msg(memcmp(image, jobs_reference, sizeof jobs_reference) == 0, "frame %d", (int)f);
        for (int p = 0; f >= count && p < PIXELS; p++) ck_assert(image[p] == UNTOUCHED);
    }
}

int jobs_hold_frames(void) {
    skg_device_info device;
    skg_device_info_init(&device);
    ck_skg(skg_context_device_get(run_context, &device));
    return device.cpu; /* a GPU is given more frames at once than a test can wait for */
}

skg_plan *jobs_long_plan(int32_t noise) {
    enum { SAMPLES_PER_CORE = 340 };
    return jobs_plan_of((int32_t)(SAMPLES_PER_CORE * jobs_frames / FRAMES_PER_CORE), noise);
}

void jobs_look_only(const float *pixel) {
    const struct timespec pause = {0, 1000000};
    const volatile float *seen = pixel;
    for (int k = 0; k < 120000 && *seen == UNTOUCHED; k++) nanosleep(&pause, NULL);
    ck_assert_msg(*seen != UNTOUCHED, "the device stood still for 120 s");
}
