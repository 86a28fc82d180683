/* What a file says of its own contents, counted before Assimp opens it: Assimp takes memory for every length that a file
 * announces, and follows parts that contain themselves until the stack ends. Private. */
#ifndef SKG_MESH_COUNTS_H
#define SKG_MESH_COUNTS_H

#include "mesh/instances.h"

#include <stdio.h>

/* Fails with SKG_ERR_FORMAT where a file of glTF 1 and 2 (also binary), COLLADA, AMF or X3D places its parts in circles, more
 * than SKG_INSTANCES_MAX times or too deep, announces lengths that its bytes do not have, or would take too much memory. Files
 * of other kinds pass. */
skg_status skg_mesh_check_counts(const char *path, FILE *stream, int64_t size);

/* The same of the text of a file, which ends in a zero.
 *
 * binary   bytes of the chunk of a .glb file that belongs to its first buffer; -1: none */
skg_status skg_mesh_count_gltf(const char *path, int64_t size, const char *text, size_t length,
                               int64_t binary);

enum skg_mesh_xml { SKG_XML_COLLADA, SKG_XML_AMF, SKG_XML_X3D, SKG_XML_KINDS };

skg_status skg_mesh_count_xml(const char *path, int64_t size, const char *text, enum skg_mesh_xml kind);

skg_status skg_mesh_check_collada_lengths(const char *path, const char *text);

#endif
