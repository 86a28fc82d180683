/* A material by its name. */
#ifndef SKG_TESTS_NAMED_H
#define SKG_TESTS_NAMED_H

#include "suite.h"

#include <skiagraph/material.h>

static inline skg_material *named(const char *text) {
    skg_material *material = NULL;
    ck_skg(skg_material_create_named(text, &material));
    return material;
}

#endif
