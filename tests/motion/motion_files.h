/* A set-up in a folder of its own, and what moves in it. */
#ifndef SKG_TESTS_MOTION_FILES_H
#define SKG_TESTS_MOTION_FILES_H

#include "setup/types.h"
#include "suite.h"

#include <skiagraph/motion.h>

#include <string.h>
#include <unistd.h>

static char folder[64], path[128];
static skg_setup *setup;
static skg_motion *motion;

static const char heading[] =
    "{\"Source\": {\"Position\": [0, -860, -20, \"mm\"], \"Shape\": \"PointSource\",\n"
    "  \"Beam\": [{\"Energy\": 60, \"Unit\": \"keV\", \"PhotonCount\": 1}]},\n"
    " \"Detector\": {\"Position\": [0, 140, -20, \"mm\"], \"UpVector\": [0, 0, -1],\n"
    "  \"NumberOfPixels\": [16, 16], \"Size\": [480, 480, \"mm\"]},\n \"Samples\": [\n";

static inline void set_up(void) {
    strcpy(folder, "/tmp/skg-motion-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/scene.json", folder);
}

static inline void close_setup(void) {
    skg_motion_release(&motion);
    skg_setup_release(&setup);
}

static inline void tear_down(void) {
    close_setup();
    unlink(path);
    ck_assert_int_eq(rmdir(folder), 0);
}

/* Height of the part's lowest vertex, mm. */
static inline double height_of(const char *label) {
    int64_t part = 0;
    skg_part found;
    skg_mesh_health health;
    skg_part_init(&found);
    skg_mesh_health_init(&health);
    ck_skg(skg_scene_part_find(setup->scene, label, &part));
    ck_skg(skg_scene_part_get(setup->scene, part, &found));
    ck_skg(skg_mesh_health_get(found.mesh, &health));
    return health.bounds[2];
}

#endif
