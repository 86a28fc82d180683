/* The hub of the thread that computes: takes what pages have asked for, and hands letters out. */
#include "live/hub_inside.h"

#include "common/encode.h"
#include "common/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

char *live_hub_page_get(live_hub *hub) {
    pthread_mutex_lock(&hub->lock);
    char *copy = hub->page ? strdup(hub->page) : NULL;
    pthread_mutex_unlock(&hub->lock);
    return copy;
}

static int has_asked(const live_hub *hub) {
    int has = hub->waiting.take_count > 0;
    for (int k = 0; k < LIVE_KINDS; k++) has |= hub->waiting.newest[k] != NULL;
    return has;
}

/* The page whose look has waited longest; NULL: there is none. */
static live_client *find_look(const live_hub *hub) {
    live_client *first = NULL;
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        live_client *client = hub->clients[i];
        if (client && client->look && (!first || client->look_order < first->look_order)) first = client;
    }
    return first;
}

skg_live_message *live_hub_look_take(live_hub *hub, int64_t *page) {
    skg_live_message *look = NULL;
    pthread_mutex_lock(&hub->lock);
    live_client *client = find_look(hub);
    if (client) {
        look = client->look;
        *page = client->order;
        client->look = NULL;
    }
    pthread_mutex_unlock(&hub->lock);
    return look;
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

int live_hub_has(live_hub *hub, int kind) {
    pthread_mutex_lock(&hub->lock);
    const int has = hub->waiting.newest[kind] != NULL;
    pthread_mutex_unlock(&hub->lock);
    return has;
}

int live_hub_is_thirsty(live_hub *hub) {
    int is_thirsty = 0;
    pthread_mutex_lock(&hub->lock);
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        const live_client *client = hub->clients[i];
        /* a frame that a free sender is about to take is as good as taken */
        if (client && client->sends &&
            (!client->frame.letter || (live_client_can_take(client) && !client->is_busy)))
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

void live_hub_page_set(live_hub *hub, char *html) {
    pthread_mutex_lock(&hub->lock);
    free(hub->page);
    hub->page = html;
    pthread_mutex_unlock(&hub->lock);
}

/* Replaces a letter for pages that begin, and sends it to those that are there. Takes over the letter. */
static void post(live_hub *hub, skg_live_letter **place, skg_live_letter *letter, int is_sent) {
    if (!letter) return;
    pthread_mutex_lock(&hub->lock); /* once, so that a page that begins meanwhile misses nothing */
    for (int i = 0; is_sent && i < LIVE_PAGES_MAX; i++)
        if (hub->clients[i] && hub->clients[i]->sends) live_mail_add(&hub->clients[i]->mail, letter);
    if (place) {
        skg_live_letter_release(place);
        *place = live_letter_share(letter);
    }
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
    skg_live_letter_release(&letter);
}

void live_hub_radiograph_set(live_hub *hub, skg_live_letter *letter) {
    post(hub, &hub->radiograph, letter, 0);
}

void live_hub_scene_tell(live_hub *hub, skg_live_letter *letter, int is_new) {
    post(hub, &hub->greeting, letter, is_new);
}

void live_hub_tell(live_hub *hub, skg_live_letter *letter) {
    post(hub, NULL, letter, 1);
}

void live_hub_shot_tell(live_hub *hub, skg_live_letter *letter) {
    post(hub, &hub->shot, letter, 1);
}

void live_hub_tell_json(live_hub *hub, json_t *object) {
    live_hub_tell(hub, live_letter_of(object));
}

void live_hub_refuse(live_hub *hub, const char *sentence) {
    json_t *object = json_object();
    json_object_set_new(object, "refused", cli_json_text(sentence));
    live_hub_tell_json(hub, object);
}

void live_hub_show(live_hub *hub, int64_t number, skg_live_letter *letter) {
    if (!letter) return;
    pthread_mutex_lock(&hub->lock);
    for (int i = 0; i < LIVE_PAGES_MAX; i++) {
        live_client *client = hub->clients[i];
        if (!client || !client->sends) continue;
        skg_live_letter_release(&client->frame.letter);
        client->frame = (live_framed){live_letter_share(letter), number};
    }
    skg_live_letter_release(&hub->last.letter);
    hub->last = (live_framed){letter, number};
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
}

void live_hub_picture(live_hub *hub, int64_t page, skg_live_letter *letter) {
    pthread_mutex_lock(&hub->lock);
    for (int i = 0; letter && i < LIVE_PAGES_MAX; i++) {
        live_client *client = hub->clients[i];
        if (!client || !client->sends || client->order != page) continue;
        skg_live_letter_release(&client->picture);
        client->picture = live_letter_share(letter);
    }
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
    skg_live_letter_release(&letter);
}

void live_hub_give(live_hub *hub, skg_live_letter *letter) {
    pthread_mutex_lock(&hub->lock);
    live_client *owner = live_hub_owner(hub);
    if (owner) live_mail_add(&owner->mail, letter);
    pthread_cond_broadcast(&hub->sent);
    pthread_mutex_unlock(&hub->lock);
    skg_live_letter_release(&letter);
}
