/* What mesh files say and their reader passes over is refused by name; what is read right is not. */
#include "mesh/mesh.h"
#include "mesh/mesh_files.h"

#include <float.h>

/* The tetrahedron of 1/6, whose positions and indices lie in one buffer: members of the file, node and mesh, and the type of the
 * positions. */
static const char *gltf_of(const char *file, const char *node, const char *mesh, int type) {
    static char text[4096];
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},%s\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":\"first\",%s\"mesh\":0}],"
        "\"skins\":[{\"joints\":[0]}],"
        "\"meshes\":[{%s\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"targets\":[{\"POSITION\":0}]}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":%d,\"count\":4,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,1]},{\"bufferView\":1,\"componentType\":5123,\"count\":12,"
        "\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"buffers\":[{\"byteLength\":72,\"uri\":"
        "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAQACAAMAAAADAAIA\"}]}",
        file, node, mesh, type);
    return file_of("a.gltf", text);
}

/* What concerns looks alone, what is applied, and targets that move nothing are read. */
START_TEST(gltf_that_moves_nothing) {
    static const char *const files[][3] = {
        {"\"extensionsRequired\":[\"KHR_materials_unlit\",\"KHR_texture_transform\",\"KHR_draco_mesh_compression\","
         "\"KHR_mesh_quantization\"],",
         "", ""},
        {"\"extensionsUsed\":[\"FOO_bar\",\"EXT_mesh_gpu_instancing\"],", "", ""},
        {"", "", "\"weights\":[0],"},
        {"", "\"weights\":[0],", "\"weights\":[1],"}};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        skg_mesh *mesh = load(gltf_of(files[f][0], files[f][1], files[f][2], 5126));
        ck_assert_double_eq_tol(health_of(mesh).volume, 1. / 6, 4 * DBL_EPSILON);
        skg_mesh_release(&mesh);
    }
}
END_TEST

START_TEST(gltf_that_moves_vertices) {
    static const struct {
        const char *file, *node, *mesh, *sentence;
        int type;
    } files[] = {
        {"\"extensionsRequired\":[\"KHR_materials_unlit\",\"FOO_bar\"],", "", "",
         "requires the extension \"FOO_bar\"", 5126},
        {"\"extensionsRequired\":[\"EXT_meshopt_compression\"],", "", "", "\"EXT_meshopt_compression\"",
         5126},
        {"", "", "", "KHR_mesh_quantization", 5122},
        {"", "\"extensions\":{\"EXT_mesh_gpu_instancing\":{}},", "", "EXT_mesh_gpu_instancing", 5126},
        {"", "", "\"weights\":[0.5],", "the node \"first\" has morph targets", 5126},
        {"", "\"weights\":[1],", "\"weights\":[0],", "apply them to the mesh", 5126},
        {"", "\"skin\":0,", "", "apply the pose", 5126}};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++)
        refuse(gltf_of(files[f].file, files[f].node, files[f].mesh, files[f].type), SKG_ERR_FORMAT,
               files[f].sentence);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, make_folder, remove_folder);
    tcase_add_test(tests, gltf_that_moves_nothing);
    tcase_add_test(tests, gltf_that_moves_vertices);
}

SKG_SUITE_MAIN("mesh unread", add_tests)
