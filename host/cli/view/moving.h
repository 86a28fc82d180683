/* Pages and films of a scene, which may breathe. Functions that return int return an exit status and print the error. */
#ifndef SKG_CLI_VIEW_MOVING_H
#define SKG_CLI_VIEW_MOVING_H

#include "view/work.h"

/* Writes a page of the present moment, or of w->seconds if that is given. */
int view_write_page(view_work *w, const char *path);

/* Writes w->seconds at w->fps. The labels stay where they are in the first frame. */
int view_write_film(view_work *w, const char *path);

#endif
