/* Words of messages: the name that was meant, one or many. Private. */
#ifndef SKG_NAMES_H
#define SKG_NAMES_H

#include <stdint.h>

/* The entry of names[0..count) nearest to `name` by edit distance without regard to case; NULL when none is
 * near enough to be a slip of the finger. */
const char *skg_nearest_name(const char *name, const char *const *names, int64_t count);

/* Equality without regard to case (ASCII). */
int skg_same_name(const char *a, const char *b);

/* The words that go with a number: `one` with 1, `many` with any other. */
const char *skg_plural(int64_t count, const char *one, const char *many);

#endif
