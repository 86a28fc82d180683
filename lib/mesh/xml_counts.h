/* Checks the placements in the text of a file in XML. Private. */
#ifndef SKG_MESH_XML_COUNTS_H
#define SKG_MESH_XML_COUNTS_H

#include "core/core.h"

enum skg_mesh_xml { SKG_XML_COLLADA, SKG_XML_AMF, SKG_XML_X3D, SKG_XML_KINDS };

/* Fails as skg_mesh_check_counts does. text: ends in a zero */
skg_status skg_mesh_count_xml(const char *path, int64_t size, const char *text, enum skg_mesh_xml kind);

#endif
