/* The spectrum of a tube behind layers, and its quality. */
#ifndef SKG_TESTS_TUBE_H
#define SKG_TESTS_TUBE_H

#include "support/named.h"

#include <skiagraph/beam.h>

enum { LAYERS_MAX = 8 };

/* A layer of a filter; a list of layers ends with material NULL. */
typedef struct {
    const char *material;
    double mm;
} layer;

static inline skg_spectrum *tube_of(int32_t anode, int32_t model, double kvp, double angle,
                                    const layer *layers) {
    skg_tube t;
    skg_filter filters[LAYERS_MAX];
    skg_material *materials[LAYERS_MAX];
    skg_spectrum *spectrum = NULL;
    int count = 0;
    for (; layers && layers[count].material; count++) {
        materials[count] = named(layers[count].material);
        skg_filter_init(&filters[count]);
        filters[count].material = materials[count];
        filters[count].thickness_mm = layers[count].mm;
    }
    skg_tube_init(&t);
    t.model = model;
    t.anode = anode;
    t.kvp = kvp;
    t.angle_deg = angle;
    t.filters = filters;
    t.filter_count = count;
    ck_skg(skg_spectrum_create_tube(&t, &spectrum));
    while (count > 0) skg_material_release(&materials[--count]);
    return spectrum;
}

static inline skg_spectrum *tube(int32_t model, double kvp, double angle, const layer *layers) {
    return tube_of(74, model, kvp, angle, layers);
}

static inline skg_quality quality_of(int32_t anode, int32_t model, double kvp, double angle,
                                     const layer *layers) {
    skg_quality q;
    skg_quality_init(&q);
    skg_spectrum *spectrum = tube_of(anode, model, kvp, angle, layers);
    ck_skg(skg_spectrum_quality_get(spectrum, &q));
    skg_spectrum_release(&spectrum);
    return q;
}

static inline skg_quality quality(int32_t model, double kvp, double angle, const layer *layers) {
    return quality_of(74, model, kvp, angle, layers);
}

#endif
