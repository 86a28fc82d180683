/* Refuses what X3D files say and Assimp passes over: shapes in nodes that it does not follow, prototypes, and clockwise faces. */
#include "mesh/x3d_unread.h"

#include "mesh/xml.h"

#include <string.h>

/* Names of elements; each list ends in NULL. */
static const char *const followed[] = {"X3D", "Scene", "Group", "StaticGroup", "Transform", "Switch", NULL};
static const char *const groups[] = {"Group", "StaticGroup", "Transform", "Switch", NULL};
/* Nodes whose contents are placed by other nodes, or never. */
static const char *const definitions[] = {"ProtoDeclare", "ExternProtoDeclare", "Script", NULL};
static const char *const shapes[] = {"Shape", "Inline", NULL};
static const char *const geometries[] = {"IndexedFaceSet",
                                         "IndexedTriangleSet",
                                         "IndexedTriangleFanSet",
                                         "IndexedTriangleStripSet",
                                         "TriangleSet",
                                         "TriangleFanSet",
                                         "TriangleStripSet",
                                         "ElevationGrid",
                                         "Extrusion",
                                         "Box",
                                         "Sphere",
                                         NULL};
static const char *const leaky[] = {"Cylinder", "Cone", NULL};

typedef struct {
    skg_xml xml;
    int64_t level;      /* open elements */
    int64_t left;       /* level of the outermost one that is not followed; 0: none */
    char name[40];      /* its name */
    int is_definition;  /* it is one */
    int makes_shapes;   /* a prototype has shapes or geometry, or lies in another file */
    int uses_prototype; /* outside definitions */
    int64_t wound[2];   /* geometries that are counter-clockwise, clockwise */
} walk;

static int is_one_of(const skg_xml *xml, const char *const *names) {
    while (*names && !skg_xml_is(xml, *names)) names++;
    return *names != NULL;
}

static int has(const skg_xml *xml, const char *name, const char *value) {
    char text[1024];
    return skg_xml_attribute(xml, name, text, sizeof text) > 0 && (!value || strcmp(text, value) == 0);
}

static skg_status fail(const char *path, const char *name, const char *sentence) {
    return skg_fail(SKG_ERR_FORMAT, "%s: %s %s", path, name, sentence);
}

static skg_status open_element(walk *w, const char *path) {
    const skg_xml *xml = &w->xml;
    const int is_used = has(xml, "USE", NULL), is_geometry = is_one_of(xml, geometries);
    w->level++;
    if (w->left && w->is_definition) {
        w->makes_shapes |= is_geometry || is_one_of(xml, shapes);
        return SKG_OK;
    }
    w->makes_shapes |= skg_xml_is(xml, "ExternProtoDeclare");
    w->uses_prototype |= skg_xml_is(xml, "ProtoInstance");
    if (is_one_of(xml, leaky))
        return fail(path, skg_xml_is(xml, leaky[0]) ? leaky[0] : leaky[1],
                    "is not read without gaps; export it as triangles (IndexedFaceSet), or as .ply or .stl");
    if (w->left && (is_one_of(xml, shapes) || (is_used && is_one_of(xml, groups))))
        return fail(
            path, w->name,
            "holds shapes, which are not read there; put them into a Group or Transform, or export .ply or "
            ".stl");
    if (is_geometry && !is_used) w->wound[has(xml, "ccw", "false")]++;
    if (w->left || is_one_of(xml, followed)) return SKG_OK;
    w->left = w->level;
    w->is_definition = is_one_of(xml, definitions);
    const size_t length = xml->name_length < sizeof w->name - 1 ? xml->name_length : sizeof w->name - 1;
    memcpy(w->name, xml->name, length), w->name[length] = '\0';
    return SKG_OK;
}

skg_status skg_mesh_check_x3d_unread(const char *path, const char *text) {
    walk w = {.xml = {.at = text}};
    while (skg_xml_next(&w.xml) > 0) {
        if (w.xml.opens) SKG_TRY(open_element(&w, path));
        if (!w.xml.closes) continue;
        if (w.left == w.level) w.left = w.is_definition = 0;
        w.level -= w.level > 0;
    }
    if (w.uses_prototype && w.makes_shapes)
        return fail(
            path, "ProtoInstance",
            "places what a prototype defines, which is not read; export the file without prototypes, or as .ply "
            "or .stl");
    if (w.wound[0] > 0 && w.wound[1] > 0)
        return fail(
            path, "ccw=\"false\"",
            "of some geometry is not read, which would face inward beside the others; export all with one "
            "winding, or as .ply or .stl");
    return SKG_OK;
}
