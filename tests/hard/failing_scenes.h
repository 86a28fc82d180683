/* The scenes of failing_test, and the effects of its runs. */
#ifndef SKG_TESTS_FAILING_SCENES_H
#define SKG_TESTS_FAILING_SCENES_H

#include <skiagraph/skiagraph.h>

/* The effects, spread over few runs; settings change the scene file. */
typedef struct {
    const char *file, *settings[12]; /* NULL: no more */
    int32_t strategy;
    skg_spot spot; /* shape 0: the scene's */
    int32_t bands, clip, falloff, ratio, breathes;
    int32_t strided; /* the image's rows are not dense */
    int32_t shared;  /* on OpenCL objects of the caller, into the caller's buffer */
    int32_t scans;   /* a scan into files, beside the images */
    int32_t varies;  /* the variance of the noise, beside the images */
    int32_t series;  /* the scatter of many frames, beside the images */
    int32_t derives; /* derivatives, whose weights are the caller's buffer, beside the images */
    const char *device;
    int32_t fresh; /* nothing was kept: the device is tested, and programs are compiled and kept */
} effects;

enum { FAILING_RUNS = 14 };
extern const effects failing_runs[FAILING_RUNS];

/* Writes scene.json, body.json and the files that they name into a folder. */
void failing_write_scenes(const char *folder);

#endif
