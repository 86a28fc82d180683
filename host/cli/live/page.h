/* The page: HTML with the surfaces of the scene, and what it draws of source and detector. */
#ifndef CLI_LIVE_PAGE_H
#define CLI_LIVE_PAGE_H

#include "live/scene.h"

/* The page as HTML with the scene of a wish in it, which is loaded once more, because its breath is posed. The caller frees it; NULL
 * with an error printed. */
char *live_page_make(const live_base *base, const live_wish *wish, const char *nonce);

#endif
