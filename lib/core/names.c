/* The nearest name to one that is unknown, for messages. */
#include "core/text.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

int skg_same_name(const char *a, const char *b) {
    while (*a && *b && tolower((unsigned char)*a) == tolower((unsigned char)*b)) a++, b++;
    return *a == '\0' && *b == '\0';
}

/* Longer names are not compared; every name that the library knows is shorter. */
enum { LONGEST = 64 };

/* Damerau-Levenshtein distance (optimal string alignment). */
static int distance(const char *a, const char *b) {
    int rows[3][LONGEST + 1];
    size_t na = strlen(a), nb = strlen(b);
    if (na > LONGEST || nb > LONGEST) return LONGEST;
    for (size_t j = 0; j <= nb; j++) rows[0][j] = (int)j;
    for (size_t i = 1; i <= na; i++) {
        int *before = rows[(i + 2) % 3], *last = rows[(i - 1) % 3], *here = rows[i % 3];
        here[0] = (int)i;
        for (size_t j = 1; j <= nb; j++) {
            int ca = tolower((unsigned char)a[i - 1]), cb = tolower((unsigned char)b[j - 1]);
            int best = last[j - 1] + (ca != cb);
            if (last[j] + 1 < best) best = last[j] + 1;
            if (here[j - 1] + 1 < best) best = here[j - 1] + 1;
            if (i > 1 && j > 1 && ca == tolower((unsigned char)b[j - 2]) &&
                cb == tolower((unsigned char)a[i - 2]) && before[j - 2] + 1 < best)
                best = before[j - 2] + 1;
            here[j] = best;
        }
    }
    return rows[na % 3][nb];
}

const char *skg_nearest_name(const char *name, const char *const *names, int64_t count) {
    /* Typing errors: one in up to three letters. */
    const int length = (int)strlen(name);
    const char *nearest = NULL;
    int best = length <= 3 ? 2 : length / 3 + 2;
    for (int64_t i = 0; i < count; i++) {
        int d = distance(name, names[i]);
        if (d < best) best = d, nearest = names[i];
    }
    return nearest;
}

const char *skg_plural(int64_t count, const char *one, const char *many) {
    return count == 1 ? one : many;
}
