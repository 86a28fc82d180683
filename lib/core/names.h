/* Names in messages: which name was meant, singular or plural. Private. */
#ifndef SKG_NAMES_H
#define SKG_NAMES_H

#include <stdint.h>

/* The entry of names[0..count) nearest to `name` by edit distance without regard to case. NULL if none is near
 * enough to be a typing error: at most a third of the name's length plus one edit. */
const char *skg_nearest_name(const char *name, const char *const *names, int64_t count);

/* Equality without regard to case (ASCII). */
int skg_same_name(const char *a, const char *b);

/* The singular `one` if count is 1, otherwise the plural `many`. */
const char *skg_plural(int64_t count, const char *one, const char *many);

#endif
