/* A scene of which every sum is a known integer. Private.
 *
 * Under a parallel beam along z, with pixels of 1 mm and a path of 1024 mm, the faces of these boxes have depths whose
 * numerators are small and whose denominators are powers of two. So are their gradients, since their sides are. No step of
 * the kernels rounds, and every path length is exact: one bit that is wrong is found. */
#ifndef SKG_EXACT_H
#define SKG_EXACT_H

#include "selftest/judge.h"

/* Compares the path lengths of each strategy, in single precision. The status is that of the calls. */
skg_status skg_exact_judge(skg_context *context, skg_finding *finding);

#endif
