/* Refuses files in XML with elements that Assimp passes over, or cannot bear. Private. */
#ifndef SKG_MESH_XML_UNREAD_H
#define SKG_MESH_XML_UNREAD_H

#include "mesh/xml_counts.h"

/* Fails with SKG_ERR_FORMAT where a file has an element that moves vertices and is not read, or is not placed as the file says, or indices that are no whole numbers
 * from 0. text: ends in a zero */
skg_status skg_mesh_check_xml_unread(const char *path, const char *text, enum skg_mesh_xml kind);

#endif
