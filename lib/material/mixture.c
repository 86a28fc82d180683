/* The mixtures of the tables, by name. */
#include "material/mixture.h"

#include "core/text.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The tables have about 370 names of mixtures and elements. */
enum { NAMES_MAX = 1024 };

/* Fractions by mass that differ by less are one composition: they are given in tenths of a percent at best. */
static const double SAME_FRACTION = 5e-4;

/* Keeps letters and digits only, in lower case: "Bone, cortical" and "bone cortical" are one name. */
static void plain(const char *text, size_t length, char *out) {
    size_t used = 0;
    for (size_t i = 0; i < length && used + 1 < SKG_LONGEST_NAME; i++)
        if (isalnum((unsigned char)text[i])) out[used++] = (char)tolower((unsigned char)text[i]);
    out[used] = '\0';
}

/* Copies the k-th of the names that ';' separates. Returns 0 if there are fewer. */
static int name_at(const char *names, int k, char *out) {
    for (; k > 0; k--) {
        names = strchr(names, ';');
        if (!names) return 0;
        names++;
    }
    while (*names == ' ') names++;
    size_t length = strcspn(names, ";");
    if (length >= SKG_LONGEST_NAME) length = SKG_LONGEST_NAME - 1;
    memcpy(out, names, length);
    out[length] = '\0';
    return 1;
}

void skg_mixture_name(const skg_mixture_row *row, char name[SKG_LONGEST_NAME]) {
    name_at(row->names, 0, name);
}

const skg_mixture_row *skg_find_mixture(const char *name) {
    char wanted[SKG_LONGEST_NAME], one[SKG_LONGEST_NAME], own[SKG_LONGEST_NAME];
    plain(name, strlen(name), wanted);
    if (!*wanted) return NULL;
    for (int32_t i = 0; i < skg_mixture_count; i++)
        for (int k = 0; name_at(skg_mixtures[i].names, k, one); k++) {
            plain(one, strlen(one), own);
            if (strcmp(own, wanted) == 0) return &skg_mixtures[i];
        }
    return NULL;
}

/* The fraction of an element in a list; 0 if it is not there. */
static double fraction_of(int32_t z, int64_t count, const skg_mass_fraction *parts) {
    for (int64_t i = 0; i < count; i++)
        if (parts[i].z == z) return parts[i].fraction;
    return 0;
}

double skg_mixture_density(int64_t count, const skg_mass_fraction *parts) {
    double density = 0;
    for (int32_t i = 0; i < skg_mixture_count; i++) {
        const skg_mixture_row *row = &skg_mixtures[i];
        int same = row->count == count;
        for (int32_t k = 0; k < row->count && same; k++) {
            const skg_mass_fraction *part = &skg_mass_fractions[row->first + k];
            same = fabs(fraction_of(part->z, count, parts) - part->fraction) <= SAME_FRACTION;
        }
        if (!same || row->density == density) continue;
        if (density > 0) return 0;
        density = row->density;
    }
    return density;
}

int skg_lacks_hyphens(const skg_mixture_row *row, const char *text) {
    char wanted[SKG_LONGEST_NAME], one[SKG_LONGEST_NAME], own[SKG_LONGEST_NAME];
    plain(text, strlen(text), wanted);
    if (strchr(text, '-')) return 0;
    for (int k = 0; name_at(row->names, k, one); k++) {
        plain(one, strlen(one), own);
        if (strcmp(own, wanted) == 0) return strchr(one, '-') != NULL;
    }
    return 0;
}

/* Fewer letters stand for a word only if they are all of it: "Cf" is no carbon fibre, "CAS" no casting alloy. */
enum { SHORTEST_BEGINNING = 4 };

/* Whether the text begins with these letters. Hyphens in the text are skipped: "icru44" begins "ICRU-44". */
static int begins(const char *text, const char *word, size_t length) {
    const int is_short = length < SHORTEST_BEGINNING;
    for (; length > 0; text++) {
        if (*text == '-') continue;
        if (tolower((unsigned char)*text) != tolower((unsigned char)*word)) return 0;
        word++, length--;
    }
    return !is_short || !isalnum((unsigned char)*text);
}

/* Whether every word of the query is a word of the names, or begins one. */
static int has_words(const char *names, const char *query) {
    for (const char *word = query; *word;) {
        while (*word && !isalnum((unsigned char)*word)) word++;
        size_t length = 0;
        while (isalnum((unsigned char)word[length])) length++;
        if (length == 0) break;
        int found = 0;
        for (const char *c = names; *c && !found; c++) {
            int start = c == names || !isalnum((unsigned char)c[-1]);
            found = start && begins(c, word, length);
        }
        if (!found) return 0;
        word += length;
    }
    return 1;
}

int skg_find_mixtures(const char *query, const skg_mixture_row **row, char *list, size_t size) {
    int found = 0;
    size_t used = 0;
    char name[SKG_LONGEST_NAME];
    list[0] = '\0';
    for (int32_t i = 0; i < skg_mixture_count; i++) {
        if (!has_words(skg_mixtures[i].names, query)) continue;
        *row = &skg_mixtures[i];
        if (found++ < SKG_NAME_SUGGESTIONS && name_at(skg_mixtures[i].names, 0, name) && used < size) {
            int wrote = snprintf(list + used, size - used, "%s\"%s\"", found > 1 ? ", " : "", name);
            used += wrote > 0 ? (size_t)wrote : 0;
        }
    }
    return found;
}

skg_status skg_nearest_material(const char *text, char near[SKG_LONGEST_NAME]) {
    char(*names)[SKG_LONGEST_NAME] = NULL;
    const char **list = NULL;
    skg_status status = SKG_OK;
    int64_t count = 0;
    near[0] = '\0';
    SKG_TRY_CLEANUP(skg_alloc(NAMES_MAX, sizeof *names, "names", &names));
    SKG_TRY_CLEANUP(skg_alloc(NAMES_MAX, sizeof *list, "names", &list));
    for (int32_t i = 0; i < skg_mixture_count; i++)
        for (int k = 0; count < NAMES_MAX && name_at(skg_mixtures[i].names, k, names[count]); k++) count++;
    for (int32_t z = 1; z <= SKG_LAST_ELEMENT; z++)
        for (int k = 0; count < NAMES_MAX && name_at(skg_elements[z].names, k, names[count]); k++) count++;
    for (int64_t i = 0; i < count; i++) list[i] = names[i];
    const char *found = skg_nearest_name(text, list, count);
    if (found) snprintf(near, SKG_LONGEST_NAME, "%s", found);
cleanup:
    skg_free(&names);
    skg_free(&list);
    return status;
}

skg_status skg_material_tabled_count(int64_t *count) {
    SKG_NEEDS(count);
    *count = skg_mixture_count;
    return SKG_OK;
}

skg_status skg_material_tabled_get(int64_t index, const char **name, double *density) {
    SKG_NEEDS(name);
    SKG_NEEDS(density);
    if (index < 0 || index >= skg_mixture_count)
        return skg_fail(SKG_ERR_ARGUMENT, "skg_material_tabled_get: entry %" PRId64 " of %" PRId32, index,
                        skg_mixture_count);
    *name = skg_mixtures[index].names;
    *density = skg_mixtures[index].density;
    return SKG_OK;
}
