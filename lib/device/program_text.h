/* What a program is compiled from. Private to lib/device. */
#ifndef SKG_PROGRAM_TEXT_H
#define SKG_PROGRAM_TEXT_H

#include "device/device.h"

enum { SKG_PROGRAM_FILES = 17, SKG_PROGRAM_OPTIONS = 2048 };

/* Kernel files in their order, from the folder for kernels or built in. */
typedef struct {
    int32_t files, reserved;
    const char *const *names;
    const char *texts[SKG_PROGRAM_FILES];
    char *read[SKG_PROGRAM_FILES];                    /* texts that were read; NULL: built in */
    char digests[SKG_PROGRAM_FILES][SKG_DIGEST_TEXT]; /* of the texts */
    char options[SKG_PROGRAM_OPTIONS];                /* for the compiler */
} skg_program_text;

/* Finds the text. what: for messages. Release it after a failure, too. It keeps the address of the names. */
skg_status skg_program_text_find(const skg_device *device, int32_t files, const char *const *names,
                                 const char *options, const char *what, skg_program_text *text);
void skg_program_text_release(skg_program_text *text);

/* Creates the program of a text, to be built. */
skg_status skg_program_text_create(const skg_device *device, const skg_program_text *text,
                                   cl_program *program);

#endif
