/* Whole scenes to image. */
#include "scenes.h"

#include "shapes.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ORGANS = 60, FILES = 1024, NO_PARENT = -1 };
static const double adipose = 0.171, soft = 0.193, bone = 0.428, lung = 0.05; /* 1/cm, about 80 keV */

typedef struct {
    double low[3], high[3]; /* mm */
} box;

static const box nothing = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};

static int64_t add_part(bench_scene *out, skg_mesh *mesh, double per_cm, int64_t inside, const double *place,
                        const double *scale) {
    skg_material *material = NULL;
    skg_part part;
    int64_t id = 0, parts = 0;
    char label[32];
    bench_try(skg_material_create_mu("tissue", per_cm, &material), "material");
    bench_try(skg_scene_part_count(out->scene, &parts), "scene");
    snprintf(label, sizeof label, "organ %lld", (long long)parts);
    skg_part_init(&part);
    part.mesh = mesh, part.material = material, part.inside = inside, part.label = label;
    for (int k = 0; k < 3; k++) part.pose[5 * k] = scale[k], part.pose[4 * k + 3] = place[k];
    bench_try(skg_scene_part_add(out->scene, &part, &id), "part");
    skg_material_release(&material);
    return id;
}

static skg_mesh *make_mesh(skg_context *context, int kind, double radius, int64_t triangles, int leaky) {
    bench_shape shape;
    skg_mesh *mesh = NULL;
    shape_make(kind, radius, triangles, &shape);
    if (leaky) shape_cut(&shape);
    bench_try(skg_mesh_create(context, shape_name(kind),
                              &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                 .vertices = shape.vertices,
                                                 .floats = shape.positions,
                                                 .triangles = shape.triangles,
                                                 .corners = shape.corners,
                                                 .unit_mm = 1},
                              &mesh),
              "mesh");
    shape_free(&shape);
    return mesh;
}

/* The source stands 1200 mm before the middle; the detector stands 100 mm behind the box and covers its
 * shadow. */
static void view_box(const box *all, long size, skg_view *view) {
    double half[3], middle[3];
    for (int k = 0; k < 3; k++) {
        half[k] = (all->high[k] - all->low[k]) / 2;
        middle[k] = (all->high[k] + all->low[k]) / 2;
    }
    const double source = 1200, detector = half[1] + 100;
    const double shadow = 2.1 * fmax(half[0], half[2]) * (source + detector) / (source - half[1]);
    skg_view_init(view);
    view->columns = view->rows = size;
    for (int k = 0; k < 3; k++) view->source[k] = view->centre[k] = middle[k];
    view->source[1] -= source;
    view->centre[1] += detector;
    view->column_step[0] = shadow / (double)size;
    view->row_step[2] = -shadow / (double)size;
}

static void begin(skg_context *context, bench_scene *out) {
    memset(out, 0, sizeof *out);
    skg_plan_options_init(&out->options);
    bench_try(skg_scene_create(context, &out->scene), "scene");
    bench_try(skg_spectrum_create_mono(80, 1000, &out->beam), "beam");
}

static const double nowhere[3] = {0, 0, 0}, unscaled[3] = {1, 1, 1};

void scene_generate(skg_context *context, const scene_changes *changes, long size, bench_scene *out) {
    const double torso[3] = {180, 110, 220};
    const box all = {{-torso[0], -torso[1], -torso[2]}, {torso[0], torso[1], torso[2]}};
    begin(context, out);
    view_box(&all, size, &out->view);
    skg_mesh *envelope = make_mesh(context, SHAPE_SPHERE, 1, 2592, 0);
    const int64_t outer = add_part(out, envelope, adipose, NO_PARENT, nowhere, torso);
    skg_mesh_release(&envelope);
    for (int k = 0; k < ORGANS; k++) { /* five layers of three by four */
        const double place[3] = {(k % 4 - 1.5) * 56, (k / 4 % 3 - 1) * 46, (k / 12 - 2) * 58};
        const double radius = 18 + k % 3, per_cm = k % 5 == 0 ? bone : k % 5 == 1 ? lung : soft;
        skg_mesh *organ = make_mesh(context, SHAPE_BLOB, radius, 648, changes->leaky && k == ORGANS / 2);
        add_part(out, organ, per_cm, changes->flat ? NO_PARENT : outer, place, unscaled);
        skg_mesh_release(&organ);
    }
    if (!changes->round_source) return;
    skg_mesh *bead = make_mesh(context, SHAPE_SPHERE, 5, 72, 0);
    add_part(out, bead, soft, NO_PARENT, out->view.source, unscaled);
    skg_mesh_release(&bead);
}

/* change: what else is done to the shape; NULL: nothing. */
static void one_sphere(skg_context *context, long triangles, void (*change)(bench_shape *), long size,
                       bench_scene *out) {
    const box all = {{-160, -160, -160}, {160, 160, 160}};
    bench_shape shape;
    skg_mesh *mesh = NULL;
    begin(context, out);
    view_box(&all, size, &out->view);
    shape_make(SHAPE_SPHERE, 160, triangles, &shape);
    if (change) change(&shape);
    bench_try(skg_mesh_create(context, "sphere",
                              &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                                 .vertices = shape.vertices,
                                                 .floats = shape.positions,
                                                 .triangles = shape.triangles,
                                                 .corners = shape.corners,
                                                 .unit_mm = 1},
                              &mesh),
              "mesh");
    add_part(out, mesh, soft, NO_PARENT, nowhere, unscaled);
    skg_mesh_release(&mesh);
    shape_free(&shape);
}

static int is_mesh(const char *name) {
    const char *dot = strrchr(name, '.');
    return dot && (!strcmp(dot, ".obj") || !strcmp(dot, ".stl") || !strcmp(dot, ".ply"));
}

static int by_name(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Paths of the folder's meshes, in the order of their names, which the caller frees. */
static int list_meshes(const char *folder, char **paths) {
    DIR *directory = opendir(folder);
    if (!directory) bench_die("%s: %s", folder, strerror(errno));
    int count = 0;
    for (const struct dirent *entry = readdir(directory); entry && count < FILES;
         entry = readdir(directory)) {
        if (!is_mesh(entry->d_name)) continue;
        const size_t length = strlen(folder) + strlen(entry->d_name) + 2;
        paths[count] = bench_alloc(length, 1);
        snprintf(paths[count++], length, "%s/%s", folder, entry->d_name);
    }
    closedir(directory);
    if (!count) bench_die("%s holds no .obj, .stl or .ply file", folder);
    qsort(paths, (size_t)count, sizeof *paths, by_name);
    return count;
}

static int one_path(const char *path, char **paths) {
    paths[0] = bench_alloc(strlen(path) + 1, 1);
    strcpy(paths[0], path);
    return 1;
}

static double organ_mu(const char *path) {
    static const char *const bones[] = {"rib",     "vertebra", "sternum", "clavicle",
                                        "scapula", "humerus",  "bone"};
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    if (strstr(name, "lung") || strstr(name, "trachea") || strstr(name, "bronch")) return lung;
    for (size_t k = 0; k < sizeof bones / sizeof *bones; k++)
        if (strstr(name, bones[k])) return bone;
    return soft;
}

static void from_folder(skg_context *context, const char *folder, long size, bench_scene *out) {
    char *paths[FILES];
    skg_mesh *meshes[FILES], *envelope = NULL;
    box all = nothing;
    double edges[3], middle[3];
    begin(context, out);
    const int count = is_mesh(folder) ? one_path(folder, paths) : list_meshes(folder, paths);
    for (int i = 0; i < count; i++) {
        skg_mesh_health health;
        skg_mesh_health_init(&health);
        bench_try(skg_mesh_load(context, paths[i], 1, &meshes[i]), paths[i]);
        bench_try(skg_mesh_health_get(meshes[i], &health), paths[i]);
        for (int k = 0; k < 3; k++) {
            all.low[k] = fmin(all.low[k], health.bounds[k] - 10);
            all.high[k] = fmax(all.high[k], health.bounds[k + 3] + 10);
        }
    }
    for (int k = 0; k < 3; k++) {
        edges[k] = all.high[k] - all.low[k];
        middle[k] = (all.high[k] + all.low[k]) / 2;
    }
    bench_try(skg_mesh_create_cuboid(edges[0], edges[1], edges[2], &envelope), "envelope");
    const int64_t outer = add_part(out, envelope, adipose, NO_PARENT, middle, unscaled);
    skg_mesh_release(&envelope);
    for (int i = 0; i < count; i++) {
        add_part(out, meshes[i], organ_mu(paths[i]), outer, nowhere, unscaled);
        skg_mesh_release(&meshes[i]);
        free(paths[i]);
    }
    view_box(&all, size, &out->view);
}

static void from_file(skg_context *context, const char *path, int count, const char *const *settings,
                      bench_scene *out) {
    memset(out, 0, sizeof *out);
    skg_plan_options_init(&out->options);
    skg_view_init(&out->view);
    bench_try(skg_setup_load(context, path, count, settings, &out->setup), path);
    bench_try(skg_setup_scene_get(out->setup, &out->scene), path);
    bench_try(skg_setup_spectrum_get(out->setup, &out->beam), path);
    bench_try(skg_setup_view_get(out->setup, &out->view), path);
    bench_try(skg_setup_options_get(out->setup, &out->options), path);
    bench_try(skg_scene_retain(out->scene), path);
    bench_try(skg_spectrum_retain(out->beam), path);
}

/* Opens a scene of one sphere; returns 0 if `what` names none. */
static int open_sphere(skg_context *context, const char *what, long size, bench_scene *out) {
    static const struct {
        const char *name;
        void (*change)(bench_shape *);
    } kinds[] = {{"sphere:", NULL}, {"soup:", shape_part}, {"shuffled:", shape_shuffle}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const size_t length = strlen(kinds[k].name);
        long triangles = 0;
        if (strncmp(what, kinds[k].name, length) != 0) continue;
        bench_numbers(what + length, 8, 50000000, 1, &triangles);
        one_sphere(context, triangles, kinds[k].change, size, out);
        return 1;
    }
    return 0;
}

void scene_open_set(skg_context *context, const char *what, long size, int count, const char *const *settings,
                    bench_scene *out) {
    const size_t length = what ? strlen(what) : 0;
    if (!what)
        scene_generate(context, &(scene_changes){0}, size, out);
    else if (length > 5 && !strcmp(what + length - 5, ".json"))
        from_file(context, what, count, settings, out);
    else if (!open_sphere(context, what, size, out))
        from_folder(context, what, size, out);
}

void scene_open(skg_context *context, const char *what, long size, bench_scene *out) {
    scene_open_set(context, what, size, 0, NULL, out);
}

void scene_close(bench_scene *scene) {
    skg_spectrum_release(&scene->beam);
    skg_scene_release(&scene->scene);
    skg_setup_release(&scene->setup);
}

/* The middle of the box that holds the middles of all parts. */
static void find_middle(const skg_scene *scene, double *middle) {
    int64_t parts = 0;
    box all = nothing;
    bench_try(skg_scene_part_count(scene, &parts), "scene");
    for (int64_t i = 0; i < parts; i++) {
        skg_part part;
        skg_mesh_health health;
        skg_part_init(&part);
        skg_mesh_health_init(&health);
        bench_try(skg_scene_part_get(scene, i, &part), "part");
        bench_try(skg_mesh_health_get(part.mesh, &health), "part");
        for (int k = 0; k < 3; k++) {
            double place = part.pose[4 * k + 3];
            for (int m = 0; m < 3; m++)
                place += part.pose[4 * k + m] * (health.bounds[m] + health.bounds[m + 3]) / 2;
            all.low[k] = fmin(all.low[k], place);
            all.high[k] = fmax(all.high[k], place);
        }
    }
    for (int k = 0; k < 3; k++) middle[k] = (all.low[k] + all.high[k]) / 2;
}

static void turn(const double *from, const double *middle, double angle, double *to) {
    const double c = cos(angle), s = sin(angle), x = from[0] - middle[0], y = from[1] - middle[1];
    to[0] = middle[0] + c * x - s * y;
    to[1] = middle[1] + s * x + c * y;
}

void scene_turn(const bench_scene *scene, double degrees, skg_view *out) {
    const skg_view *view = &scene->view;
    const double angle = degrees * BENCH_PI / 180;
    double middle[3];
    find_middle(scene->scene, middle);
    *out = *view;
    turn(view->source, middle, angle, out->source);
    turn(view->centre, middle, angle, out->centre);
    turn(view->column_step, nowhere, angle, out->column_step);
    turn(view->row_step, nowhere, angle, out->row_step);
}
