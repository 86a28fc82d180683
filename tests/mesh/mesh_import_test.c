/* Mesh files of other programs: by Assimp and against Assimp. */
#include "core/text.h"
#include "mesh/mesh.h"
#include "mesh/mesh_files.h"

#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <float.h>
#include <math.h>

/* An ascii STL or an OBJ file as other programs write them. */
static void write_text(const skg_mesh *mesh, const char *file, int is_obj) {
    FILE *stream = fopen(file, "w");
    fputs(is_obj ? "o sphere\n" : "solid sphere\n", stream);
    for (int64_t i = 0; is_obj && i < 3 * mesh->vertices; i += 3)
        fprintf(stream, "v %.9g %.9g %.9g\n", mesh->positions[i], mesh->positions[i + 1],
                mesh->positions[i + 2]);
    for (int64_t i = 0; i < 3 * mesh->triangles; i++) {
        const double *p = mesh->positions + 3 * (int64_t)mesh->corners[i];
        if (is_obj)
            fprintf(stream, i % 3 == 0 ? "f %d" : i % 3 == 1 ? " %d" : " %d\n", mesh->corners[i] + 1);
        else
            fprintf(stream, "%svertex %.9g %.9g %.9g\n%s", i % 3 ? "" : "facet normal 0 0 0\nouter loop\n",
                    p[0], p[1], p[2], i % 3 == 2 ? "endloop\nendfacet\n" : "");
    }
    if (!is_obj) fputs("endsolid sphere\n", stream);
    fclose(stream);
}

/* Other formats go through Assimp: OFF, and glTF whose one tetrahedron two nodes place and scale. */
START_TEST(formats_of_assimp) {
    skg_mesh *mesh =
        load(file_of("a.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n"
                              "3 0 3 2\n"));
    ck_assert_double_eq_tol(health_of(mesh).volume, 1. / 6, 4 * DBL_EPSILON);
    skg_mesh_release(&mesh);
    mesh = load(file_of(
        "b.gltf",
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":["
        "{\"children\":[1,2],\"translation\":[10,0,0]},{\"mesh\":0},"
        "{\"mesh\":0,\"scale\":[2,2,2],\"translation\":[0,5,0]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,1]},{\"bufferView\":1,\"componentType\":5123,\"count\":12,"
        "\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"buffers\":[{\"byteLength\":72,\"uri\":"
        "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAQACAAMAAAADAAIA\"}]}"));
    skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.components, 2);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_double_eq_tol(health.volume, 9. / 6, 16 * DBL_EPSILON * 1.5);
    ck_assert_double_eq(health.bounds[0], 10);
    ck_assert_double_eq(health.bounds[3], 12);
    ck_assert_double_eq(health.bounds[4], 7);
    skg_mesh_release(&mesh);
}
END_TEST

/* A node that mirrors turns the winding (glTF 2.0): beside an unmirrored one, volumes would cancel. */
START_TEST(mirrored_nodes_turn_the_winding) {
    skg_mesh *mesh = load(file_of(
        "mirrored.gltf",
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":["
        "{\"mesh\":0,\"translation\":[10,0,0]},{\"mesh\":0,\"scale\":[-2,2,2]}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,1]},{\"bufferView\":1,\"componentType\":5123,\"count\":12,"
        "\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"buffers\":[{\"byteLength\":72,\"uri\":"
        "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAQACAAMAAAADAAIA\"}]}"));
    const skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.turned, 0);
    ck_assert_int_eq(health.flipped, 0);
    ck_assert_double_eq_tol(health.volume, 9. / 6, 16 * DBL_EPSILON * 1.5);
    skg_mesh_release(&mesh);
}
END_TEST

/* Assimp, which welds nothing, as the oracle of our own readers: the same triangles in the same order, to the
 * last bit but one (its floats from text are not always the nearest). */
START_TEST(own_readers_agree_with_assimp) {
    static const char *const names[] = {"a.stl", "b.ply", "c.stl", "d.obj"};
    skg_mesh *mesh;
    ck_skg(skg_mesh_create_sphere(100. / 3, 12, &mesh));
    for (int i = 0; i < 4; i++) {
        if (i < 2)
            ck_skg(skg_mesh_save(mesh, in_folder(names[i])));
        else
            write_text(mesh, in_folder(names[i]), i == 3);
        skg_mesh *ours = load(path);
        const struct aiScene *scene = aiImportFile(path, 0);
        ck_assert_ptr_nonnull(scene);
        ck_assert_uint_eq(scene->mNumMeshes, 1);
        const struct aiMesh *theirs = scene->mMeshes[0];
        ck_assert_int_eq(theirs->mNumFaces, ours->triangles);
        for (int64_t t = 0; t < ours->triangles; t++)
            for (int c = 0; c < 3; c++) {
                const struct aiVector3D *p = &theirs->mVertices[theirs->mFaces[t].mIndices[c]];
                const double *q = ours->positions + 3 * (int64_t)ours->corners[3 * t + c];
                ck_assert_double_eq_tol((double)p->x, q[0], 100. / 3 * (double)FLT_EPSILON);
                ck_assert_double_eq_tol((double)p->y, q[1], 100. / 3 * (double)FLT_EPSILON);
                ck_assert_double_eq_tol((double)p->z, q[2], 100. / 3 * (double)FLT_EPSILON);
            }
        aiReleaseImport(scene);
        skg_mesh_release(&ours);
    }
    skg_mesh_release(&mesh);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, make_folder, remove_folder);
    tcase_add_test(tests, formats_of_assimp);
    tcase_add_test(tests, mirrored_nodes_turn_the_winding);
    tcase_add_test(tests, own_readers_agree_with_assimp);
}

SKG_SUITE_MAIN("mesh import", add_tests)
