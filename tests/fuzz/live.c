/* Messages of pages. One that is a wish is read again from its own text, and is then the same. */
#include "fuzz/fuzz.h"

#include <skiagraph/live.h>

#include <stdlib.h>
#include <string.h>

static void check_again(const skg_live_message *wish) {
    const char *text = NULL;
    int32_t moved = 1, other = 1;
    skg_live_message *again = NULL;
    if (skg_live_message_text_get(wish, &text) != SKG_OK) abort();
    if (skg_live_message_create(text, (int64_t)strlen(text), &again) != SKG_OK) abort();
    if (skg_live_wish_compare(wish, again, &moved, &other) != SKG_OK || moved || other) abort();
    skg_live_message_release(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *text = fuzz_text(data, size);
    skg_live_message *message = NULL;
    skg_live_asked asked;
    const skg_status status = skg_live_message_create(text, (int64_t)size, &message);
    if (status != SKG_OK) fuzz_expect_sentence(status);
    skg_live_asked_init(&asked);
    if (message && skg_live_message_get(message, &asked) != SKG_OK) abort();
    if (message && asked.kind == SKG_LIVE_ASKED_WISH) check_again(message);
    skg_live_message_release(&message);
    free(text);
    return 0;
}
