/* A scene of two boxes in a parallel beam along y, for tests of the command; edits of it by --set. */
#ifndef SKG_TESTS_CLI_SCENE_H
#define SKG_TESTS_CLI_SCENE_H

static const char scene[] =
    "{ \"Source\": { \"Position\": [0, -400, 0, \"mm\"], \"Shape\": \"ParallelBeam\",\n"
    "    \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}] },\n"
    "  \"Detector\": { \"Position\": [0, 100, 0, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "    \"NumberOfPixels\": [65, 49], \"Spacing\": [1, 2, \"mm\"] },\n"
    "  \"Samples\": [\n"
    "    {\"Label\": \"skin\", \"Cube\": [40.5, \"mm\"], \"Type\": \"outer\", \"Material\": [\"mu\", 0.2]},\n"
    "    {\"Label\": \"bone\", \"Cuboid\": [10.5, 20, 30.5, \"mm\"], \"Material\": [\"mu\", 0.5]} ] }\n";

#endif
