/* The meshes of a real thorax: needs the data. */
#include "core/text.h"
#include "data.h"
#include "mesh/mesh.h"
#include "mesh/mesh_files.h"

/* The organs of a real thorax: numbered as in their files, closed and outward after welding. */
START_TEST(organs_are_closed_and_outward) {
    char data[DATA_PATH], file[DATA_PATH + 300], line[512];
    DIR *all = opendir(data_path("bodyparts3d", data));
    if (!all) skip_test("%s is missing; SKG_DATA names its folder", data);
    int organs = 0;
    int64_t triangles = 0;
    for (struct dirent *entry; (entry = readdir(all));) {
        const char *dot = strrchr(entry->d_name, '.');
        if (!dot || !skg_same_name(dot, ".obj")) continue;
        snprintf(file, sizeof file, "%s/%s", data, entry->d_name);
        skg_mesh *mesh;
        ck_skg(skg_mesh_load(NULL, file, 1, &mesh));
        skg_mesh_health health = health_of(mesh);
        ck_assert_msg(health.closed && health.consistent && health.outward && !health.flipped, "%s", file);
        ck_assert_int_eq(health.nonmanifold_edges, 0);
        ck_assert_double_gt(health.volume, 100);
        int64_t vertices = 0;
        FILE *stream = fopen(file, "r");
        while (fgets(line, sizeof line, stream)) {
            double p[3];
            if (sscanf(line, "v %lf %lf %lf", p, p + 1, p + 2) != 3) continue;
            ck_assert_mem_eq(mesh->positions + 3 * vertices, p, sizeof p);
            vertices++;
        }
        fclose(stream);
        ck_assert_int_eq(vertices, mesh->vertices);
        triangles += health.triangles;
        organs++;
        skg_mesh_release(&mesh);
    }
    closedir(all);
    ck_assert_int_eq(organs, 61);
    ck_assert_int_eq(triangles, 371034);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_test(tests, organs_are_closed_and_outward);
}

SKG_SUITE_MAIN("organs", add_tests)
