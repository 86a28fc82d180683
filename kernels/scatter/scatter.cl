/* Histories of scattered photons. Each work-item follows SKG_WIDE photons side by side, and begins another where one has ended.
 *
 * A photon is made to interact in the object (its weight carries the probability) and to survive. From each interaction it
 * contributes to SKG_SCATTER_SIDE^2 places of the detector, and by where it flies on, if that is the detector. Either way could
 * do alone: they are combined by the balance heuristic (Veach and Guibas, Optimally combining sampling techniques for Monte
 * Carlo rendering, SIGGRAPH 1995), so that contributions stay finite however near the detector is. */
typedef struct {
    const skg_scatter_args *args;
    skg_object object;
    __global const skg_mix *energies, *momenta;
    __global const float *detector;
    __global uint *sums; /* of the batch */
    __global const float4 *lines; /* of shells that emit; with args.shells > 0 */
} skg_scattering;

/* Photons under way: `order` is the number of interactions so far. */
typedef struct {
    skg_place3 at, direction;
    skg_fv kev, weight;
    skg_fv x, y;  /* where they hit the detector, in shares of its sides */
    skg_fv share; /* of what they contribute where they fly on; the rest are the places on the detector */
    skg_fv reach; /* mm to the detector, if they fly to it: it stops them */
    skg_uv history, order;
    skg_intv alive, changed; /* -1 or 0; changed: a Compton scattering was among the interactions */
} skg_photons;

/* An interaction: what stands where it is. In 1/mm, and what normalises the shapes. */
typedef struct {
    skg_mixtures medium;
    skg_fv total, compton, rayleigh, compton_shape, rayleigh_shape;
    skg_fv emitted, line; /* fluorescence: photons, and the keV of one */
} skg_interaction;

/* Adds to 64-bit sums, low word first, of one lane. */
static void skg_deposit(__global uint *sums, int place, float value) {
    const long whole = convert_long_rte(value);
    volatile __global uint *word = (volatile __global uint *)sums + 2 * place;
    const uint low = (uint)whole;
    const uint old = low ? atomic_add(word, low) : 0;
    const uint high = (uint)((ulong)whole >> 32) + (uint)(old + low < old);
    if (high) atomic_add(word + 1, high);
}

/* The first four numbers of column SKG_OF_SIGNAL, which has no more. */
static void skg_find_signal(const skg_scattering *s, skg_fv place, float4 *signal) {
    const skg_rows rows = skg_rows_at(place);
    for (int l = 0; l < SKG_WIDE; l++) {
        __global const float4 *at =
            (__global const float4 *)(s->energies + rows.row[l] * SKG_SCATTER_COLUMNS + SKG_OF_SIGNAL);
        signal[l] = at[0] + (at[SKG_SCATTER_COLUMNS * SKG_FOURS] - at[0]) * rows.share[l];
    }
}

/* Tallies what photons bring to places (u, v) of the detector, 0 to 1, in the planes of their order and kind. */
static void skg_tally(const skg_scattering *s, skg_intv who, skg_uv order, skg_intv changed, skg_fv u,
                      skg_fv v, skg_place3 direction, skg_fv kev, skg_fv weight) {
    const skg_intv column = clamp(SKG_TO_INT_V(u * (skg_fv)((float)s->args->columns)), (skg_intv)(0),
                                  (skg_intv)(s->args->columns - 1));
    const skg_intv row =
        clamp(SKG_TO_INT_V(v * (skg_fv)((float)s->args->rows)), (skg_intv)(0), (skg_intv)(s->args->rows - 1));
    const skg_intv plane = min(SKG_AS_INT_V(order), (skg_intv)(3)) - 1 + (changed & 3);
    const skg_intv cell = row * s->args->columns + column,
                   cells = (skg_intv)(s->args->rows * s->args->columns);
    const skg_arrival arrival = skg_arrive(s->args, direction, kev);
    const int images = SKG_SCATTER_PLANES * s->args->rows * s->args->columns;
    float4 signal[SKG_WIDE];
    float weights[SKG_WIDE];
    int places[SKG_WIDE], wanted[SKG_WIDE];
    skg_find_signal(s, arrival.place, signal);
    if (s->args->grid) weight *= skg_through_grid(s->args, signal, u, v, direction, arrival.facing);
    SKG_STORE_V(intv, plane * cells + cell, places);
    int powers[SKG_WIDE];
    SKG_STORE_V(intv, SKG_SCATTER_KINDS * cells + cell, powers);
    SKG_STORE_V(intv, who & (weight > (skg_fv)(0.0f)), wanted);
    int bands[SKG_WIDE];
    skg_find_bands(s->args, s->detector, kev, bands);
    for (int layer = 0; layer < s->args->layers; layer++) {
        skg_fv part = weight;
        if (s->args->cosines > 0) part *= skg_layer_share(s->args, s->detector + s->args->edges, layer, &arrival);
        SKG_STORE_V(realv, part * (skg_fv)(s->args->scale), weights);
        for (int l = 0; l < SKG_WIDE; l++) {
            int image = layer * s->args->bands;
            if (!wanted[l]) continue;
            if (bands[l] < 0) continue;
            image += bands[l];
            skg_deposit(s->sums, image * images + places[l], weights[l] * signal[l].x);
            if (s->args->noise) skg_deposit(s->sums, image * images + powers[l], weights[l] * signal[l].y);
        }
    }
}

/* How likely a photon is scattered to an angle, per sr and interaction: by Compton scattering (Klein and Nishina, times S), which
 * leaves it *left keV, and by Rayleigh scattering (Thomson, times F^2). */
static void skg_differential(const skg_scattering *s, const skg_interaction *i, skg_fv kev, skg_fv cosine,
                             skg_fv *compton, skg_fv *rayleigh, skg_fv *left) {
    const skg_fv one = (skg_fv)(1.0f), less = max(one - cosine, (skg_fv)(0.0f));
    const skg_fv ratio = one / fma(kev * (skg_fv)(1.0f / SKG_ELECTRON_KEV), less, one);
    const skg_fv momentum =
        kev * (skg_fv)(1.0f / SKG_KEV_ANGSTROM) * skg_root_v(max(less * (skg_fv)(0.5f), (skg_fv)(1e-12f)));
    const skg_fv place = min(skg_float_log_v(fma(momentum, (skg_fv)(s->args->per_momentum), one)) *
                                 (skg_fv)(s->args->per_log_momentum),
                             (skg_fv)((float)s->args->momenta - 1.001f));
    const skg_fv klein = (skg_fv)(0.5f) * ratio * ratio * (ratio + one / ratio - less * (one + cosine));
    const skg_fv thomson = (skg_fv)(0.5f) * fma(cosine, cosine, one);
    const skg_rows rows = skg_rows_at(place);
    const skg_fv s_of = skg_value(s->momenta, 2, 0, &rows, &i->medium),
                 f_of = skg_value(s->momenta, 2, 1, &rows, &i->medium);
    const skg_fv tiny = (skg_fv)(1e-30f);
    *compton = i->compton * klein * s_of / max(i->compton_shape * i->total, tiny);
    *rayleigh = i->rayleigh * thomson * f_of / max(i->rayleigh_shape * i->total, tiny);
    *left = kev * ratio;
}

/* Fluorescence, per sr and interaction; and the share of interactions after which there is a photon. */
static skg_fv skg_glow(const skg_interaction *i) {
    return i->emitted * (skg_fv)(0.0795774715f) / max(i->total, (skg_fv)(1e-30f)); /* 1 / (4 pi) */
}

static skg_fv skg_albedo(const skg_interaction *i) {
    return (i->compton + i->rayleigh + i->emitted) / max(i->total, (skg_fv)(1e-30f));
}

/* The share of photons that come through sums of coefficients times mm. rows: of their energy */
static skg_fv skg_passes(const skg_scattering *s, const skg_mixtures *sums, const skg_rows *rows) {
    return skg_exp(-skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, rows, sums));
}

/* Contributions of an interaction to places of the detector, one in each of SKG_SCATTER_SIDE^2 equal pieces. */
static void skg_next_event(const skg_scattering *s, const skg_photons *p, const skg_sight *sight,
                           const skg_interaction *i, skg_fv across, skg_fv down) {
    const float side = 1.0f / SKG_SCATTER_SIDE;
    const skg_rows own = skg_rows_at(skg_energy_place(s->args, p->kev)),
                   line = skg_rows_at(skg_energy_place(s->args, i->line));
    for (int k = 0; k < SKG_SCATTER_SIDE * SKG_SCATTER_SIDE; k++) {
        const skg_fv u = (across + (skg_fv)((float)(k % SKG_SCATTER_SIDE))) * side;
        const skg_fv v = (down + (skg_fv)((float)(k / SKG_SCATTER_SIDE))) * side;
        skg_mixtures sums;
        skg_fv enter, compton, rayleigh, left, x, y;
        skg_sight_draw(sight, u, v, &x, &y);
        const skg_fv per_sr = skg_sight_per_sr(s->args, sight, x, y);
        const skg_fv distance = skg_root_v(fma(x, x, fma(y, y, sight->z * sight->z)));
        const skg_place3 direction = skg_sight_direction(s->args, sight, x, y, distance);
        const skg_intv seen = p->alive & sight->ahead;
        const skg_fv pu = (x - sight->x0) / s->args->side_u, pv = (y - sight->y0) / s->args->side_v;
        const skg_fv within = skg_within(s->args, p->at, direction, distance, &enter);
        const skg_fv length = seen ? within : (skg_fv)(0.0f);
        skg_optical_depth(s->args, &s->object, p->at, direction, enter, length, &sums);
        if (s->args->world_around) skg_add_world(&s->object, distance - length, &sums);
        skg_differential(s, i, p->kev, skg_dot3(p->direction, direction), &compton, &rayleigh, &left);
        /* The likelihood over those of both ways to get there: of all places, and of flying on. */
        const skg_fv glow = skg_glow(i);
        const skg_fv both = fma(per_sr, (skg_fv)((float)(SKG_SCATTER_SIDE * SKG_SCATTER_SIDE)),
                                (compton + rayleigh + glow) / max(skg_albedo(i), (skg_fv)(1e-30f)));
        const skg_fv weight = p->weight / max(both, (skg_fv)(1e-30f));
        const skg_rows lower = skg_rows_at(skg_energy_place(s->args, left));
        skg_tally(s, seen, p->order, p->changed, pu, pv, direction, p->kev,
                  weight * rayleigh * skg_passes(s, &sums, &own));
        skg_tally(s, seen, p->order, (skg_intv)(-1), pu, pv, direction, left,
                  weight * compton * skg_passes(s, &sums, &lower));
        if (s->args->shells > 0)
            skg_tally(s, seen, p->order, (skg_intv)(-1), pu, pv, direction, i->line,
                      weight * glow * skg_passes(s, &sums, &line));
    }
}

/* Lets photons fly on: emitted ones in any direction; the others in one from a table of equally likely angles for the whole object, the
 * weight by the cell's own likelihood over the table's. */
static void skg_fly_on(const skg_scattering *s, __global const float *angles, skg_photons *p,
                       const skg_sight *sight, const skg_interaction *i, skg_fv angle, skg_fv turn,
                       skg_fv process) {
    const skg_intv row = clamp(
        SKG_TO_INT_V(fma(skg_energy_place(s->args, p->kev), (skg_fv)(s->args->angle_rows), (skg_fv)(0.5f))),
        (skg_intv)(0), (skg_intv)(s->args->angle_last));
    const skg_fv place = angle * (skg_fv)((float)SKG_SCATTER_ANGLES);
    const skg_intv bin = clamp(SKG_TO_INT_V(place), (skg_intv)(0), (skg_intv)(SKG_SCATTER_ANGLES - 1));
    int from[SKG_WIDE];
    float low[SKG_WIDE], wide[SKG_WIDE];
    SKG_STORE_V(intv, row * (SKG_SCATTER_ANGLES + 1) + bin, from);
    for (int l = 0; l < SKG_WIDE; l++) low[l] = angles[from[l]], wide[l] = angles[from[l] + 1] - low[l];
    const skg_fv width = SKG_LOAD_V(realv, wide);
    const skg_fv one = (skg_fv)(1.0f), albedo = skg_albedo(i);
    const skg_fv glows = i->emitted / max(i->compton + i->rayleigh + i->emitted, (skg_fv)(1e-30f)), scatters = max(one - glows, (skg_fv)(1e-6f));
    const skg_intv emits = process < glows;
    process = (process - glows) / scatters;
    const skg_fv cosine = emits ? fma(angle, (skg_fv)(2.0f), -one) : fma(place - SKG_TO_FLOAT_V(bin), width, SKG_LOAD_V(realv, low));
    skg_fv compton, rayleigh, left, u, v;
    skg_differential(s, i, p->kev, cosine, &compton, &rayleigh, &left);
    const skg_fv sum = max(compton + rayleigh, (skg_fv)(1e-30f));
    p->weight *= emits ? albedo : sum * width * (skg_fv)(SKG_SCATTER_ANGLES * 6.28318531f) / scatters;
    p->direction = skg_deflect(p->direction, cosine, turn);
    const skg_intv changes = process * sum < compton;
    p->kev = emits ? i->line : changes ? left : p->kev;
    p->changed |= changes | emits;
    const skg_fv own = (sum + skg_glow(i)) / max(albedo, (skg_fv)(1e-30f));
    const skg_intv meets = skg_hit_detector(s->args, sight, p->direction, &u, &v);
    const skg_fv per_sr = skg_sight_per_sr(s->args, sight, u, v);
    p->x = (u - sight->x0) / s->args->side_u;
    p->y = (v - sight->y0) / s->args->side_v;
    p->share = meets ? own / fma(per_sr, (skg_fv)((float)(SKG_SCATTER_SIDE * SKG_SCATTER_SIDE)), own) : (skg_fv)(0.0f);
    p->reach = meets ? skg_root_v(fma(u, u, fma(v, v, sight->z * sight->z))) : (skg_fv)(SKG_SCATTER_FAR);
}

/* A photon whose weight is low dies, or goes on with that of several. */
static void skg_roulette(const skg_scatter_args *args, skg_photons *p, skg_fv word) {
    const skg_fv chance = min(p->weight * (skg_fv)(1.0f / SKG_SCATTER_LEAST), (skg_fv)(1.0f));
    const skg_intv stays = word < chance;
    p->weight = p->weight / max(chance, (skg_fv)(1e-30f));
    p->alive &= stays & (p->kev > (skg_fv)(args->min_kev)) & (p->order < (skg_uv)(SKG_SCATTER_ORDERS));
}

/* Photons that leave the source: the place in the field, the energy, the point of the focal spot. */
static void skg_emit(const skg_scattering *s, __constant const uint *lattice, __global const float4 *beam,
                     __global const float *profiles, __global const float4 *spots, uint batch, skg_intv fresh,
                     skg_photons *p) {
    const skg_scatter_args *args = s->args;
    const skg_fv u = skg_lattice(lattice, batch, p->history, SKG_DIM_U),
                 v = skg_lattice(lattice, batch, p->history, SKG_DIM_V);
    const skg_fv energy = skg_lattice(lattice, batch, p->history, SKG_DIM_ENERGY),
                 spot = skg_lattice(lattice, batch, p->history, SKG_DIM_SPOT);
    float at[SKG_WIDE], kev[SKG_WIDE], weight[SKG_WIDE], x[SKG_WIDE], y[SKG_WIDE], z[SKG_WIDE];
    int bins[SKG_WIDE];
    float per_mm[SKG_WIDE];
    SKG_STORE_V(realv, energy, at);
    SKG_STORE_V(realv, spot * (skg_fv)((float)args->spots), x);
    for (int l = 0; l < SKG_WIDE; l++) {
        int low = 0, high = args->bins - 1;
        while (low < high) {
            const int middle = (low + high) / 2;
            if (beam[middle].y > at[l])
                high = middle;
            else
                low = middle + 1;
        }
        kev[l] = beam[low].x;
        weight[l] = beam[low].z;
        bins[l] = low;
        per_mm[l] = beam[low].w;
        const float4 point = spots[min((int)x[l], args->spots - 1)];
        x[l] = point.x, y[l] = point.y, z[l] = point.z;
    }
    const skg_place3 source = {SKG_LOAD_V(realv, x), SKG_LOAD_V(realv, y), SKG_LOAD_V(realv, z)};
    const skg_place3 on = {
        fma((skg_fv)(args->field_u[0]), u, fma((skg_fv)(args->field_v[0]), v, (skg_fv)(args->field[0]))),
        fma((skg_fv)(args->field_u[1]), u, fma((skg_fv)(args->field_v[1]), v, (skg_fv)(args->field[1]))),
        fma((skg_fv)(args->field_u[2]), u, fma((skg_fv)(args->field_v[2]), v, (skg_fv)(args->field[2])))};
#if SKG_PARALLEL
    const skg_place3 direction = source; /* the beam's direction */
    skg_place3 begin = {fma(direction.x, (skg_fv)(-args->far), on.x), fma(direction.y, (skg_fv)(-args->far), on.y),
                        fma(direction.z, (skg_fv)(-args->far), on.z)};
    if (args->world_around) begin = skg_on(begin, direction, (skg_fv)(args->world_start) - skg_dot3(begin, direction));
    const skg_fv share = (skg_fv)(1.0f);
#else
    const skg_place3 to = {on.x - source.x, on.y - source.y, on.z - source.z}, begin = source;
    const skg_fv square = skg_dot3(to, to), one_over = (skg_fv)(1.0f) / skg_root_v(square);
    const skg_place3 direction = skg_times(to, one_over);
    /* Photons per sr: the field's area as the source sees it, over that at its middle. */
    const skg_fv facing = direction.x * args->normal[0] + direction.y * args->normal[1] + direction.z * args->normal[2];
    skg_fv share = facing * (skg_fv)(args->far * args->far) / square;
    if (args->heel_rows > 0) share *= skg_heel_share(args, profiles, bins, direction);
    if (args->fan_rows > 0) share *= skg_filter_share(args, profiles, per_mm, direction);
#endif
    p->at.x = fresh ? begin.x : p->at.x, p->at.y = fresh ? begin.y : p->at.y,
    p->at.z = fresh ? begin.z : p->at.z;
    p->direction.x = fresh ? direction.x : p->direction.x, p->direction.y = fresh ? direction.y : p->direction.y,
    p->direction.z = fresh ? direction.z : p->direction.z;
    p->kev = fresh ? SKG_LOAD_V(realv, kev) : p->kev;
    p->weight = fresh ? SKG_LOAD_V(realv, weight) * share : p->weight;
    p->order = fresh ? (skg_uv)(0) : p->order;
    p->changed &= ~fresh;
    p->share = fresh ? (skg_fv)(0.0f) : p->share;
    p->reach = fresh ? skg_until_plane(args, begin, direction) : p->reach;
    p->alive |= fresh;
}

/* Photons interact after `depth`, within what is around the cells, or in them. mu: 1/mm per coefficient; around: of the world */
static void skg_interact(const skg_scattering *s, skg_photons *p, const skg_mixtures *mu, skg_fv around, skg_fv before, skg_fv enter,
                         skg_fv length, skg_fv within, skg_fv depth, skg_mixtures *medium) {
    const skg_fv first = before * around, inside = depth - first, none = (skg_fv)(0.0f);
    const skg_intv ahead = inside < none, behind = ~ahead & (inside > within) & (around > none);
    const skg_intv here = p->alive & ~ahead & ~behind;
    skg_fv on = enter + skg_collide(s->args, &s->object, p->at, p->direction, enter, here ? length : none, mu, min(inside, within), medium);
    on = ahead ? depth / max(around, (skg_fv)(1e-30f)) : behind ? before + length + (inside - within) / max(around, (skg_fv)(1e-30f)) : on;
    p->at = skg_on(p->at, p->direction, on);
    if (!skg_any(ahead | behind)) return;
    int outside[SKG_WIDE];
    SKG_STORE_V(intv, ahead | behind, outside);
    for (int l = 0; l < SKG_WIDE; l++) {
        if (!outside[l]) continue;
        medium->of[l] = s->object.media[0];
    }
}

/* One flight of all photons: what they tally where they hit the detector, then to the next interaction. */
static void skg_flight(const skg_scattering *s, __constant const uint *lattice, __global const float *angles,
                       uint batch, skg_photons *p) {
    skg_uv a[4], b[4];
    skg_mixtures sums, mu;
    skg_interaction i;
    skg_sight sight;
    skg_fv enter;
    skg_words(s->args, p->history, p->order, batch, 0, a);
    skg_words(s->args, p->history, p->order, batch, 1, b);
    const skg_intv first = p->order == (skg_uv)(0), second = p->order == (skg_uv)(1);
#define SKG_DRAW(word, of_first, of_second)                                                                  \
    (first    ? skg_lattice(lattice, batch, p->history, of_first)                                         \
     : second ? skg_lattice(lattice, batch, p->history, of_second)                                        \
              : skg_uniform(word))
    const skg_fv within = skg_within(s->args, p->at, p->direction, p->reach, &enter);
    const skg_fv length = p->alive ? within : (skg_fv)(0.0f);
    skg_optical_depth(s->args, &s->object, p->at, p->direction, enter, length, &sums);
    const skg_fv place = skg_energy_place(s->args, p->kev);
    const skg_rows rows = skg_rows_at(place);
    const skg_fv within_cells = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, &rows, &sums);
    skg_fv depth = within_cells, around = (skg_fv)(0.0f), before = enter, behind = (skg_fv)(0.0f);
    if (s->args->world_around) {
        skg_mixtures world;
        for (int l = 0; l < SKG_WIDE; l++) world.of[l] = (skg_mix)(0.0f);
        skg_add_world(&s->object, (skg_fv)(1.0f), &world);
        around = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, &rows, &world);
        skg_around(s->args, p->at, p->direction, p->reach, enter, length, &before, &behind);
        depth += around * (before + behind);
    }
    const skg_fv passed = skg_exp(-depth);
    const skg_fv arrives = s->args->world_around ? skg_exp(-fma(around, p->reach - length, within_cells)) : passed;
    skg_tally(s, p->alive & (p->share > (skg_fv)(0.0f)), p->order, p->changed, p->x, p->y, p->direction, p->kev,
              p->weight * p->share * arrives);
    /* Somewhere on the way. */
    for (int l = 0; l < SKG_WIDE; l++) mu.of[l] = skg_mix_at(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, &rows, l);
    p->alive &= depth > (skg_fv)(1e-7f);
    const skg_fv chosen = SKG_DRAW(a[1], SKG_DIM_DEPTH, SKG_DIM_DEPTH_2), share = (skg_fv)(SKG_SCATTER_EVEN);
    const skg_intv evenly = chosen < share;
    const skg_fv rest = evenly ? chosen / share : (chosen - share) / ((skg_fv)(1.0f) - share);
    const skg_fv until =
        evenly ? rest * depth
               : -skg_float_log_v(max(fma(-rest, (skg_fv)(1.0f) - passed, (skg_fv)(1.0f)), (skg_fv)(1e-37f)));
    const skg_fv fall = skg_exp(-until);
    p->weight *= fall / (share / max(depth, (skg_fv)(1e-7f)) +
                         ((skg_fv)(1.0f) - share) * fall / max((skg_fv)(1.0f) - passed, (skg_fv)(1e-7f)));
    skg_interact(s, p, &mu, around, before, enter, length, within_cells, min(until, depth), &i.medium);
    p->order += 1;
    i.total = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, &rows, &i.medium);
    i.compton = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_COMPTON, &rows, &i.medium);
    i.rayleigh = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_RAYLEIGH, &rows, &i.medium);
    i.compton_shape = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_COMPTON_SHAPE, &rows, &i.medium);
    i.rayleigh_shape = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_RAYLEIGH_SHAPE, &rows, &i.medium);
    i.emitted = (skg_fv)(0.0f), i.line = p->kev;
    if (s->args->shells > 0)
        i.emitted = skg_fluorescence(s->args, s->energies + s->args->energies * SKG_SCATTER_COLUMNS, s->lines, &rows, &i.medium, skg_uniform(a[0]), &i.line);
    p->alive &= i.total > (skg_fv)(0.0f);
    skg_see(s->args, p->at, &sight);
    skg_next_event(s, p, &sight, &i, SKG_DRAW(a[2], SKG_DIM_SIGHT_U, SKG_DIM_SIGHT_U_2), SKG_DRAW(a[3], SKG_DIM_SIGHT_V, SKG_DIM_SIGHT_V_2));
    const skg_fv angle = first ? skg_lattice(lattice, batch, p->history, SKG_DIM_ANGLE) : skg_uniform(b[0]);
    const skg_fv turn = first ? skg_lattice(lattice, batch, p->history, SKG_DIM_TURN) : skg_uniform(b[1]);
    const skg_fv process = first ? skg_lattice(lattice, batch, p->history, SKG_DIM_PROCESS) : skg_uniform(b[2]);
    skg_fly_on(s, angles, p, &sight, &i, angle, turn, process);
    skg_words(s->args, p->history, p->order, batch, 2, a);
    skg_roulette(s->args, p, skg_uniform(a[0]));
}

/* media, tree, faces   the object (walk.clh)
 * energies  [energies][SKG_SCATTER_COLUMNS] what photons meet, by energy, then [energies][args.shells] what shells emit; momenta:
 *           [momenta][2] S and F^2
 * angles    [rows][SKG_SCATTER_ANGLES + 1] cosines between which scattering is equally likely
 * beam      [bins] energy, share of the bins up to this one, weight, 1/mm of a bow-tie filter; then lines of shells
 * profiles  of the heel effect and a bow-tie filter: their tables (profile.clh); else NULL
 * spots     [spots] points of the source, or the direction of a parallel beam
 * lattice   [SKG_SCATTER_DIMENSIONS] generating vector; then for each batch its shift
 * detector  [args.edges] edges of the bands, keV; then with args.cosines what layers record (arrive.clh); else NULL
 * sums      [batches][args.layers][bands][SKG_SCATTER_PLANES][rows][columns] 64-bit sums, low word first
 * Work-items: those of a batch, then batches. */
__kernel void skg_scatter(skg_scatter_args args, __global const skg_mix *media, __global const uint *tree, __global const float4 *faces,
                          __global const skg_mix *energies, __global const skg_mix *momenta,
                          __global const float *angles, __global const float4 *beam,
                          __global const float *profiles, __global const float4 *spots, __constant const uint *lattice, __global const float *detector,
                          __global uint *sums) {
    const uint batch = (uint)get_global_id(1);
    uint next = (uint)args.first + (uint)get_global_id(0) * (uint)args.each;
    const uint end = min(next + (uint)args.each, (uint)args.end);
    const int images = args.layers * args.bands * SKG_SCATTER_PLANES * args.rows * args.columns;
    const skg_scattering s = {&args, {media, tree, faces}, energies, momenta, detector, sums + (size_t)batch * 2 * (size_t)images, beam + args.bins};
    skg_photons p = {
        .alive = (skg_intv)(0), .changed = (skg_intv)(0), .history = (skg_uv)(0), .order = (skg_uv)(0)};
    uint numbers[SKG_WIDE];
    int alive[SKG_WIDE], fresh[SKG_WIDE];
    for (;;) {
        SKG_STORE_V(intv, p.alive, alive);
        SKG_STORE_V(intv, SKG_AS_INT_V(p.history), (int *)numbers);
        for (int l = 0; l < SKG_WIDE; l++) {
            fresh[l] = !alive[l] && next < end ? -1 : 0;
            if (fresh[l]) numbers[l] = next++;
        }
        p.history = SKG_AS_UINT_V(SKG_LOAD_V(intv, (int *)numbers));
        if (skg_any(SKG_LOAD_V(intv, fresh)))
            skg_emit(&s, lattice, beam, profiles, spots, batch, SKG_LOAD_V(intv, fresh), &p);
        if (!skg_any(p.alive)) break;
        skg_flight(&s, lattice, angles, batch, &p);
    }
}
