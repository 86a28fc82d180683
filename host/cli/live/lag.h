/* The lag of the scene's detector (GreyValues.Lag) in the frames of a page. */
#ifndef CLI_LIVE_LAG_H
#define CLI_LIVE_LAG_H

#include "live/scene.h"

enum { LIVE_LAG_TERMS = 8 };

/* Signal that the detector holds from the frames before. It outlives views, poses and settings that leave detector and quantity as they are. All zero:
 * none. */
typedef struct {
    skg_lag *lag; /* NULL: at rest, or the detector has none */
    int64_t values, count;
    int32_t quantity;
    int is_settled;                   /* 1: the last frame shows what the next one would */
    double terms[2 * LIVE_LAG_TERMS]; /* [count][2] */
} live_lag;

/* Lets a whole image show what the detector holds. A detector with other pixels, terms or quantity begins at rest. Returns 0 with a
 * sentence. */
int live_lag_show(live_lag *lag, const live_scene *scene, const skg_live_frame *frame, char *sentence);

/* Whether further frames of the same view would be others. */
int live_lag_changes(const live_lag *lag);
void live_lag_free(live_lag *lag);

#endif
