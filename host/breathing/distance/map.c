/* Maps: a mesh with a distance and a colour at each vertex. */
#include "core/core.h"
#include "core/files.h"
#include "core/text.h"
#include "distance/sample.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Colours of equal steps in brightness, from the table "viridis" of S. van der Walt and N. Smith (2015, CC0). */
static const uint8_t scale[][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                   {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                   {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
enum { STEPS = sizeof scale / sizeof *scale - 1 };

static void colour_of(double value, uint8_t *rgb) {
    const double at = STEPS * (value > 0 ? fmin(value, 1) : 0);
    const int step = (int)fmin(at, STEPS - 1);
    for (int k = 0; k < 3; k++)
        rgb[k] = (uint8_t)lround(scale[step][k] + (at - step) * (scale[step + 1][k] - scale[step][k]));
}

skg_status skg_distance_colour(double value, uint8_t *rgb) {
    SKG_NEEDS(rgb);
    colour_of(value, rgb);
    return SKG_OK;
}

static unsigned char *put(unsigned char *to, uint64_t bits, int bytes) {
    for (int i = 0; i < bytes; i++) to[i] = (unsigned char)(bits >> (8 * i));
    return to + bytes;
}

/* Failures to write are found by skg_output_commit. */
static void write_vertex(FILE *stream, const double *position, double distance, double high) {
    unsigned char record[3 * 8 + 4 + 3], *to = record;
    const float narrow = (float)distance;
    uint32_t word;
    for (int k = 0; k < 3; k++) {
        uint64_t bits;
        memcpy(&bits, position + k, sizeof bits);
        to = put(to, bits, 8);
    }
    memcpy(&word, &narrow, sizeof word);
    to = put(to, word, 4);
    colour_of(distance / high, to);
    fwrite(record, sizeof record, 1, stream);
}

static skg_status write(const skg_surface *s, const double *distances, double high, const char *path) {
    skg_output_file file;
    SKG_TRY(skg_output_open(path, &file));
    fprintf(
        file.stream,
        "ply\nformat binary_little_endian 1.0\ncomment skiagraph: mm; colours from 0 to %.9g mm\nelement vertex "
        "%" PRId64 "\nproperty double x\nproperty double y\nproperty double z\nproperty float distance\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face %" PRId64
        "\nproperty list uchar int vertex_indices\nend_header\n",
        high, s->vertices, s->triangles);
    for (int64_t i = 0; i < s->vertices; i++)
        write_vertex(file.stream, s->positions + 3 * i, distances[i], high);
    for (int64_t t = 0; t < s->triangles; t++) {
        unsigned char record[1 + 3 * 4], *to = put(record, 3, 1);
        for (int k = 0; k < 3; k++) to = put(to, (uint32_t)s->corners[3 * t + k], 4);
        fwrite(record, sizeof record, 1, file.stream);
    }
    return skg_output_commit(&file);
}

skg_status skg_distance_map_save(const skg_mesh *mesh, const double *distances, double high_mm,
                                 const char *path) {
    SKG_PLAIN;
    skg_surface surface;
    SKG_NEEDS(mesh);
    SKG_NEEDS(distances);
    SKG_NEEDS(path);
    if (!(high_mm > 0 && isfinite(high_mm)))
        return skg_fail(SKG_ERR_ARGUMENT,
                        "skg_distance_map_save: colours from 0 to %g mm; the end has to be above 0", high_mm);
    SKG_TRY(skg_surface_create(mesh, &surface));
    const skg_status status = write(&surface, distances, high_mm, path);
    skg_surface_free(&surface);
    return status;
}
