#include "breathe.h"

#include "folder.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Text PLY: nine digits bring every float back. */
static int write_ply(const char *path, int64_t vertices, const double *now, const double *rest,
                     int64_t triangles, const int32_t *corners) {
    FILE *f = fopen(path, "w");
    if (!f) return cli_error(CLI_OUTPUT, "%s: cannot be written: %s", path, strerror(errno));
    fprintf(
        f,
        "ply\nformat ascii 1.0\ncomment mm; displacement from the scene's own mesh\nelement vertex %" PRId64
        "\nproperty float x\nproperty float y\nproperty float z\nproperty float displacement\nelement face "
        "%" PRId64 "\nproperty list uchar int vertex_indices\nend_header\n",
        vertices, triangles);
    for (int64_t i = 0; i < vertices; i++) {
        const double *p = now + 3 * i, *q = rest + 3 * i;
        const double moved = sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                                  (p[2] - q[2]) * (p[2] - q[2]));
        fprintf(f, "%.9g %.9g %.9g %.9g\n", p[0], p[1], p[2], moved);
    }
    for (int64_t t = 0; t < triangles; t++)
        fprintf(f, "3 %" PRId32 " %" PRId32 " %" PRId32 "\n", corners[3 * t], corners[3 * t + 1],
                corners[3 * t + 2]);
    int failed = ferror(f) | fclose(f);
    if (!failed) return CLI_DONE;
    remove(path);
    return cli_error(CLI_OUTPUT, "%s: cannot be written: %s", path, strerror(errno));
}

static int write_part(const cli_fluoroscopy *f, int64_t part, const char *label, const skg_mesh *mesh,
                      const char *folder, int64_t frame) {
    int64_t vertices = 0, triangles = 0;
    skg_status status = skg_mesh_size(mesh, &vertices, &triangles);
    double *now = malloc((size_t)vertices * 6 * sizeof *now);
    int32_t *corners = malloc((size_t)triangles * 3 * sizeof *corners);
    char *path = cli_path_in(folder, "%s-%04" PRId64 ".ply", label, frame);
    int exit_status = CLI_DONE;
    if (!now || !corners || !path) {
        exit_status = cli_error(CLI_DEVICE, "out of host memory for %s", label);
    } else {
        for (char *c = path + strlen(folder) + 1; *c; c++)
            if (*c == '/' || *c == ' ') *c = '-';
        if (status == SKG_OK) status = skg_mesh_read_positions(mesh, now, 0);
        if (status == SKG_OK) status = skg_motion_rest(f->motion, part, now + 3 * vertices);
        if (status == SKG_OK) status = skg_mesh_read_triangles(mesh, corners, 0);
        exit_status = status != SKG_OK
                          ? cli_fail(status)
                          : write_ply(path, vertices, now, now + 3 * vertices, triangles, corners);
    }
    free(now);
    free(corners);
    free(path);
    return exit_status;
}

int cli_write_meshes(const cli_fluoroscopy *f, const char *folder, int64_t frame) {
    int64_t parts = 0;
    int exit_status = CLI_DONE;
    skg_status status = skg_scene_size(f->session.scene, &parts);
    for (int64_t p = 0; p < parts && status == SKG_OK && exit_status == CLI_DONE; p++) {
        skg_part part;
        int32_t moves = 0;
        skg_part_init(&part);
        status = skg_scene_part(f->session.scene, p, &part);
        if (status == SKG_OK) status = skg_motion_moves(f->motion, p, &moves);
        if (status == SKG_OK && moves) exit_status = write_part(f, p, part.label, part.mesh, folder, frame);
    }
    return status == SKG_OK ? exit_status : cli_fail(status);
}
