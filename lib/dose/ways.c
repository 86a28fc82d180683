/* Which part has which piece of a line: nesting, overlaps, priorities. */
#include "dose/pieces.h"

#include "core/maths.h"
#include "scene/scene.h"

skg_rules skg_rules_of(const skg_recipe *recipe) {
    return (skg_rules){.scene = recipe->scene,
                       .competing = recipe->priority_possible,
                       .clip = recipe->options.clip,
                       .unite = recipe->options.unite,
                       .cells = recipe->volume_count > 0};
}

static skg_status reserve(const skg_rules *rules, skg_way *way) {
    if (way->winding) return SKG_OK;
    SKG_TRY(skg_alloc(rules->scene->count, sizeof *way->winding, "dose", &way->winding));
    return skg_alloc(rules->scene->count, sizeof *way->active, "dose", &way->active);
}

void skg_way_free(skg_way *way) {
    skg_free(&way->crossings);
    skg_free(&way->pieces);
    skg_free(&way->presences);
    skg_free(&way->winding);
    skg_free(&way->active);
}

/* A part that is entered once more or less; its number stays in the list as long as it is somewhere inside. */
static void turn(skg_way *way, int32_t part, int32_t by) {
    int64_t i = 0;
    const int32_t before = way->winding[part];
    way->winding[part] += by;
    if (before == 0 && by != 0) {
        way->active[way->active_count++] = part;
    } else if (way->winding[part] == 0) {
        while (way->active[i] != part) i++;
        way->active[i] = way->active[--way->active_count];
    }
}

/* How often a place counts as within a part, before others displace it. */
static int32_t within(const skg_rules *rules, const skg_way *way, int64_t part) {
    const int32_t winding = way->winding[part];
    return rules->unite ? winding > 0 : winding;
}

/* Whether another part with the same parent and a higher priority is there. */
static int is_displaced(const skg_rules *rules, const skg_way *way, int64_t part) {
    const skg_scene_part_data *parts = rules->scene->parts;
    if (within(rules, way, part) == 0) return 0;
    for (int64_t i = 0; i < way->active_count; i++) {
        const skg_scene_part_data *other = &parts[way->active[i]];
        if (other->inside == parts[part].inside && other->priority > parts[part].priority &&
            within(rules, way, way->active[i]) > 0)
            return 1;
    }
    return 0;
}

/* Winding number of a part at the current place of the way; 0 where it, or a part that it lies inside at any depth, is displaced or
 * clipped. */
static int32_t counted(const skg_rules *rules, const skg_way *way, int64_t part) {
    const skg_scene_part_data *parts = rules->scene->parts;
    for (int64_t up = part; rules->competing && up >= 0; up = parts[up].inside) {
        if (is_displaced(rules, way, up)) return 0;
        if (rules->clip && parts[up].inside >= 0 && within(rules, way, parts[up].inside) == 0) return 0;
    }
    return within(rules, way, part);
}

skg_status skg_way_add_piece(skg_way *way, double from, double to) {
    if (way->piece_count == way->piece_room) {
        const int64_t room = 2 * way->piece_room + 64;
        SKG_TRY(skg_realloc(room, sizeof *way->pieces, "dose", &way->pieces));
        way->piece_room = room;
    }
    way->pieces[way->piece_count++] = (skg_piece){from, to, way->presence_count, 0};
    return SKG_OK;
}

skg_status skg_way_add_presence(skg_way *way, const skg_presence *presence) {
    if (!(presence->share > 0))
        return SKG_OK; /* a part that leaves its parent takes away what is not there: a plan warns of it */
    if (way->presence_count == way->presence_room) {
        const int64_t room = 2 * way->presence_room + 64;
        SKG_TRY(skg_realloc(room, sizeof *way->presences, "dose", &way->presences));
        way->presence_room = room;
    }
    way->presences[way->presence_count++] = *presence;
    way->pieces[way->piece_count - 1].count++;
    return SKG_OK;
}

static skg_status add_presence(skg_way *way, int32_t part, double share) {
    const skg_presence presence = {.part = part, .share = share};
    return skg_way_add_presence(way, &presence);
}

/* Of the parts that are there, what is not displaced by those inside them. */
static skg_status add_piece(const skg_rules *rules, double from, double to, skg_way *way) {
    const skg_scene_part_data *parts = rules->scene->parts;
    int32_t world = 1;
    if (!(to > from)) return SKG_OK;
    SKG_TRY(skg_way_add_piece(way, from, to));
    for (int64_t i = 0; i < way->active_count; i++) {
        const int32_t part = way->active[i], own = counted(rules, way, part);
        int32_t rest = own;
        if (parts[part].inside < 0) world -= own;
        for (int64_t k = 0; k < way->active_count; k++)
            if (parts[way->active[k]].inside == part) rest -= counted(rules, way, way->active[k]);
        SKG_TRY(add_presence(way, part, rest));
    }
    return add_presence(way, -1, world);
}

/* Drops the crossings of other parts than the only one that is there. */
static void leave_alone(const skg_rules *rules, skg_way *way) {
    int64_t count = 0;
    for (int64_t i = 0; i < way->crossing_count; i++)
        if (way->crossings[i].part + 1 == rules->alone) way->crossings[count++] = way->crossings[i];
    way->crossing_count = count;
}

skg_status skg_way_find(const skg_forest *tree, const skg_rules *rules, const double from[3],
                        const double direction[3], double reach, skg_way *way) {
    double at = 0;
    SKG_TRY(reserve(rules, way));
    SKG_TRY(skg_way_cross(tree, from, direction, way));
    if (rules->alone) leave_alone(rules, way);
    way->piece_count = way->presence_count = 0;
    /* Where it begins, what it leaves later. */
    for (int64_t i = 0; i < way->crossing_count; i++)
        turn(way, way->crossings[i].part, -way->crossings[i].sign);
    skg_status status = SKG_OK;
    for (int64_t i = 0; i < way->crossing_count; i++) {
        const skg_crossing *c = &way->crossings[i];
        if (status == SKG_OK) status = add_piece(rules, at, fmin(c->at, reach), way);
        turn(way, c->part, c->sign);
        at = fmin(c->at, reach);
    }
    for (int64_t i = 0; i < way->active_count; i++) way->winding[way->active[i]] = 0; /* none: signs cancel */
    way->active_count = 0;
    return status == SKG_OK && isfinite(reach) ? add_piece(rules, at, reach, way) : status;
}
