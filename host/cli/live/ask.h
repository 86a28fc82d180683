/* What pages ask for besides images: values under the cursor, files, what accuracy costs. */
#ifndef CLI_LIVE_ASK_H
#define CLI_LIVE_ASK_H

#include "live/hub.h"
#include "live/scene.h"

/* {"probed": [column, row], "parts": [[label, mm], ...]}: the lengths of the ray to a pixel within each part that it meets. The
 * image's pixels are those of the whole detector. Returns NULL with a sentence. */
json_t *live_probe(const live_base *base, const live_scene *scene, const live_wish *wish, const double at[2],
                   char *sentence);

/* Makes the image of a wish as `skiagraph image` does, and a file of it for live_hub_give: "SKLB", 4 bytes with the length of a name,
 * the name, and the bytes of the file. The caller frees it. Returns 0 with a sentence. */
int live_take(const live_base *base, const live_wish *wish, const char *format, unsigned char **bytes,
              size_t *size, char *sentence);

/* Measures what each dial costs and changes, and tells the pages each result. Ends when something else is asked for. */
void live_measure(const live_base *base, const live_scene *scene, const live_wish *wish, live_hub *hub);

/* Reconstructs a slice of the scene as a wish has it, and tells pages how far that is and what came out. Ends when a newer wish or another
 * slice is asked for. */
void live_reconstruct(const live_base *base, const live_wish *wish, const live_switches *switches,
                      live_hub *hub);

#endif
