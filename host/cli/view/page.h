/* The page in which the scene can be turned. */
#ifndef SKG_CLI_VIEW_PAGE_H
#define SKG_CLI_VIEW_PAGE_H

#include "view/place.h"
#include "view/shapes.h"

/* What the page shows. */
typedef struct {
    const cli_session *session;
    const skg_look *look; /* its direction, path and colours */
    const view_places *places;
    const view_shapes *shapes;
    double seconds; /* that the frames of the shapes last */
    /* [image_frames][image_rows][image_columns] greys of the detector, image_frames 1 or that of the shapes; NULL: none */
    const uint8_t *image;
    int64_t image_columns, image_rows, image_frames;
} view_page;

/* Writes the page. Returns an exit status and prints the error. */
int view_page_write(const view_page *page, const char *path);

#endif
