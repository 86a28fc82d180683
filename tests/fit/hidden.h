/* Bodies with hidden parameters: the smallest thorax, and surfaces of its organs as these parameters pose them. */
#ifndef SKG_TESTS_FIT_HIDDEN_H
#define SKG_TESTS_FIT_HIDDEN_H

#include "fit/types.h"
#include "scene/scene.h"
#include "setup/types.h"
#include "suite.h"
#include "support/random.h"

#include <skiagraph/distance.h>
#include <skiagraph/fit.h>
#include <skiagraph/motion.h>
#include <skiagraph/thorax.h>

#include <dirent.h>
#include <math.h>
#include <string.h>

static char folder[64], scene_path[128];

/* Writes the smallest thorax. */
static inline void set_up(void) {
    skg_thorax_options options;
    skg_thorax *thorax;
    strcpy(folder, "/tmp/skg-fit-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(scene_path, sizeof scene_path, "%s/thorax.json", folder);
    skg_thorax_options_init(&options);
    options.triangles = 10000;
    options.simple = 1;
    ck_skg(skg_thorax_create(&options, &thorax));
    ck_skg(skg_thorax_save(thorax, folder));
    skg_thorax_release(&thorax);
}

static inline void tear_down(void) {
    DIR *files = opendir(folder);
    for (struct dirent *one; (one = readdir(files));) {
        char path[400];
        snprintf(path, sizeof path, "%s/%s", folder, one->d_name);
        if (one->d_name[0] != '.') unlink(path);
    }
    closedir(files);
    rmdir(folder);
}

static inline skg_setup *load(int64_t count, const char *const *settings) {
    skg_setup *setup;
    ck_skg(skg_setup_load(NULL, scene_path, count, settings, &setup));
    return setup;
}

static inline int64_t part_of(const skg_setup *setup, const char *label) {
    for (int64_t p = 0; p < setup->scene->count; p++)
        if (!strcmp(setup->scene->parts[p].label, label)) return p;
    ck_abort_msg("no part %s", label);
}

/* A target surface: scene, organ, phase, settings, noise. */
typedef struct {
    const char *scene; /* NULL: the thorax */
    const char *label;
    double phase;
    int count;
    const char *const *settings; /* [count] */
    double noise;                /* standard deviation of every vertex along each axis, mm */
    int divided;                 /* 1: every triangle is divided into four */
} surface_of;

/* The middle of each edge becomes a vertex, each triangle four. Both arrays have room for that. */
static inline void divide(int64_t *vertices, double *positions, int64_t *triangles, int32_t *corners) {
    const int64_t before = *vertices, count = *triangles;
    int32_t *next = malloc((size_t)(3 * count) * sizeof *next),
            *first = malloc((size_t)before * sizeof *first);
    int32_t *other = malloc((size_t)(3 * count) * sizeof *other);
    int64_t made = 0;
    for (int64_t v = 0; v < before; v++) first[v] = -1;
    for (int64_t t = count; t-- > 0;) {
        int32_t c[3], m[3];
        memcpy(c, corners + 3 * t, sizeof c);
        for (int e = 0; e < 3; e++) {
            const int32_t p = c[e] < c[(e + 1) % 3] ? c[e] : c[(e + 1) % 3], q = c[e] + c[(e + 1) % 3] - p;
            int32_t at = first[p];
            while (at >= 0 && other[at] != q) at = next[at];
            if (at < 0) {
                at = (int32_t)made++;
                other[at] = q, next[at] = first[p], first[p] = at;
                for (int k = 0; k < 3; k++)
                    positions[3 * (before + at) + k] = 0.5 * (positions[3 * p + k] + positions[3 * q + k]);
            }
            m[e] = (int32_t)before + at;
        }
        const int32_t four[12] = {c[0], m[0], m[2], m[0], c[1], m[1], m[2], m[1], c[2], m[0], m[1], m[2]};
        memcpy(corners + 12 * t, four, sizeof four);
    }
    *vertices += made, *triangles *= 4;
    free(next);
    free(first);
    free(other);
}

/* A normal deviate, nearly: the sum of twelve numbers. */
static inline double bell(uint64_t *state) {
    double sum = -6;
    for (int i = 0; i < 12; i++) sum += draw(state, 0, 1);
    return sum;
}

static inline skg_mesh *surface(const surface_of *from) {
    skg_setup *setup;
    skg_motion *motion;
    skg_mesh *copy;
    int64_t vertices, triangles;
    uint64_t state = 11;
    ck_skg(skg_setup_load(NULL, from->scene ? from->scene : scene_path, from->count, from->settings, &setup));
    const skg_mesh *mesh = setup->scene->parts[part_of(setup, from->label)].mesh;
    ck_skg(skg_motion_create(NULL, setup, &motion));
    ck_skg(skg_motion_pose_at_phase(motion, from->phase));
    ck_skg(skg_mesh_count(mesh, &vertices, &triangles));
    double *positions = calloc((size_t)(3 * (vertices + 3 * triangles)), sizeof *positions);
    int32_t *corners = calloc((size_t)(12 * triangles), sizeof *corners);
    ck_skg(skg_mesh_positions_get(mesh, positions, 0));
    ck_skg(skg_mesh_triangles_get(mesh, corners, 0));
    if (from->divided) divide(&vertices, positions, &triangles, corners);
    for (int64_t i = 0; i < 3 * vertices && from->noise > 0; i++) positions[i] += from->noise * bell(&state);
    ck_skg(skg_mesh_create(NULL, from->label,
                           &(skg_mesh_source){.size = sizeof(skg_mesh_source),
                                              .vertices = vertices,
                                              .positions = positions,
                                              .triangles = triangles,
                                              .corners = corners,
                                              .unit_mm = 1},
                           &copy));
    free(positions);
    free(corners);
    skg_motion_release(&motion);
    skg_setup_release(&setup);
    return copy;
}

static inline skg_fit_state run(skg_fit *fit) {
    skg_fit_state state;
    skg_fit_state_init(&state);
    do ck_skg(skg_fit_step(fit, &state));
    while (!state.done);
    return state;
}

static inline skg_fit_target target_of(const skg_fit *fit, int64_t index) {
    skg_fit_target target;
    skg_fit_target_init(&target);
    ck_skg(skg_fit_target_get(fit, index, &target));
    return target;
}

static inline skg_fit *begin(const skg_setup *setup, int64_t evaluations, double enough_mm,
                             const char *parameters) {
    skg_fit_options options;
    skg_fit *fit;
    skg_fit_options_init(&options);
    options.evaluations = evaluations;
    options.enough_mm = enough_mm;
    ck_skg(skg_fit_create(NULL, setup, &options, &fit));
    if (parameters) ck_skg(skg_fit_parameters_choose(fit, parameters));
    return fit;
}

static inline void add_target(skg_fit *fit, const skg_setup *setup, const surface_of *from) {
    skg_mesh *mesh = surface(from);
    ck_skg(skg_fit_target_add(fit, part_of(setup, from->label), from->phase, mesh));
    skg_mesh_release(&mesh);
}

/* The bars: 0.1 mm, and 2 % of the motion. */
static inline void check_found(skg_fit *fit) {
    int64_t count;
    ck_skg(skg_fit_finish(fit));
    ck_skg(skg_fit_target_count(fit, &count));
    for (int64_t t = 0; t < count; t++) {
        const skg_fit_target target = target_of(fit, t);
        const double most = fmin(0.1, 0.02 * target.motion_mm);
        ck_assert_msg(target.after_mean_mm <= most, "%s at %g: %g mm of %g mm", target.label, target.phase,
                      target.after_mean_mm, target.motion_mm);
    }
}

#endif
