/* Health of a mesh that tests ask for. */
#ifndef SKG_TESTS_MESH_HEALTH_H
#define SKG_TESTS_MESH_HEALTH_H

#include "suite.h"

#include <skiagraph/mesh.h>

static inline skg_mesh_health health_of(const skg_mesh *mesh) {
    skg_mesh_health health;
    skg_mesh_health_init(&health);
    ck_skg(skg_mesh_health_get(mesh, &health));
    return health;
}

#endif
