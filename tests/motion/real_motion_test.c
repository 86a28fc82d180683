/* A scene of sixty-one organs of a real man breathes: needs the data. */
#include "data.h"
#include "motion/motion_files.h"

#include <dirent.h>

/* A scene file of the folder's meshes; 0 where there is none. */
static int write_real_scene(const char *here, const char *data) {
    struct dirent **entry;
    int count = scandir(data, &entry, NULL, alphasort), organs = 0;
    if (count < 0) return 0;
    FILE *stream = fopen(path, "w");
    ck_assert_ptr_nonnull(stream);
    fputs(heading, stream);
    for (int i = 0; i < count; i++) {
        char *dot = strrchr(entry[i]->d_name, '.');
        if (dot && strcmp(dot, ".obj") == 0) {
            *dot = '\0';
            fprintf(stream,
                    "%s {\"Label\": \"%s\", \"Path\": \"%s/%s/%s.obj\", \"Unit\": \"mm\", "
                    "\"Material\": [\"mu\", 0.2]}",
                    organs++ ? ",\n" : "", entry[i]->d_name, here, data, entry[i]->d_name);
        }
        free(entry[i]);
    }
    free(entry);
    fputs("]}\n", stream);
    ck_assert_int_eq(fclose(stream), 0);
    return organs;
}

START_TEST(a_scene_of_real_organs_breathes) {
    char data[DATA_PATH], here[512] = "";
    data_path("bodyparts3d", data);
    if (*data != '/') ck_assert_ptr_nonnull(getcwd(here, sizeof here)); /* paths are relative to the scene */
    if (!write_real_scene(here, data)) skip_test("%s is missing; SKG_DATA names its folder", data);
    skg_body *body;
    skg_body_measure m;
    skg_body_measure_init(&m);
    ck_skg(skg_setup_load(NULL, path, 0, NULL, &setup));
    ck_skg(skg_motion_create(NULL, setup, &motion));
    const double rest = height_of("liver");
    ck_skg(skg_motion_pose_at_phase(motion, 0));
    ck_assert(height_of("liver") < rest - 7);
    ck_skg(skg_motion_body_get(motion, &body));
    ck_skg(skg_body_measure_get(body, &m));
    ck_assert(m.broken_links == 0 && m.tidal_ml > 200 && m.tidal_ml < 1000);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_test(tests, a_scene_of_real_organs_breathes);
}

SKG_SUITE_MAIN("real motion", add_tests)
