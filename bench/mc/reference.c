/* Reference images: MetaImage headers (.mhd) with raw float32, little endian. */
#include "mc/reference.h"

#include "common/bench.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    int64_t columns, rows;
    char data[512];
} header;

static int read_header(const char *path, header *h) {
    char line[1024];
    FILE *file = fopen(path, "r");
    if (!file) return 0;
    *h = (header){0};
    while (fgets(line, sizeof line, file)) {
        char type[64];
        if (sscanf(line, "ElementType = %63s", type) == 1 && strcmp(type, "MET_FLOAT") != 0)
            bench_die("%s: its elements are %s instead of MET_FLOAT", path, type);
        if (strncmp(line, "BinaryDataByteOrderMSB = True", 29) == 0)
            bench_die("%s: its data are big endian", path);
        sscanf(line, "DimSize = %" SCNd64 " %" SCNd64, &h->columns, &h->rows);
        sscanf(line, "ElementDataFile = %511[^\r\n]", h->data);
    }
    fclose(file);
    return 1;
}

double *reference_read(const char *prefix, const char *name, int64_t columns, int64_t rows, int needed) {
    char path[4096], data[5000];
    header h;
    snprintf(path, sizeof path, "%s%s.mhd", prefix, name);
    if (!read_header(path, &h)) {
        if (needed) bench_die("%s: cannot be read", path);
        return NULL;
    }
    if (h.columns != columns || h.rows != rows)
        bench_die("%s: %" PRId64 " x %" PRId64 " pixels, the scene has %" PRId64 " x %" PRId64, path,
                  h.columns, h.rows, columns, rows);
    const char *slash = strrchr(path, '/');
    snprintf(data, sizeof data, "%.*s%s", slash ? (int)(slash - path) + 1 : 0, path, h.data);
    const size_t count = (size_t)(columns * rows);
    float *narrow = bench_alloc(count, sizeof *narrow);
    double *image = bench_alloc(count, sizeof *image);
    FILE *file = fopen(data, "rb");
    if (!file || fread(narrow, sizeof *narrow, count, file) != count)
        bench_die("%s: %zu floats were expected", data, count);
    fclose(file);
    for (size_t p = 0; p < count; p++) image[p] = (double)narrow[p];
    free(narrow);
    return image;
}

void reference_write(const char *prefix, const char *name, const double *image, int64_t count) {
    char path[4096];
    snprintf(path, sizeof path, "%s%s.raw", prefix, name);
    FILE *file = bench_open(path);
    for (int64_t p = 0; p < count; p++) {
        const float value = (float)image[p];
        if (fwrite(&value, sizeof value, 1, file) != 1) bench_die("%s: cannot be written", path);
    }
    fclose(file);
}

double reference_ncc(const double *a, const double *b, int64_t count) {
    double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
    for (int64_t p = 0; p < count; p++) {
        mean_a += a[p] / (double)count;
        mean_b += b[p] / (double)count;
    }
    for (int64_t p = 0; p < count; p++) {
        aa += (a[p] - mean_a) * (a[p] - mean_a);
        bb += (b[p] - mean_b) * (b[p] - mean_b);
        ab += (a[p] - mean_a) * (b[p] - mean_b);
    }
    return ab / sqrt(aa * bb);
}
