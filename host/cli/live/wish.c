/* A wish of a page: its message, and what that says. */
#include "live/wish.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int live_fail(char *sentence) {
    snprintf(sentence, LIVE_SENTENCE, "%s", skg_last_error());
    return 0;
}

live_wish live_wish_of(skg_live_message *message) {
    live_wish wish = {.message = message};
    skg_live_asked_init(&wish.says);
    if (message) (void)skg_live_message_get(message, &wish.says);
    return wish;
}

live_wish live_wish_plain(void) {
    static const char plain[] = "{\"wish\": 0}";
    skg_live_message *message = NULL;
    (void)skg_live_message_create(plain, sizeof plain - 1, &message);
    return live_wish_of(message);
}

live_wish live_wish_copy(const live_wish *wish) {
    if (wish->message) (void)skg_live_message_retain(wish->message);
    return *wish;
}

void live_wish_free(live_wish *wish) {
    skg_live_message_release(&wish->message);
}

int live_wish_change(live_wish *wish, json_t *changes, char *sentence) {
    skg_live_message *changed = NULL;
    char *text = json_dumps(changes, JSON_COMPACT | JSON_REAL_PRECISION(17));
    const int is_changed = text && skg_live_message_change(wish->message, text, &changed) == SKG_OK;
    free(text);
    json_decref(changes);
    if (!is_changed) return live_fail(sentence);
    live_wish_free(wish);
    *wish = live_wish_of(changed);
    return 1;
}

skg_live_letter *live_letter_of(json_t *object) {
    skg_live_letter *letter = NULL;
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    if (text) (void)skg_live_letter_create(1, text, (int64_t)strlen(text), &letter);
    free(text);
    return letter;
}
