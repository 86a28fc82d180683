/* Meshes instead of a scene: the flags --material, --kvp, --kev, --filter, --from and --unit. */
#include "cli/command.h"

#include <float.h>
#include <math.h>

/* A cuboid of 20 x 10 x 40 of the file's unit, about (5, 5, 5), as an OBJ file. */
static const char box[] = "v -5 0 -15\nv 15 0 -15\nv -5 10 -15\nv 15 10 -15\n"
                          "v -5 0 25\nv 15 0 25\nv -5 10 25\nv 15 10 25\n"
                          "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

static void set_up_box(void) {
    set_up();
    write_text("box.obj", box);
}

/* The first channel's least and largest value. */
static void check_range(double low, double high, double margin) {
    json_t *object = said_json(), *range = json_array_get(member(object, "range"), 0);
    ck_assert_double_eq_tol(json_number_value(json_array_get(range, 0)), low, margin);
    ck_assert_double_eq_tol(json_number_value(json_array_get(range, 1)), high, margin);
    json_decref(object);
}

START_TEST(a_mesh_needs_no_scene) {
    ck_run(0, "image box.obj --material Al --kvp 120 -o box.png");
    ck_assert(has_file("box.png"));
    ck_assert_ptr_nonnull(strstr(complained, "the beam is filtered by 2.5 mm of aluminium"));
    ck_assert_ptr_nonnull(strstr(complained, "fitted to the parts: 256 x 512 pixels"));
    ck_assert_ptr_nonnull(strstr(said, "percentiles 0.5 and 99.5 of the pixels"));
    ck_run(0, "image box.obj --material Al --kvp 120 --filter Al:3mm --filter \"Cu 0.1\" -o box.png --quiet");
    ck_assert_str_eq(complained, "");
    ck_run(0, "plan box.obj --material Al --kev 60");
    ck_assert_ptr_nonnull(strstr(said, "60 keV"));
}
END_TEST

/* Lengths across the box from its sides, up to a pixel's oblique ray: 1 + (20 / 1000)^2 / 2. */
START_TEST(a_mesh_is_seen_from_any_side) {
    const double oblique = 40 * 2e-4 + 1e-5;
    ck_run(0, "lbuffer box.obj --material Al --json -o l.mha");
    check_range(0, 10, oblique);
    ck_run(0, "lbuffer box.obj --material Al --from side --json -o l.mha");
    check_range(0, 20, oblique);
    ck_run(0, "lbuffer box.obj --material Al --from top --json -o l.mha");
    check_range(0, 40, oblique);
    ck_run(0, "lbuffer box.obj --material Al --from 0,0,-2 --unit cm --json -o l.mha");
    check_range(0, 400, 400 * 0.02);
    ck_run(0, "image box.obj --material H2O --kev 60 --from top --quantity attenuation --json -o l.mha "
              "--set Samples.box.Material='[\"mu\",0.5]'");
    check_range(0, 2, 0.05 * oblique + 1e-6);
}
END_TEST

START_TEST(several_meshes) {
    write_text("a.obj", box);
    ck_assert_int_eq(run("lbuffer box.obj ./box.obj a.obj --material Al --part \"box 2\" --json -o l.mha"),
                     0);
    check_range(0, 10, 40 * 2e-4 + 1e-5);
    ck_run(0, "plan box.obj a.obj --material Al --material H2O --kev 60");
    ck_assert_ptr_nonnull(strstr(said, "2 parts"));
    ck_run_fails(2, "3 meshes have 2 materials",
                 "plan box.obj a.obj a.obj --material Al --material Cu --kev 60");
}
END_TEST

static const struct {
    int exit_status;
    const char *says, *words;
} bad[] = {
    {2, "box.obj is a mesh, not a scene; add --material NAME", "image box.obj -o a.png"},
    {2, "give the beam as either --kvp KV", "image box.obj --material Al -o a.png"},
    {2, "give the beam as either --kvp KV", "image box.obj --material Al --kvp 90 --kev 60 -o a.png"},
    {2, "--filter belongs to a tube", "image box.obj --material Al --kev 60 --filter Al:1 -o a.png"},
    {2, "--filter thick is not", "image box.obj --material Al --kvp 60 --filter thick -o a.png"},
    {2, "--from \"back\" is no side", "image box.obj --material Al --kev 60 --from back -o a.png"},
    {2, "--from 0,0,0 is no direction", "image box.obj --material Al --kev 60 --from 0,0,0 -o a.png"},
    {2, "--from 1,2 is no direction", "image box.obj --material Al --kev 60 --from 1,2 -o a.png"},
    {2, "box.json is a scene", "image box.json --material Al --kev 60 -o a.png"},
    {2, "--kev describes meshes", "image box.json --kev 60 -o a.png"},
    {2, "one word too many", "image a.json b.json -o a.png"},
    {2, "did you mean mm", "image box.obj --material Al --kev 60 --unit mn -o a.png"},
    {3, "Unobtainium", "image box.obj --material Unobtainium --kev 60 -o a.png"},
    {3, "none.obj", "image none.obj --material Al --kev 60 -o a.png"},
};

START_TEST(bad_meshes_are_refused) {
    ck_run_fails(bad[_i].exit_status, bad[_i].says, "%s", bad[_i].words);
    ck_assert(!has_file("a.png"));
}
END_TEST

/* The box with a second one beside it, of 4 mm, at x = 28 to 32; its faces are turned inward. */
static const char inverted[] =
    "v 28 3 3\nv 32 3 3\nv 28 7 3\nv 32 7 3\nv 28 3 7\nv 32 3 7\nv 28 7 7\nv 32 7 7\n"
    "f 10 12 11 9\nf 15 16 14 13\nf 13 14 10 9\nf 12 16 15 11\nf 11 15 13 9\nf 14 16 12 10\n";

START_TEST(inverted_components_are_turned) {
    char text[1024];
    snprintf(text, sizeof text, "%s%s", box, inverted);
    write_text("two.obj", text);
    ck_run(1, "mesh two.obj");
    ck_assert_ptr_nonnull(strstr(said, "1 of 2 components is inverted: number 2 (12 triangles, near ("));
    ck_assert_ptr_nonnull(
        strstr(said, "faces inward in the open, where lengths become negative. --fix -o FILE"));
    ck_run(1, "mesh two.obj --json");
    json_t *object = said_json(), *file = json_array_get(member(object, "files"), 0);
    ck_assert_int_eq(json_integer_value(json_object_get(file, "inverted_components")), 1);
    json_decref(object);
    ck_run(0, "lbuffer two.obj --material Al -o l.mha --json");
    check_range(-4, 10, 40 * 2e-4 + 1e-5); /* the margin is that of rays from the side, as above */
    ck_assert_ptr_nonnull(strstr(complained, "part two: 1 of 2 components is inverted"));
    ck_assert_ptr_nonnull(strstr(complained, "\"Repair\": \"orientation\""));
    ck_run(0, "lbuffer two.obj --material Al -o l.mha --json --set Repair=orientation");
    check_range(0, 10, 40 * 2e-4 + 1e-5);
    ck_assert_ptr_null(strstr(complained, "inverted"));
    ck_assert_ptr_nonnull(strstr(complained, "1 of 2 components turned"));
    ck_run(0, "lbuffer two.obj --material Al -o l.mha --quiet --set 'Repair=[\"exact\", \"orientation\"]'");
    ck_run_fails(3, "chosen before",
                 "lbuffer two.obj --material Al -o l.mha --quiet --set 'Repair=[\"exact\", \"none\"]'");
    ck_run(0, "mesh two.obj --fix -o turned.ply");
    ck_assert_ptr_nonnull(strstr(said, "volume 8064 mm3"));
    ck_assert_ptr_nonnull(strstr(said, "wrote turned.ply"));
    ck_run(0, "mesh turned.ply");
    ck_run_fails(2, "--fix and -o go together", "mesh two.obj --fix");
    ck_run_fails(2, "--fix and -o go together", "mesh two.obj -o a.ply");
    ck_run_fails(2, "written as .ply or .stl", "mesh two.obj --fix -o a.obj");
}
END_TEST

/* The larger box faces inward: the mesh is inverted as a whole, which is said once although the smaller box is turned, too. */
START_TEST(what_is_inverted_is_said_once) {
    static const char two[] =
        "v -5 0 -15\nv 15 0 -15\nv -5 10 -15\nv 15 10 -15\nv -5 0 25\nv 15 0 25\nv -5 10 25\nv 15 10 25\n"
        "f 2 4 3 1\nf 7 8 6 5\nf 5 6 2 1\nf 4 8 7 3\nf 3 7 5 1\nf 6 8 4 2\n"
        "v 28 3 3\nv 32 3 3\nv 28 7 3\nv 32 7 3\nv 28 3 7\nv 32 3 7\nv 28 7 7\nv 32 7 7\n"
        "f 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf 11 15 16 12\nf 9 13 15 11\nf 10 12 16 14\n";
    write_text("two.obj", two);
    ck_run(0, "lbuffer two.obj --material Al -o l.mha --json --set Repair=orientation");
    const char *first = strstr(complained, "inverted as a whole");
    ck_assert_ptr_nonnull(first);
    ck_assert_ptr_null(strstr(first + 1, "inverted as a whole"));
    ck_assert_ptr_nonnull(strstr(complained, "1 of 2 components turned"));
}
END_TEST

/* A COLLADA file in centimetres is a scene graph, without a unit; beside it, a part that somebody made in metres is named; groups
 * become parts. */
static const char collada[] =
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset>"
    "<created>2026-01-01T00:00:00</created><unit meter=\"0.01\" name=\"cm\"/><up_axis>Y_UP</up_axis></asset>"
    "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"24\">"
    "-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1</float_array><technique_common><accessor source=\"#a\" "
    "count=\"8\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
    "type=\"float\"/></accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
    "source=\"#p\"/></vertices><triangles count=\"12\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 2 3 0 3 "
    "1 4 5 7 4 7 6 0 1 5 0 5 4 2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5</p></triangles></mesh></geometry></library_geometries>"
    "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><instance_geometry url=\"#g\"/></node></visual_scene>"
    "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";

START_TEST(files_bring_their_units_and_groups) {
    write_text("engine.dae", collada);
    write_text(
        "engine.json",
        "{\"Source\": {\"Shape\": \"PointSource\", \"Position\": [0, -500, 0, \"mm\"], \"Beam\": [{\"Energy\": 60, \"Unit\": "
        "\"keV\", \"PhotonCount\": 1000}]}, \"Detector\": {\"Position\": [0, 250, 0, \"mm\"], \"UpVector\": [0, 0, -1], "
        "\"NumberOfPixels\": [61, 61], \"Spacing\": [1, 1, \"mm\"]}, \"SceneGraph\": {\"Path\": \"engine.dae\", "
        "\"Material\": \"Fe\", \"Label\": \"engine\"}, \"Samples\": [{\"Label\": \"small\", \"Path\": \"box.obj\", \"Group\": "
        "\"lid\", \"Material\": \"Al\", \"Unit\": \"um\"}]}");
    char text[1024];
    snprintf(text, sizeof text, "g lid\n%so base\nv 0 0 0\nv 9 0 0\nv 0 9 0\nf 9 10 11\n", box);
    write_text("box.obj", text);
    ck_run(0, "lbuffer engine.json --part engine --json -o l.mha");
    check_range(0, 20, 0.01); /* oblique rays: 20 (10 / 500)^2 / 2 */
    ck_assert_ptr_nonnull(
        strstr(complained, "small: its box is 0.04 mm long, under 1/500 of the field of view"));
    ck_assert_ptr_nonnull(strstr(complained, "its unit is um, as named"));
    ck_run(0, "image engine.json --only small -o a.mha --quantity attenuation --json");
    check_range(0, 0.02, 0.02);
    ck_run(0, "image engine.json --without \"s*\" -o a.mha --quantity transmission --quiet");
    ck_run_fails(2, "did you mean \"engine\"", "image engine.json --only engin -o a.mha");
    ck_run_fails(2, "no part is left", "image engine.json --without engine,s*l -o a.mha");
    write_text("marked.txt", "\xEF\xBB\xBF"
                             "60 1000\n");
    write_text(
        "marked.json",
        "\xEF\xBB\xBF{\"Source\": {\"From\": \"front\", \"Beam\": {\"TextFile\": \"marked.txt\", \"Unit\": "
        "\"keV\"}}, \"Samples\": [{\"Cube\": [20, \"mm\"], \"Material\": \"Al\"}]}");
    ck_run(0, "plan marked.json --quiet"); /* byte-order marks in a scene and a spectrum */
    ck_run(1, "mesh box.obj --groups");
    ck_assert_ptr_nonnull(strstr(said, "group \"lid\": 12 triangles"));
    ck_assert_ptr_nonnull(strstr(said, "unit: mm, assumed"));
    ck_run(0, "mesh box.obj --split . --scene parts.json --unit cm");
    ck_run(0, "mesh lid.ply");
    ck_assert_ptr_nonnull(strstr(said, "x -50 to 150"));
    ck_run(0, "lbuffer parts.json --part lid --json -o l.mha");
    static char scene[4096];
    read_back("parts.json", scene, sizeof scene);
    ck_assert_ptr_nonnull(strstr(scene, "\"Path\": \"lid.ply\"")); /* the scene may be moved with its parts */
    write_text("plain.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n");
    ck_run_fails(3, "no groups", "mesh plain.obj --split .");
}
END_TEST

/* Two boxes of one file that overlap by 2 mm along the rays, 12 triangles listed twice, and a cavity that leaves: sums with a
 * warning, or the union. */
START_TEST(overlaps_within_a_mesh) {
    static const char lower[] =
        "v -5 8 -15\nv 15 8 -15\nv -5 14 -15\nv 15 14 -15\nv -5 8 25\nv 15 8 25\nv -5 14 25\nv 15 14 25\n"
        "f 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf 11 15 16 12\nf 9 13 15 11\nf 10 12 16 14\n";
    char text[2048];
    snprintf(text, sizeof text, "%s%s", box, lower);
    write_text("two.obj", text);
    ck_run(1, "mesh two.obj --json");
    json_t *object = said_json(), *file = json_array_get(member(object, "files"), 0);
    ck_assert_int_eq(json_integer_value(json_object_get(file, "overlapping_components")), 1);
    json_decref(object);
    ck_run(0, "lbuffer two.obj --material Al -o l.mha --json");
    check_range(0, 16, 40 * 2e-4 + 1e-3);
    ck_assert_ptr_nonnull(strstr(complained, "overlaps a larger one: number 2 by up to 40 mm"));
    ck_run(0, "lbuffer two.obj --material Al -o l.mha --json --set Repair=union");
    check_range(0, 14, 40 * 2e-4 + 1e-3);
    ck_assert_ptr_null(strstr(complained, "overlap"));
    snprintf(text, sizeof text, "%s%s", box, strstr(box, "f 1"));
    write_text("twice.obj", text);
    ck_run(1, "mesh twice.obj --strict --json");
    object = said_json(), file = json_array_get(member(object, "files"), 0);
    ck_assert_int_eq(json_integer_value(json_object_get(file, "duplicates")), 12);
    json_decref(object);
    ck_run(0, "lbuffer twice.obj --material Al -o l.mha --json");
    check_range(0, 20, 40 * 4e-4 + 1e-3);
    ck_assert_ptr_nonnull(strstr(complained, "12 of 24 triangles are duplicates"));
    ck_run(1, "plan twice.obj --material Al --kev 60 --strict");
    ck_run(0, "lbuffer twice.obj --material Al -o l.mha --json --set 'Repair=[\"exact\", \"union\"]'");
    check_range(0, 10, 40 * 2e-4 + 1e-3);
    ck_assert_ptr_null(strstr(complained, "duplicates"));
    ck_run(
        0,
        "image twice.obj --material Al --kev 60 --from top -o a.mha --quantity attenuation --json --set Repair=union "
        "--set Samples.twice.Material='[\"mu\",0.5]'");
    check_range(0, 2, 2e-3);
}
END_TEST

/* A prism over a star whose outline crosses itself: its middle is inside twice. One whose outline does not is nothing to speak of. */
START_TEST(surfaces_that_cross_themselves) {
    for (int star = 0; star < 2; star++) {
        char text[2048] = "v 0 0 -10\nv 0 0 10\n";
        for (int k = 0; k < 10; k++) {
            const double angle = (star ? 2 : 1) * acos(-1) * 2 / 5 * (k % 5);
            snprintf(text + strlen(text), sizeof text - strlen(text), "v %.9f %.9f %d\n", 10 * cos(angle),
                     10 * sin(angle), k < 5 ? -10 : 10);
        }
        for (int k = 0; k < 5; k++) {
            const int a = 3 + k, b = 3 + (k + 1) % 5;
            snprintf(text + strlen(text), sizeof text - strlen(text), "f %d %d %d %d\nf 1 %d %d\nf 2 %d %d\n",
                     a, b, b + 5, a + 5, b, a, a + 5, b + 5);
        }
        write_text("prism.obj", text);
        ck_run(0, "lbuffer prism.obj --material Al -o l.mha --json");
        ck_assert((strstr(complained, "crosses itself") != NULL) == star);
        ck_run(0, "lbuffer prism.obj --material Al -o l.mha --json --set Repair=union");
        ck_assert_ptr_null(strstr(complained, "crosses itself"));
    }
}
END_TEST

/* 2 x 2 x 2 cells of 10 mm in the middle: seven of HU 40, one of air. */
static void write_volume(void) {
    static const char header[] =
        "ObjectType = Image\nNDims = 3\nBinaryDataByteOrderMSB = False\nOffset = -5 -5 -5\n"
        "ElementSpacing = 10 10 10\nDistanceUnits = mm\nDimSize = 2 2 2\nElementType = MET_SHORT\n"
        "ElementDataFile = LOCAL\n";
    char bytes[sizeof header - 1 + 16];
    memcpy(bytes, header, sizeof header - 1);
    for (size_t k = 0; k < 8; k++) {
        bytes[sizeof header - 1 + 2 * k] = k == 3 ? 0x18 : 40; /* -1000 is 0xfc18 */
        bytes[sizeof header - 1 + 2 * k + 1] = k == 3 ? (char)0xfc : 0;
    }
    write_bytes("ct.mha", bytes, sizeof bytes);
}

static void write_volume_scene(const char *name, const char *keys) {
    char text[2048];
    snprintf(
        text, sizeof text,
        "{\"Source\": {\"Position\": [0, 0, -500, \"mm\"], \"Shape\": \"PointSource\","
        " \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]},"
        " \"Detector\": {\"Position\": [0, 0, 100, \"mm\"], \"UpVector\": [0, 1, 0], \"NumberOfPixels\": [16, 16],"
        " \"Size\": [32, 32, \"mm\"]}, \"Samples\": [{\"Label\": \"patient\", \"Volume\": \"ct.mha\"%s},"
        " {\"Label\": \"pin\", \"Cube\": [4, \"mm\"], \"Material\": \"Ti\", \"Parent\": \"patient\"}]}",
        keys);
    write_text(name, text);
}

START_TEST(volumes_are_parts) {
    write_volume();
    write_volume_scene("s.json", "");
    ck_run(0, "mesh ct.mha --json");
    json_t *object = said_json(), *file = json_array_get(member(object, "files"), 0),
           *classes = member(file, "classes");
    ck_assert_int_eq(json_integer_value(json_array_get(member(file, "cells"), 2)), 2);
    ck_assert_double_eq(json_number_value(member(file, "low")), -1000);
    ck_assert_uint_eq(json_array_size(classes), 2);
    ck_assert_double_eq(json_number_value(member(json_array_get(classes, 0), "share")), 0.125);
    json_decref(object);
    ck_run(0, "mesh ct.mha");
    ck_assert_ptr_nonnull(strstr(said, "columns along +x"));
    ck_run(0, "plan s.json");
    ck_assert_ptr_nonnull(strstr(said, "patient: 2 x 2 x 2 cells of 16 bits"));
    ck_assert_ptr_nonnull(strstr(said, "hits of 2 parts are listed"));
    ck_run(0, "image s.json --quantity attenuation -o a.mha");
    ck_run(0, "image s.json --without pin --quantity attenuation -o a.mha");
    ck_run(0, "parts s.json");
    ck_assert_ptr_nonnull(strstr(said, "cells of a volume"));
    ck_run(0, "mesh ct.mha --unit cm");
    ck_assert_ptr_nonnull(strstr(said, "x -100 to 100"));
    ck_assert_ptr_nonnull(
        strstr(complained, "note: ct.mha: read in cm, as was asked; the file itself is in mm"));
    write_volume_scene("s.json", ", \"Unit\": \"mm\"");
    ck_run(0, "parts s.json");
    ck_assert_ptr_null(strstr(complained, "as was asked"));
    write_volume_scene("s.json", ", \"Unit\": \"cm\"");
    ck_run(0, "parts s.json");
    ck_assert_ptr_nonnull(strstr(complained, "): read in cm, as was asked; the file itself is in mm"));
    write_volume_scene(
        "s.json",
        ", \"Classes\": [[-1000, \"Air\"], [0, \"Water\"]], \"Transform\": [[\"Rotation\", 30, 0, 0, 1]]");
    ck_run(0, "image s.json -o a.mha");
    write_volume_scene("s.json", ", \"Transform\": [[\"Translation\", 9, 0, 0, \"mm\"]]");
    ck_run(0, "image s.json -o a.mha");
    ck_assert_ptr_nonnull(strstr(complained, "pin leaves patient"));
    ck_assert_ptr_nonnull(
        strstr(complained, "nothing is clamped but the cells of a volume, which are cut out once"));
}
END_TEST

static const struct {
    const char *keys, *says;
} bad_volumes[] = {
    {", \"Density\": 1", "whose values say the density"},
    {", \"Cube\": [4, \"mm\"]", "stands beside Volume"},
    {", \"Interpolation\": \"cubic\"", "interpolation"},
    {", \"Values\": \"grey\"", "grey"},
    {", \"Values\": \"density\"", "give it a material or classes"},
    {", \"Values\": \"mu\", \"Material\": \"Water\"", "need no material"},
    {", \"Values\": \"mu\"", "at least 0"},
    {", \"Classes\": [[0, \"Air\"], [0, \"Water\"]]", "not above"},
    {", \"Classes\": [[0, \"Air\"]], \"Material\": \"Water\"", "has a material and classes"},
    {", \"Material\": [\"mu\", 0.2]", "no density can change it"},
    {", \"Transform\": [[\"Scaling\", 1, 0, 1]]", "flattens"},
};

START_TEST(bad_volumes_are_refused) {
    write_volume();
    write_volume_scene("s.json", bad_volumes[_i].keys);
    ck_run(3, "image s.json -o a.mha");
    ck_assert_msg(strstr(complained, bad_volumes[_i].says) != NULL, "%s: %s", bad_volumes[_i].says,
                  complained);
    ck_assert(!has_file("a.mha"));
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up_box, tear_down);
    tcase_add_test(tests, a_mesh_needs_no_scene);
    tcase_add_test(tests, a_mesh_is_seen_from_any_side);
    tcase_add_test(tests, several_meshes);
    tcase_add_test(tests, inverted_components_are_turned);
    tcase_add_test(tests, what_is_inverted_is_said_once);
    tcase_add_test(tests, overlaps_within_a_mesh);
    tcase_add_test(tests, surfaces_that_cross_themselves);
    tcase_add_test(tests, volumes_are_parts);
    tcase_add_loop_test(tests, bad_volumes_are_refused, 0, sizeof bad_volumes / sizeof *bad_volumes);
    tcase_add_test(tests, files_bring_their_units_and_groups);
    tcase_add_loop_test(tests, bad_meshes_are_refused, 0, sizeof bad / sizeof *bad);
}

SKG_SUITE_MAIN("meshes", add_tests)
