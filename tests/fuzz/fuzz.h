/* Shared code of the fuzz targets: a folder of their own, and files in it. Each target defines
 * LLVMFuzzerTestOneInput; libFuzzer drives it (SKG_FUZZ), or replay.c over the corpus. */
#ifndef SKG_TESTS_FUZZ_H
#define SKG_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The path of `name` in a temporary folder that goes away when the process ends; valid until the next call. */
const char *fuzz_path(const char *name);

/* Writes a file there. */
const char *fuzz_write(const char *name, const void *bytes, size_t size);

/* Checks what a failing call owes its caller: a sentence. Ends the process without one. */
void fuzz_expect_sentence(int32_t status);

/* One more than the last byte, for what reads text. The caller frees it. */
char *fuzz_text(const uint8_t *data, size_t size);

#endif
