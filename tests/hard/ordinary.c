/* Bound on the time of a frame of a hard case: three times that of an ordinary scene of that size. */
#include "hard/catalogue.h"
#include "suite.h"
#include "support/angles.h"
#include "support/random.h"

#include <math.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 9 };

typedef struct {
    double from[3], way[3]; /* the path is from + t way, 0 <= t <= 1 */
} path;

static path path_to(const skg_view *view, double column, double row) {
    path p;
    const double c = column - 0.5 * (double)(view->columns - 1), r = row - 0.5 * (double)(view->rows - 1);
    for (int k = 0; k < 3; k++) {
        const double pixel = view->centre[k] + c * view->column_step[k] + r * view->row_step[k];
        p.way[k] = (view->projection == SKG_PROJECTION_POINT ? pixel : view->centre[k]) - view->source[k];
        p.from[k] = pixel - p.way[k];
    }
    return p;
}

static double triple(const double a[3], const double b[3], const double c[3]) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* Moeller and Trumbore, Journal of Graphics Tools 2(1), 1997. */
static int meets(const path *p, const double *a, const double *b, const double *c) {
    double ab[3], ac[3], from[3];
    for (int k = 0; k < 3; k++) ab[k] = b[k] - a[k], ac[k] = c[k] - a[k], from[k] = p->from[k] - a[k];
    const double whole = triple(p->way, ab, ac);
    const double u = triple(p->way, from, ac) / whole, v = triple(p->way, ab, from) / whole;
    const double t = -triple(from, ab, ac) / whole;
    return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 && t <= 1;
}

typedef struct {
    int64_t triangles;
    double hits; /* expected, of all pixels' paths with triangles */
} size_of_scene;

static size_of_scene measure(const skg_scene *scene, const skg_view *view) {
    enum { PATHS_MAX = 1000 };
    static path paths[PATHS_MAX];
    int64_t parts = 0, met = 0, count = 0, vertices = 0, triangles = 0;
    uint64_t seed = 3;
    size_of_scene size = {0};
    double *rest = NULL, *posed = NULL;
    int32_t *corners = NULL;
    const skg_mesh *known = NULL;
    ck_skg(skg_scene_part_count(scene, &parts));
    for (int64_t i = 0; i < parts; i++) {
        skg_part part;
        skg_part_init(&part);
        ck_skg(skg_scene_part_get(scene, i, &part));
        ck_skg(skg_mesh_count(part.mesh, &vertices, &triangles));
        size.triangles += triangles;
    }
    count = 30000000 / size.triangles < 8 ? 8 : 30000000 / size.triangles;
    if (count > PATHS_MAX) count = PATHS_MAX;
    for (int64_t n = 0; n < count; n++)
        paths[n] =
            path_to(view, draw(&seed, 0, (double)view->columns - 1), draw(&seed, 0, (double)view->rows - 1));
    for (int64_t i = 0; i < parts; i++) {
        skg_part part;
        skg_part_init(&part);
        ck_skg(skg_scene_part_get(scene, i, &part));
        if (part.mesh != known) {
            known = part.mesh;
            ck_skg(skg_mesh_count(part.mesh, &vertices, &triangles));
            rest = realloc(rest, (size_t)vertices * 3 * sizeof *rest);
            posed = realloc(posed, (size_t)vertices * 3 * sizeof *posed);
            corners = realloc(corners, (size_t)triangles * 3 * sizeof *corners);
            ck_skg(skg_mesh_positions_get(part.mesh, rest, 0));
            ck_skg(skg_mesh_triangles_get(part.mesh, corners, 0));
        }
        for (int64_t v = 0; v < vertices; v++)
            for (int k = 0; k < 3; k++) {
                const double *row = part.pose + 4 * k, *at = rest + 3 * v;
                posed[3 * v + k] = row[0] * at[0] + row[1] * at[1] + row[2] * at[2] + row[3];
            }
        for (int64_t t = 0; t < triangles; t++)
            for (int64_t n = 0; n < count; n++)
                met += meets(&paths[n], posed + 3 * corners[3 * t], posed + 3 * corners[3 * t + 1],
                             posed + 3 * corners[3 * t + 2]);
    }
    free(rest);
    free(posed);
    free(corners);
    size.hits = (double)met / (double)count * (double)(view->rows * view->columns);
    return size;
}

/* Spheres about one centre, as many as give the wanted triangles and hits; 400 mm of detector. */
static skg_scene *ordinary_scene(size_of_scene size, const skg_view *view) {
    const double largest = 120, pitch = 400.0 / (double)view->columns, magnified = 1.2;
    const double shadow = pi * largest * largest * magnified * magnified / (pitch * pitch);
    const double layers = fmax(1, ceil(size.hits / (2 * shadow)));
    const double radius = fmax(1, largest * sqrt(size.hits / (2 * shadow * layers)));
    const int down = (int)fmax(3, sqrt((double)size.triangles / layers) / 2);
    solid all = solid_sphere(radius, 2 * down, down);
    for (double n = 1; n < layers; n++) {
        solid next = solid_sphere(radius * (1 - 0.3 * n / layers), 2 * down, down);
        solid_add(&all, &next);
        solid_free(&next);
    }
    skg_scene *scene = run_scene(&all, NULL);
    solid_free(&all);
    return scene;
}

static double frame_ms(skg_plan *plan, const skg_view *view) {
    struct timespec start, end;
    clock_gettime(CLOCK_MONOTONIC, &start);
    free(run_image(plan, view));
    clock_gettime(CLOCK_MONOTONIC, &end);
    return 1e3 * (double)(end.tv_sec - start.tv_sec) + 1e-6 * (double)(end.tv_nsec - start.tv_nsec);
}

void hard_compare_time(hard_outcome *o, const skg_scene *scene, skg_plan *plan, const skg_view *view) {
    const size_of_scene size = measure(scene, view);
    skg_view ordinary = run_view(view->columns, 400.0 / (double)view->columns);
    ordinary.rows = view->rows;
    skg_scene *other_scene = ordinary_scene(size, &ordinary);
    skg_plan *other = run_plan(other_scene, &ordinary, (run_choice){0});
    double least = HUGE_VAL, other_min = HUGE_VAL;
    for (int n = 0; n < ROUNDS; n++) { /* alternately: both see the same machine */
        least = fmin(least, frame_ms(plan, view));
        other_min = fmin(other_min, frame_ms(other, &ordinary));
    }
    o->slower = least / other_min;
    skg_plan_release(&other);
    skg_scene_release(&other_scene);
}
