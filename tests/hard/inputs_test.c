/* Inputs that never end, never begin or grow when they are unpacked: each is refused at once with a sentence. */
#include "suite.h"
#include "support/archive.h"

#include <skiagraph/scanning.h>
#include <skiagraph/skiagraph.h>

#include <string.h>
#include <sys/stat.h>

static char folder[64], path[256];

static void set_up(void) {
    strcpy(folder, "/tmp/skg-inputs-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
}

static void tear_down(void) {
    char line[128];
    snprintf(line, sizeof line, "rm -rf %s", folder);
    ck_assert_int_eq(system(line), 0);
}

static const char *in_folder(const char *name) {
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_bytes(const char *name, const void *bytes, size_t count) {
    FILE *stream = fopen(in_folder(name), "wb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_uint_eq(fwrite(bytes, 1, count, stream), count);
    fclose(stream);
}

static const char *const kinds[] = {"a.stl", "a.obj", "a.ply", "a.3mf",    "a.dae",  "spectrum",
                                    "table", "poses", "list",  "response", "a.json", "a.h5"};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* A build without HDF5 reads no scans. */
static int is_possible(int kind) {
    return kind != 11 || skg_scan_file_path_check("a.h5") == SKG_OK;
}

static skg_status read_input(int kind, const char *from) {
    skg_status status = SKG_OK;
    skg_mesh *mesh = NULL;
    skg_spectrum *spectrum = NULL;
    skg_material *material = NULL;
    skg_response *response = NULL;
    skg_setup *setup = NULL;
    skg_scan *scan = NULL;
    skg_view view;
    skg_view_init(&view);
    char scene[512];
    if (kind < 5) status = skg_mesh_load(NULL, from, 1, &mesh);
    if (kind == 5) status = skg_spectrum_load(from, "keV", &spectrum);
    if (kind == 6) status = skg_material_load_table(from, "keV", &material);
    if (kind == 7) status = skg_scan_load_table(&view, NULL, from, &scan);
    if (kind == 8) {
        snprintf(
            scene, sizeof scene,
            "{\"Source\":{\"Position\":[0,-1,0,\"m\"],\"Shape\":\"ParallelBeam\",\"Beam\":[{\"Energy\":60,"
            "\"Unit\":\"keV\",\"PhotonCount\":1}]},\"Detector\":{\"Position\":[0,10,0,\"cm\"],\"UpVector\":[0,0,-1],"
            "\"NumberOfPixels\":[9,7],\"Spacing\":[1,1,\"mm\"],\"LSF\":\"%s\"},\"Samples\":[{\"Label\":\"a\","
            "\"Sphere\":[12,3,\"mm\"],\"Material\":[\"mu\",1]}]}",
            from);
        write_bytes("scene.json", scene, strlen(scene));
        status = skg_setup_load(NULL, in_folder("scene.json"), 0, NULL, &setup);
    }
    if (kind == 9) status = skg_response_load(from, "keV", SKG_RESPONSE_MEANING_SIGNAL, &response);
    if (kind == 10) status = skg_setup_load(NULL, from, 0, NULL, &setup);
    if (kind == 11) {
        skg_scan_reader *reader = NULL;
        status = skg_scan_reader_open(from, &reader);
        skg_scan_reader_release(&reader);
    }
    return status;
}

START_TEST(what_is_no_file_is_refused) {
    char from[256];
    if (!is_possible(_i)) return;
    ck_assert_int_eq(mkfifo(in_folder(kinds[_i]), 0666), 0);
    strcpy(from, path);
    ck_skg_fails(read_input(_i, from), SKG_ERR_FILE, "it is a pipe or a device, not a file");
    ck_assert_int_eq(unlink(from), 0);
    ck_assert_int_eq(symlink("/dev/zero", from), 0);
    ck_skg_fails(read_input(_i, from), SKG_ERR_FILE, "it is a pipe or a device, not a file");
    ck_assert_int_eq(unlink(from), 0);
    ck_assert_int_eq(mkdir(from, 0777), 0);
    ck_skg_fails(read_input(_i, from), SKG_ERR_FILE, "it is a folder, not a file");
}
END_TEST

/* Files with holes, which take no room. */
START_TEST(what_is_too_long_is_refused) {
    const int64_t mib = 1 << 20, most = (_i < 5 ? 65536 : 256) * mib;
    char from[256];
    if (_i == 11) return; /* a scan may have any length */
    write_bytes(kinds[_i], "", 0);
    strcpy(from, path);
    if (truncate(from, most + 1) != 0) return; /* the file system has no such files */
    ck_skg_fails(read_input(_i, from), SKG_ERR_FILE,
                 _i < 5 ? "longer than 65536 MiB" : "longer than 256 MiB");
}
END_TEST

/* A glTF file that refers to a pipe. */
START_TEST(references_are_opened_alike) {
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"pipe.bin\",\"byteLength\":36}],\"bufferViews\":"
        "[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"componentType\":"
        "5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0}";
    skg_mesh *mesh = NULL;
    ck_assert_int_eq(mkfifo(in_folder("pipe.bin"), 0666), 0);
    write_bytes("a.gltf", text, strlen(text));
    ck_assert_int_ne(skg_mesh_load(NULL, path, 1, &mesh), SKG_OK);
    ck_assert_int_gt((int)strlen(skg_last_error()), 0);
}
END_TEST

/* relations: instead of the usual text; NULL: that */
static void make_archive_with(archive *a, const char *relations) {
    static const char *const names[] = {"[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"};
    static const char *const texts[] = {
        "<?xml version=\"1.0\"?><Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
        "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
        "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>",
        "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
        "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>",
        "<?xml version=\"1.0\"?><model unit=\"millimeter\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources><object id=\"1\" "
        "type=\"model\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex "
        "x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" "
        "v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" "
        "v2=\"2\" v3=\"3\"/></triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>"};
    const char *const used[] = {texts[0], relations ? relations : texts[1], texts[2]};
    make_archive_of(a, 3, names, used);
}

static void make_archive(archive *a) {
    make_archive_with(a, NULL);
}

static void ck_archive(const archive *a, const char *name, skg_status expected, const char *text) {
    skg_mesh *mesh = NULL;
    write_bytes(name, a->bytes, a->size);
    if (expected == SKG_OK)
        ck_skg(skg_mesh_load(NULL, path, 1, &mesh));
    else
        ck_skg_fails(skg_mesh_load(NULL, path, 1, &mesh), expected, text);
    skg_mesh_release(&mesh);
}

static void set(archive *a, size_t at, uint64_t value, int count) {
    const size_t size = a->size;
    a->size = at;
    put(a, value, count);
    a->size = size;
}

/* A 3MF file in inches whose object lies in another part (in mm), built twice, once mirrored and moved; a support is left out; and
 * what is made of itself is refused. */
START_TEST(objects_of_3mf_lie_anywhere) {
    static archive a;
    static const char *const names[] = {"_rels/.rels", "3D/3dmodel.model", "3D/Objects/a.model"};
    static const char relations[] =
        "<Relationships><Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    static const char mesh_text[] =
        "<model unit=\"millimeter\"><resources><object id=\"7\" name=\"A &amp; B\" type=\"model\"><mesh><vertices>"
        "<vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"2\" z=\"0\"/><vertex x=\"0\" "
        "y=\"0\" z=\"3\"/></vertices><triangles><triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>"
        "<triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh></object></resources>"
        "<build/></model>";
    static const char build[] =
        "<m:model unit=\"inch\" xmlns:m=\"core\" xmlns:p=\"production\"><m:resources><m:object id=\"2\" type=\"model\">"
        "<m:components><m:component p:path=\"/3D/Objects/a.model\" objectid=\"7\"/></m:components></m:object>"
        "<m:object id=\"3\" type=\"support\"/><m:object id=\"4\"><m:components><m:component objectid=\"4\"/></m:components>"
        "</m:object></m:resources><m:build><m:item objectid=\"%s\"/><m:item objectid=\"3\"/><m:item objectid=\"2\" "
        "transform=\"-1 0 0 0 1 0 0 0 1 2 0 0\"/></m:build></m:model>";
    char text[2048];
    skg_mesh *mesh = NULL;
    skg_mesh_health health;
    snprintf(text, sizeof text, build, "2");
    make_archive_of(&a, 3, names, (const char *const[]){relations, text, mesh_text});
    write_bytes("production.3mf", a.bytes, a.size);
    ck_skg(skg_mesh_load(NULL, path, 0, &mesh));
    skg_mesh_health_init(&health);
    ck_skg(skg_mesh_health_get(mesh, &health));
    ck_assert_int_eq(health.closed, 1);
    ck_assert_int_eq(health.turned + health.flipped, 0);
    /* rounding of doubles of some mm */
    ck_assert_double_eq_tol(health.volume, 2, 1e-12);
    ck_assert_double_eq_tol(health.bounds[3], 2 * 25.4, 1e-12); /* the move is in inches, the object in mm */
    ck_assert_double_eq_tol(health.bounds[5], 3, 1e-12);
    skg_mesh_release(&mesh);
    const skg_mesh_reading reading = {.size = sizeof reading, .unit_mm = 1, .group = "A & B"};
    ck_skg(skg_mesh_load_as(NULL, path, &reading, &mesh));
    ck_skg(skg_mesh_health_get(mesh, &health));
    /* likewise */
    ck_assert_double_eq_tol(health.bounds[3], 2, 1e-12);
    skg_mesh_release(&mesh);
    snprintf(text, sizeof text, build, "4");
    make_archive_of(&a, 3, names, (const char *const[]){relations, text, mesh_text});
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "a.3mf: the object \"4\" contains itself; take what leads back");
    make_archive_of(&a, 2, names, (const char *const[]){relations, text});
    snprintf(text, sizeof text, build, "2");
    make_archive_of(&a, 2, names, (const char *const[]){relations, text});
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "a.model\", which is not there");
    ck_archive(&a, "a.amf", SKG_ERR_FORMAT, "a.amf: is a ZIP archive, as only 3MF may be; unpack it");
}
END_TEST

static const char root_relations[] =
    "<Relationships><Relationship Target=\"/m.model\" Id=\"r\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

/* Eight objects, each of ten of the next, are 11,111,111 in a kilobyte; five of them 11,111. */
START_TEST(objects_are_counted_before_they_are_opened) {
    static archive a;
    static char text[16384];
    size_t n = 0;
    for (int deep = 5; deep <= 8; deep += 3) {
        n = (size_t)sprintf(
            text, "<model><resources><object id=\"0\"><mesh><vertices><vertex x=\"0\" y=\"0\" "
                  "z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices>"
                  "<triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object>");
        for (int k = 1; k < deep; k++) {
            n += (size_t)sprintf(text + n, "<object id=\"%d\"><components>", k);
            for (int i = 0; i < 10; i++)
                n += (size_t)sprintf(text + n, "<component objectid=\"%d\"/>", k - 1);
            n += (size_t)sprintf(text + n, "</components></object>");
        }
        sprintf(text + n, "</resources><build><item objectid=\"%d\"/></build></model>", deep - 1);
        make_archive_of(&a, 2, (const char *const[]){"_rels/.rels", "m.model"},
                        (const char *const[]){root_relations, text});
        if (deep == 5)
            ck_archive(&a, "a.3mf", SKG_OK, "");
        else
            ck_archive(&a, "a.3mf", SKG_ERR_FORMAT,
                       "a.3mf: places 11111111 parts, more than 100000 (the object \"7\" alone");
    }
}
END_TEST

/* Circles in the formats that Assimp reads, which follows them until the stack ends. */
START_TEST(circles_of_nodes_are_refused) {
    static const struct {
        const char *name, *text, *sentence;
    } cases[] = {
        {"a.gltf",
         "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[1]},{\"children\":"
         "[0]}]}",
         "the node \"0\" contains itself"},
        {"one.gltf",
         "{\"asset\":{\"version\":\"1.0\"},\"nodes\":{\"a\":{\"children\":[\"b\"]},\"b\":{\"children\":[\"b\"]}}}",
         "the node \"b\" contains itself"},
        {"a.dae",
         "<COLLADA version=\"1.4.1\"><library_nodes><node id=\"n\"><node><instance_node url=\"#n\"/></node></node>"
         "</library_nodes><library_visual_scenes><visual_scene id=\"s\"><node><instance_node url=\"#n\"/></node></visual_scene>"
         "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>",
         "the node \"n\" contains itself"},
        {"named.unknown",
         "<COLLADA version=\"1.4.1\"><library_visual_scenes><visual_scene id=\"s\"><node name=\"n\"><instance_node url=\"#n\"/>"
         "</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>",
         "the node \"\" contains itself"},
        {"a.amf",
         "<amf unit=\"inch\"><constellation id=\"1\"><instance objectid=\"2\"/></constellation><constellation id=\"2\"><instance "
         "objectid=\"1\"/></constellation></amf>",
         "the object \"1\" contains itself"},
        {"a.x3d",
         "<X3D><Scene><Group DEF=\"g\"><Transform><Group USE=\"g\"/></Transform></Group></Scene></X3D>",
         "the node \"g\" contains itself"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        skg_mesh *mesh = NULL;
        write_bytes(cases[k].name, cases[k].text, strlen(cases[k].text));
        ck_skg_fails(skg_mesh_load(NULL, path, 1, &mesh), SKG_ERR_FORMAT, cases[k].sentence);
    }
}
END_TEST

/* Lengths of a glTF file that its bytes do not have, which Assimp would take memory for; nodes that place each other. */
START_TEST(lengths_of_gltf_are_held_against_its_bytes) {
    static const struct {
        const char *view, *count, *bytes, *nodes, *sentence;
    } cases[] = {
        {"\"bufferView\":0,", "3", "36", "{\"mesh\":0}", NULL},
        {"\"bufferView\":0,", "3", "2000000000", "{\"mesh\":0}", "the buffer \"0\" is 2000000000 bytes long"},
        {"\"bufferView\":0,", "4", "36", "{\"mesh\":0}",
         "the accessor \"0\" is 48 bytes long by its text, and has 36"},
        {"", "100000000", "36", "{\"mesh\":0}", "the accessor \"0\" is 1200000000 bytes long"},
        {"", "5000000", "36", "{\"mesh\":0},{\"mesh\":0},{\"mesh\":0},{\"mesh\":0}",
         "MiB of memory, more than 1 GiB and more than 64"},
        {"\"bufferView\":0,", "3", "36",
         "{\"mesh\":0},{\"children\":[0,0,0,0,0,0,0,0]},{\"children\":[1,1,1,1,1,1,1,1]},"
         "{\"children\":[2,2,2,2,2,2,2,2]},{\"children\":[3,3,3,3,3,3,3,3]},{\"children\":[4,4,4,4,4,4,4,4]},{\"children\":[5,5,5,5,5,5,5,5]}",
         "places 299593 parts, more than 100000 (the node \"6\""},
    };
    char text[2048];
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        skg_mesh *mesh = NULL;
        sprintf(
            text,
            "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[%s],\"meshes\":[{\"primitives\":["
            "{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{%s\"componentType\":5126,\"count\":%s,\"type\":\"VEC3\"}],"
            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":%s,\"uri\":\"data:application/octet-"
            "stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}",
            cases[k].nodes, cases[k].view, cases[k].count, cases[k].bytes);
        write_bytes("a.gltf", text, strlen(text));
        if (cases[k].sentence)
            ck_skg_fails(skg_mesh_load(NULL, path, 1, &mesh), SKG_ERR_FORMAT, cases[k].sentence);
        else
            ck_skg(skg_mesh_load(NULL, path, 1, &mesh));
        skg_mesh_release(&mesh);
    }
}
END_TEST

/* Binary glTF: chunks longer than the file, and a buffer longer than its chunk. */
START_TEST(chunks_of_glb_are_held_against_the_file) {
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":2000000000}]}  ";
    static const struct {
        uint32_t text, binary;
        const char *sentence;
    } cases[] = {{1u << 31, 4, "its text is 2147483648 bytes long by its head"},
                 {sizeof text - 1, 1u << 31, "its chunk of numbers is 2147483648 bytes long"},
                 {sizeof text - 1, 4, "the buffer \"0\" is 2000000000 bytes long by its text, and has 4"}};
    static archive a;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        a.size = 0;
        put(&a, 0x46546C67, 4), put(&a, 2, 4), put(&a, 32 + sizeof text - 1, 4);
        put(&a, cases[k].text, 4), put(&a, 0x4E4F534A, 4);
        memcpy(a.bytes + a.size, text, sizeof text - 1), a.size += sizeof text - 1;
        put(&a, cases[k].binary, 4), put(&a, 0x004E4942, 4), put(&a, 0, 4);
        ck_archive(&a, "a.glb", SKG_ERR_FORMAT, cases[k].sentence);
    }
}
END_TEST

START_TEST(archives_are_measured_before_they_are_unpacked) {
    enum { LENGTH = 24, NAME = 28, ENTRY = 46 };
    static archive a;
    make_archive(&a);
    const size_t second = a.directory + ENTRY + strlen("[Content_Types].xml");
    ck_archive(&a, "a.3mf", SKG_OK, "");
    set(&a, a.directory + LENGTH, (1u << 30) + 1, 4);
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "longer than 1024 MiB when it is unpacked");
    ck_archive(&a, "a.unknown", SKG_ERR_FORMAT, "longer than 1024 MiB when it is unpacked");
    set(&a, a.directory + LENGTH, 600u << 20, 4); /* two of them */
    set(&a, second + LENGTH, 600u << 20, 4);
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "longer than 1024 MiB when it is unpacked");
    memmove(a.bytes + 7, a.bytes, a.size), a.size += 7; /* behind other bytes, as Assimp accepts it */
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "longer than 1024 MiB when it is unpacked");
    make_archive(&a);
    set(&a, a.directory + LENGTH, 900u << 20, 4);
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT,
               "\"[Content_Types].xml\" is 943718400 bytes long by its directory");
    make_archive(&a);
    set(&a, a.directory + LENGTH, UINT32_MAX, 4); /* a length of 8 bytes that is not there */
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "the archive is damaged: its directory cannot be read");
    make_archive(&a);
    set(&a, second, 0, 4);
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "the archive is damaged");
    make_archive(&a);
    set(&a, a.size - 10, UINT32_MAX, 4);
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "the archive is damaged");
}
END_TEST

/* Other bytes before and behind an archive, and the end of another directory in its comment, which Assimp would take. */
START_TEST(archives_end_where_assimp_says) {
    static archive a, damaged;
    make_archive(&a);
    memmove(a.bytes + 7, a.bytes, a.size), a.size += 7;
    ck_archive(&a, "a.3mf", SKG_OK, "");
    put(&a, 0, 5);
    ck_archive(&a, "a.3mf", SKG_OK, "");
    make_archive(&a), make_archive(&damaged);
    damaged.bytes[damaged.directory - 20] ^= 1;
    set(&a, a.size - 2, damaged.size, 2);
    memcpy(a.bytes + a.size, damaged.bytes, damaged.size), a.size += damaged.size;
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "a part of it is not what its check sum says");
}
END_TEST

/* Assimp ends the process where a check sum is wrong. */
START_TEST(damaged_parts_of_archives_are_refused) {
    static archive a;
    make_archive(&a);
    const size_t size = a.size, texts = a.directory;
    for (size_t at = (size_t)_i; at < size; at += 16) {
        skg_mesh *mesh = NULL;
        make_archive(&a);
        a.bytes[at] ^= (unsigned char)(1 << at / 16 % 8);
        write_bytes("a.3mf", a.bytes, a.size);
        skg_mesh_load(NULL, path, 1, &mesh); /* some bytes have no meaning */
        skg_mesh_release(&mesh);
    }
    make_archive(&a);
    a.bytes[texts - 20 - (size_t)_i] ^= 1;
    ck_archive(&a, "a.3mf", SKG_ERR_FORMAT, "a part of it is not what its check sum says");
}
END_TEST

#define MODEL "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\""

/* Assimp ends the process where it finds no model by the relationships. */
START_TEST(relationships_of_archives_are_checked) {
    static const struct {
        const char *text, *error; /* NULL: is read */
    } cases[] = {
        {"<Relationships><Relationship Id=\"a\" " MODEL " Target=\"/3D/3dmodel.model\"/></Relationships>",
         NULL},
        {"\xEF\xBB\xBF<?xml version='1.0'?>\r\n<Relationships xmlns = 'x' >\n<Relationship Target='3D/3dmodel.model' "
         "Id='a' " MODEL "></Relationship>\n</Relationships>\n",
         NULL},
        {"<Relationships><Relationship " MODEL " Target=\"/3D/other.model\"/></Relationships>",
         "names \"3D/other.model\""},
        {"<Relationships><Relationship " MODEL " Target=\"/\"/></Relationships>", "names \"\""},
        {"<Relationships><Relationship " MODEL "/></Relationships>", "names \"\""},
        {"", "cannot be read"},
        {"no XML", "cannot be read"},
        {"<?xml version='1.0'?>", "cannot be read"},
        {"<Relationships>", "cannot be read"},
        {"</Relationships>", "cannot be read"},
        {"<Relationships></Relationships><Relationships>", "cannot be read"},
        {"<Relationships><Relationships></Relationships></Relationships>", "cannot be read"},
        {"<Relationships><Relationship " MODEL " Target=\"/3D/3dmodel.model\"></Relationships>",
         "cannot be read"},
        {"<Relationships><Relationship " MODEL "Target=\"/3D/3dmodel.model\"/></Relationships>",
         "cannot be read"},
        {"<Relationships><Relationship " MODEL " Target=\"/3D/3dmodel.model/></Relationships>",
         "cannot be read"},
        {"<Relationships><Relationship " MODEL " Target=\"&#47;3D/3dmodel.model\"/></Relationships>",
         "cannot be read"},
    };
    static archive a;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        make_archive_with(&a, cases[k].text);
        ck_archive(&a, "a.3mf", cases[k].error ? SKG_ERR_FORMAT : SKG_OK,
                   cases[k].error ? cases[k].error : "");
    }
}
END_TEST

static void add_tests(TCase *tests) {
    tcase_add_checked_fixture(tests, set_up, tear_down);
    tcase_add_loop_test(tests, what_is_no_file_is_refused, 0, KINDS);
    tcase_add_test(tests, relationships_of_archives_are_checked);
    tcase_add_loop_test(tests, damaged_parts_of_archives_are_refused, 0, 16);
    tcase_add_loop_test(tests, what_is_too_long_is_refused, 0, KINDS);
    tcase_add_test(tests, references_are_opened_alike);
    tcase_add_test(tests, objects_of_3mf_lie_anywhere);
    tcase_add_test(tests, objects_are_counted_before_they_are_opened);
    tcase_add_test(tests, circles_of_nodes_are_refused);
    tcase_add_test(tests, lengths_of_gltf_are_held_against_its_bytes);
    tcase_add_test(tests, chunks_of_glb_are_held_against_the_file);
    tcase_add_test(tests, archives_are_measured_before_they_are_unpacked);
    tcase_add_test(tests, archives_end_where_assimp_says);
}

SKG_SUITE_MAIN("inputs", add_tests)
