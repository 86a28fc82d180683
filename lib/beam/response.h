/* Representation of a response: a table, or a layer that absorbs. Private. */
#ifndef SKG_RESPONSE_H
#define SKG_RESPONSE_H

#include "beam/deposition.h"

#include <skiagraph/beam.h>

struct skg_response {
    skg_refs refs;
    int64_t count;   /* rows of a table; 0: the response is a layer that absorbs */
    int32_t meaning; /* of a table: SKG_RESPONSE_MEANING_... */
    int32_t reserved;
    double *energy_kev, *recorded_kev, *efficiency, *swank;
    skg_material *material;     /* retained */
    double mm;                  /* thickness at the full density of the material */
    skg_escape *escape;         /* of the layer; NULL: no fluorescence leaves it */
    skg_deposition *deposition; /* of the layer; NULL: every interaction leaves all energy but fluorescence */
    skg_response *base;         /* retained: what records, whose DQE is `efficiency`; NULL: none */
};

#endif
