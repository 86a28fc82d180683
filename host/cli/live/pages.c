/* Pages of the hub: how they come and go, what they ask for, and a thread for each that sends to it. */
#include "live/hub_inside.h"

#include "common/encode.h"
#include "common/progress.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

live_hub *live_hub_create(live_send send) {
    live_hub *hub = calloc(1, sizeof *hub);
    pthread_condattr_t clock;
    if (!hub) return NULL;
    hub->send = send;
    pthread_mutex_init(&hub->lock, NULL);
    pthread_condattr_init(&clock);
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    pthread_cond_init(&hub->asked, &clock);
    pthread_cond_init(&hub->sent, &clock);
    pthread_condattr_destroy(&clock);
    hub->active_ms = cli_now_ms();
    return hub;
}

void live_asked_free(live_asked *asked) {
    for (int k = 0; k < LIVE_KINDS; k++) skg_live_message_release(asked->newest + k);
    while (asked->take_count > 0) skg_live_message_release(asked->takes + --asked->take_count);
}

void live_hub_free(live_hub *hub) {
    if (!hub) return;
    live_asked_free(&hub->waiting);
    skg_live_letter_release(&hub->last.letter);
    skg_live_letter_release(&hub->radiograph);
    skg_live_letter_release(&hub->greeting);
    skg_live_letter_release(&hub->shot);
    free(hub->page);
    pthread_mutex_destroy(&hub->lock);
    pthread_cond_destroy(&hub->asked);
    pthread_cond_destroy(&hub->sent);
    free(hub);
}

/* The page that may change the scene; NULL: there is no page. Under the lock, as all that follows up to the sender. */
live_client *live_hub_owner(const live_hub *hub) {
    live_client *owner = NULL;
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        live_client *client = hub->clients[i];
        if (client && client->sends && (!owner || client->order < owner->order)) owner = client;
    }
    return owner;
}

static void tell_one(live_client *client, const char *key, const char *word) {
    json_t *object = json_object();
    json_object_set_new(object, key, cli_json_text(word));
    skg_live_letter *letter = live_letter_of(object);
    live_mail_add(&client->mail, letter);
    skg_live_letter_release(&letter);
}

static void tell_role(live_client *client, int is_owner) {
    tell_one(client, "role", is_owner ? "owner" : "reader");
}

int live_client_can_take(const live_client *client) {
    return client->frame.letter && client->untaken < UNTAKEN_MAX;
}

/* Takes the letter to send next: texts and files, then a frame, then a picture. NULL: nothing. */
static skg_live_letter *take_letter(live_client *client) {
    skg_live_letter *letter = live_mail_take(&client->mail);
    if (!letter && live_client_can_take(client)) {
        letter = client->frame.letter;
        client->frame.letter = NULL;
        client->sent[client->untaken++] = client->frame.number;
        pthread_cond_signal(&client->hub->asked);
    }
    if (letter) return letter;
    letter = client->picture;
    client->picture = NULL;
    return letter;
}

/* Sends what there is until the page leaves. */
static void *run_sender(void *user) {
    live_client *client = user;
    live_hub *hub = client->hub;
    pthread_mutex_lock(&hub->lock);
    while (!client->leaves) {
        skg_live_letter *letter = take_letter(client);
        const uint8_t *bytes = NULL;
        int32_t is_text = 0;
        int64_t count = 0;
        if (!letter) {
            pthread_cond_wait(&hub->sent, &hub->lock);
            continue;
        }
        (void)skg_live_letter_get(letter, &is_text, &bytes, &count);
        client->is_busy = 1;
        pthread_mutex_unlock(&hub->lock);
        const int is_there = hub->send(client->connection, !is_text, bytes, (size_t)count);
        skg_live_letter_release(&letter);
        pthread_mutex_lock(&hub->lock);
        client->is_busy = 0;
        if (!is_there) client->leaves = 1;
    }
    pthread_mutex_unlock(&hub->lock);
    return NULL;
}

int live_hub_is_full(live_hub *hub) {
    int place = 0;
    pthread_mutex_lock(&hub->lock);
    while (place < LIVE_PAGES_MAX && hub->clients[place]) place++;
    pthread_mutex_unlock(&hub->lock);
    return place == LIVE_PAGES_MAX;
}

live_client *live_hub_join(live_hub *hub, void *connection) {
    live_client *client = calloc(1, sizeof *client);
    int place = 0;
    if (!client) return NULL;
    *client = (live_client){.hub = hub, .connection = connection};
    pthread_mutex_lock(&hub->lock);
    while (place < LIVE_PAGES_MAX && hub->clients[place]) place++;
    if (place < LIVE_PAGES_MAX) hub->clients[place] = client;
    pthread_mutex_unlock(&hub->lock);
    if (place < LIVE_PAGES_MAX) return client;
    free(client);
    return NULL;
}

int live_hub_greet(live_client *client) {
    live_hub *hub = client->hub;
    pthread_mutex_lock(&hub->lock);
    client->sends = 1;
    client->order = hub->greeted++;
    tell_role(client, live_hub_owner(hub) == client);
    live_mail_add(&client->mail, hub->greeting);
    live_mail_add(&client->mail, hub->radiograph);
    live_mail_add(&client->mail, hub->shot);
    client->frame = (live_framed){live_letter_share(hub->last.letter), hub->last.number};
    hub->active_ms = cli_now_ms();
    if (pthread_create(&client->sender, NULL, run_sender, client) != 0) client->sends = 0;
    const int is_sending = client->sends;
    pthread_mutex_unlock(&hub->lock);
    return is_sending;
}

void live_hub_leave(live_client *client) {
    live_hub *hub = client->hub;
    pthread_mutex_lock(&hub->lock);
    const int was_owner = live_hub_owner(hub) == client, was_sending = client->sends;
    for (int i = 0; i < LIVE_PAGES_MAX; i++)
        if (hub->clients[i] == client) hub->clients[i] = NULL;
    live_client *owner = live_hub_owner(hub);
    if (was_owner && owner) tell_role(owner, 1);
    client->leaves = 1;
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
    if (was_sending) pthread_join(client->sender, NULL);
    skg_live_letter_release(&client->frame.letter);
    skg_live_letter_release(&client->picture);
    skg_live_message_release(&client->look);
    live_mail_clear(&client->mail);
    free(client);
}

static void take_ack(live_client *client, int64_t number) {
    for (int i = 0; i < client->untaken; i++)
        if (client->sent[i] == number) {
            client->untaken -= i + 1; /* those before it are taken as well */
            memmove(client->sent, client->sent + i + 1, (size_t)client->untaken * sizeof *client->sent);
            return;
        }
}

/* Keeps what is asked for, instead of an older message of the kind; a page has one look, of which a newer one takes the turn. */
static void keep(live_client *client, int kind, skg_live_message **message) {
    live_asked *waiting = &client->hub->waiting;
    skg_live_message **place = waiting->newest + kind;
    if (kind == SKG_LIVE_ASKED_LOOK) {
        place = &client->look;
        if (!*place) client->look_order = client->hub->looks++;
    } else if (kind == SKG_LIVE_ASKED_TAKE) {
        if (waiting->take_count == LIVE_FORMATS) return;
        place = waiting->takes + waiting->take_count++;
    }
    skg_live_message_release(place);
    *place = *message;
    *message = NULL;
    client->hub->active_ms = cli_now_ms();
    pthread_cond_signal(&client->hub->asked);
}

void live_hub_hear(live_client *client, const char *text, size_t length) {
    live_hub *hub = client->hub;
    skg_live_message *message = NULL;
    skg_live_asked asked;
    skg_live_asked_init(&asked);
    const int is_read = skg_live_message_create(text, (int64_t)length, &message) == SKG_OK &&
                        skg_live_message_get(message, &asked) == SKG_OK;
    pthread_mutex_lock(&hub->lock);
    if (!is_read) {
        tell_one(client, "refused", skg_last_error());
    } else if (asked.kind == SKG_LIVE_ASKED_ACK) {
        take_ack(client, asked.number);
        pthread_cond_signal(&hub->asked);
    } else if (live_hub_owner(hub) != client && asked.kind != SKG_LIVE_ASKED_PROBE &&
               asked.kind != SKG_LIVE_ASKED_LOOK) {
        tell_one(client, "refused", "another page changes this scene; this one only shows it");
    } else {
        keep(client, asked.kind, &message);
    }
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
    skg_live_message_release(&message);
}
