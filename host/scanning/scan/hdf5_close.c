/* Closes files of HDF5 that were written to, also where the disk is full. */
#define _GNU_SOURCE /* memfd_create */
#include "scan/hdf5_files.h"

#include <sys/mman.h>
#include <sys/stat.h>

/* Of an open file; -1: it has none. */
static int descriptor_of(hid_t file) {
    int *descriptor = NULL;
    return H5Fget_vfd_handle(file, H5P_DEFAULT, (void **)&descriptor) >= 0 && descriptor ? *descriptor : -1;
}

/* Makes sure that there is room for what HDF5 still holds of a file. A write that fails while it closes a file leaves HDF5 in a state
 * in which the process ends by a signal, at the latest when HDF5 closes the file once more at its end. */
static int has_room(int descriptor, int64_t bytes) {
    struct stat there;
    if (fstat(descriptor, &there) != 0) return 0;
    const int reason = posix_fallocate(descriptor, there.st_size, (off_t)bytes);
    if (reason == ENOSPC || reason == EFBIG || reason == EDQUOT) {
        errno = reason;
        return 0;
    }
    return reason != 0 || ftruncate(descriptor, there.st_size) == 0; /* some file systems reserve nothing */
}

int skg_hdf5_close(hid_t file, int written, int64_t bytes) {
    const int descriptor = descriptor_of(file), good = written && has_room(descriptor, bytes), reason = errno;
    /* A file that is lost is finished in memory. */
    const int memory = good ? -1 : memfd_create("skiagraph", MFD_CLOEXEC);
    if (memory >= 0) {
        if (descriptor >= 0) (void)dup3(memory, descriptor, O_CLOEXEC);
        close(memory);
    }
    const int closed = H5Fclose(file) >= 0;
    if (!good) errno = reason;
    return good && closed;
}
