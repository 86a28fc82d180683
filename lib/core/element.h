/* Sizes of the elements of images. Private. */
#ifndef SKG_ELEMENT_H
#define SKG_ELEMENT_H

#include <skiagraph/types.h>

/* Bytes of an element of enum skg_type. */
static inline int64_t skg_element_bytes(int32_t type) {
    return type == SKG_TYPE_FLOAT64 ? 8 : type == SKG_TYPE_UINT16 ? 2 : 4;
}

#endif
