/* The scene whose costs are studied, and the page that shows them. */
#ifndef SKG_TESTS_COST_SCENE_H
#define SKG_TESTS_COST_SCENE_H

#include "cli/browser.h"

/* A tube, a box and a sphere in it: every dial but the source's. */
static const char small_scene[] =
    "{ \"Source\": { \"Position\": [0, -400, 0, \"mm\"], \"Shape\": \"PointSource\",\n"
    "    \"Beam\": {\"kVp\": 80, \"Filter\": [[\"Al\", 3, \"mm\"]]} },\n"
    "  \"Detector\": { \"Position\": [0, 100, 0, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "    \"NumberOfPixels\": [33, 25], \"Spacing\": [1, 2, \"mm\"] },\n"
    "  \"Samples\": [\n"
    "    {\"Label\": \"skin\", \"Cube\": [30.5, \"mm\"], \"Type\": \"outer\", \"Material\": [\"HU\", 20]},\n"
    "    {\"Label\": \"bone\", \"Sphere\": [16, 7, \"mm\"], \"Material\": [\"HU\", 900]} ] }\n";

static const char disc[] = "--set 'Source.Shape=[\"Disc\",2,\"mm\"]'";

static inline void set_up_scene(void) {
    set_up();
    write_text("small scene.json", small_scene);
}

#endif
