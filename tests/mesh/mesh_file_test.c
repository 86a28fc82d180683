/* Mesh files of our own readers and writers: back as they were, damaged, not to be written. */
#include "core/context.h"
#include "mesh/mesh.h"
#include "mesh/mesh_files.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <sys/stat.h>

static char last_warning[1024];
void __wrap_skg_log(skg_context *context, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void __wrap_skg_log(skg_context *context, int32_t level, const char *format, ...) {
    (void)context, (void)level;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(last_warning, sizeof last_warning, format, arguments);
    va_end(arguments);
}

/* How many more allocations of the library succeed before one fails; negative: all succeed. */
static int64_t allocations_left = -1;
void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size) {
    return allocations_left >= 0 && allocations_left-- == 0 ? NULL : __real_calloc(count, size);
}
void *__real_realloc(void *old, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_realloc(void *old, size_t size) {
    return allocations_left >= 0 && allocations_left-- == 0 ? NULL : __real_realloc(old, size);
}

static void check_same_bits(const skg_mesh *a, const skg_mesh *b) {
    ck_assert_int_eq(a->vertices, b->vertices);
    ck_assert_int_eq(a->triangles, b->triangles);
    ck_assert_mem_eq(a->positions, b->positions, 3 * (size_t)a->vertices * sizeof(double));
    ck_assert_mem_eq(a->corners, b->corners, 3 * (size_t)a->triangles * sizeof(int32_t));
}

START_TEST(ply_comes_back_bit_for_bit) {
    skg_mesh *mesh, *back;
    ck_skg(skg_mesh_create_sphere(1. / 3, 20, &mesh)); /* no floats */
    ck_skg(skg_mesh_save(mesh, in_folder("sphere.ply")));
    back = load(path);
    check_same_bits(mesh, back);
    const char *name;
    ck_skg(skg_mesh_name_get(back, &name));
    ck_assert_str_eq(name, "sphere.ply");
    skg_mesh_release(&mesh);
    skg_mesh_release(&back);
    ck_skg(skg_mesh_create_cube(3, &mesh)); /* floats hold it: 12 bytes a vertex, 13 a triangle */
    ck_skg(skg_mesh_save(mesh, in_folder("cube.ply")));
    struct stat about;
    ck_assert_int_eq(stat(path, &about), 0);
    ck_assert_int_lt(about.st_size, 256 + 8 * 12 + 12 * 13);
    back = load(path);
    check_same_bits(mesh, back);
    skg_mesh_release(&back);
    ck_skg(skg_mesh_load(NULL, path, 10, &back));
    ck_assert_double_eq(health_of(back).bounds[3], 15);
    skg_mesh_release(&mesh);
    skg_mesh_release(&back);
}
END_TEST

/* STL has floats and no shared vertices: corner by corner, in order. */
START_TEST(stl_comes_back_corner_by_corner) {
    skg_mesh *mesh, *back;
    ck_skg(skg_mesh_create_sphere(100. / 3, 20, &mesh));
    ck_skg(skg_mesh_save(mesh, in_folder("sphere.STL")));
    back = load(path);
    ck_assert_int_eq(back->vertices, 3 * mesh->triangles);
    for (int64_t i = 0; i < 3 * mesh->triangles; i++) {
        ck_assert_int_eq(back->corners[i], i);
        for (int k = 0; k < 3; k++)
            ck_assert_double_eq(back->positions[3 * i + k],
                                (double)(float)mesh->positions[3 * (int64_t)mesh->corners[i] + k]);
    }
    skg_mesh_health health = health_of(back);
    ck_assert_int_eq(health.closed && health.outward, 1);
    ck_assert_int_eq(health.welded_vertices, mesh->vertices);
    /* Once it is floats, nothing changes any more. */
    skg_mesh *again;
    ck_skg(skg_mesh_save(back, in_folder("again.stl")));
    again = load(path);
    check_same_bits(back, again);
    skg_mesh_release(&again);
    skg_mesh_release(&mesh);
    skg_mesh_release(&back);
}
END_TEST

#define FACET(a, b, c)                                                                                       \
    "facet normal 0 0 0\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet\n"

START_TEST(ascii_stl_of_two_solids_is_one_mesh) {
    skg_mesh *mesh = load(file_of(
        "two.stl", "solid a\n" FACET("0 0 0", "1 0 0", "0 1 0") "endsolid a\n"
                                                                "solid b\n" FACET("5 0 0.5", "6 0 0",
                                                                                  "5 1e1 0") "endsolid b\n"));
    ck_assert_int_eq(mesh->vertices, 6);
    ck_assert_int_eq(mesh->triangles, 2);
    ck_assert_double_eq(mesh->positions[11], 0.5);
    ck_assert_double_eq(mesh->positions[16], 10);
    ck_assert_int_eq(health_of(mesh).components, 2);
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(damaged_stl_is_refused) {
    unsigned char stl[84 + 2 * 50] = "solid: a binary file of a careless program", *body = stl + 84;
    skg_mesh *mesh;
    stl[80] = 2;
    body[15] = body[30] = 1; /* tiny numbers, no matter which */
    mesh = load(file_of_bytes("good.stl", stl, sizeof stl));
    ck_assert_int_eq(mesh->triangles, 2);
    skg_mesh_release(&mesh);
    refuse(file_of_bytes("cut.stl", stl, sizeof stl - 20), SKG_ERR_FORMAT,
           "truncated: its header counts 2 triangles, its 164 bytes are enough for 1");
    refuse(file_of_bytes("head.stl", stl, 60), SKG_ERR_FORMAT, "truncated");
    stl[83] = 0xF0;
    refuse(file_of_bytes("count.stl", stl, sizeof stl), SKG_ERR_FORMAT, "counts 4026531842 triangles");
    stl[80] = 1, stl[83] = 0;
    refuse(file_of_bytes("more.stl", stl, sizeof stl), SKG_ERR_FORMAT, "not a binary STL");
    stl[80] = 0;
    refuse(file_of_bytes("none.stl", stl, 84), SKG_ERR_MESH, "no triangles");
    refuse(file_of("ascii.stl", "solid a\n" FACET("0 0 0", "1 0 0", "0 1 0")), SKG_ERR_FORMAT, "endsolid");
    refuse(file_of("short.stl", "solid a\nfacet normal 0 0 0\nouter loop\nvertex 1 2"), SKG_ERR_FORMAT,
           "line 4: three numbers");
    refuse(file_of("facet.stl", "solid a\nfacet normal 0 0 0\nouter loop\nvertex 1 2 3\n"), SKG_ERR_FORMAT,
           "line 5: truncated: a facet ends");
    refuse(file_of("edge.stl", "solid a\nfacet\nvertex 1 2 3\nvertex 1 2 4\nendfacet\nendsolid"),
           SKG_ERR_FORMAT, "line 5: a facet of fewer");
    refuse(file_of("word.stl", "solid a\nfacet\nvortex 1 2 3\n"), SKG_ERR_FORMAT, "line 3: not a word");
    refuse(file_of("out.stl", "solid a\nendsolid\nfacet\n"), SKG_ERR_FORMAT, "line 3: no \"solid\"");
    refuse(file_of("nothing.stl", "solid a\nendsolid a\n"), SKG_ERR_MESH, "no triangles");
    refuse(file_of("text.stl", "this is a letter to a friend"), SKG_ERR_FORMAT, "truncated");
    refuse(file_of("nan.stl", "solid a\n" FACET("0 0 0", "1 nan 0", "0 1 0") "endsolid a\n"), SKG_ERR_MESH,
           "vertex 1 is at");
}
END_TEST

#define FACETS                                                                                               \
    "FACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nEND LOOP\nEND FACET\n"

/* Text as other programs write it: capitals, a byte-order mark, blank lines, "end solid"; bytes behind the last triangle. */
START_TEST(text_of_other_programs) {
    static const char *const texts[] = {
        "SOLID A\n" FACETS "ENDSOLID A\n", "\xEF\xBB\xBFsolid a\n" FACETS "endsolid",
        "\r\n \n\tSolid\r\n" FACETS "end solid a b\n", "solid\n" FACETS "End\tSolid"};
    skg_mesh *mesh = NULL;
    for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
        ck_skg(skg_mesh_load(NULL, file_of("a.stl", texts[t]), 1, &mesh));
        ck_assert_int_eq(mesh->triangles, 1);
        skg_mesh_release(&mesh);
    }
    refuse(file_of("b.stl", "\xFF\xFEs"), SKG_ERR_FORMAT, "UTF-16");
    refuse(file_of("c.stl", "\xEF\xBB\xBFsolid a\n" FACETS), SKG_ERR_FORMAT, "truncated");
    ck_skg(
        skg_mesh_load(NULL, file_of("a.obj", "\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), 1, &mesh));
    skg_mesh_release(&mesh);
    ck_skg(skg_mesh_load(
        NULL,
        file_of("a.ply",
                "\xEF\xBB\xBFply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        1, &mesh));
    skg_mesh_release(&mesh);
    ck_skg(skg_mesh_create_cube(20, &mesh));
    ck_skg(skg_mesh_save(mesh, in_folder("long.stl")));
    skg_mesh_release(&mesh);
    FILE *stream = fopen(path, "ab");
    fputs("made by a program", stream);
    fclose(stream);
    ck_skg(skg_mesh_load(NULL, path, 1, &mesh));
    ck_assert_double_eq_tol(health_of(mesh).volume, 8000, 8000 * 64 * DBL_EPSILON);
    ck_assert_int_eq(health_of(mesh).trailing_bytes, 17);
    skg_mesh_release(&mesh);
}
END_TEST

/* A strip whose triangles turn around alternately, and a second one behind -1: two tetrahedra but for a face. */
START_TEST(strips_of_ply) {
    skg_mesh *mesh = NULL;
    ck_skg(skg_mesh_load(
        NULL,
        file_of("strip.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                             "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                             "end_header\n0 0 0\n0 1 0\n1 0 0\n0 0 1\n10 0 1 2 3 0 1 -1 0 0 1\n"),
        1, &mesh));
    const skg_mesh_health health = health_of(mesh);
    ck_assert_int_eq(health.triangles, 4);
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.turned, 0);
    ck_assert_double_eq_tol(health.volume, 1. / 6, 16 * DBL_EPSILON);
    skg_mesh_release(&mesh);
}
END_TEST

START_TEST(files_that_are_none) {
    skg_mesh *mesh;
    refuse(in_folder("absent.stl"), SKG_ERR_FILE, "No such file");
    refuse(file_of("empty.stl", ""), SKG_ERR_FORMAT, "the file is empty");
    refuse(file_of("empty.obj", ""), SKG_ERR_FORMAT, "the file is empty");
    refuse(folder, SKG_ERR_FILE, "not a file");
    refuse(file_of("a.unknown", "what is this"), SKG_ERR_FORMAT, "a.unknown");
    refuse(file_of("a", "what is this"), SKG_ERR_FORMAT, "/a: ");
    refuse(file_of("a.step", "ISO-10303-21;\nHEADER;\n"), SKG_ERR_FORMAT,
           "holds curved solids, not triangles; mesh it first");
    refuse(file_of("a.igs", "S 1\n"), SKG_ERR_FORMAT, "curved solids");
    refuse(file_of("a.vtu", "<VTKFile/>"), SKG_ERR_FORMAT, "in Python, sk.Mesh.from_meshio");
    file_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ck_skg_fails(skg_mesh_load(NULL, path, -1, &mesh), SKG_ERR_ARGUMENT, "unit -1 mm");
    ck_skg_fails(skg_mesh_load(NULL, path, (double)NAN, &mesh), SKG_ERR_ARGUMENT, "unit nan mm");
    ck_skg_fails(skg_mesh_load(NULL, NULL, 1, &mesh), SKG_ERR_ARGUMENT, "path is NULL");
    ck_skg_fails(skg_mesh_load(NULL, path, 1, NULL), SKG_ERR_ARGUMENT, "mesh is NULL");
}
END_TEST

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

START_TEST(obj_keeps_its_numbering) {
    skg_mesh *mesh =
        load(file_of("a.obj", "# two squares and a triangle\r\nmtllib none.mtl\r\n"
                              "v 0.1 0 0\nvn 0 0 1\nv 1 0 0 0.5 0.5 0.5\n\nv 1 \\\n 1 0 # corner\n"
                              "v 0 1 -1e-3\no first\nvt 0 0\nf 1/1/1 2/1/1 3//1 4\nusemtl x\n"
                              "v 9 9 9\nv 8 8 8\no second\nf -1 -2 \\\n -3\nl 1 2\nf 3 2 1"));
    const double positions[] = {0.1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, -1e-3, 9, 9, 9, 8, 8, 8};
    const int32_t corners[] = {0, 1, 2, 0, 2, 3, 5, 4, 3, 2, 1, 0};
    ck_assert_int_eq(mesh->vertices, 6);
    ck_assert_int_eq(mesh->triangles, 4);
    ck_assert_mem_eq(mesh->positions, positions, sizeof positions);
    ck_assert_mem_eq(mesh->corners, corners, sizeof corners);
    ck_assert_ptr_nonnull(strstr(last_warning, "a.obj: 1 points or lines left out"));
    skg_mesh_release(&mesh);
}
END_TEST

/* Of LF, CR LF, and CR alone, as old programs write, also behind a comment and a line that goes on. */
START_TEST(obj_ends_lines_by_any_of_three) {
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    static const double positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    static const int32_t corners[] = {0, 1, 2, 0, 2, 3};
    for (int e = 0; e < 3; e++) {
        char text[256] = "";
        for (const char *c = "# by hand\n" SQUARE "f 1 2 \\\n3 # first\nf 1 3 4\n"; *c; c++)
            strcat(text, *c == '\n' ? ends[e] : (const char[]){*c, '\0'});
        skg_mesh *mesh = load(file_of("lines.obj", text));
        ck_assert_int_eq(mesh->vertices, 4);
        ck_assert_int_eq(mesh->triangles, 2);
        ck_assert_mem_eq(mesh->positions, positions, sizeof positions);
        ck_assert_mem_eq(mesh->corners, corners, sizeof corners);
        skg_mesh_release(&mesh);
        refuse(file_of("bad.obj", strcat(text, "f 1 2")), SKG_ERR_FORMAT, "line 9: a face");
    }
}
END_TEST

/* A file's vertices of no triangle are left out, because they would count in its bounds; an array keeps its numbers, and a warning says
 * when they do count. */
START_TEST(vertices_of_no_triangle) {
    static const char tetrahedron[] = "v 1 1 1\nv 1000 1000 1000\nv 2 1 1\nv 1 2 1\nv 1 1 2\n"
                                      "f 1 4 3\nf 1 3 5\nf 1 5 4\nf 3 4 5\n";
    static const double places[] = {1, 1, 1, 1.2, 1.2, 1.2, 2, 1, 1, 1, 2, 1, 1, 1, 2};
    static const int32_t faces[] = {0, 3, 2, 0, 2, 4, 0, 4, 3, 2, 3, 4}, first_face[] = {0, 2, 1};
    skg_mesh *mesh = load(file_of("stray.obj", tetrahedron));
    ck_assert_int_eq(mesh->vertices, 4);
    ck_assert_mem_eq(mesh->corners, first_face, sizeof first_face);
    ck_assert_double_eq_tol((double)mesh->highest[0] + mesh->origin[0], 2, 1e-6); /* a float's last bits */
    ck_assert_ptr_nonnull(strstr(last_warning, "stray.obj: 1 vertex of no triangle left out"));
    skg_mesh_release(&mesh);
    for (int outside = 0; outside < 2; outside++) {
        static char nobody[sizeof(void *)]; /* stands for a context, which only the log would read */
        skg_mesh_arrays arrays = {.vertices = 5, .triangles = 4};
        ck_skg(skg_alloc(15, sizeof(double), "test", &arrays.positions));
        ck_skg(skg_alloc(12, sizeof(int32_t), "test", &arrays.corners));
        memcpy(arrays.positions, places, sizeof places);
        memcpy(arrays.corners, faces, sizeof faces);
        arrays.positions[3] += 9 * outside;
        last_warning[0] = '\0';
        ck_skg(skg_mesh_adopt((skg_context *)(void *)nobody, "array", &arrays, &mesh));
        ck_assert_int_eq(mesh->vertices, 5);
        ck_assert(outside ==
                  (strstr(last_warning, "array: 1 vertex belongs to no triangle, but stretches its bounds") !=
                   NULL));
        skg_mesh_release(&mesh);
    }
}
END_TEST

START_TEST(damaged_obj_is_refused) {
    refuse(file_of("a.obj", SQUARE "f 1 2"), SKG_ERR_FORMAT, "line 5: a face of fewer than three corners");
    refuse(file_of("b.obj", SQUARE "v 1 2\nf 1 2 3"), SKG_ERR_FORMAT, "line 5: a vertex is");
    refuse(file_of("c.obj", "v 1 2 3x\n"), SKG_ERR_FORMAT, "line 1: a vertex is");
    refuse(file_of("d.obj", SQUARE "f 1 2 0"), SKG_ERR_FORMAT, "count from 1");
    refuse(file_of("e.obj", SQUARE "f 1 2 -5"), SKG_ERR_MESH, "line 5: vertex -5 of 4");
    refuse(file_of("f.obj", SQUARE "f 1 2 3\nf 1 2 99"), SKG_ERR_MESH,
           "triangle 1 names vertex 98, but vertices run from 0 to 3");
    skg_mesh *none;
    ck_skg_fails(skg_mesh_load(NULL, "", 1, &none), SKG_ERR_ARGUMENT, "the path of a mesh is empty");
    refuse(file_of("f.obj", SQUARE "f 1 2 99"), SKG_ERR_MESH, "vertices run from 0 to 3");
    refuse(file_of("g.obj", SQUARE "f 1 2 9999999999"), SKG_ERR_MESH, "line 5: vertex 9999999999");
    refuse(file_of("h.obj", SQUARE "f 1 2 99999999999999999999"), SKG_ERR_FORMAT, "line 5");
    refuse(file_of("i.obj", SQUARE), SKG_ERR_MESH, "no triangles");
    refuse(file_of("j.obj", "v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3"), SKG_ERR_MESH, "vertex 1 is at (nan");
    refuse(file_of_bytes("k.obj", "v 0 0 0\0", 9), SKG_ERR_FORMAT, "zero byte");
    refuse(file_of("l.obj", SQUARE "f a b c"), SKG_ERR_FORMAT, "line 5");
    refuse(file_of("m.obj", SQUARE "g \\\r\\\\ \\\r"), SKG_ERR_MESH, "no triangles"); /* continues nothing */
}
END_TEST

#define HEADER(format, type, faces)                                                                          \
    "ply\nformat " format " 1.0\ncomment hello\nelement camera 1\nproperty list int8 uint8 list\n"           \
    "property uint16 size\nelement vertex 4\nproperty " type " x\nproperty uchar red\nproperty " type        \
    " y\nproperty " type " z\nelement face " faces                                                           \
    "\nproperty short flags\nproperty list uchar int vertex_indices\nend_header\n"

START_TEST(ply_of_every_kind) {
    const double positions[] = {0, 0, 0.5, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const int32_t corners[] = {0, 1, 2, 0, 2, 3, 2, 1, 0};
    skg_mesh *mesh = load(file_of(
        "a.ply", HEADER("ascii", "double", "3") "3 1 2 3 500\n0 255 0 .5\n1 0 0 0\n"
                                                "1 0 1 0\n0 0 1 0\n7 4 0 1 2 3\n7 3 2 1 0\n7 2 0 1\n"));
    ck_assert_int_eq(mesh->vertices, 4);
    ck_assert_int_eq(mesh->triangles, 3);
    ck_assert_mem_eq(mesh->positions, positions, sizeof positions);
    ck_assert_mem_eq(mesh->corners, corners, sizeof corners);
    ck_assert_ptr_nonnull(strstr(last_warning, "1 points or lines"));
    skg_mesh_release(&mesh);
    /* This mesh as big-endian bytes; 0.5 is 3F000000, 1 is 3F800000. */
    static const char header[] = HEADER("binary_big_endian", "float", "2");
    static const char body[] = "\3\1\2\3\1\xF4"
                               "\0\0\0\0\0\0\0\0\0\x3F\0\0\0"
                               "\x3F\x80\0\0\0\0\0\0\0\0\0\0\0"
                               "\x3F\x80\0\0\0\x3F\x80\0\0\0\0\0\0"
                               "\0\0\0\0\0\x3F\x80\0\0\0\0\0\0"
                               "\0\7\4\0\0\0\0\0\0\0\1\0\0\0\2\0\0\0\3"
                               "\0\7\3\0\0\0\2\0\0\0\1\0\0\0\0";
    char whole[sizeof header + sizeof body];
    memcpy(whole, header, sizeof header - 1);
    memcpy(whole + sizeof header - 1, body, sizeof body - 1);
    size_t size = sizeof header + sizeof body - 2;
    mesh = load(file_of_bytes("b.ply", whole, size));
    ck_assert_int_eq(mesh->triangles, 3);
    ck_assert_mem_eq(mesh->positions, positions, sizeof positions);
    ck_assert_mem_eq(mesh->corners, corners, sizeof corners);
    skg_mesh_release(&mesh);
    refuse(file_of_bytes("c.ply", whole, size - 1), SKG_ERR_FORMAT, "face 1 of 2 cannot be read");
    refuse(file_of_bytes("d.ply", whole, size - 40), SKG_ERR_FORMAT, "vertex 3 of 4 cannot be read");
    whole[size - 1] = 77;
    refuse(file_of_bytes("e.ply", whole, size), SKG_ERR_MESH, "triangle 2 names vertex 77");
    whole[size - 4] = -1;
    refuse(file_of_bytes("f.ply", whole, size), SKG_ERR_MESH, "face 1 names vertex -167");
}
END_TEST

START_TEST(damaged_ply_is_refused) {
    refuse(file_of("a.ply", "plx\n"), SKG_ERR_FORMAT, "\"plx\"");
    refuse(file_of("b.ply", "ply\nformat ascii 1.0\nelement vertex 3"), SKG_ERR_FORMAT, "end_header");
    refuse(file_of("c.ply", "ply\nformat ascii 1.0\nelement vertex 3\nend_header\n"), SKG_ERR_FORMAT,
           "not a triangle mesh");
    refuse(file_of("d.ply", "ply\nformat morse 1.0\nend_header\n"), SKG_ERR_FORMAT, "morse");
    refuse(file_of("e.ply", "ply\nformat ascii 1.0\nproperty int x\n"), SKG_ERR_FORMAT, "property int x");
    refuse(file_of("f.ply", "ply\nelement vertex -3\n"), SKG_ERR_FORMAT, "vertex -3");
    refuse(file_of("g.ply", "ply\nelement vertex 3\nproperty quad x\n"), SKG_ERR_FORMAT, "quad");
    refuse(file_of("h.ply", HEADER("ascii", "float", "9999999999") "0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n"
                                                                   "0 3 0 1 2\n"),
           SKG_ERR_FORMAT, "face 1 of 9999999999 cannot be read");
    refuse(file_of("i.ply", HEADER("ascii", "float", "1") "0 0\n0 0 0 0\nx"), SKG_ERR_FORMAT,
           "vertex 1 of 4");
    refuse(file_of("j.ply", HEADER("ascii", "float", "0") "0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 0\n"),
           SKG_ERR_MESH, "no triangles");
}
END_TEST

START_TEST(nothing_is_left_where_nothing_can_be_written) {
    skg_mesh *mesh;
    ck_skg(skg_mesh_create_cube(1, &mesh));
    ck_skg_fails(skg_mesh_save(mesh, in_folder("no/such/folder.ply")), SKG_ERR_OUTPUT, "folder.ply");
    ck_skg_fails(skg_mesh_save(mesh, folder), SKG_ERR_OUTPUT, folder); /* a folder is there */
    ck_skg_fails(skg_mesh_save(mesh, NULL), SKG_ERR_ARGUMENT, "path is NULL");
    static const char *const others[] = {"scene.json", "mesh.obj", "mesh", "mesh.stl.txt"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        FILE *stream = fopen(in_folder(others[i]), "wb");
        ck_assert_ptr_nonnull(stream);
        fputs("{}", stream);
        fclose(stream);
        ck_skg_fails(skg_mesh_save(mesh, path), SKG_ERR_ARGUMENT, "use .ply or .stl");
        char still[3] = "";
        stream = fopen(path, "rb");
        ck_assert(stream && fread(still, 1, 2, stream) == 2 && fgetc(stream) == EOF);
        fclose(stream);
        ck_assert_str_eq(still, "{}");
    }
    ck_skg_fails(skg_mesh_save(NULL, "a.ply"), SKG_ERR_ARGUMENT, "mesh is NULL");
    skg_mesh_release(&mesh);
}
END_TEST

/* Every allocation fails once; each time a clean refusal, no mesh, no file, no leak (under the sanitizer). */
START_TEST(memory_may_end_anywhere) {
    skg_mesh *mesh = NULL, *cube;
    ck_skg(skg_mesh_create_cube(1, &cube));
    file_of("a.obj", SQUARE "f 1 2 3 4\n");
    for (int what = 0; what < 3; what++) {
        skg_status status = SKG_ERR_MEMORY;
        int64_t failures = 0;
        char target[300];
        snprintf(target, sizeof target, "%s/%s", folder, what == 2 ? "out.stl" : "a.obj");
        for (; status != SKG_OK; failures++) {
            allocations_left = failures;
            if (what == 0) status = skg_mesh_create_sphere(1, 8, &mesh);
            if (what == 1) status = skg_mesh_load(NULL, target, 1, &mesh);
            if (what == 2) status = skg_mesh_save(cube, target);
            allocations_left = -1;
            if (status == SKG_OK) break;
            ck_assert_int_eq(status, SKG_ERR_MEMORY);
            ck_assert_ptr_null(mesh);
            ck_assert(what != 2 || access(target, F_OK) != 0);
        }
        ck_assert_int_ge(failures, what == 2 ? 2 : 8);
        skg_mesh_release(&mesh);
    }
    skg_mesh_release(&cube);
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, make_folder, remove_folder);
    tcase_add_test(tests, ply_comes_back_bit_for_bit);
    tcase_add_test(tests, stl_comes_back_corner_by_corner);
    tcase_add_test(tests, ascii_stl_of_two_solids_is_one_mesh);
    tcase_add_test(tests, damaged_stl_is_refused);
    tcase_add_test(tests, text_of_other_programs);
    tcase_add_test(tests, strips_of_ply);
    tcase_add_test(tests, files_that_are_none);
    tcase_add_test(tests, obj_keeps_its_numbering);
    tcase_add_test(tests, obj_ends_lines_by_any_of_three);
    tcase_add_test(tests, vertices_of_no_triangle);
    tcase_add_test(tests, damaged_obj_is_refused);
    tcase_add_test(tests, ply_of_every_kind);
    tcase_add_test(tests, damaged_ply_is_refused);
    tcase_add_test(tests, nothing_is_left_where_nothing_can_be_written);
    tcase_add_test(tests, memory_may_end_anywhere);
}

SKG_SUITE_MAIN("mesh files", add_tests)
