/* One writer at a time: a lock of the operating system on NAME.lock, which goes when its process ends however that
 * happens. The file says who has it. Such a lock belongs to the whole process, and closing any descriptor of its file
 * gives it up; so within the process a table says which lock files are locked, and none of these is opened again. */
#include "core/files.h"
#include "scan/format.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OWNER_LENGTH = 320 };

/* A lock file that a process has. The child of a fork inherits the table but no lock. */
typedef struct held_lock {
    struct held_lock *next;
    dev_t device;
    ino_t inode;
    pid_t process;
    int descriptor;
} held_lock;

static pthread_mutex_t table_mutex = PTHREAD_MUTEX_INITIALIZER;
static held_lock *table;

/* A child process may be forked while another thread holds the mutex. */
static void take_table(void) {
    pthread_mutex_lock(&table_mutex);
}

static void give_table(void) {
    pthread_mutex_unlock(&table_mutex);
}

static void survive_fork(void) {
    pthread_atfork(take_table, give_table, give_table);
}

static held_lock **find_held(const struct stat *of) {
    held_lock **at = &table;
    while (*at && ((*at)->device != of->st_dev || (*at)->inode != of->st_ino || (*at)->process != getpid()))
        at = &(*at)->next;
    return at;
}

static skg_status fail_locked(const char *path, const char *owner) {
    return skg_fail(SKG_ERR_OUTPUT,
                    "%s: is locked: %s writes this scan; wait for its end, or choose another output", path,
                    owner);
}

static skg_status fail_owned(const char *path, int descriptor) {
    char owner[OWNER_LENGTH];
    const ssize_t got = pread(descriptor, owner, sizeof owner - 1, 0);
    owner[got > 0 ? got : 0] = '\0';
    skg_one_line(owner);
    return fail_locked(path, *owner ? owner : "another process");
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
static int is_current(const char *path, int descriptor, struct stat *mine) {
    struct stat named;
    return fstat(descriptor, mine) == 0 && stat(path, &named) == 0 && mine->st_ino == named.st_ino &&
           mine->st_dev == named.st_dev;
}

/* Locks the file; `entry` is filled in. */
static skg_status lock_file(const char *path, held_lock *entry) {
    for (;;) {
        struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
        struct stat there;
        if (stat(path, &there) == 0 && *find_held(&there)) return fail_locked(path, "this process");
        const int descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
        if (descriptor < 0) return skg_output_fail(path, errno, "");
        if (fcntl(descriptor, F_SETLK, &lock) != 0) {
            const int reason = errno;
            const skg_status status = reason == EACCES || reason == EAGAIN
                                          ? fail_owned(path, descriptor)
                                          : skg_output_fail(path, reason, "");
            close(descriptor);
            return status;
        }
        if (is_current(path, descriptor, &there)) {
            write_owner(descriptor);
            entry->device = there.st_dev;
            entry->inode = there.st_ino;
            entry->process = getpid();
            entry->descriptor = descriptor;
            return SKG_OK;
        }
        close(descriptor);
    }
}

skg_status skg_scan_lock(const char *path, int *result) {
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    held_lock *entry = NULL;
    SKG_TRY(skg_alloc(1, sizeof *entry, "lock", &entry));
    pthread_once(&once, survive_fork);
    take_table();
    const skg_status status = lock_file(path, entry);
    if (status == SKG_OK) {
        entry->next = table;
        table = entry;
        *result = entry->descriptor;
    }
    give_table();
    if (status != SKG_OK) skg_free(&entry);
    return status;
}

void skg_scan_unlock(const char *path, int *descriptor) {
    struct stat mine;
    if (*descriptor < 0) return;
    held_lock *entry = NULL;
    take_table();
    held_lock **at = fstat(*descriptor, &mine) == 0 ? find_held(&mine) : &entry;
    if ((entry = *at)) {
        *at = entry->next;
        unlink(path); /* the child of a fork, which is not in the table, leaves its parent's lock */
    }
    close(*descriptor);
    give_table();
    skg_free(&entry);
    *descriptor = -1;
}
