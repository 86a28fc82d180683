/* A scene of all organ surfaces of a folder, inside an envelope of adipose tissue that is wrapped around
 * them:
 *
 *     real_thorax FOLDER OUT     reads FOLDER/ *.obj (mm; x to the left, y to the back, z to the head),
 *                                writes OUT/thorax.json and OUT/envelope.stl
 *
 * Attenuation coefficients are those of one energy, 60 keV: mass attenuation of ICRU-44 tissues (NIST X-ray
 * mass attenuation coefficients, table 4) times their densities. */
#include <skiagraph/skiagraph.h>

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LEVELS = 40, DIRECTIONS = 96, ORGANS_MAX = 256 };
static const double MARGIN = 14; /* mm of fat over the outermost organ */
static const double TURN = 6.283185307179586;

/* First words of the names of parts, and 1/cm at 60 keV. The first that fits. */
static const struct {
    const char *prefix;
    double per_cm;
} tissues[] = {
    {"lung", 0.0534},    /* 0.2053 cm2/g x 0.26 g/cm3 */
    {"trachea", 0.0534}, /* a wall about air: as lung */
    {"rib", 0.366},      /* 0.2596 x 1.41: ribs as a whole, ICRU-46 */
    {"vertebra", 0.366}, {"scapula", 0.366},   {"clavicle", 0.366},
    {"sternum", 0.366},  {"cartilage", 0.225}, /* 0.2049 x 1.10 */
    {"", 0.217},                               /* soft tissue: 0.2048 x 1.06 */
};

typedef struct {
    char name[256];
    int64_t vertices;
    double *positions;
} organ;

static int failed(skg_status status) {
    if (status == SKG_OK) return 0;
    fprintf(stderr, "real_thorax: %s\n", skg_last_error());
    return 1;
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const organ *)a)->name, ((const organ *)b)->name);
}

static int read_organs(const char *folder, organ *organs) {
    DIR *directory = opendir(folder);
    int count = 0;
    for (struct dirent *entry; directory && (entry = readdir(directory)) && count < ORGANS_MAX;) {
        const size_t length = strlen(entry->d_name);
        char path[4096];
        skg_mesh *mesh = NULL;
        int64_t triangles = 0;
        organ *one = &organs[count];
        if (length < 5 || length > 200 || strcmp(entry->d_name + length - 4, ".obj") != 0) continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        memcpy(one->name, entry->d_name, length - 4);
        if (failed(skg_mesh_load(NULL, path, 1, &mesh)) ||
            failed(skg_mesh_count(mesh, &one->vertices, &triangles)))
            break;
        one->positions = calloc((size_t)one->vertices * 3, sizeof(double));
        if (one->positions) count += !failed(skg_mesh_positions_get(mesh, one->positions, 0));
        skg_mesh_release(&mesh);
    }
    if (directory) closedir(directory);
    if (count == 0) fprintf(stderr, "real_thorax: no .obj file could be read in %s\n", folder);
    qsort(organs, (size_t)count, sizeof *organs, by_name);
    return count;
}

/* Support function: how far organs reach in each direction of the (x, y) plane, by level. */
static void find_reach(const organ *organs, int count, const double *centre, double low, double step,
                       double reach[LEVELS][DIRECTIONS]) {
    double across[DIRECTIONS], down[DIRECTIONS];
    for (int level = 0; level < LEVELS; level++)
        for (int d = 0; d < DIRECTIONS; d++) reach[level][d] = 0;
    for (int d = 0; d < DIRECTIONS; d++) {
        across[d] = cos(TURN * d / DIRECTIONS);
        down[d] = sin(TURN * d / DIRECTIONS);
    }
    for (int o = 0; o < count; o++)
        for (int64_t v = 0; v < organs[o].vertices; v++) {
            const double *p = organs[o].positions + 3 * v;
            const int at = (int)((p[2] - low) / step);
            for (int level = at - 5; level <= at + 6; level++) {
                if (level < 0 || level >= LEVELS) continue;
                for (int d = 0; d < DIRECTIONS; d++) {
                    const double along = (p[0] - centre[0]) * across[d] + (p[1] - centre[1]) * down[d];
                    reach[level][d] = fmax(reach[level][d], along);
                }
            }
        }
}

/* Where the convex outline with this support lies along each direction. */
static void outline_of(const double *reach, double *radius) {
    for (int d = 0; d < DIRECTIONS; d++) {
        radius[d] = 1e9;
        for (int e = 0; e < DIRECTIONS; e++) {
            const double cosine = cos(TURN * (e - d) / DIRECTIONS);
            if (cosine > 0.05) radius[d] = fmin(radius[d], (reach[e] + MARGIN) / cosine);
        }
    }
}

/* Rings of vertices around the organs, closed by a fan at either end. */
static int write_envelope(const organ *organs, int count, const char *path) {
    static double reach[LEVELS][DIRECTIONS], radius[LEVELS][DIRECTIONS];
    static double positions[(LEVELS * DIRECTIONS + 2) * 3];
    static int32_t corners[2 * LEVELS * DIRECTIONS * 3];
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9}, centre[2];
    for (int o = 0; o < count; o++)
        for (int64_t k = 0; k < 3 * organs[o].vertices; k++) {
            low[k % 3] = fmin(low[k % 3], organs[o].positions[k]);
            high[k % 3] = fmax(high[k % 3], organs[o].positions[k]);
        }
    const double bottom = low[2] - MARGIN, step = (high[2] - low[2] + 2 * MARGIN) / (LEVELS - 1);
    for (int k = 0; k < 2; k++) centre[k] = 0.5 * (low[k] + high[k]);
    find_reach(organs, count, centre, bottom, step, reach);
    for (int level = 0; level < LEVELS; level++) outline_of(reach[level], radius[level]);
    for (int level = 0; level < LEVELS; level++)
        for (int d = 0; d < DIRECTIONS; d++) {
            double sum = 0;
            int terms =
                0; /* a mean over fewer levels than a level's reach was taken from: nothing sticks out */
            for (int near = level - 3; near <= level + 3; near++)
                if (near >= 0 && near < LEVELS) sum += radius[near][d], terms++;
            double *p = positions + 3 * (level * DIRECTIONS + d);
            p[0] = centre[0] + sum / terms * cos(TURN * d / DIRECTIONS);
            p[1] = centre[1] + sum / terms * sin(TURN * d / DIRECTIONS);
            p[2] = bottom + step * level;
        }
    const int32_t ends = LEVELS * DIRECTIONS;
    for (int end = 0; end < 2; end++) {
        memcpy(positions + 3 * (ends + end), centre, sizeof centre);
        positions[3 * (ends + end) + 2] = bottom + (end ? step * (LEVELS - 1) : 0);
    }
    int64_t triangles = 0;
#define TRIANGLE(a, b, c)                                                                                    \
    corners[3 * triangles] = (a), corners[3 * triangles + 1] = (b), corners[3 * triangles++ + 2] = (c)
    for (int d = 0; d < DIRECTIONS; d++) {
        const int next = (d + 1) % DIRECTIONS, top = (LEVELS - 1) * DIRECTIONS;
        for (int level = 0; level + 1 < LEVELS; level++) {
            const int32_t a = level * DIRECTIONS + d, b = level * DIRECTIONS + next;
            TRIANGLE(a, b, b + DIRECTIONS);
            TRIANGLE(a, b + DIRECTIONS, a + DIRECTIONS);
        }
        TRIANGLE(ends, next, d);
        TRIANGLE(ends + 1, top + d, top + next);
    }
    skg_mesh *mesh = NULL;
    int bad = failed(skg_mesh_create(NULL, "envelope",
                                     &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                        .vertices = ends + 2,
                                                        .positions = positions,
                                                        .triangles = triangles,
                                                        .corners = corners,
                                                        .unit_mm = 1},
                                     &mesh)) ||
              failed(skg_mesh_save(mesh, path));
    skg_mesh_release(&mesh);
    return bad;
}

static double attenuation_of(const char *name) {
    int i = 0;
    while (strncmp(name, tissues[i].prefix, strlen(tissues[i].prefix)) != 0) i++;
    return tissues[i].per_cm;
}

static int write_scene(const organ *organs, int count, const char *folder, const char *path) {
    FILE *file = fopen(path, "w");
    if (!file) {
        fprintf(stderr, "real_thorax: %s cannot be written\n", path);
        return 1;
    }
    fprintf(
        file,
        "{\"Source\": {\"Position\": [0, 902, 1188, \"mm\"], \"Shape\": \"PointSource\",\n"
        "            \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]},\n"
        " \"Detector\": {\"Position\": [0, -298, 1188, \"mm\"], \"UpVector\": [0, 0, -1], \"RightVector\": [1, 0, 0],\n"
        "              \"NumberOfPixels\": [1024, 1024], \"Size\": [560, 560, \"mm\"]},\n"
        " \"Samples\": [\n"
        "  {\"Label\": \"envelope\", \"Path\": \"envelope.stl\", \"Unit\": \"mm\", \"Type\": \"outer\", \"Material\": "
        "[\"mu\", 0.1875]}");
    for (int o = 0; o < count; o++)
        fprintf(
            file,
            ",\n  {\"Label\": \"%s\", \"Path\": \"%s/%s.obj\", \"Unit\": \"mm\", \"Parent\": \"envelope\", \"Material\": [\"mu\", %g]}",
            organs[o].name, folder, organs[o].name, attenuation_of(organs[o].name));
    fprintf(file, "\n ]}\n");
    if (fclose(file) == 0) return 0;
    fprintf(stderr, "real_thorax: %s could not be written to its end\n", path);
    return 1;
}

int main(int argc, char **argv) {
    static organ organs[ORGANS_MAX];
    char envelope[4096], scene[4096];
    if (argc != 3) {
        fprintf(stderr, "usage: real_thorax FOLDER OUT\n");
        return 2;
    }
    snprintf(envelope, sizeof envelope, "%s/envelope.stl", argv[2]);
    snprintf(scene, sizeof scene, "%s/thorax.json", argv[2]);
    const int count = read_organs(argv[1], organs);
    int bad =
        count == 0 || write_envelope(organs, count, envelope) || write_scene(organs, count, argv[1], scene);
    for (int o = 0; o < count; o++) free(organs[o].positions);
    return bad;
}
