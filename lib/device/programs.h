/* Programs: the sources of the kernels, what a program is compiled from, and compiled programs in the user's folder. Private to
 * lib/device; the table of the sources is made by kernels/CMakeLists.txt. */
#ifndef SKG_PROGRAMS_H
#define SKG_PROGRAMS_H

#include "device/device.h"

/* --- the sources of the kernels, built in --- */

typedef struct {
    const char *name;   /* "draw.clh" */
    const char *folder; /* "raster": of kernels/ */
    const char *text;
    const char *digest; /* SHA-256 of the text, in hexadecimal */
} skg_kernel_source;

extern const skg_kernel_source skg_kernel_sources[];
extern const int skg_kernel_source_count;
extern const char skg_kernel_sources_digest[]; /* SHA-256 of names and contents, in hexadecimal */

/* --- what a program is compiled from (program_text.c) --- */

enum { SKG_PROGRAM_FILES = 24, SKG_PROGRAM_OPTIONS = 2048 };

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

/* --- compiled programs in the user's folder, so that a device compiles each of them once (binaries.c) --- */

/* The key of a program: its text, its options and the device. */
skg_digest skg_binary_key(const skg_device *device, const skg_program_text *text);

/* The cached program of a key, ready for use. NULL: there is none, or the driver rejects it, in which case it is removed. */
cl_program skg_binary_load(skg_device *device, const skg_digest *key, const char *options);

/* Caches a program. It should have been launched: PoCL adds the machine code of a kernel then. */
void skg_binary_save(const skg_device *device, const skg_digest *key, cl_program program);

/* Number of processes that use a program before it is cached, if its driver caches it too. PoCL compiles all kernels a second
 * time when it is asked for the binary: 0.95 s for an image. A process that loads the binary from our cache starts 0.05 s earlier
 * than with PoCL's own cache, which preprocesses the text each time. */
enum { SKG_USES_THAT_PAY = 20 };

/* Counts a process that has used a program. 1: it should cache the program. */
int skg_binary_pays(const skg_device *device, const skg_digest *key);

/* --- the programs of a context (program.c) --- */

/* Frees the programs of a context. OpenCL is called only if `ours`: not in a child process after a fork. */
void skg_programs_release(skg_device *device, int ours);

#endif
