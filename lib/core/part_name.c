#include "core/text.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/auxv.h>
#include <unistd.h>

static const char mark[] = ".part-";

/* The kernel gives each program 16 random bytes when it starts, so that the library and the command, which share no
 * variables, find the same tag. They also protect the stack: only 32 bits of a hash of all of them are shown. */
static uint32_t tag(void) {
    uint64_t seed[2] = {0}, hash = (uint64_t)getpid();
    const void *random = (const void *)(uintptr_t)getauxval(AT_RANDOM);
    if (random) memcpy(seed, random, sizeof seed);
    for (int i = 0; i < 2; i++) {
        hash ^= seed[i];
        hash = (hash ^ hash >> 30) * 0xBF58476D1CE4E5B9u;
        hash = (hash ^ hash >> 27) * 0x94D049BB133111EBu;
        hash ^= hash >> 31;
    }
    return (uint32_t)(hash >> 32);
}

void skg_part_ending(char ending[SKG_PART_ENDING]) {
    snprintf(ending, SKG_PART_ENDING, "%s%ld-%08" PRIx32, mark, (long)getpid(), tag());
}

int skg_part_open(const char *path, char *temporary) {
    enum { TRIES = 100 };
    const size_t size = strlen(path) + SKG_PART_ENDING;
    char ending[SKG_PART_ENDING], number[16] = "";
    skg_part_ending(ending);
    for (int n = 1; n <= TRIES; n++) {
        snprintf(temporary, size, "%s%s%s", path, ending, number);
        const int descriptor = open(temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0 || errno != EEXIST) return descriptor;
        snprintf(number, sizeof number, "-%d", n);
    }
    return -1;
}

int skg_part_is_of(const char *name, const char *end) {
    const size_t length = strlen(end);
    const char *at = name, *last = NULL;
    while ((at = strstr(at, mark))) last = at++;
    return last && (size_t)(last - name) >= length && memcmp(last - length, end, length) == 0 &&
           last[sizeof mark - 1] &&
           strspn(last + sizeof mark - 1, "0123456789abcdef-") == strlen(last + sizeof mark - 1);
}
