/* Names of files that are not finished, and whether the process that makes one still lives. */
#include "core/text.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <unistd.h>

static const char mark[] = ".part-";

static uint64_t mix(uint64_t hash, uint64_t word) {
    hash ^= word;
    hash = (hash ^ hash >> 30) * 0xBF58476D1CE4E5B9u;
    hash = (hash ^ hash >> 27) * 0x94D049BB133111EBu;
    return hash ^ hash >> 31;
}

/* Number of this start of this machine and this name space of processes, without which the number of a process is ambiguous. 0: not
 * known. */
static uint32_t machine(void) {
    char boot[40] = "";
    struct stat space;
    const int file = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
    const ssize_t count = file < 0 ? -1 : read(file, boot, sizeof boot);
    uint64_t hash = 0;
    if (file >= 0) close(file);
    if (count <= 0 || stat("/proc/self/ns/pid", &space) != 0) return 0;
    for (size_t at = 0; at < sizeof boot; at += sizeof hash) {
        uint64_t word;
        memcpy(&word, boot + at, sizeof word);
        hash = mix(hash, word);
    }
    return (uint32_t)(mix(hash, (uint64_t)space.st_ino) >> 48) | 1;
}

/* The kernel gives each program 16 random bytes when it starts, so that the library and the command, which share no
 * variables, find the same tag. They also protect the stack: only 32 bits of a hash of all of them are shown. */
static uint32_t tag(void) {
    uint64_t seed[2] = {0}, hash = (uint64_t)getpid();
    const void *random = (const void *)(uintptr_t)getauxval(AT_RANDOM);
    if (random) memcpy(seed, random, sizeof seed);
    for (int i = 0; i < 2; i++) hash = mix(hash, seed[i]);
    return (uint32_t)(hash >> 32);
}

void skg_part_ending(char ending[SKG_PART_ENDING]) {
    snprintf(ending, SKG_PART_ENDING, "%s%ld-%04" PRIx32 "%08" PRIx32, mark, (long)getpid(), machine(),
             tag());
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

int skg_part_is_left(const char *name) {
    char own[SKG_PART_ENDING], *end = NULL;
    uint32_t its_machine = 0, its_tag = 0;
    const char *at = name, *last = NULL;
    int length = 0;
    while ((at = strstr(at, mark))) last = at++;
    if (!last || last == name) return 0;
    const long process = strtol(last + sizeof mark - 1, &end, 10);
    if (process <= 0 || sscanf(end, "-%4" SCNx32 "%8" SCNx32 "%n", &its_machine, &its_tag, &length) != 2 ||
        length != 13 || end[length + (int)strspn(end + length, "-0123456789")] != '\0')
        return 0;
    if (its_machine == 0 || its_machine != machine()) return 0;
    skg_part_ending(own);
    if (process == (long)getpid()) return strncmp(last, own, strlen(own)) != 0;
    return kill((pid_t)process, 0) != 0 && errno == ESRCH;
}
