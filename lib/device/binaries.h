/* Compiled programs that are kept in the user's folder (store.h), so that a device compiles each of them once. Private
 * to lib/device. */
#ifndef SKG_BINARIES_H
#define SKG_BINARIES_H

#include "device/program_text.h"

/* The key of a program: its text, its options and the device. */
skg_digest skg_binary_key(const skg_device *device, const skg_program_text *text);

/* The program that was kept under this key, ready for use. NULL: there is none, or the driver rejects it, in which case
 * it is removed. */
cl_program skg_binary_load(skg_device *device, const skg_digest *key, const char *options);

/* Keeps a program. It should have been launched: PoCL adds the machine code of a kernel then. */
void skg_binary_save(const skg_device *device, const skg_digest *key, cl_program program);

/* The process from which on a program is kept although its driver keeps it, too. PoCL compiles all kernels a second time
 * when it is asked for programs: 0.95 s for those of an image. A process that loads them from our folder starts 0.05 s
 * earlier than with PoCL's own cache, which preprocesses the text each time. */
enum { SKG_USES_THAT_PAY = 20 };

/* Counts a process that has used a program, and says whether it should keep it. */
int skg_binary_pays(const skg_device *device, const skg_digest *key);

#endif
