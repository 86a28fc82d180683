/* Sixty-one organs of a real man breathe, where the data is present. */
#include "body/body.h"
#include "suite.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static int64_t warnings;

static void count_warnings(skg_body *body) {
    for (int64_t i = 0; i < body->organs; i++)
        warnings += body->organ[i].role == ROLE_STATIC && !skg_label_stays(body->organ[i].label);
}

/* A body of all organs in the folder, in alphabetical order; NULL where there is none. */
static skg_body *load(const char *folder) {
    struct dirent **entry;
    int count = scandir(folder, &entry, NULL, alphasort);
    if (count < 0) return NULL;
    skg_body *body;
    ck_skg(skg_body_create(NULL, NULL, &body));
    for (int i = 0; i < count; i++) {
        char path[1400], *dot = strrchr(entry[i]->d_name, '.');
        snprintf(path, sizeof path, "%s/%s", folder, entry[i]->d_name);
        if (dot && !strcmp(dot, ".obj")) {
            *dot = 0;
            skg_organ organ;
            skg_organ_init(&organ);
            ck_skg(skg_mesh_load(NULL, path, 1, &organ.mesh));
            organ.label = entry[i]->d_name;
            ck_skg(skg_body_add(body, &organ, NULL));
            skg_mesh_release(&organ.mesh);
        }
        free(entry[i]);
    }
    free(entry);
    return body;
}

START_TEST(real_organs_breathe) {
    char folder[1024];
    const char *data = getenv("SKG_DATA");
    snprintf(folder, sizeof folder, "%s/bodyparts3d", data ? data : SKG_SOURCE_DIR "/../shared/data");
    skg_body *body = load(folder);
    if (!body) {
        printf("real_organs_breathe: skipped, no folder %s\n", folder);
        return;
    }
    ck_skg(skg_body_link(body));
    count_warnings(body);
    ck_assert_int_le(warnings, 4); /* aorta, and the cartilages, which are one part a side */
    for (int step = 0; step <= 2; step++) {
        skg_breath_state state;
        skg_breath_state_init(&state);
        state.thoracic = state.diaphragmatic = 0.5 * step;
        ck_skg(skg_body_pose(body, &state));
        skg_body_measure m;
        skg_body_measure_init(&m);
        ck_skg(skg_body_get_measure(body, &m));
        ck_assert_int_eq(m.broken_links, 0); /* P1 on every deformable organ */
        ck_assert_double_eq_tol(m.diaphragm_mm[0], 7.5 * step, 1e-9);
        ck_assert_double_eq_tol(m.diaphragm_mm[1], 7.5 * step, 1e-9);
        if (step == 0) ck_assert_double_eq_tol(m.tidal_ml, 0, 1e-6);
        if (step == 2) ck_assert_msg(m.tidal_ml > 200 && m.tidal_ml < 1000, "tidal volume %g ml", m.tidal_ml);
        if (step == 2) ck_assert_msg(m.liver_mm[2] < -7, "liver %g mm", m.liver_mm[2]);
    }
    int ribs = 0;
    for (int64_t i = 0; i < body->organs; i++) { /* the same head on both sides, near the spine */
        const skg_body_organ *o = body->organ + i;
        if (o->role != ROLE_RIB) continue;
        ribs++;
        ck_assert_msg(o->side * o->head[0] > 5 && o->side * o->head[0] < 45, "%s: head at x %g", o->label,
                      o->head[0]);
    }
    ck_assert_int_eq(ribs, 24);
    skg_body_release(&body);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, real_organs_breathe);
}

SKG_SUITE_MAIN("real", add_tests)
