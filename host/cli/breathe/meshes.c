/* The meshes of the parts at one moment of the breath, as files of a folder. */
#include "breathe/outputs.h"

#include "common/file.h"
#include "common/made.h"
#include "common/say.h"
#include "common/values.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VERTEX_BYTES = 3 * 8 + 4, TRIANGLE_BYTES = 1 + 3 * 4, LONGEST_HEADER = 512 };

static unsigned char *put(unsigned char *to, uint64_t bits, int bytes) {
    for (int i = 0; i < bytes; i++) to[i] = (unsigned char)(bits >> (8 * i));
    return to + bytes;
}

static unsigned char *put_vertex(unsigned char *to, const double *now, const double *rest) {
    const float moved =
        (float)sqrt((now[0] - rest[0]) * (now[0] - rest[0]) + (now[1] - rest[1]) * (now[1] - rest[1]) +
                    (now[2] - rest[2]) * (now[2] - rest[2]));
    uint32_t narrow;
    for (int k = 0; k < 3; k++) {
        uint64_t wide;
        memcpy(&wide, now + k, sizeof wide);
        to = put(to, wide, 8);
    }
    memcpy(&narrow, &moved, sizeof narrow);
    return put(to, narrow, 4);
}

/* Binary PLY with positions in double, so that they are exact. */
static int write_ply(const char *path, int64_t vertices, const double *now, const double *rest,
                     int64_t triangles, const int32_t *corners) {
    unsigned char *bytes =
        malloc((size_t)(LONGEST_HEADER + vertices * VERTEX_BYTES + triangles * TRIANGLE_BYTES));
    if (!bytes) return cli_error(CLI_DEVICE, "out of host memory for %s", path);
    unsigned char *to =
        bytes +
        snprintf(
            (char *)bytes, LONGEST_HEADER,
            "ply\nformat binary_little_endian 1.0\ncomment skiagraph: mm; displacement from the scene's own "
            "mesh\nelement vertex %" PRId64
            "\nproperty double x\nproperty double y\nproperty double z\nproperty float "
            "displacement\nelement face %" PRId64 "\nproperty list uchar int vertex_indices\nend_header\n",
            vertices, triangles);
    for (int64_t i = 0; i < vertices; i++) to = put_vertex(to, now + 3 * i, rest + 3 * i);
    for (int64_t t = 0; t < triangles; t++) {
        to = put(to, 3, 1);
        for (int k = 0; k < 3; k++) to = put(to, (uint32_t)corners[3 * t + k], 4);
    }
    cli_made(path);
    const int exit_status = cli_write_file(path, bytes, (size_t)(to - bytes));
    free(bytes);
    return exit_status;
}

static int write_part(const fluoroscopy *f, int64_t part, const char *label, const skg_mesh *mesh,
                      const char *folder, int64_t frame) {
    int64_t vertices = 0, triangles = 0;
    skg_status status = skg_mesh_count(mesh, &vertices, &triangles);
    double *now = malloc((size_t)vertices * 6 * sizeof *now);
    int32_t *corners = malloc((size_t)triangles * 3 * sizeof *corners);
    char name[CLI_NAME_OF_PART];
    cli_name_of_part(label, part, name);
    char *path = cli_path_in(folder, "%s-%04" PRId64 ".ply", name, frame);
    int exit_status = CLI_DONE;
    if (!now || !corners || !path) {
        exit_status = cli_error(CLI_DEVICE, "out of host memory for %s", label);
    } else {
        exit_status = cli_check_overwrite(f->arguments, path);
        if (status == SKG_OK) status = skg_mesh_positions_get(mesh, now, 0);
        if (status == SKG_OK) status = skg_motion_rest_get(f->motion, part, now + 3 * vertices);
        if (status == SKG_OK) status = skg_mesh_triangles_get(mesh, corners, 0);
        if (exit_status == CLI_DONE)
            exit_status = status != SKG_OK
                              ? cli_fail(status)
                              : write_ply(path, vertices, now, now + 3 * vertices, triangles, corners);
    }
    free(now);
    free(corners);
    free(path);
    return exit_status;
}

int meshes_write(const fluoroscopy *f, const char *folder, int64_t frame) {
    int64_t parts = 0;
    int exit_status = CLI_DONE;
    skg_status status = skg_scene_part_count(f->session.scene, &parts);
    for (int64_t p = 0; p < parts && status == SKG_OK && exit_status == CLI_DONE; p++) {
        skg_part part;
        int32_t moves = 0;
        skg_part_init(&part);
        status = skg_scene_part_get(f->session.scene, p, &part);
        if (status == SKG_OK) status = skg_motion_part_moves(f->motion, p, &moves);
        if (status == SKG_OK && moves) exit_status = write_part(f, p, part.label, part.mesh, folder, frame);
    }
    return status == SKG_OK ? exit_status : cli_fail(status);
}
