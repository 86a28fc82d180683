/* Texts by a grammar: each byte of the input of a fuzz target chooses an alternative. */
#ifndef SKG_TESTS_EXPAND_H
#define SKG_TESTS_EXPAND_H

#include <stddef.h>
#include <stdint.h>

enum { ALTERNATIVES_MAX = 24, EXPANDED_MAX = 1 << 16 };

/* <name> in an alternative stands for one of the alternatives of that rule; a name that no rule has is text. The first one ends
 * every recursion. */
typedef struct {
    const char *name, *alternatives[ALTERNATIVES_MAX];
} rule;

/* Writes the first rule without a zero at the end, and returns the length. */
size_t fuzz_expand(const rule *rules, size_t count, const uint8_t *data, size_t size,
                   char text[EXPANDED_MAX]);

#endif
