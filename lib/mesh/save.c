/* Writing of mesh files: binary PLY and binary STL, both little-endian. */
#include "mesh/mesh.h"

#include "core/files.h"
#include "core/maths.h"
#include "core/text.h"

#include <inttypes.h>
#include <string.h>

static void put(unsigned char *to, uint64_t bits, int bytes) {
    for (int i = 0; i < bytes; i++) to[i] = (unsigned char)(bits >> (8 * i));
}

static void put_float(unsigned char *to, float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    put(to, bits, 4);
}

static void put_double(unsigned char *to, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    put(to, bits, 8);
}

/* Whether floats hold every position exactly. A PLY file of floats then has half the size and loses nothing. */
static int fits_float(const skg_mesh *mesh) {
    for (int64_t i = 0; i < mesh->vertices; i++) {
        double p[3];
        skg_mesh_vertex(mesh, i, p);
        for (int k = 0; k < 3; k++)
            if ((double)(float)p[k] != p[k]) return 0;
    }
    return 1;
}

/* Failures to write are found by skg_output_commit. */
static void write_ply(const skg_mesh *mesh, FILE *stream) {
    int size = fits_float(mesh) ? 4 : 8;
    const char *type = size == 4 ? "float" : "double";
    unsigned char record[3 * 8];
    fprintf(
        stream,
        "ply\nformat binary_little_endian 1.0\ncomment skiagraph: positions in mm\nelement vertex %" PRId64
        "\nproperty %s x\nproperty %s y\nproperty %s z\nelement face %" PRId64
        "\nproperty list uchar int vertex_indices\nend_header\n",
        mesh->vertices, type, type, type, mesh->triangles);
    for (int64_t i = 0; i < mesh->vertices; i++) {
        double p[3];
        skg_mesh_vertex(mesh, i, p);
        for (int k = 0; k < 3; k++)
            if (size == 4)
                put_float(record + 4 * k, (float)p[k]);
            else
                put_double(record + 8 * k, p[k]);
        fwrite(record, (size_t)(3 * size), 1, stream);
    }
    record[0] = 3;
    for (int64_t t = 0; t < mesh->triangles; t++) {
        for (int k = 0; k < 3; k++) put(record + 1 + 4 * k, (uint32_t)mesh->corners[3 * t + k], 4);
        fwrite(record, 13, 1, stream);
    }
}

/* The unit normal that the order of the corners gives. STL has zeros for a triangle without area. */
static void normal_of(float corner[3][3], float normal[3]) {
    double u[3], v[3], n[3];
    for (int k = 0; k < 3; k++) {
        u[k] = (double)corner[1][k] - (double)corner[0][k];
        v[k] = (double)corner[2][k] - (double)corner[0][k];
    }
    skg_cross(u, v, n);
    double length = skg_length(n);
    for (int k = 0; k < 3; k++) normal[k] = length > 0 ? (float)(n[k] / length) : 0;
}

static void write_stl(const skg_mesh *mesh, FILE *stream) {
    unsigned char record[84] = "skiagraph: binary STL, mm"; /* must not begin with "solid" */
    put(record + 80, (uint64_t)mesh->triangles, 4);
    fwrite(record, 84, 1, stream);
    memset(record, 0, sizeof record);
    for (int64_t t = 0; t < mesh->triangles; t++) {
        float corner[3][3], normal[3];
        for (int c = 0; c < 3; c++) {
            double p[3];
            skg_mesh_vertex(mesh, mesh->corners[3 * t + c], p);
            for (int k = 0; k < 3; k++) corner[c][k] = (float)p[k];
        }
        normal_of(corner, normal);
        for (int k = 0; k < 3; k++) {
            put_float(record + 4 * k, normal[k]);
            for (int c = 0; c < 3; c++) put_float(record + 12 * (c + 1) + 4 * k, corner[c][k]);
        }
        fwrite(record, 50, 1, stream);
    }
}

skg_status skg_mesh_save(const skg_mesh *mesh, const char *path) {
    SKG_PLAIN;
    skg_output_file file;
    SKG_NEEDS(mesh);
    SKG_NEEDS(path);
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    const int is_stl = dot && skg_same_name(dot, ".stl");
    if (!*path) return skg_fail(SKG_ERR_ARGUMENT, "skg_mesh_save: no path");
    if (mesh->first_bad >= 0)
        return skg_fail(SKG_ERR_MESH, "%s: vertex %" PRId64 " is not finite; not written to %s", mesh->name,
                        mesh->first_bad, path);
    SKG_TRY(skg_output_open(path, &file));
    if (!is_stl && !(dot && skg_same_name(dot, ".ply"))) {
        skg_output_discard(&file);
        return skg_fail(SKG_ERR_ARGUMENT,
                        "%s: the extension %s%s is no mesh format that is written; use .ply or .stl", path,
                        dot ? dot : "", dot ? "" : "is missing and");
    }
    if (is_stl)
        write_stl(mesh, file.stream);
    else
        write_ply(mesh, file.stream);
    return skg_output_commit(&file);
}
