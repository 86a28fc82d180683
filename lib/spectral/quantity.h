/* The kind of quantity that the images of a plan hold. Private. */
#ifndef SKG_QUANTITY_H
#define SKG_QUANTITY_H

#include <skiagraph/plan.h>

/* Whether values have to be keV or photons in a pixel until noise has been added. */
int skg_quantity_is_absolute(const skg_plan_options *options);

/* Whether photons count alike, whatever their energy: where they are counted, and in ratios of bands unless these are
 * weighted by energy. */
int skg_quantity_counts(const skg_plan_options *options);

/* Whether the quantity is a ratio to the flat field. */
int skg_quantity_is_ratio(const skg_plan_options *options);

#endif
