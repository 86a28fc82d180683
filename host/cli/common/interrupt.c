/* Removes unfinished outputs when a signal ends the process. The handler makes async-signal-safe calls only:
 * it reads folders by getdents64 into static memory, because readdir allocates. */
#define _GNU_SOURCE /* getdents64 */
#include "common/interrupt.h"

#include "common/progress.h"
#include "core/text.h"

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { FOLDERS_MAX = 64, LONGEST_PATH = 4096, ENTRY_BYTES = 16384 };

static pthread_t writer;
static char folders[FOLDERS_MAX][LONGEST_PATH];
static volatile sig_atomic_t folder_count;
static char suffix[SKG_PART_ENDING]; /* of unfinished files; a number may follow */
static volatile sig_atomic_t guarded_child;

/* Two sentences, so that the handler reads a whole one while the other is written. */
static char kept[2][LONGEST_PATH] = {"no output was written", ""};
static volatile sig_atomic_t kept_now;
static char kept_file[2][LONGEST_PATH]; /* its name until now, and then */
static volatile sig_atomic_t has_kept_file;
static volatile sig_atomic_t is_gentle, is_asked; /* is_asked: the signal; 0: none */
static skg_progress *cancelled;                   /* by the first signal; NULL: none */

void cli_keep(const char *format, ...) {
    va_list arguments;
    const int next = 1 - kept_now;
    va_start(arguments, format);
    vsnprintf(kept[next], sizeof kept[next], format, arguments);
    va_end(arguments);
    kept_now = next;
}

void cli_keep_file(const char *temporary, const char *path) {
    has_kept_file = 0;
    if (!temporary || strlen(temporary) >= LONGEST_PATH || strlen(path) >= LONGEST_PATH) return;
    strcpy(kept_file[0], temporary);
    strcpy(kept_file[1], path);
    has_kept_file = 1;
}

void cli_guard_child(pid_t child) {
    guarded_child = child;
}

/* Nothing can be done if it fails. */
static void say(const char *text) {
    const ssize_t written = write(STDERR_FILENO, text, strlen(text));
    (void)written;
}

void cli_stop_gently(void) {
    cancelled = cli_progress();
    is_gentle = 1;
}

int cli_stop_asked(void) {
    return is_asked != 0;
}

void cli_end_by_signal(void) {
    fflush(NULL);
    signal(is_asked, SIG_DFL);
    raise(is_asked);
}

static int is_unfinished(const char *name) {
    const char *found = strstr(name, suffix), *end = found ? found + strlen(suffix) : NULL;
    return found && found > name && end[strspn(end, "-0123456789")] == '\0';
}

static void clear_folder(const char *path) {
    static _Alignas(struct dirent64) char entries[ENTRY_BYTES];
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    ssize_t size;
    if (folder < 0) return;
    while ((size = getdents64(folder, entries, sizeof entries)) > 0)
        for (ssize_t at = 0; at < size;) {
            const struct dirent64 *entry = (const struct dirent64 *)(const void *)(entries + at);
            if (is_unfinished(entry->d_name)) unlinkat(folder, entry->d_name, 0);
            at += entry->d_reclen;
        }
    close(folder);
}

/* Cleans up in the thread that writes, which therefore writes no more. */
static void end(int number) {
    if (!pthread_equal(pthread_self(), writer)) {
        pthread_kill(writer, number);
        return;
    }
    if (is_gentle && !is_asked) {
        is_asked = number;
        if (cancelled) (void)skg_progress_cancel(cancelled);
        say("\nskiagraph: stopping; what is done is kept (a second signal ends at once)\n");
        return;
    }
    if (guarded_child > 0 && kill(guarded_child, SIGKILL) == 0) waitpid(guarded_child, NULL, 0);
    if (has_kept_file && rename(kept_file[0], kept_file[1]) == 0) has_kept_file = 0;
    for (int f = 0; f < folder_count; f++) clear_folder(folders[f]);
    say("\nskiagraph: interrupted; ");
    say(kept[kept_now]);
    say("\n");
    signal(number, SIG_DFL);
    raise(number); /* is delivered when the handler returns */
}

void cli_catch_signals(void) {
    /* SIGUSR1 and SIGXCPU: job managers send them before their limit */
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU};
    const int count = sizeof numbers / sizeof *numbers;
    struct sigaction action = {.sa_handler = end, .sa_flags = SA_RESTART}, before;
    writer = pthread_self();
    skg_part_ending(suffix);
    sigemptyset(&action.sa_mask);
    for (int n = 0; n < count; n++) sigaddset(&action.sa_mask, numbers[n]);
    for (int n = 0; n < count; n++)
        if (sigaction(numbers[n], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(numbers[n], &action, NULL);
}

static void clear_leftovers(const char *path) {
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        if (skg_part_is_left(entry->d_name)) unlinkat(dirfd(folder), entry->d_name, 0);
    if (folder) closedir(folder);
}

static void guard(const char *path, size_t length) {
    if (folder_count == FOLDERS_MAX || length >= LONGEST_PATH) return;
    memcpy(folders[folder_count], path, length);
    folders[folder_count][length] = '\0';
    folder_count++;
    clear_leftovers(folders[folder_count - 1]);
}

void cli_guard_output(const char *path) {
    const char *slash = strrchr(path, '/');
    guard(path, strlen(path));
    if (slash)
        guard(path, (size_t)(slash - path) + 1);
    else
        guard(".", 1);
}
