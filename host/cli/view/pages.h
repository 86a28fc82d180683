/* Pages in which the scene can be turned, and films of it. Functions that return int return an exit status and print the
 * error. */
#ifndef CLI_VIEW_PAGES_H
#define CLI_VIEW_PAGES_H

#include "view/picture.h"
#include "view/surfaces.h"

#include <jansson.h>

/* Contents of the page. */
typedef struct {
    const cli_session *session;
    const skg_look *look; /* its direction, path and colours */
    const view_places *places;
    const view_shapes *shapes;
    double seconds; /* that the frames of the shapes last */
    /* [image_frames][image_rows][image_columns] greys of the detector, image_frames 1 or that of the shapes; NULL: none */
    const uint8_t *image;
    int64_t image_columns, image_rows, image_frames;
    const cli_sensitivity *sensitivity; /* NULL: not wanted */
} view_page;

/* The scene of a page as JSON that can stand in a script, and the bytes of its surfaces in base 64. The caller frees both, also
 * after a failure. */
int view_page_texts(const view_page *page, char **scene, char **bytes);

/* The triangles of a page with so many moments. */
int64_t view_max_triangles(int64_t frames);

/* Writes the page. */
int view_page_write(const view_page *page, const char *path);

/* Pages and films of a scene, which may breathe. */

/* Writes a page of the present moment, or of w->seconds if that is given. */
int view_write_page(view_work *w, const char *path);

/* Writes the parts of the present moment, with all their triangles, as glTF 2.0 in one file: in metres, y up. */
int view_write_glb(view_work *w, const char *path);

/* Writes w->seconds at w->fps. The labels stay where they are in the first frame. */
int view_write_film(view_work *w, const char *path);

#endif
