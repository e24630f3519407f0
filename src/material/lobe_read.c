// SPDX-License-Identifier: Apache-2.0
// Reading the tables of lobes.
#include "material/lobe_grid.h"
#include "material/lobe_table.h"

#include <string.h>

/** A lobe seen through its wrappers: what it takes to bring its coefficients to the surface. */
typedef struct Turn {
    Vec3 wo;     // of the lobe
    float angle; // by which its frame is turned about z
    bool behind; // seen from behind
} Turn;

/** @return false when nothing is seen, or when something else than a turn or the other side is between. */
static bool turn_of(const Bsdf *bsdf, const BsdfLobe *lobe, Vec3 wo, Turn *out)
{
    BsdfWay way;
    if (!sheen_bsdf_way(bsdf, lobe, wo, &way)) return false;
    *out = (Turn){.wo = bsdf_way_wo(&way), .behind = wo.z < 0.0f};
    for (int i = 0; i < way.n; ++i) {
        const BsdfWrap *wrap = way.wraps[i];
        if (wrap->kind == SHEEN_WRAP_COAT || (wrap->kind == SHEEN_WRAP_FRAME && wrap->material)) return false;
        if (wrap->kind == SHEEN_WRAP_FRAME) out->angle += atan2f(wrap->frame.t.y, wrap->frame.t.x);
    }
    return out->wo.z > 0.0f;
}

/** The factors of a lobe's shapes, and how the energies of pairs of shapes add up to that of all its channels. */
typedef struct Factors {
    Rgb a[LOBE_SHAPES_MAX];
    float pair[LOBE_SHAPES_MAX * (LOBE_SHAPES_MAX + 1) / 2];
} Factors;

static void factors_of(const LobeTable *t, const BsdfLobe *lobe, Factors *out)
{
    sheen_lobe_factors(&t->family, lobe, out->a);
    for (unsigned i = 0, pair = 0; i < t->node.n_shapes; ++i)
        for (unsigned j = i; j < t->node.n_shapes; ++j) {
            Rgb p = rgb_mul(out->a[i], out->a[j]);
            out->pair[pair++] = (i == j ? 1.0f : 2.0f) * (p.r + p.g + p.b);
        }
}

/** Energy that is missing at order n. */
static float missing_at(const LobeTable *t, const float *data, const LobeTaps *taps, const Factors *f, unsigned n)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < taps->n; ++i) {
        if (taps->linear[i] == 0.0f) continue;
        const float *at = data + (size_t)taps->node[i] * t->node.size + t->node.missing + n * t->node.n_pairs;
        float here = 0.0f;
        for (unsigned pair = 0; pair < t->node.n_pairs; ++pair) here += f->pair[pair] * at[pair];
        sum += taps->linear[i] * here;
    }
    return sum;
}

/** Which order a lobe takes, and what of its last band, so that nothing jumps where the order changes. */
typedef struct Choice {
    unsigned n;
    float band, error, share;
} Choice;

static Choice choose(const SheenLobeTables *all, const LobeTable *t, const float *data, const LobeTaps *taps,
                     const Factors *f, unsigned most)
{
    float energy = missing_at(t, data, taps, f, 0), allowed = all->error;
    if (!(energy > 0.0f)) return (Choice){.n = 0};
    float end = missing_at(t, data, taps, f, all->n) / energy;
    Choice c = {.share = smoothstep((allowed - end) / (0.5f * allowed)) * taps->fade, .band = 1.0f};
    if (!(c.share > 0.0f)) return (Choice){.n = 0};
    float before = 1.0f, error = 1.0f;
    float wanted = LOBE_FINE * allowed;
    while (c.n < most && !(error <= wanted)) {
        before = error;
        error = missing_at(t, data, taps, f, ++c.n) / energy;
    }
    if (error < wanted && before > error) c.band = clampf((before - wanted) / (before - error), 0.0f, 1.0f);
    c.error = maxf(error + sqrf(1.0f - c.band) * (before - error), 0.0f);
    return c;
}

/** Even or odd in x (1) and y (2) of wo: as the basis function itself is. */
static unsigned parity_of(int m)
{
    return m >= 0 ? (unsigned)m & 1u : 2u | (((unsigned)-m + 1u) & 1u);
}

/** The interpolated coefficient of a shape. @param at  of the first node, number of the coefficient included */
static float interpolate(const LobeTable *t, const float *at, const LobeTaps *taps, unsigned parity)
{
    float sum = 0.0f;
    for (unsigned i = 0; i < taps->n; ++i) sum += taps->weight[parity][i] * at[(size_t)taps->node[i] * t->node.size];
    return sum;
}

static Rgb value_of(const LobeTable *t, const float *at, const LobeTaps *taps, const Factors *f, unsigned parity)
{
    Rgb sum = rgb_gray(0.0f);
    for (unsigned k = 0; k < t->node.n_shapes; ++k)
        sum = rgb_mad(sum, interpolate(t, at + k * t->node.coefficients, taps, parity), f->a[k]);
    return sum;
}

/** Adds the pair (l, m), (l, -m) turned by an angle: c and s are the cosine and sine of m times it. */
static void add_turned(Rgb out[], unsigned l, int m, Rgb even, Rgb odd, float c, float s)
{
    Rgb *to_even = &out[basis_index(l, m)], *to_odd = &out[basis_index(l, -m)];
    *to_even = rgb_add(*to_even, rgb_sub(rgb_scale(even, c), rgb_scale(odd, s)));
    *to_odd = rgb_add(*to_odd, rgb_add(rgb_scale(even, s), rgb_scale(odd, c)));
}

typedef struct Reader {
    const LobeTable *t;
    const float *data;
    SheenBasis basis;
    const Turn *turn;
    const LobeTaps *taps;
    const Factors *factors;
    float flip_x, flip_y;                                 // -1 where the table is read mirrored
    float cos_m[SHEEN_ORDER_MAX], sin_m[SHEEN_ORDER_MAX]; // of m times the angle by which it is turned
} Reader;

/** The value of function (l, m) in the own frame of an anisotropic lobe. */
static Rgb value_at(const Reader *r, unsigned l, int m)
{
    unsigned parity = parity_of(m);
    size_t index = basis_index(l, m);
    float sign = (parity & 1u ? r->flip_x : 1.0f) * (parity & 2u ? r->flip_y : 1.0f);
    // What the harmonics of the whole sphere are below the surface.
    if (r->turn->behind && r->basis == SHEEN_BASIS_SH && (((int)l + m) & 1)) sign = -sign;
    return rgb_scale(value_of(r->t, r->data + index, r->taps, r->factors, parity), sign);
}

static void add_band(const Reader *r, unsigned l, float scale, Rgb out[])
{
    out[basis_index(l, 0)] = rgb_mad(out[basis_index(l, 0)], scale, value_at(r, l, 0));
    for (int m = 1; m <= (int)l; ++m) {
        Rgb odd = value_at(r, l, -m);
        add_turned(out, l, m, rgb_scale(value_at(r, l, m), scale), rgb_scale(odd, scale), r->cos_m[m], r->sin_m[m]);
    }
}

// Adds a shape of an isotropic lobe, of which there are terms of cos(m phi) alone: all that nodes hold side by side is
// interpolated at once, as if m were even and as if it were odd.
static void add_isotropic(const Reader *r, unsigned shape, const Choice *c, float scale, Rgb out[])
{
    float even[SHEEN_ZENITH_MAX], odd[SHEEN_ZENITH_MAX];
    size_t n = (size_t)c->n * (c->n + 1) / 2;
    for (size_t z = 0; z < n; ++z) even[z] = odd[z] = 0.0f;
    for (unsigned i = 0; i < r->taps->n; ++i) {
        const float *node = r->data + (size_t)r->taps->node[i] * r->t->node.size + shape * r->t->node.coefficients;
        float a = r->taps->weight[0][i], b = r->taps->weight[1][i];
        for (size_t z = 0; z < n; ++z) even[z] += a * node[z], odd[z] += b * node[z];
    }
    Rgb factor = rgb_scale(r->factors->a[shape], scale);
    bool below = r->turn->behind && r->basis == SHEEN_BASIS_SH;
    for (unsigned l = 0; l < c->n; ++l) {
        Rgb band = rgb_scale(factor, l + 1 == c->n ? c->band : 1.0f);
        for (unsigned m = 0; m <= l; ++m) {
            float value = (m & 1u ? odd : even)[basis_zenith_index(l, m)];
            if (below && ((l + m) & 1u)) value = -value;
            Rgb *plus = &out[basis_index(l, (int)m)], *minus = &out[basis_index(l, -(int)m)];
            *plus = rgb_mad(*plus, value * r->cos_m[m], band);
            if (m) *minus = rgb_mad(*minus, value * r->sin_m[m], band);
        }
    }
}

// Powers of one turn, which is exact enough for the few that there are.
static void turns(unsigned n, float angle, Reader *r)
{
    float c = cosf(angle), s = sinf(angle);
    r->cos_m[0] = 1.0f, r->sin_m[0] = 0.0f;
    for (unsigned m = 1; m < n; ++m) {
        r->cos_m[m] = r->cos_m[m - 1] * c - r->sin_m[m - 1] * s;
        r->sin_m[m] = r->sin_m[m - 1] * c + r->cos_m[m - 1] * s;
    }
}

/** Adds a lobe to the coefficients. @return its choice */
static Choice add_lobe(const SheenLobeTables *all, const LobeTable *t, SheenBasis basis, const BsdfLobe *lobe,
                       const Turn *turn, Rgb out[])
{
    LobeTaps taps;
    Factors factors;
    Vec3 wo = turn->wo;
    float across = sqrtf(wo.x * wo.x + wo.y * wo.y);
    bool isotropic = t->node.isotropic;
    Vec3 at = isotropic ? v3(across, 0.0f, wo.z) : v3(fabsf(wo.x), fabsf(wo.y), wo.z);
    sheen_lobe_taps(t, at, lobe->microfacet.alpha_u, &taps);
    if (!(taps.fade > 0.0f)) return (Choice){.n = 0};
    factors_of(t, lobe, &factors);
    const float *data = t->data[basis];
    Choice c = choose(all, t, data, &taps, &factors, t->order[basis]);
    Reader reader;
    reader.t = t, reader.data = data, reader.basis = basis;
    reader.turn = turn, reader.taps = &taps, reader.factors = &factors;
    reader.flip_x = reader.flip_y = 1.0f;
    if (!isotropic && wo.x < 0.0f) reader.flip_x = -1.0f;
    if (!isotropic && wo.y < 0.0f) reader.flip_y = -1.0f;
    float angle = turn->angle + (isotropic && across > 0.0f ? atan2f(wo.y, wo.x) : 0.0f);
    turns(c.n, angle, &reader);
    float scale = c.share * lobe->weight;
    for (unsigned k = 0; isotropic && k < t->node.n_shapes; ++k) add_isotropic(&reader, k, &c, scale, out);
    for (unsigned l = 0; !isotropic && l < c.n; ++l) add_band(&reader, l, scale * (l + 1 == c.n ? c.band : 1.0f), out);
    return c;
}

void sheen_lobe_table_read(const SheenLobeTables *tables, SheenBasis basis, const Bsdf *bsdf, Vec3 wo_l,
                           Rgb coefficients[], LobeReading *out)
{
    memset(out, 0, sizeof *out);
    unsigned order = sheen_lobe_tables_order(tables);
    for (size_t i = 0; i < basis_size(order); ++i) coefficients[i] = rgb_gray(0.0f);
    for (uint32_t i = 0; order > 0 && i < bsdf->n_lobes; ++i) {
        const BsdfLobe *lobe = &bsdf->lobes[i];
        unsigned slot = sheen_lobe_slot(lobe);
        if (slot >= LOBE_SLOTS_MAX || !(lobe->weight > 0.0f)) continue;
        uint32_t table = tables->slots[lobe->material - tables->scene->materials][slot];
        Turn turn;
        if (table == 0 || tables->tables[table - 1].order[basis] == 0 || !turn_of(bsdf, lobe, wo_l, &turn)) continue;
        Choice c = add_lobe(tables, &tables->tables[table - 1], basis, lobe, &turn, coefficients);
        out->share[i] = c.share;
        out->error = maxf(out->error, c.error);
        if (c.n > out->order) out->order = c.n;
    }
}
