/* Scene files for tests: a good one, and edits of it, in a folder of their own. */
#ifndef SKG_TESTS_SETUP_FILES_H
#define SKG_TESTS_SETUP_FILES_H

#include "setup/types.h"
#include "suite.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static char folder[64], path[128];
static skg_setup *setup;

static inline void write_file(const char *name, const char *text) {
    char full[128];
    snprintf(full, sizeof full, "%s/%s", folder, name);
    FILE *stream = fopen(full, "wb");
    ck_assert_ptr_nonnull(stream);
    ck_assert_uint_eq(fwrite(text, 1, strlen(text), stream), strlen(text));
    ck_assert_int_eq(fclose(stream), 0);
}

static inline void set_up(void) {
    strcpy(folder, "/tmp/skg-setup-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.json", folder);
    setup = NULL;
}

static inline void tear_down(void) {
    static const char *const names[] = {"scene.json", "box.stl", "open.obj", "motion.csv", "form.txt"};
    skg_setup_release(&setup);
    for (int i = 0; i < 5; i++) {
        char full[128];
        snprintf(full, sizeof full, "%s/%s", folder, names[i]);
        unlink(full);
    }
    ck_assert_int_eq(rmdir(folder), 0);
}

/* A set-up as gVXR's users write it; line 1 is the opening brace. */
static const char good[] =
    "{\n"
    "    \"Window size\": [800, 450],\n"
    "    \"Source\": {\n"
    "        \"Position\": [0, -40, 0, \"cm\"],\n"
    "        \"Shape\": \"PointSource\",\n"
    "        \"Beam\": [{\"Energy\": 0.06, \"Unit\": \"MeV\", \"PhotonCount\": 1000}]\n"
    "    },\n"
    "    \"Detector\": {\n"
    "        \"Position\": [0, 100, 0, \"mm\"],\n"
    "        \"UpVector\": [0, 0, -1],\n"
    "        \"NumberOfPixels\": [64, 48],\n"
    "        \"Size\": [6.4, 9.6, \"cm\"]\n"
    "    },\n"
    "    \"Samples\": [\n"
    "        {\n"
    "            \"Label\": \"skin\", \"Cube\": [40, \"mm\"], \"Type\": \"outer\",\n"
    "            \"Material\": [\"mu\", 0.2], \"Opacity\": 0.4\n"
    "        },\n"
    "        {\n"
    "            \"Label\": \"bone\",\n"
    "            \"Cuboid\": [1, 2, 3, \"cm\"],\n"
    "            \"Material\": [\"mu\", 0.5]\n"
    "        }\n"
    "    ]\n"
    "}\n";

/* good with one piece of its text replaced by another. */
static inline void write_edited(const char *from, const char *to) {
    const char *at = strstr(good, from);
    ck_assert_msg(at != NULL, "\"%s\" is not in the good file", from);
    char text[4096];
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, to, at + strlen(from));
    write_file("scene.json", text);
}

static inline skg_status load(void) {
    skg_setup_release(&setup);
    return skg_setup_load(NULL, path, 0, NULL, &setup);
}

#endif
