/* Processes that this one starts, one at a time. */
#include "common/child.h"

#include "common/interrupt.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

enum { LONGEST_PATH = 4096 };

extern char **environ;

int cli_has_program(const char *name) {
    const char *folder = getenv("PATH");
    while (folder) {
        char path[LONGEST_PATH];
        const size_t length = strcspn(folder, ":");
        const int its = snprintf(path, sizeof path, "%.*s/%s", (int)length, length ? folder : ".", name);
        if (length == 0) snprintf(path, sizeof path, "./%s", name); /* an empty entry is the present folder */
        if (its > 0 && its < (int)sizeof path && access(path, X_OK) == 0) return 1;
        folder = folder[length] ? folder + length + 1 : NULL;
    }
    return 0;
}

/* The child has a process group of its own: Ctrl-C goes to this process alone, whose handler kills the child. */
static int spawn(const char *const *words, int input, int output, int complaints, pid_t *process) {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none;
    int reason = posix_spawn_file_actions_init(&files);
    if (reason) return reason;
    reason = posix_spawnattr_init(&attributes);
    if (!reason) {
        sigemptyset(&none);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
        posix_spawnattr_setpgroup(&attributes, 0);
        posix_spawnattr_setsigmask(&attributes, &none);
        reason = posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
        if (!reason && output >= 0) reason = posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
        if (!reason && output < 0)
            reason = posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        if (!reason) reason = posix_spawn_file_actions_adddup2(&files, complaints, STDERR_FILENO);
        if (!reason)
            reason = posix_spawnp(process, words[0], &files, &attributes, (char *const *)(uintptr_t)words,
                                  environ);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&files);
    return reason;
}

/* Starts it with signals blocked: one that came before the guard is set would leave the child alone. */
int cli_process_start(const char *const *words, int input, int output, int complaints, pid_t *process) {
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int reason = spawn(words, input, output, complaints, process);
    if (!reason) cli_guard_child(*process);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return reason;
}

int cli_process_end(pid_t process) {
    int status = 0;
    siginfo_t ended;
    sigset_t all, before;
    while (waitid(P_PID, (id_t)process, &ended, WEXITED | WNOWAIT) != 0 && errno == EINTR) continue;
    sigfillset(&all); /* the handler must not kill a process that has ended: its number may be another's */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    waitpid(process, &status, 0);
    cli_guard_child(0);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

int cli_child_start(const char *const *words, cli_child *child) {
    int ends[2];
    *child = (cli_child){0};
    /* A socket, because MSG_NOSIGNAL spares this process the SIGPIPE of a child that has ended. */
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return errno;
    child->complaints = tmpfile();
    int reason = child->complaints ? 0 : errno;
    if (!reason) reason = cli_process_start(words, ends[1], -1, fileno(child->complaints), &child->process);
    close(ends[1]);
    child->input = ends[0];
    if (reason) {
        close(child->input);
        if (child->complaints) fclose(child->complaints);
        *child = (cli_child){0};
    }
    return reason;
}

int cli_child_feed(const cli_child *child, const void *bytes, size_t count) {
    const char *from = bytes;
    while (count > 0) {
        const ssize_t sent = send(child->input, from, count, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) return 0;
        from += sent;
        count -= (size_t)sent;
    }
    return 1;
}

/* Lines become sentences of one line; control characters become blanks. */
static void read_complaints(FILE *complaints, char *said, size_t size) {
    rewind(complaints);
    size_t count = fread(said, 1, size - 1, complaints);
    while (count > 0 && (unsigned char)said[count - 1] <= ' ') count--;
    said[count] = '\0';
    for (size_t i = 0; i < count; i++) {
        if (said[i] == '\n') said[i] = ';';
        if ((unsigned char)said[i] < ' ') said[i] = ' ';
    }
}

int cli_child_end(cli_child *child, char *said, size_t size) {
    close(child->input);
    const int status = cli_process_end(child->process);
    read_complaints(child->complaints, said, size);
    fclose(child->complaints);
    *child = (cli_child){0};
    return status;
}

void cli_child_kill(cli_child *child) {
    char said[2];
    if (child->process <= 0) return;
    kill(child->process, SIGKILL);
    cli_child_end(child, said, sizeof said);
}
