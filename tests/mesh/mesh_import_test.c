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

#define OFF_VERTICES "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"

/* Words in front of OFF, comments, colours, polygons of many corners and a head without the word. */
START_TEST(off_as_others_write_it) {
    static const char *const files[] = {
        "OFF 4 4 6\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2",
        "# made by hand\r\nOFF\r\n\r\n4 4 0 # a tetrahedron\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n0 0 1\r\n"
        "3 0 2 1 255 0 0\r\n3 0 1 3\r\n\r\n3 1 2 3 # a face\r\n3 0 3 2\r\n\r\n",
        "4 4\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
        "COFF\n4 4 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n0 0 1 1 1 1 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n"
        "3 0 3 2\n",
        "OFF\n4 5 0\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n3 1 2 3\n10 0 3 2 2 2 2 2 2 2 2\n2 0 1\n"};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        skg_mesh *mesh = load(file_of("b.off", files[f]));
        ck_assert_double_eq_tol(health_of(mesh).volume, 1. / 6, 4 * DBL_EPSILON);
        ck_assert_int_eq(health_of(mesh).left_out, f == 4);
        skg_mesh_release(&mesh);
    }
}
END_TEST

START_TEST(off_that_is_cut_off) {
    static const struct {
        const char *text, *says;
    } files[] = {
        {"OFF\n4 4 0\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n3 1 2 3\n", "damaged: face 3 of 4 cannot be read"},
        {"OFF\n4 4 0\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n3 1 2\n3 0 3 2\n", "face 2 of 4 cannot be read"},
        {"OFF\n4 4 0\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n3\n", "face 2 of 4 cannot be read"},
        {"OFF\n4 4 0\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n3 1 2 x\n3 0 3 2\n", "face 2 of 4 cannot be read"},
        {"OFF\n5 4 0\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n", "face 3 of 4 cannot be read"},
        {"OFF\n4 4 0\n0 0 0\n1 0\n", "vertex 1 of 4 cannot be read"},
        {"OFF\n4 4 0\n0 0 0\n1 0 1,5\n", "vertex 1 of 4 cannot be read"},
        {"OFF\n4 1 0\n" OFF_VERTICES "3 0 2 1\n3 0 1 3\n", "lines behind its last face, number 0"},
        {"solid a\nendsolid a\n", "not an OFF file"},
        {"OFF\n", "not an OFF file"},
        {"OFF BINARY\n", "is binary OFF"}};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        skg_mesh *mesh;
        ck_assert_int_ne(skg_mesh_load(NULL, file_of("c.off", files[f].text), 1, &mesh), SKG_OK);
        ck_assert_msg(strstr(skg_last_error(), files[f].says) != NULL, "%zu: %s", f, skg_last_error());
    }
    refuse(file_of("c.off", "OFF\n4 1 0\n" OFF_VERTICES "3 0 2 4\n"), SKG_ERR_MESH,
           "face 0 names vertex 4, but vertices run from 0 to 3");
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

static double mm_of(const skg_mesh *mesh, int32_t from) {
    skg_mesh_unit unit;
    skg_mesh_unit_init(&unit);
    ck_skg(skg_mesh_unit_get(mesh, &unit));
    ck_assert_int_eq(unit.from, from);
    return unit.mm;
}

static skg_mesh *load_as(const char *from, double unit_mm, const char *group) {
    skg_mesh *mesh = NULL;
    skg_mesh_reading reading;
    skg_mesh_reading_init(&reading);
    reading.unit_mm = unit_mm, reading.group = group;
    ck_skg(skg_mesh_load_as(NULL, from, &reading, &mesh));
    return mesh;
}

/* A tetrahedron of 1 x 2 x 3 units. */
#define COLLADA(asset)                                                                                                  \
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"         \
    "<!-- <unit meter=\"7\"/> --><asset><created>2026-01-01T00:00:00</created>" asset                                   \
    "</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"12\">"         \
    "0 0 0 1 0 0 0 2 0 0 0 3</float_array><technique_common><accessor source=\"#a\" count=\"4\" stride=\"3\">"          \
    "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>" \
    "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>"            \
    "<triangles count=\"4\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 2 1 0 1 3 1 2 3 0 3 2</p>"      \
    "</triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">"  \
    "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"                              \
    "<instance_visual_scene url=\"#s\"/></scene></COLLADA>"

/* The numbers of the file stay where they are, whatever its axis; its unit is used once, unless the caller names one. */
START_TEST(units_of_collada) {
    static const struct {
        const char *text;
        double mm;
    } files[] = {{COLLADA("<unit meter=\"0.001\" name=\"mm\"/><up_axis>Z_UP</up_axis>"), 1},
                 {COLLADA("<unit name=\"inch\" meter='0.0254'/><up_axis>Y_UP</up_axis>"), 25.4},
                 {COLLADA("<up_axis>X_UP</up_axis>"), 1000}};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        const char *file = file_of("c.dae", files[f].text);
        for (int named = 0; named < 2; named++) {
            skg_mesh *mesh = load_as(file, named ? 10 : 0, NULL);
            const double mm = named ? 10 : files[f].mm;
            const skg_mesh_health health = health_of(mesh);
            ck_assert_double_eq_tol(mm_of(mesh, named ? SKG_UNIT_NAMED : SKG_UNIT_FILE), mm,
                                    64 * DBL_EPSILON * mm);
            for (int k = 0; k < 3; k++) {
                ck_assert_double_eq(health.bounds[k], 0);
                ck_assert_double_eq_tol(health.bounds[3 + k], (k + 1) * mm, 64 * DBL_EPSILON * mm);
            }
            skg_mesh_release(&mesh);
        }
    }
}
END_TEST

#define AMF(unit)                                                                                            \
    "<?xml version=\"1.0\"?>\n<amf" unit "><object id=\"1\"><mesh><vertices>"                                \
    "<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>"                                   \
    "<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex>"                                   \
    "<vertex><coordinates><x>0</x><y>2</y><z>0</z></coordinates></vertex>"                                   \
    "<vertex><coordinates><x>0</x><y>0</y><z>3</z></coordinates></vertex></vertices><volume>"                \
    "<triangle><v1>0</v1><v2>2</v2><v3>1</v3></triangle><triangle><v1>0</v1><v2>1</v2><v3>3</v3></triangle>" \
    "<triangle><v1>1</v1><v2>2</v2><v3>3</v3></triangle><triangle><v1>0</v1><v2>3</v2><v3>2</v3></triangle>" \
    "</volume></mesh></object></amf>"
#define X3D(head)                                                                                                   \
    "<?xml version=\"1.0\"?><X3D profile='Interchange' version='3.3'><head>" head "</head><Scene><Shape>"           \
    "<IndexedFaceSet solid='true' coordIndex='0 2 1 -1 0 1 3 -1 1 2 3 -1 0 3 2 -1'><Coordinate point='0 0 0 1 0 0 " \
    "0 2 0 0 0 3'/></IndexedFaceSet></Shape></Scene></X3D>"

START_TEST(units_of_other_formats) {
    static const struct {
        const char *name, *text;
        double mm;
    } files[] = {{"a.amf", AMF(" unit=\"inch\""), 25.4},
                 {"b.amf", AMF(" unit='feet'"), 304.8},
                 {"c.amf", AMF(""), 1},
                 {"d.x3d", X3D(""), 1000},
                 {"e.x3d", X3D("<unit category='length' name='cm' conversionFactor='0.01'/>"), 10}};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        skg_mesh *mesh = load_as(file_of(files[f].name, files[f].text), 0, NULL);
        ck_assert_double_eq_tol(mm_of(mesh, SKG_UNIT_FILE), files[f].mm, 64 * DBL_EPSILON * files[f].mm);
        ck_assert_double_eq_tol(health_of(mesh).volume, files[f].mm * files[f].mm * files[f].mm,
                                1e-6 * files[f].mm * files[f].mm * files[f].mm); /* floats */
        skg_mesh_release(&mesh);
    }
    skg_mesh *mesh = load_as(
        file_of("a.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"), 0,
        NULL);
    ck_assert_double_eq(mm_of(mesh, SKG_UNIT_ASSUMED), 1);
    skg_mesh_release(&mesh);
}
END_TEST

/* Contents say the format of a file; a unit by its extension alone would be wrong by 1000. */
START_TEST(extensions_of_other_formats) {
    static const char stl[] =
        "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid s\n";
    static const char off[] = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 2 1\n";
    static const struct {
        const char *name, *text, *says;
    } files[] = {{"a.glb", stl, "rename it to one of: stl"},
                 {"a.gltf", stl, "a.gltf"},
                 {"a.vrm", stl, "rename it to one of: stl"},
                 {"a.amf", stl, "a.amf"},
                 {"a.x3d", stl, "a.x3d"},
                 {"a.glb", off, "rename it to one of: off"},
                 {"a.unknown", off, "rename it to one of: off"},
                 {"a.unknown", stl, "rename it to one of: stl"},
                 {"a.glb", AMF(" unit=\"inch\""), "a.glb"},
                 {"a.amf", X3D(""), "a.amf"},
                 {"a.x3d", AMF(""), "a.x3d"}};
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        skg_mesh *mesh; /* some are no triangles to the reader of the extension, which is another status */
        ck_assert_int_ne(skg_mesh_load(NULL, file_of(files[f].name, files[f].text), 0, &mesh), SKG_OK);
        ck_assert_msg(strstr(skg_last_error(), files[f].says) != NULL, "%zu: %s", f, skg_last_error());
    }
}
END_TEST

/* Objects and groups of an OBJ file by their names; a group that comes again is one. */
START_TEST(groups_of_obj) {
    const char *file =
        file_of("g.obj", "o first\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng 95_Liver\nf 1 3 2\nf 1 2 4\n"
                         "g other thing \nf 2 3 4\ng 95_Liver\nf 1 4 3\no second\nv 9 9 9\nv 8 9 9\n"
                         "v 9 8 9\nf 5 6 7\n");
    const struct {
        const char *name;
        int64_t triangles, vertices;
    } groups[] = {{"95_Liver", 3, 4}, {"other thing", 1, 3}, {"second", 1, 3}, {"first", 4, 4}};
    for (int g = 0; g < 4; g++) {
        skg_mesh *mesh = load_as(file, 0, groups[g].name);
        ck_assert_int_eq(mesh->triangles, groups[g].triangles);
        ck_assert_int_eq(mesh->vertices, groups[g].vertices);
        skg_mesh_release(&mesh);
    }
    skg_mesh *mesh = NULL;
    ck_skg_fails(skg_mesh_load_as(NULL, file,
                                  &(skg_mesh_reading){.size = sizeof(skg_mesh_reading), .group = "95_liver"},
                                  &mesh),
                 SKG_ERR_MESH, "did you mean \"95_Liver\"");
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
    tcase_add_test(tests, off_as_others_write_it);
    tcase_add_test(tests, off_that_is_cut_off);
    tcase_add_test(tests, mirrored_nodes_turn_the_winding);
    tcase_add_test(tests, units_of_collada);
    tcase_add_test(tests, units_of_other_formats);
    tcase_add_test(tests, extensions_of_other_formats);
    tcase_add_test(tests, groups_of_obj);
    tcase_add_test(tests, own_readers_agree_with_assimp);
}

SKG_SUITE_MAIN("mesh import", add_tests)
