/* Refuses what COLLADA and AMF files say and Assimp passes over, or cannot bear: skews, controllers, indices, turns. */
#include "mesh/xml_unread.h"

#include "mesh/xml.h"

#include <stdlib.h>
#include <string.h>

/* Contents that an element must have to be read. */
enum contents { UNREADABLE, INDICES, ZERO };

typedef struct {
    /* the element, and the one that it lies in at any depth; NULL: wherever it lies */
    const char *tag, *inside;
    enum contents contents;
    const char *sentence;
    /* an element of the same parent whose value Assimp forgets for this one; NULL: none */
    const char *replaces;
} element;

/* Of a row of the table. */
typedef struct {
    int within;   /* how many elements of the name that it asks for are open */
    int replaced; /* the innermost has a value other than 0 that this one would replace */
} state;

#define NO_INDICES "holds what is no whole number from 0; save the file anew with the program that made it"
#define TURNED                                                                                                        \
    "of an instance would be read as its shift; apply shift and turn to the object in the program that made it, and " \
    "export again"

static const element collada[] = {
    /* Assimp ends the process */
    {"skew", "node", UNREADABLE,
     "shears a node, which is not read; apply the shear to the mesh in the program that made it, and export "
     "again",
     NULL},
    {"instance_controller", NULL, UNREADABLE,
     "places a skin or a morph, whose pose is not read; apply the pose to the mesh in the program that made "
     "it, and export again",
     NULL},
    /* Assimp never ends at other characters, and takes indices below 0 for 0 */
    {"p", "mesh", INDICES, NO_INDICES, NULL},
    {"vcount", "mesh", INDICES, NO_INDICES, NULL},
    {0},
};
/* ISO/ASTM 52915: degrees about the axes, which Assimp takes for the shift along them: 0, too, where a shift stands before it. */
static const element amf[] = {{"rx", "instance", ZERO, TURNED, "deltax"},
                              {"ry", "instance", ZERO, TURNED, "deltay"},
                              {"rz", "instance", ZERO, TURNED, "deltaz"},
                              {0}};
static const element none[] = {{0}};
static const element *const elements[SKG_XML_KINDS] = {collada, amf, none};

/* Whether the contents of the tag at hand can be read. */
static int is_readable(const skg_xml *xml, enum contents contents) {
    char *end;
    if (contents == UNREADABLE) return 0;
    if (xml->closes) return 1;
    if (contents == INDICES) return xml->at[strspn(xml->at, "0123456789 \t\r\n")] == '<';
    const double number = strtod(xml->at, &end);
    return number == 0 && end[strspn(end, " \t\r\n")] == '<';
}

static skg_status check_tag(const char *path, const skg_xml *xml, const element *known, state *states) {
    for (size_t k = 0; known[k].tag; k++) {
        const element *e = &known[k];
        state *now = &states[k];
        const int is_wanted = xml->opens && skg_xml_is(xml, e->tag) && (!e->inside || now->within > 0);
        if (is_wanted && (!is_readable(xml, e->contents) || now->replaced))
            return skg_fail(SKG_ERR_FORMAT, "%s: the element <%s> %s", path, e->tag, e->sentence);
        if (xml->opens && e->replaces && skg_xml_is(xml, e->replaces))
            now->replaced = !is_readable(xml, ZERO);
        if (!e->inside || !skg_xml_is(xml, e->inside)) continue;
        now->within += (xml->opens != 0) - (xml->closes != 0);
        now->replaced = 0;
    }
    return SKG_OK;
}

skg_status skg_mesh_check_xml_unread(const char *path, const char *text, enum skg_mesh_xml kind) {
    state states[sizeof collada / sizeof *collada] = {{0}}; /* the longest of the tables */
    skg_xml xml = {.at = text};
    while (skg_xml_next(&xml) > 0) SKG_TRY(check_tag(path, &xml, elements[kind], states));
    return SKG_OK;
}
