/* Struts. Each face of a closed sheet is held to the other through its rim only, so every vertex of the diaphragm is
 * also linked to the nearest one of the face behind it. Private. */
#ifndef SKG_STRUTS_H
#define SKG_STRUTS_H

#include "body/types.h"

/* Adds struts to the links of an organ; the caller frees *ends. */
skg_status skg_body_add_struts(const skg_body_organ *organ, int64_t *links, int32_t **ends);

#endif
