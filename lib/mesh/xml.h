/* Tags of XML documents, one after the other: what mesh files in XML need. Private. */
#ifndef SKG_MESH_XML_H
#define SKG_MESH_XML_H

#include <stddef.h>

/* Prepare with {text}, which ends in a zero. */
typedef struct {
    const char *at; /* where it goes on */
    /* the last tag */
    const char *name; /* without its prefix */
    size_t name_length;
    const char *attributes; /* up to `at` */
    int opens, closes;      /* <a>: opens; </a>: closes; <a/>: both */
} skg_xml;

/* Goes to the next tag; comments, declarations and text are skipped. Returns 1; 0 at the end; -1 where the text is damaged. */
int skg_xml_next(skg_xml *xml);

/* Whether the last tag has this name, without its prefix. */
int skg_xml_is(const skg_xml *xml, const char *name);

/* Copies an attribute of the last tag, by its name without prefix, with the five entities of XML replaced. Returns 1; 0: there is
 * none; -1: it is damaged or longer than size - 1. */
int skg_xml_attribute(const skg_xml *xml, const char *name, char *value, size_t size);

#endif
