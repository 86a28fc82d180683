/* Refuses what COLLADA files say and Assimp passes over, or cannot bear: skews, controllers, indices. */
#include "mesh/xml_unread.h"

#include "mesh/xml.h"

#include <string.h>

/* What the contents of an element must be to be read. */
enum contents { UNREADABLE, INDICES };

typedef struct {
    const char *tag,
        *inside; /* the element, and the one that it lies in at any depth; NULL: wherever it lies */
    enum contents contents;
    const char *sentence;
} element;

#define NO_INDICES "holds what is no whole number from 0; save the file anew with the program that made it"
static const element collada[] = {
    /* Assimp ends the process */
    {"skew", "node", UNREADABLE,
     "shears a node, which is not read; apply the shear to the mesh in the program that made it, and export "
     "again"},
    {"instance_controller", NULL, UNREADABLE,
     "places a skin or a morph, whose pose is not read; apply the pose to the mesh in the program that made "
     "it, and export again"},
    /* Assimp never ends at other characters, and takes indices below 0 for 0 */
    {"p", "mesh", INDICES, NO_INDICES},
    {"vcount", "mesh", INDICES, NO_INDICES},
    {0},
};
static const element none[] = {{0}};
static const element *const elements[SKG_XML_KINDS] = {collada, none, none};

/* Whether the contents of the tag at hand can be read. */
static int is_readable(const skg_xml *xml, enum contents contents) {
    if (contents == UNREADABLE) return 0;
    if (xml->closes) return 1;
    return xml->at[strspn(xml->at, "0123456789 \t\r\n")] == '<';
}

/* within: how many elements of the name that row k asks for are open */
static skg_status check_tag(const char *path, const skg_xml *xml, const element *known, int *within) {
    for (size_t k = 0; known[k].tag; k++) {
        const element *e = &known[k];
        const int is_wanted = xml->opens && skg_xml_is(xml, e->tag) && (!e->inside || within[k] > 0);
        if (is_wanted && !is_readable(xml, e->contents))
            return skg_fail(SKG_ERR_FORMAT, "%s: the element <%s> %s", path, e->tag, e->sentence);
        if (e->inside && skg_xml_is(xml, e->inside)) within[k] += (xml->opens != 0) - (xml->closes != 0);
    }
    return SKG_OK;
}

skg_status skg_mesh_check_xml_unread(const char *path, const char *text, enum skg_mesh_xml kind) {
    int within[sizeof collada / sizeof *collada] = {0}; /* the longest of the tables */
    skg_xml xml = {.at = text};
    while (skg_xml_next(&xml) > 0) SKG_TRY(check_tag(path, &xml, elements[kind], within));
    return SKG_OK;
}
