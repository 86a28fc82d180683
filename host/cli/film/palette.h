/* The 256 colours that come nearest to those of a film. */
#ifndef SKG_CLI_FILM_PALETTE_H
#define SKG_CLI_FILM_PALETTE_H

#include <stddef.h>
#include <stdint.h>

enum { PALETTE_COLOURS = 256 };

typedef struct palette palette;

/* NULL if memory is exhausted. The caller frees it by palette_free, which may be given NULL. */
palette *palette_create(void);
void palette_free(palette *p);

/* Counts the colours of pixels of 4 bytes: red, green, blue and one that is ignored. */
void palette_count(palette *p, const unsigned char *pixels, int64_t count);

/* Chooses the colours, when all pixels are counted: those of the film if they are at most 256, otherwise boxes of colours
 * that are split where they vary most (X. Wu, in Graphics Gems II, 1991, p. 126), moved to the means of what they stand for
 * (S. P. Lloyd, IEEE Transactions on Information Theory 28 (1982) 129). Returns 0 if memory is exhausted.
 *
 * colours   out: red, green and blue of each; those that are not used are black */
int palette_choose(palette *p, unsigned char colours[PALETTE_COLOURS][3]);

/* The number of the colour that stands for a pixel that was counted. */
unsigned char palette_index(const palette *p, const unsigned char *pixel);

#endif
