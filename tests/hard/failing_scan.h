/* A scan for failing_test: run, files, packed copy, reading back. */
#ifndef SKG_TESTS_FAILING_SCAN_H
#define SKG_TESTS_FAILING_SCAN_H

#include <skiagraph/skiagraph.h>

/* Makes scan.mha, scan.tif, scan.h5, packed.h5 and geometry.csv in a folder, or goes on with them. image: [row][column] the last
 * projection as the packed copy has it; left as it is without HDF5. */
skg_status failing_scan(const char *folder, skg_plan *plan, const skg_scene *scene, const skg_view *view,
                        float *image);

#endif
