/* Counts what the nodes of COLLADA, AMF and X3D files place. */
#include "mesh/xml_counts.h"

#include "mesh/instances.h"
#include "mesh/xml.h"

#include <string.h>

enum {
    DEEPEST = 1000, /* levels of nodes that Assimp follows well within the stack of a thread */
    LONGEST = 1024  /* of a name */
};

/* Kinds of names. */
enum { NODE, NODE_NAME, GEOMETRY, CONTROLLER, SCENE, DEFINED };

/* An element that is a part (id: its name), or one that places a part (reference: whose). NULL as tag: any element. */
typedef struct {
    const char *tag, *id, *reference;
    uint64_t kind;
    double own;
} element;

static const element collada[] = {
    {"node", "id", NULL, NODE, 1},
    {"geometry", "id", NULL, GEOMETRY, 0},
    {"controller", "id", NULL, CONTROLLER, 0},
    {"visual_scene", "id", NULL, SCENE, 0},
    {"instance_node", NULL, "url", NODE, 0},
    {"instance_geometry", NULL, "url", GEOMETRY, 0},
    {"instance_controller", NULL, "url", CONTROLLER, 0},
    {"skin", NULL, "source", GEOMETRY, 0},
    {"morph", NULL, "source", GEOMETRY, 0},
    {"instance_visual_scene", NULL, "url", SCENE, 0},
    {0},
};
static const element amf[] = {
    {"object", "id", NULL, NODE, 1},
    {"constellation", "id", NULL, NODE, 1},
    {"instance", NULL, "objectid", NODE, 0},
    {0},
};
static const element x3d[] = {
    {NULL, "DEF", NULL, DEFINED, 1},
    {NULL, NULL, "USE", DEFINED, 0},
    {0},
};
static const element *const elements[SKG_XML_KINDS] = {collada, amf, x3d};

/* The open parts, of which each contains the next. */
typedef struct {
    skg_instances parts;
    enum skg_mesh_xml kind;
    int64_t open[DEEPEST + 1];
    size_t level[DEEPEST + 1]; /* of the element of each open part */
    int32_t depth;             /* of the innermost open part; 0: the file */
    size_t at;                 /* level of the element at hand */
} counter;

static skg_status read_name(counter *c, const skg_xml *xml, const char *attribute, char *name, int *found) {
    *found = skg_xml_attribute(xml, attribute, name, LONGEST);
    if (*found < 0)
        return skg_fail(SKG_ERR_FORMAT,
                        "%s: the \"%s\" of an element is damaged or longer than %d characters", c->parts.path,
                        attribute, LONGEST - 1);
    return SKG_OK;
}

/* Opens a part in the one at hand. What lies in no other part of COLLADA and AMF is a library: only references place it. */
static skg_status open_part(counter *c, const skg_xml *xml, const element *e, const char *id) {
    char name[LONGEST] = "";
    int64_t part;
    int found = 0;
    if (c->depth == DEEPEST)
        return skg_fail(SKG_ERR_FORMAT, "%s: the element \"%s\" lies more than %d of its kind deep",
                        c->parts.path, id, (int)DEEPEST);
    SKG_TRY(skg_instances_add(&c->parts, id, e->own, &part));
    if (*id) SKG_TRY(skg_instances_name(&c->parts, part, skg_instances_key(e->kind, id)));
    if (e->kind == NODE && c->kind == SKG_XML_COLLADA) SKG_TRY(read_name(c, xml, "name", name, &found));
    if (found > 0) SKG_TRY(skg_instances_name(&c->parts, part, skg_instances_key(NODE_NAME, name)));
    if (c->depth > 0 || c->kind == SKG_XML_X3D)
        SKG_TRY(skg_instances_place(&c->parts, c->open[c->depth], part));
    c->depth++;
    c->open[c->depth] = part;
    c->level[c->depth] = c->at;
    return SKG_OK;
}

/* Assimp looks for a node of COLLADA by its name where no id fits. */
static skg_status place(counter *c, const element *e, const char *name) {
    name += *name == '#';
    return skg_instances_place_named(&c->parts, c->open[c->depth], skg_instances_key(e->kind, name),
                                     e->kind == NODE ? skg_instances_key(NODE_NAME, name) : 0);
}

static skg_status open_element(counter *c, const skg_xml *xml) {
    char name[LONGEST];
    for (const element *e = elements[c->kind]; e->id || e->reference; e++) {
        int found = 0;
        *name = '\0';
        if (e->tag && !skg_xml_is(xml, e->tag)) continue;
        SKG_TRY(read_name(c, xml, e->id ? e->id : e->reference, name, &found));
        if (e->id && (found > 0 || e->tag)) SKG_TRY(open_part(c, xml, e, name));
        if (e->reference && found > 0) SKG_TRY(place(c, e, name));
    }
    return SKG_OK;
}

static skg_status count_elements(counter *c, const char *text) {
    skg_xml xml = {.at = text};
    int64_t part;
    SKG_TRY(skg_instances_add(&c->parts, "file", 0, &part));
    for (const char *from = text; skg_xml_next(&xml) > 0; from = xml.at) {
        c->parts.nodes[c->open[c->depth]].bytes += (double)(xml.name - from);
        c->at += xml.opens != 0;
        if (xml.opens) SKG_TRY(open_element(c, &xml));
        c->parts.nodes[c->open[c->depth]].bytes += (double)(xml.at - xml.name);
        if (!xml.closes) continue;
        if (c->depth > 0 && c->level[c->depth] == c->at) c->depth--;
        c->at -= c->at > 0;
    }
    return skg_instances_check(&c->parts);
}

skg_status skg_mesh_count_xml(const char *path, int64_t size, const char *text, enum skg_mesh_xml kind) {
    counter c = {.kind = kind,
                 .parts = {.path = path,
                           .kind = kind == SKG_XML_AMF ? "object" : "node",
                           .size = size,
                           .deepest = DEEPEST,
                           .all = kind == SKG_XML_AMF}};
    const skg_status status = count_elements(&c, text);
    skg_instances_free(&c.parts);
    return status;
}
