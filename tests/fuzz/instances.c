/* Mesh files whose parts place each other (3MF, glTF, COLLADA, AMF, X3D), by a grammar: the first byte chooses the format, the
 * others its objects, what they are made of, and what lengths they announce. */
#include "fuzz/expand.h"
#include "fuzz/fuzz.h"
#include "support/archive.h"

#include <skiagraph/mesh.h>

#include <string.h>

/* clang-format off */
static const rule rules_3mf[] = {
    {"$file", {"<model unit=\"millimeter\"><resources><$objects></resources><build><$items></build></model>"}},
    {"$objects", {"<$object>", "<$object><$objects>", "<$object><$object><$object><$object><$objects>"}},
    {"$object", {"<object id=\"<$id>\"><$mesh></object>", "<object id=\"<$id>\"><components><$components></components></object>",
                 "<object id=\"<$id>\" type=\"support\"><components><$components></components></object>", "<object id=\"<$id>\"/>"}},
    {"$mesh", {"<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/>"
               "</vertices><triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>", "<mesh/>"}},
    {"$components", {"<$component>", "<$component><$components>", "<$component><$component><$component><$component><$components>"}},
    {"$component", {"<component objectid=\"<$id>\"/>", "<component objectid=\"<$id>\" transform=\"1 0 0 0 1 0 0 0 1 0 0 2\"/>",
                    "<component path=\"/3D/a.model\" objectid=\"<$id>\"/>"}},
    {"$items", {"<item objectid=\"<$id>\"/>", "<item objectid=\"<$id>\"/><$items>"}},
    {"$id", {"1", "2", "3", "4", "5", "6", "7", "8", "9"}},
};
static const rule rules_gltf[] = {
    {"$file", {"{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[<$list>]}],\"nodes\":[<$nodes>],\"meshes\":[{\"primitives\":"
               "[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],\"accessors\":[{<$view>\"componentType\":5126,\"count\":<$count>,\"type\":\"VEC3\"},"
               "{\"bufferView\":1,\"componentType\":5123,\"count\":<$count>,\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":"
               "<$bytes>},{\"buffer\":0,\"byteOffset\":<$bytes>,\"byteLength\":<$bytes>}],\"buffers\":[{\"byteLength\":<$bytes>,\"uri\":"
               "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAQACAAMAAAADAAIA\"}]}"}},
    {"$view", {"\"bufferView\":0,", ""}},
    {"$nodes", {"<$node>", "<$node>,<$nodes>", "<$node>,<$node>,<$node>,<$node>,<$nodes>"}},
    {"$node", {"{\"mesh\":0}", "{\"children\":[<$list>]}", "{\"mesh\":0,\"children\":[<$list>]}", "{}"}},
    {"$list", {"0", "<$id>", "<$id>,<$list>", "<$id>,<$id>,<$id>,<$list>"}},
    {"$id", {"0", "1", "2", "3", "4", "5", "6", "7", "8", "9"}},
    {"$count", {"4", "12", "3", "1000000", "4294967295", "-1", "1e300"}},
    {"$bytes", {"72", "48", "24", "0", "2000000000", "4294967296", "-4"}},
};
static const rule rules_collada[] = {
    {"$file", {"<COLLADA version=\"1.4.1\"><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"<$count>\">"
               "0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source=\"#a\" count=\"<$count>\" stride=\"3\"><param name=\"X\" "
               "type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
               "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\"><input semantic=\"VERTEX\" "
               "source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_nodes><$nodes></library_nodes>"
               "<library_visual_scenes><visual_scene id=\"s\"><$nodes></visual_scene></library_visual_scenes><scene><instance_visual_scene "
               "url=\"#s\"/></scene></COLLADA>"}},
    {"$count", {"9", "3", "0", "1000000", "4000000000"}},
    {"$nodes", {"<$node>", "<$node><$nodes>", "<$node><$node><$node><$nodes>"}},
    {"$node", {"<node id=\"<$id>\"><$content></node>", "<node name=\"<$id>\"><$content></node>"}},
    {"$content", {"<instance_geometry url=\"#g\"/>", "<instance_node url=\"#<$id>\"/>", "<$node><$content>", "<instance_node url=\"#<$id>\"/><$content>"}},
    {"$id", {"1", "2", "3", "4", "5", "6", "7", "8", "9"}},
};
static const rule rules_amf[] = {
    {"$file", {"<?xml version=\"1.0\"?><amf unit=\"inch\"><$parts></amf>"}},
    {"$parts", {"<$part>", "<$part><$parts>", "<$part><$part><$part><$parts>"}},
    {"$part", {"<object id=\"<$id>\"><mesh><vertices><vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex><vertex><coordinates><x>1</x>"
               "<y>0</y><z>0</z></coordinates></vertex><vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates></vertex></vertices><volume>"
               "<triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object>",
               "<constellation id=\"<$id>\"><$instances></constellation>"}},
    {"$instances", {"<instance objectid=\"<$id>\"/>", "<instance objectid=\"<$id>\"><deltax>1</deltax></instance><$instances>"}},
    {"$id", {"1", "2", "3", "4", "5", "6", "7", "8", "9"}},
};
static const rule rules_x3d[] = {
    {"$file", {"<X3D version=\"3.3\"><Scene><$groups></Scene></X3D>"}},
    {"$groups", {"<$group>", "<$group><$groups>", "<$group><$group><$group><$groups>"}},
    {"$group", {"<Shape DEF=\"s<$id>\"><IndexedFaceSet coordIndex=\"0 1 2 -1\"><Coordinate point=\"0 0 0 1 0 0 0 1 0\"/></IndexedFaceSet></Shape>",
                "<Group DEF=\"<$id>\"><$groups></Group>", "<Group USE=\"<$id>\"/>", "<Shape USE=\"s<$id>\"/>", "<Transform><$groups></Transform>"}},
    {"$id", {"1", "2", "3", "4", "5", "6", "7", "8", "9"}},
};
/* clang-format on */

static const struct {
    const rule *rules;
    size_t count;
    const char *name;
} formats[] = {
    {rules_3mf, sizeof rules_3mf / sizeof *rules_3mf, "m.3mf"},
    {rules_gltf, sizeof rules_gltf / sizeof *rules_gltf, "m.gltf"},
    {rules_collada, sizeof rules_collada / sizeof *rules_collada, "m.dae"},
    {rules_amf, sizeof rules_amf / sizeof *rules_amf, "m.amf"},
    {rules_x3d, sizeof rules_x3d / sizeof *rules_x3d, "m.x3d"},
};

static const char *write_3mf(const char *text) {
    static const char *const names[] = {"_rels/.rels", "3D/3dmodel.model", "3D/a.model"};
    static const char relations[] =
        "<Relationships><Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
    static archive a;
    /* the other part has the same objects, so that circles also lead through both */
    const int fits = 2 * strlen(text) < ARCHIVE_BYTES - 1024;
    make_archive_of(&a, fits ? 3 : 2, names, (const char *const[]){relations, text, text});
    return fuzz_write("m.3mf", a.bytes, a.size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static char text[EXPANDED_MAX + 1];
    skg_mesh *mesh = NULL;
    if (size == 0) return 0;
    const size_t k = *data % (sizeof formats / sizeof *formats);
    const size_t length = fuzz_expand(formats[k].rules, formats[k].count, data + 1, size - 1, text);
    text[length] = '\0';
    const char *path = k == 0 ? write_3mf(text) : fuzz_write(formats[k].name, text, length);
    fuzz_expect_sentence(skg_mesh_load(NULL, path, 1, &mesh));
    skg_mesh_release(&mesh);
    return 0;
}
