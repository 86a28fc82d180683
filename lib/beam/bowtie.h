/* Bow-tie filters. Private. */
#ifndef SKG_BOWTIE_H
#define SKG_BOWTIE_H

#include "core/core.h"

#include <skiagraph/options.h>

/* Fails with SKG_ERR_SCENE unless material and profile are usable. */
skg_status skg_bowtie_check(const skg_bowtie *bowtie);

#endif
