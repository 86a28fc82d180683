/* Words and numbers as text: names, elements, labels, paths, units. Private. */
#ifndef SKG_TEXT_H
#define SKG_TEXT_H

#include "core/core.h"

#include <skiagraph/types.h>

#include <fenv.h>
#include <locale.h>
#include <stddef.h>
#include <stdint.h>

/* --- Names in messages: which name was meant, singular or plural. */

/* The entry of names[0..count) nearest to `name` by edit distance without regard to case. NULL if none is near
 * enough to be a typing error: at most one edit in up to three letters,
 * otherwise a third of the name's length plus one. */
const char *skg_nearest_name(const char *name, const char *const *names, int64_t count);

/* Equality without regard to case (ASCII). */
int skg_same_name(const char *a, const char *b);

/* The singular `one` if count is 1, otherwise the plural `many`. */
const char *skg_plural(int64_t count, const char *one, const char *many);

/* --- Sizes of the elements of images. */

/* Bytes of an element of enum skg_type. */
static inline int64_t skg_element_bytes(int32_t type) {
    return type == SKG_TYPE_FLOAT64 ? 8 : type == SKG_TYPE_UINT16 ? 2 : 4;
}

/* --- Names of files that are not finished: NAME.part-PID-TAG. *
 * The tag has four digits of the machine since its start, because two nodes that share a folder may have processes of the same
 * number, and eight that are random for each process, because one that is started again in a container often has the same number
 * as before. */

enum { SKG_PART_ENDING = 64 };

/* The ending of all unfinished files of this process; a number may follow it (skg_part_open). */
void skg_part_ending(char ending[SKG_PART_ENDING]);

/* Makes a file under a name that no other has, for reading and writing, and returns its descriptor.
 *
 * temporary   result: the name; at least strlen(path) + SKG_PART_ENDING bytes
 * failure     -1 with errno; EEXIST: `temporary` is the last of 100 names, which other files have */
int skg_part_open(const char *path, char *temporary);

/* 1: `name` is an unfinished file whose finished name ends in `end`, of whichever process. */
int skg_part_is_of(const char *name, const char *end);

/* 1: `name` is an unfinished file of a process that lived on this machine since its start, and has ended: nobody will finish it. */
int skg_part_is_left(const char *name);

/* --- Names that may be meant by the path of a file that is not there */

/* Fails with SKG_ERR_FILE, "PATH: cannot be read: REASON", and a hint where a file of almost this path exists: one with
 * / for every backslash, or one whose name is spelled in other case.
 *
 * reason   a value of errno */
skg_status skg_fail_unreadable(const char *path, int reason);

/* --- State of the caller that must not change a call's result: a decimal comma, another rounding mode, traps, flushing to zero */

typedef struct {
    fenv_t arithmetic; /* the caller's */
    locale_t numbers;  /* the caller's */
    locale_t c;
} skg_plain;

/* Default arithmetic and the C locale, for this thread only, until skg_plain_leave. */
void skg_plain_enter(skg_plain *plain);
void skg_plain_leave(skg_plain *plain);

/* At the start of a public call that computes, reads or writes numbers: plain until the function returns. */
#define SKG_PLAIN                                                                                            \
    __attribute__((cleanup(skg_plain_leave))) skg_plain skg_caller;                                          \
    skg_plain_enter(&skg_caller)

/* --- Units as scene files spell them, without regard to case. */

/* The millimetres in one unit of length ("nm", "um", "mm", "cm", "dm", "m", "in", "ft", "dam", "hm", "km" and their full names).
 * SKG_ERR_FORMAT for another word; the sentence offers the nearest name. */
skg_status skg_unit_of_length(const char *name, double *mm);

/* Writes the name of a unit of length, or "2.5 mm" where there is none. */
void skg_unit_describe(double mm, char *text, size_t size);

/* Writes what is said where a caller names another unit than a file: the caller's wins. of_file: the file's, by name. */
void skg_unit_contradict(double mm, const char *of_file, char *text, size_t size);

/* The keV in one unit of energy ("eV", "keV", "MeV" and their full names). */
skg_status skg_unit_of_energy(const char *name, double *kev);

#endif
