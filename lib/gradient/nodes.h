/* Derivatives by the attenuation coefficients of parts at the energies of a plan. Private.
 *
 * The derivative by the exponent of node n of a ray, the sum over parts of mu of the part at n times the length through it, is minus the
 * derivative by the logarithm of what the node alone adds to the intensity. Times the length, and summed over rays, it is that by mu. */
#ifndef SKG_GRADIENT_NODES_H
#define SKG_GRADIENT_NODES_H

#include "gradient/work.h"

/* Makes the derivatives by the exponents of all nodes in a pass, whose sums are made: gradient->nodes. It replaces the adjoint and the
 * weights on the device. */
skg_status skg_gradient_keep_nodes(skg_job *job, const skg_pass *pass, const skg_sums *sums, double factor);

/* Adds the share of a part in a pass, from the path lengths through it. lengths: [rows of rays][columns of rays] */
skg_status skg_gradient_add_nodes(const skg_job *job, const skg_pass *pass, int64_t part,
                                  const double *lengths);

#endif
