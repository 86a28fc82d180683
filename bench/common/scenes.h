/* Whole scenes to image. */
#ifndef BENCH_SCENES_H
#define BENCH_SCENES_H

#include "bench.h"

typedef struct {
    skg_scene *scene;
    skg_spectrum *beam;
    skg_view view;
    skg_plan_options options;
    skg_setup *setup; /* NULL: not read from a file */
} bench_scene;

/* How a generated scene differs from the usual one. */
typedef struct {
    int flat;         /* 1: no part names a parent */
    int leaky;        /* 1: one part has a hole */
    int round_source; /* 1: a small part encloses the source */
} scene_changes;

/* what: a scene file (*.json); or a closed mesh (*.stl, *.ply, *.obj), or a folder of them, in mm, in one cuboid of
 * adipose; or one sphere of about N triangles: "sphere:N"; "soup:N", whose triangles share no vertices, as those of an
 * STL file; "shuffled:N", in random order; or NULL for 60 bumpy organs in an envelope, 42,000 triangles in total. A file
 * has a view of its own. For the others the detector has size x size pixels and just covers the scene, seen along y. */
void scene_open(skg_context *context, const char *what, long size, bench_scene *out);
/* Opens a scene with `count` settings KEY=VALUE for the scene file. */
void scene_open_set(skg_context *context, const char *what, long size, int count, const char *const *settings,
                    bench_scene *out);
void scene_generate(skg_context *context, const scene_changes *changes, long size, bench_scene *out);
void scene_close(bench_scene *scene);

/* The view turned by an angle about the axis through the middle of the scene along z. */
void scene_turn(const bench_scene *scene, double degrees, skg_view *out);

#endif
