/* Scenes of several parts against the ray caster: the source on faces, and the bound of the precision. */
#ifndef BENCH_HARD_SEVERAL_H
#define BENCH_HARD_SEVERAL_H

#include <skiagraph/skiagraph.h>

/* `count` scenes from number `first` on, in single and double precision; each that is out of its bar is printed with its
 * number. Returns how many are. */
int64_t hard_faces(skg_context *context, int64_t first, int64_t count);
int64_t hard_drawn(skg_context *context, int64_t first, int64_t count);

#endif
