/* Functions that the readers of a scene file's sections share. Private. */
#ifndef SKG_READER_H
#define SKG_READER_H

#include "core/log.h"
#include "scene/scene.h"
#include "setup/types.h"
#include "json/json.h"

typedef struct {
    skg_context *context;
    skg_logger log; /* the context's, or the source's */
    skg_json_file file;
    char *folder; /* of the scene file, with its last slash; "" for the current folder */
    skg_setup *setup;
    skg_setup_source source; /* of this library's size; its text and path are in `file` */
    int32_t has_side; /* 1: the source stands on a side of the parts, and is placed with the detector */
    double side[3];   /* from the middle to the source, of length 1 */
    /* 1: columns grow to the right as seen from the detector, not from the source */
    int32_t seen_from_detector;
    /* from the source to the middle, and to the detector; 0: chosen by the parts */
    double source_mm, detector_mm;
    int32_t has_isocentre; /* 1: the middle is isocentre; 0: the centre of the parts' bounds */
    double isocentre[3];
    int32_t noted_beyond_table; /* 1: it was said that Schneider's table ends below a Hounsfield number */
} skg_setup_reader;

/* A path relative to the scene file's folder; the caller frees it. */
skg_status skg_setup_resolve(const skg_setup_reader *reader, const char *path, char **resolved);

/* The path of a file that the scene names; the caller frees it. */
skg_status skg_setup_where(const skg_setup_reader *reader, const char *name, char **path);

/* The path of a file that the scene names, and that is read now: where the source of the set-up says, otherwise as
 * above. It is kept in the list of files, and belongs to it. */
skg_status skg_setup_find_file(skg_setup_reader *reader, const char *name, const char **path);

/* Frees the list of files. */
void skg_setup_files_free(skg_setup *setup);

/* The number of the sample with this label. node: where the label stands, for the message. */
skg_status skg_setup_find_part(const skg_setup_reader *reader, const skg_json_node *node, const char *label,
                               int64_t *part);

#endif
