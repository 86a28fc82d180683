/* ZIP archives of a few texts that are stored, not compressed, written without the library. */
#include "support/archive.h"

#include <string.h>

void put(archive *a, uint64_t value, int count) {
    for (int b = 0; b < count; b++) a->bytes[a->size++] = (unsigned char)(value >> 8 * b);
}

static uint32_t crc_of(const char *text) {
    uint32_t crc = UINT32_MAX;
    for (; *text; text++) {
        crc ^= (unsigned char)*text;
        for (int b = 0; b < 8; b++) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0);
    }
    return ~crc;
}

static void put_entry(archive *a, const char *name, const char *text, size_t at, int is_directory) {
    put(a, is_directory ? 0x02014b50 : 0x04034b50, 4);
    if (is_directory) put(a, 20, 2);
    put(a, 20, 2), put(a, 0, 8);
    put(a, crc_of(text), 4), put(a, strlen(text), 4), put(a, strlen(text), 4);
    put(a, strlen(name), 2), put(a, 0, 2);
    if (is_directory) put(a, 0, 10), put(a, at, 4);
    memcpy(a->bytes + a->size, name, strlen(name));
    a->size += strlen(name);
    if (is_directory) return;
    memcpy(a->bytes + a->size, text, strlen(text));
    a->size += strlen(text);
}

void make_archive_of(archive *a, int count, const char *const *names, const char *const *texts) {
    size_t at[FILES_MAX];
    a->size = 0;
    for (int f = 0; f < count; f++) at[f] = a->size, put_entry(a, names[f], texts[f], 0, 0);
    a->directory = a->size;
    for (int f = 0; f < count; f++) put_entry(a, names[f], texts[f], at[f], 1);
    const size_t length = a->size - a->directory;
    put(a, 0x06054b50, 4), put(a, 0, 4), put(a, (uint64_t)count, 2), put(a, (uint64_t)count, 2);
    put(a, length, 4), put(a, a->directory, 4), put(a, 0, 2);
}
