/* The mixtures of the tables, by name. Private. */
#ifndef SKG_MIXTURE_H
#define SKG_MIXTURE_H

#include "material/material.h"

/* Bytes of the longest name of a material with its closing zero, and the number of names that an ambiguous word is
 * answered with. */
enum { SKG_LONGEST_NAME = 256, SKG_NAME_SUGGESTIONS = 6 };

/* Copies the first of a mixture's names. */
void skg_mixture_name(const skg_mixture_row *row, char name[SKG_LONGEST_NAME]);

/* The mixture that has this name, without regard to case, blanks and punctuation; NULL if there is none. */
const skg_mixture_row *skg_find_mixture(const char *name);

/* The density of the mixture of these elements with these fractions by mass, g/cm3; 0 if there is none, or if there are
 * several of different densities. */
double skg_mixture_density(int64_t count, const skg_mass_fraction *parts);

/* Whether the text is one of the mixture's names without its hyphens: "Ti6Al4V" for "Ti-6Al-4V". Such numbers are parts by mass,
 * while those of a formula count atoms. */
int skg_lacks_hyphens(const skg_mixture_row *row, const char *text);

/* Counts the mixtures whose names hold every word of the query. *row is the last of them; list names the first
 * few. */
int skg_find_mixtures(const char *query, const skg_mixture_row **row, char *list, size_t size);

/* The name of a mixture or element that is nearest to the text; "" if none is near. */
skg_status skg_nearest_material(const char *text, char near[SKG_LONGEST_NAME]);

#endif
