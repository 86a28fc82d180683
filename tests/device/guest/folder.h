/* A folder for OCL_ICD_VENDORS with the bad guest, alone or beside the drivers of the system. */
#ifndef SKG_TESTS_GUEST_FOLDER_H
#define SKG_TESTS_GUEST_FOLDER_H

#include "device/cache_folder.h"

#include <sys/stat.h>

static char guest_folder[64];

/* Also makes the folder of kept verdicts. */
static inline void make_guest_folder(void) {
    const char *own = getenv("OCL_ICD_VENDORS");
    struct stat is;
    char line[1024];
    make_cache_folder();
    snprintf(guest_folder, sizeof guest_folder, "/tmp/skg-guest-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(guest_folder));
    if (!own || stat(own, &is) != 0 || !S_ISDIR(is.st_mode)) own = "/etc/OpenCL/vendors";
    snprintf(line, sizeof line, "cp %s/*.icd %s && echo %s >%s/aa-guest.icd", own, guest_folder,
             SKG_GUEST_DRIVER, guest_folder);
    ck_assert_int_eq(system(line), 0);
    setenv("OCL_ICD_VENDORS", guest_folder, 1);
    snprintf(line, sizeof line, "%s/calls", guest_folder);
    setenv("SKG_GUEST_LOG", line, 1);
    unsetenv("SKG_DEVICE");
}

static inline void remove_guest_folder(void) {
    char line[128];
    snprintf(line, sizeof line, "rm -r %s", guest_folder);
    ck_assert_int_eq(system(line), 0);
    remove_cache_folder();
}

/* Leaves the guest as the only driver. */
static inline void be_alone(void) {
    char line[512];
    snprintf(line, sizeof line, "mv %s/aa-guest.icd %s/aa && rm %s/*.icd && mv %s/aa %s/aa-guest.icd",
             guest_folder, guest_folder, guest_folder, guest_folder, guest_folder);
    ck_assert_int_eq(system(line), 0);
}

/* How often the guest was called so. */
static inline int count_calls(const char *name) {
    char path[128], line[128];
    int count = 0;
    snprintf(path, sizeof path, "%s/calls", guest_folder);
    FILE *file = fopen(path, "r");
    if (!file) return 0;
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        count += strcmp(line, name) == 0;
    }
    fclose(file);
    return count;
}

#endif
