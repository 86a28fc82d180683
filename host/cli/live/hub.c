/* Between the thread that computes and the pages: what pages ask for goes in, frames and sentences go out. */
#include "live/hub.h"

#include "common/encode.h"
#include "common/progress.h"
#include "live/mail.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { UNTAKEN_MAX = 2 }; /* frames under way to a page: while it shows one, the next is sent */

struct live_client {
    live_hub *hub;
    void *connection;
    pthread_t sender;
    int sends, leaves; /* leaves: the sender ends */
    int is_busy;       /* the sender sends */
    int64_t order;     /* the page that was greeted first may change the scene */
    int64_t sent[UNTAKEN_MAX];
    int untaken;
    live_packet *frame, *picture;
    int64_t look_order; /* of its look among those of all pages; 0: none waits */
    live_look look;
    live_mail mail;
};

struct live_hub {
    pthread_mutex_t lock;
    pthread_cond_t asked, sent; /* a page asked for something; something is to be sent */
    live_send send;
    live_client *clients[LIVE_PAGES_MAX];
    int64_t greeted, looks;
    live_asked waiting;
    double active_ms;
    char *page;
    char *greeting, *shot;   /* texts for pages that begin: the scene, and the last frame's */
    live_packet *last;       /* frame, likewise */
    live_packet *radiograph; /* NULL: there is none */
};

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

void live_hub_free(live_hub *hub) {
    if (!hub) return;
    if (hub->waiting.has_wish) live_wish_free(&hub->waiting.wish);
    live_packet_release(&hub->last);
    live_packet_release(&hub->radiograph);
    free(hub->page);
    free(hub->greeting);
    free(hub->shot);
    pthread_mutex_destroy(&hub->lock);
    pthread_cond_destroy(&hub->asked);
    pthread_cond_destroy(&hub->sent);
    free(hub);
}

/* The page that may change the scene; NULL: there is no page. Under the lock, as all that follows up to the sender. */
static live_client *find_owner(const live_hub *hub) {
    live_client *owner = NULL;
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        live_client *client = hub->clients[i];
        if (client && client->sends && (!owner || client->order < owner->order)) owner = client;
    }
    return owner;
}

static void tell(live_client *client, const char *text) {
    live_mail_add(&client->mail, 0, text, strlen(text));
}

static void tell_role(live_client *client, int is_owner) {
    tell(client, is_owner ? "{\"role\": \"owner\"}" : "{\"role\": \"reader\"}");
}

static void refuse(live_client *client, const char *sentence) {
    json_t *object = json_object();
    json_object_set_new(object, "refused", cli_json_text(sentence));
    char *text = json_dumps(object, JSON_COMPACT);
    json_decref(object);
    if (text) tell(client, text);
    free(text);
}

static int can_take(const live_client *client) {
    return client->frame && client->untaken < UNTAKEN_MAX;
}

/* Sends what there is until the page leaves. */
static void *run_sender(void *user) {
    live_client *client = user;
    live_hub *hub = client->hub;
    pthread_mutex_lock(&hub->lock);
    while (!client->leaves) {
        int is_binary = 1;
        live_packet *packet = live_mail_take(&client->mail, &is_binary);
        if (!packet && can_take(client)) {
            packet = client->frame;
            client->frame = NULL;
            client->sent[client->untaken++] = packet->number;
            pthread_cond_signal(&hub->asked);
        }
        if (!packet) {
            packet = client->picture;
            client->picture = NULL;
        }
        if (!packet) {
            pthread_cond_wait(&hub->sent, &hub->lock);
            continue;
        }
        client->is_busy = 1;
        pthread_mutex_unlock(&hub->lock);
        const int is_there = hub->send(client->connection, is_binary, packet->bytes, packet->size);
        pthread_mutex_lock(&hub->lock);
        client->is_busy = 0;
        live_packet_release(&packet);
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
    tell_role(client, find_owner(hub) == client);
    if (hub->greeting) tell(client, hub->greeting);
    if (hub->radiograph) live_mail_add(&client->mail, 1, hub->radiograph->bytes, hub->radiograph->size);
    if (hub->shot) tell(client, hub->shot);
    client->frame = live_packet_retain(hub->last);
    hub->active_ms = cli_now_ms();
    if (pthread_create(&client->sender, NULL, run_sender, client) != 0) client->sends = 0;
    const int is_sending = client->sends;
    pthread_mutex_unlock(&hub->lock);
    return is_sending;
}

void live_hub_leave(live_client *client) {
    live_hub *hub = client->hub;
    pthread_mutex_lock(&hub->lock);
    const int was_owner = find_owner(hub) == client, was_sending = client->sends;
    for (int i = 0; i < LIVE_PAGES_MAX; i++)
        if (hub->clients[i] == client) hub->clients[i] = NULL;
    live_client *owner = find_owner(hub);
    if (was_owner && owner) tell_role(owner, 1);
    client->leaves = 1;
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
    if (was_sending) pthread_join(client->sender, NULL);
    pthread_mutex_lock(&hub->lock);
    live_packet_release(&client->frame);
    live_packet_release(&client->picture);
    if (client->look_order) live_look_free(&client->look);
    live_mail_clear(&client->mail);
    pthread_mutex_unlock(&hub->lock);
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

/* Keeps what is asked for, instead of an older wish of the kind. */
static void keep(live_hub *hub, live_message *message) {
    live_asked *waiting = &hub->waiting;
    if (message->kind == LIVE_WISH) {
        if (waiting->has_wish) live_wish_free(&waiting->wish);
        waiting->wish = message->wish;
        waiting->has_wish = 1;
    } else if (message->kind == LIVE_PROBE) {
        memcpy(waiting->probe, message->probe, sizeof waiting->probe);
        waiting->has_probe = 1;
    } else if (message->kind == LIVE_MEASURE) {
        waiting->has_measure = 1;
    } else if (message->kind == LIVE_REGISTER) {
        waiting->part = message->part;
        waiting->has_register = 1;
    } else if (message->kind == LIVE_RECONSTRUCT) {
        waiting->switches = message->switches;
        waiting->has_reconstruct = 1;
    } else if (waiting->take_count < LIVE_FORMATS) {
        memcpy(waiting->takes[waiting->take_count++], message->take, sizeof message->take);
    }
    hub->active_ms = cli_now_ms();
    pthread_cond_signal(&hub->asked);
}

/* A page has one look; a newer one takes its turn. */
static void keep_look(live_client *client, const live_look *look) {
    live_hub *hub = client->hub;
    if (client->look_order)
        live_look_free(&client->look);
    else
        client->look_order = ++hub->looks;
    client->look = *look;
    hub->active_ms = cli_now_ms();
    pthread_cond_signal(&hub->asked);
}

void live_hub_hear(live_client *client, const char *text, size_t length) {
    live_hub *hub = client->hub;
    live_message message;
    char sentence[LIVE_SENTENCE];
    const int is_read = live_message_read(text, length, &message, sentence);
    pthread_mutex_lock(&hub->lock);
    if (!is_read) {
        refuse(client, sentence);
    } else if (message.kind == LIVE_ACK) {
        take_ack(client, message.ack);
        pthread_cond_signal(&hub->asked);
    } else if (message.kind == LIVE_LOOK) {
        keep_look(client, &message.look);
    } else if (find_owner(hub) != client && message.kind != LIVE_PROBE) {
        refuse(client, "another page changes this scene; this one only shows it");
        if (message.kind == LIVE_WISH) live_wish_free(&message.wish);
    } else {
        keep(hub, &message);
    }
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
}

char *live_hub_page_get(live_hub *hub) {
    pthread_mutex_lock(&hub->lock);
    char *copy = hub->page ? strdup(hub->page) : NULL;
    pthread_mutex_unlock(&hub->lock);
    return copy;
}

static int has_asked(const live_hub *hub) {
    const live_asked *waiting = &hub->waiting;
    return waiting->has_wish || waiting->has_probe || waiting->has_measure || waiting->has_register ||
           waiting->has_reconstruct || waiting->take_count > 0;
}

/* The page whose look has waited longest; NULL: there is none. */
static live_client *find_look(const live_hub *hub) {
    live_client *first = NULL;
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        live_client *client = hub->clients[i];
        if (client && client->look_order && (!first || client->look_order < first->look_order))
            first = client;
    }
    return first;
}

int live_hub_look_take(live_hub *hub, live_look *look, int64_t *page) {
    pthread_mutex_lock(&hub->lock);
    live_client *client = find_look(hub);
    if (client) {
        *look = client->look;
        *page = client->order;
        client->look_order = 0;
    }
    pthread_mutex_unlock(&hub->lock);
    return client != NULL;
}

void live_hub_picture(live_hub *hub, int64_t page, unsigned char *bytes, size_t size) {
    live_packet *packet = live_packet_create(0, bytes, size);
    if (!packet) return;
    pthread_mutex_lock(&hub->lock);
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        live_client *client = hub->clients[i];
        if (!client || !client->sends || client->order != page) continue;
        live_packet_release(&client->picture);
        client->picture = live_packet_retain(packet);
    }
    live_packet_release(&packet);
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
}

int live_hub_wait(live_hub *hub, double ms, int sees_looks, live_asked *asked) {
    struct timespec end;
    clock_gettime(CLOCK_MONOTONIC, &end);
    const double ns = (double)end.tv_nsec + 1e6 * fmax(ms, 0);
    end.tv_sec += (time_t)(ns / 1e9);
    end.tv_nsec = (long)fmod(ns, 1e9);
    pthread_mutex_lock(&hub->lock);
    if (!has_asked(hub) && !(sees_looks && find_look(hub)) && ms > 0)
        pthread_cond_timedwait(&hub->asked, &hub->lock, &end);
    const int has = has_asked(hub);
    *asked = hub->waiting;
    hub->waiting = (live_asked){0};
    pthread_mutex_unlock(&hub->lock);
    return has;
}

int live_hub_has_news(live_hub *hub) {
    pthread_mutex_lock(&hub->lock);
    const int has = hub->waiting.has_wish;
    pthread_mutex_unlock(&hub->lock);
    return has;
}

int live_hub_has_other_slice(live_hub *hub) {
    pthread_mutex_lock(&hub->lock);
    const int has = hub->waiting.has_reconstruct;
    pthread_mutex_unlock(&hub->lock);
    return has;
}

int live_hub_is_thirsty(live_hub *hub) {
    int is_thirsty = 0;
    pthread_mutex_lock(&hub->lock);
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        const live_client *client = hub->clients[i];
        /* a frame that a free sender is about to take is as good as taken */
        if (client && client->sends && (!client->frame || (can_take(client) && !client->is_busy)))
            is_thirsty = 1;
    }
    pthread_mutex_unlock(&hub->lock);
    return is_thirsty;
}

double live_hub_idle(live_hub *hub) {
    pthread_mutex_lock(&hub->lock);
    const double ms = cli_now_ms() - hub->active_ms;
    pthread_mutex_unlock(&hub->lock);
    return ms / 1000;
}

/* Replaces the page, or a text for pages that begin. Takes over the text. */
static void replace(live_hub *hub, char **text, char *by) {
    pthread_mutex_lock(&hub->lock);
    free(*text);
    *text = by;
    pthread_mutex_unlock(&hub->lock);
}

void live_hub_page_set(live_hub *hub, char *html) {
    replace(hub, &hub->page, html);
}

void live_hub_radiograph_set(live_hub *hub, unsigned char *bytes, size_t size) {
    pthread_mutex_lock(&hub->lock);
    live_packet_release(&hub->radiograph);
    hub->radiograph = live_packet_create(0, bytes, size);
    pthread_mutex_unlock(&hub->lock);
}

void live_hub_greeting_set(live_hub *hub, const char *text) {
    replace(hub, &hub->greeting, strdup(text));
}

/* Under the lock. */
static void tell_all(live_hub *hub, const char *text) {
    for (int i = 0; i < LIVE_PAGES_MAX; i++)
        if (hub->clients[i] && hub->clients[i]->sends) tell(hub->clients[i], text);
    pthread_cond_broadcast(&hub->sent);
}

void live_hub_tell(live_hub *hub, const char *text) {
    pthread_mutex_lock(&hub->lock);
    tell_all(hub, text);
    pthread_mutex_unlock(&hub->lock);
}

void live_hub_tell_json(live_hub *hub, json_t *object) {
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    if (text) live_hub_tell(hub, text);
    free(text);
}

void live_hub_shot_tell(live_hub *hub, json_t *object) {
    char *text = json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17));
    json_decref(object);
    if (!text) return;
    pthread_mutex_lock(&hub->lock); /* once, so that a page that begins meanwhile misses no text */
    tell_all(hub, text);
    free(hub->shot);
    hub->shot = text;
    pthread_mutex_unlock(&hub->lock);
}

void live_hub_show(live_hub *hub, int64_t number, unsigned char *bytes, size_t size) {
    live_packet *packet = live_packet_create(number, bytes, size);
    if (!packet) return;
    pthread_mutex_lock(&hub->lock);
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        live_client *client = hub->clients[i];
        if (!client || !client->sends) continue;
        live_packet_release(&client->frame);
        client->frame = live_packet_retain(packet);
    }
    live_packet_release(&hub->last);
    hub->last = packet;
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
}

void live_hub_give(live_hub *hub, const void *bytes, size_t size) {
    pthread_mutex_lock(&hub->lock);
    live_client *owner = find_owner(hub);
    if (owner) live_mail_add(&owner->mail, 1, bytes, size);
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
}
