/* Settings (--set): each line of the input is one, applied to a good scene. */
#include "fuzz/fuzz.h"

#include <skiagraph/setup.h>

#include <stdlib.h>
#include <string.h>

static const char scene[] =
    "{\"Source\": {\"Position\": [0, -40, 0, \"cm\"], \"Shape\": \"PointSource\","
    " \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1000}]},"
    " \"Detector\": {\"Position\": [0, 10, 0, \"cm\"], \"UpVector\": [0, 0, -1],"
    " \"NumberOfPixels\": [64, 48], \"Size\": [32, 24, \"cm\"]},"
    " \"Samples\": [{\"Label\": \"skin\", \"Cube\": [80, \"mm\"], \"Material\": [\"mu\", 0.2], \"Type\": \"outer\"},"
    " {\"Label\": \"bone\", \"Cube\": [2, \"cm\"], \"Material\": [\"HU\", 500]}]}";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    enum { LIMIT = 32 };
    static int ready = 0;
    const char *lines[LIMIT];
    int64_t count = 0;
    skg_setup *setup = NULL;
    if (!ready) fuzz_write("scene.json", scene, strlen(scene));
    ready = 1;
    char *text = fuzz_text(data, size);
    for (char *line = strtok(text, "\n"); line && count < LIMIT; line = strtok(NULL, "\n"))
        lines[count++] = line;
    fuzz_expect_sentence(skg_setup_load(NULL, fuzz_path("scene.json"), count, lines, &setup));
    skg_setup_release(&setup);
    free(text);
    return 0;
}
