/* How Assimp opens files: by our opener, also those that a file refers to. Private. */
#ifndef SKG_MESH_ASSIMP_FILES_H
#define SKG_MESH_ASSIMP_FILES_H

#include <assimp/cfileio.h>

/* Prepares the functions for aiImportFileEx. */
void skg_assimp_files(struct aiFileIO *files);

#endif
