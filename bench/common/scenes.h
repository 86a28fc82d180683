/* Whole scenes to image. */
#ifndef BENCH_SCENES_H
#define BENCH_SCENES_H

#include "bench.h"

typedef struct {
    skg_scene *scene;
    skg_spectrum *beam;
    skg_view view;
    skg_plan_options options;
    skg_setup *setup; /* NULL: not from a file */
} bench_scene;

/* What can go differently in a generated scene. */
typedef struct {
    int flat;         /* 1: no part names a parent */
    int open;         /* 1: one part has a hole */
    int round_source; /* 1: one small part more, about the source */
} scene_changes;

/* `what` is a scene file (*.json); a folder of closed meshes in mm, which go into one cuboid of adipose;
 * "sphere:N", one sphere of about N triangles; or NULL: 60 bumpy organs in an envelope, 42,000 triangles in
 * all. A file keeps its own view; else the detector has size x size pixels and just holds the scene, seen
 * along y. */
void scene_open(skg_context *context, const char *what, long size, bench_scene *out);
void scene_generate(skg_context *context, const scene_changes *changes, long size, bench_scene *out);
void scene_close(bench_scene *scene);

/* The view turned about an axis along z through the middle of the scene, by an angle in degrees. */
void scene_turn(const bench_scene *scene, double degrees, skg_view *out);

#endif
