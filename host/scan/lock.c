/* One writer at a time: a lock of the operating system on NAME.lock, which goes when its process ends however that
 * happens. The file says who has it. */
#include "core/output.h"
#include "scan/format.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OWNER_LENGTH = 320 };

static skg_status fail_locked(const char *path, int descriptor) {
    char owner[OWNER_LENGTH];
    const ssize_t got = pread(descriptor, owner, sizeof owner - 1, 0);
    owner[got > 0 ? got : 0] = '\0';
    skg_one_line(owner);
    return skg_fail(SKG_ERR_OUTPUT,
                    "%s: is locked: %s writes this scan; wait for its end, or choose another output", path,
                    *owner ? owner : "another process");
}

static void write_owner(int descriptor) {
    char host[256] = "", owner[OWNER_LENGTH];
    gethostname(host, sizeof host - 1);
    const int length = snprintf(owner, sizeof owner, "process %ld on %s", (long)getpid(), host);
    if (ftruncate(descriptor, 0) != 0 || pwrite(descriptor, owner, (size_t)length, 0) != length) {
        /* The lock holds without a name. */
    }
}

/* Whether the file that is locked is still the one of this name: its last owner may have removed it in between. */
static int is_current(const char *path, int descriptor) {
    struct stat mine, named;
    return fstat(descriptor, &mine) == 0 && stat(path, &named) == 0 && mine.st_ino == named.st_ino &&
           mine.st_dev == named.st_dev;
}

skg_status skg_scan_lock(const char *path, int *result) {
    for (;;) {
        struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
        const int descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor < 0) return skg_output_fail(path, errno, "");
        if (fcntl(descriptor, F_SETLK, &lock) != 0) {
            const int reason = errno;
            const skg_status status = reason == EACCES || reason == EAGAIN
                                          ? fail_locked(path, descriptor)
                                          : skg_output_fail(path, reason, "");
            close(descriptor);
            return status;
        }
        if (is_current(path, descriptor)) {
            write_owner(descriptor);
            *result = descriptor;
            return SKG_OK;
        }
        close(descriptor);
    }
}

void skg_scan_unlock(const char *path, int *descriptor) {
    if (*descriptor < 0) return;
    unlink(path);
    close(*descriptor);
    *descriptor = -1;
}
