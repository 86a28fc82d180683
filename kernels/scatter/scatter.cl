/* Histories of scattered photons. Each work-item follows SKG_WIDE photons side by side, and begins another where one has ended.
 *
 * A photon is made to interact in the object (its weight carries the probability) and to survive. From each interaction it
 * contributes to skg_side^2 places of the detector, and by where it flies on, if that is the detector. Either way could
 * do alone: they are combined by the balance heuristic (Veach and Guibas, Optimally combining sampling techniques for Monte
 * Carlo rendering, SIGGRAPH 1995), so that contributions stay finite however near the detector is. */

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
    p->share = meets ? own / fma(per_sr, (skg_fv)((float)(skg_side(s) * skg_side(s))), own) : (skg_fv)(0.0f);
    p->reach = meets ? skg_root_v(fma(u, u, fma(v, v, sight->z * sight->z))) : (skg_fv)(SKG_SCATTER_FAR);
}

/* A photon whose weight is low dies, or goes on with that of several. */
static void skg_roulette(const skg_scatter_args *args, skg_photons *p, skg_fv word) {
    const skg_fv chance = min(p->weight * (skg_fv)(1.0f / SKG_SCATTER_LEAST), (skg_fv)(1.0f));
    const skg_intv stays = word < chance;
    p->weight = p->weight / max(chance, (skg_fv)(1e-30f));
    p->alive &= stays & (p->kev > (skg_fv)(args->min_kev)) & (p->order < (skg_uv)(SKG_SCATTER_ORDERS));
}

/* A way to the next interaction. */
typedef struct {
    skg_fv enter, length, before, behind; /* mm: to the cells, through them; of the world before and behind them */
    skg_fv around;                        /* 1/mm of the world */
    skg_fv depth;                         /* of all */
} skg_way;

static skg_way skg_way_ahead(const skg_scattering *s, const skg_photons *p, const skg_rows *rows) {
    skg_way way = {.around = (skg_fv)(0.0f), .behind = (skg_fv)(0.0f)};
    skg_mixtures sums;
    const skg_fv within = skg_within(s->args, p->at, p->direction, p->reach, &way.enter);
    way.length = p->alive ? within : (skg_fv)(0.0f);
    way.before = way.enter;
    skg_optical_depth(s->args, &s->object, p->at, p->direction, way.enter, way.length, &sums);
    way.depth = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, rows, &sums);
    if (s->args->world_around == 0) return way;
    skg_mixtures world;
    for (int l = 0; l < SKG_WIDE; l++) world.of[l] = (skg_mix)(0.0f);
    skg_add_world(&s->object, (skg_fv)(1.0f), &world);
    way.around = skg_value(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, rows, &world);
    skg_around(s->args, p->at, p->direction, p->reach, way.enter, way.length, &way.before, &way.behind);
    way.depth += way.around * (way.before + way.behind);
    return way;
}

/* The optical depth of the next interaction, from a number from 0 to 1: even up to what lies ahead, or as photons have it. Weights make
 * good for it. */
static skg_fv skg_draw_depth(skg_photons *p, skg_fv all, skg_fv number) {
    const skg_fv one = (skg_fv)(1.0f), share = (skg_fv)(SKG_SCATTER_EVEN), depth = max(all, (skg_fv)(1e-7f));
    const skg_fv passed = skg_exp(-all);
    const skg_intv evenly = number < share;
    const skg_fv rest = evenly ? number / share : (number - share) / (one - share);
    const skg_fv until = evenly ? rest * all : -skg_float_log_v(max(fma(-rest, one - passed, one), (skg_fv)(1e-37f)));
    const skg_fv fall = skg_exp(-until);
    p->weight *= fall / (share / depth + (one - share) * fall / max(one - passed, (skg_fv)(1e-7f)));
    return min(until, all);
}

/* Photons interact after an optical depth, before the cells, in them or behind them. mu: 1/mm per coefficient */
static void skg_interact(const skg_scattering *s, skg_photons *p, const skg_mixtures *mu, const skg_way *way, skg_fv depth,
                         skg_mixtures *medium) {
    const skg_fv none = (skg_fv)(0.0f), per = max(way->around, (skg_fv)(1e-30f));
    const skg_fv inside = fma(-way->before, way->around, depth);
    const skg_intv ahead = inside < none;
    skg_fv left = inside;
    skg_fv on = way->enter + skg_collide(s->args, &s->object, p->at, p->direction, way->enter, p->alive & ~ahead ? way->length : none, mu, &left, medium);
    const skg_intv passes = ~ahead & (left > none), world = passes & (way->around > none);
    on = ahead ? depth / per : world ? way->before + way->length + left / per : on;
    p->at = skg_on(p->at, p->direction, on);
    if (!skg_any(ahead | world)) return;
    int outside[SKG_WIDE];
    SKG_STORE_V(intv, ahead | world, outside);
    for (int l = 0; l < SKG_WIDE; l++) {
        if (!outside[l]) continue;
        medium->of[l] = s->object.media[0];
    }
}

/* Cross sections at the places where photons interact, and the energy of a line of fluorescence. draw: chooses the line of a shell that
 * emits */
static void skg_find_interaction(const skg_scattering *s, const skg_photons *p, const skg_rows *rows, skg_fv draw, skg_interaction *i) {
    skg_fv *const values[] = {&i->total, &i->compton, &i->rayleigh, &i->compton_shape, &i->rayleigh_shape};
    for (int k = 0; k < SKG_OF_SIGNAL; k++) *values[k] = skg_value(s->energies, SKG_SCATTER_COLUMNS, k, rows, &i->medium);
    i->emitted = (skg_fv)(0.0f), i->line = p->kev;
    if (s->args->shells > 0)
        i->emitted = skg_fluorescence(s->args, s->energies + s->args->energies * SKG_SCATTER_COLUMNS, s->lines, rows, &i->medium, draw, &i->line);
}

/* One flight of all photons to the next interaction, and what they tally there. */
static void skg_flight(const skg_scattering *s, __constant const uint *lattice, __global const float *angles,
                       uint batch, skg_photons *p) {
    skg_uv a[4], b[4];
    skg_mixtures mu;
    skg_interaction i;
    skg_sight sight;
    skg_words(s->args, p->history, p->order, batch, 0, a);
    skg_words(s->args, p->history, p->order, batch, 1, b);
    const skg_intv first = p->order == (skg_uv)(0), second = p->order == (skg_uv)(1);
#define SKG_DRAW(word, of_first, of_second)                                                                  \
    (first    ? skg_lattice(lattice, batch, p->history, of_first)                                         \
     : second ? skg_lattice(lattice, batch, p->history, of_second)                                        \
              : skg_uniform(word))
    const skg_rows rows = skg_rows_at(skg_energy_place(s->args, p->kev));
    const skg_way way = skg_way_ahead(s, p, &rows);
    for (int l = 0; l < SKG_WIDE; l++) mu.of[l] = skg_mix_at(s->energies, SKG_SCATTER_COLUMNS, SKG_OF_TOTAL, &rows, l);
    p->alive &= way.depth > (skg_fv)(1e-7f);
    skg_interact(s, p, &mu, &way, skg_draw_depth(p, way.depth, SKG_DRAW(a[1], SKG_DIM_DEPTH, SKG_DIM_DEPTH_2)), &i.medium);
    p->order += 1;
    skg_find_interaction(s, p, &rows, skg_uniform(a[0]), &i);
    p->alive &= i.total > (skg_fv)(0.0f);
    skg_see(s->args, p->at, &sight);
    skg_photons on = *p;
    const skg_fv angle = first ? skg_lattice(lattice, batch, p->history, SKG_DIM_ANGLE) : skg_uniform(b[0]);
    const skg_fv turn = first ? skg_lattice(lattice, batch, p->history, SKG_DIM_TURN) : skg_uniform(b[1]);
    const skg_fv process = first ? skg_lattice(lattice, batch, p->history, SKG_DIM_PROCESS) : skg_uniform(b[2]);
    skg_fly_on(s, angles, &on, &sight, &i, angle, turn, process);
    skg_next_event(s, p, &on, &sight, &i, SKG_DRAW(a[2], SKG_DIM_SIGHT_U, SKG_DIM_SIGHT_U_2), SKG_DRAW(a[3], SKG_DIM_SIGHT_V, SKG_DIM_SIGHT_V_2), b[3]);
    *p = on;
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
    const skg_scattering s = {&args,
                              {media, tree, faces},
                              energies, momenta, detector, sums + (size_t)batch * 2 * (size_t)images, beam + args.bins};
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
            skg_emit(&args, lattice, beam, profiles, spots, batch, SKG_LOAD_V(intv, fresh), &p);
        if (!skg_any(p.alive)) break;
        skg_flight(&s, lattice, angles, batch, &p);
    }
}
