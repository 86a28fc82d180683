/* Runs a fuzz target over the files of a folder, for builds without libFuzzer. */
#include "fuzz/fuzz.h"

#include <dirent.h>
#include <stdlib.h>

static int run_file(const char *path) {
    FILE *file = fopen(path, "rb");
    static uint8_t bytes[1 << 20];
    if (!file) return 1;
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    uint8_t *exact = malloc(size + 1); /* so that a read beyond the end is seen */
    if (!exact) return 1;
    for (size_t n = 0; n < size; n++) exact[n] = bytes[n];
    LLVMFuzzerTestOneInput(exact, size);
    free(exact);
    return 0;
}

int main(int count, char **words) {
    char path[4096];
    int files = 0, failed = 0;
    DIR *all = count == 2 ? opendir(words[1]) : NULL;
    if (!all) {
        fprintf(stderr, "usage: replay FOLDER\n");
        return 2;
    }
    for (struct dirent *one; (one = readdir(all));) {
        if (one->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", words[1], one->d_name);
        failed += run_file(path);
        files++;
    }
    closedir(all);
    printf("%d files\n", files);
    return files == 0 || failed != 0;
}
