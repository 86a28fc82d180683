/* Files that a wish may name. */
#ifndef CLI_LIVE_PATHS_H
#define CLI_LIVE_PATHS_H

#include "live/wish.h"

/* Whether every text of the settings of a wish that could be a path stays in the folder of the scene. What a page asks for is
 * answered with sentences that may show the start of a file, so it reads no others. sentence: why not */
int live_paths_check(const char *scene, const live_wish *wish, char sentence[LIVE_SENTENCE]);

#endif
