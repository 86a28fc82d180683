/* Counts work under way, because some calls of drivers must not meet any. */
#include "driver/driver.h"

#include <pthread.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int64_t under_way; /* work of this process; guarded by the lock */

static void count(int64_t more) {
    pthread_mutex_lock(&lock);
    under_way += more;
    pthread_mutex_unlock(&lock);
}

void skg_work_begin(void) {
    count(1);
}

void skg_work_end(void) {
    count(-1);
}

int64_t skg_work_count(void) {
    pthread_mutex_lock(&lock);
    const int64_t now = under_way;
    pthread_mutex_unlock(&lock);
    return now;
}

void skg_work_none_call(void (*call)(void *data), void *data) {
    pthread_mutex_lock(&lock);
    if (under_way == 0) call(data);
    pthread_mutex_unlock(&lock);
}
