// SPDX-License-Identifier: Apache-2.0
#include "light/choose.h"

// Up to this many lights are compared one with another.
#define FLAT_MAX 256u
// Estimates on the stack: of the lights of a group, or of all groups and the lights without a place.
#define GROUPS_MAX 1024u
#define WEIGHTS_MAX (GROUPS_MAX + CHOOSE_INFINITE_MAX)
_Static_assert(GROUPS_MAX *GROUPS_MAX == CHOOSE_MAX, "groups are as large as they are many");

typedef struct Weights {
    float w[WEIGHTS_MAX + ESTIMATE_PADDING];
    uint32_t n;
    float sum; // 0 when it is not finite
} Weights;

static void add_up(Weights *w, uint32_t n)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < n; ++i) sum += w->w[i];
    w->n = n;
    w->sum = isfinite(sum) ? sum : 0.0f;
}

static void weigh_lights(const Chooser *c, uint32_t first, uint32_t count, Vec3 p, Vec3 n, Weights *w)
{
    sheen_estimate_table_weigh(&c->table, first, count, p, n, w->w);
    add_up(w, count);
}

static void weigh_groups(const Chooser *c, Vec3 p, Vec3 n, Weights *w)
{
    uint32_t n_infinite = c->n - c->n_placed;
    sheen_bodies_weigh(&c->groups, 0, c->n_groups, p, n, w->w);
    sheen_estimate_table_weigh(&c->table, c->n_placed, n_infinite, p, n, w->w + c->n_groups);
    add_up(w, c->n_groups + n_infinite);
}

static uint32_t group_count(const Chooser *c, uint32_t group)
{
    uint32_t first = group * c->group_size;
    return c->n_placed - first < c->group_size ? c->n_placed - first : c->group_size;
}

// The last entry above zero takes what rounding of the sums leaves over. @return the probability, 0 for none
static float pick(const Weights *w, float *u, uint32_t *index)
{
    if (!(w->sum > 0.0f)) return 0.0f;
    float target = *u * w->sum, before = 0.0f, sum = 0.0f;
    for (uint32_t i = 0; i < w->n && sum <= target; ++i) {
        if (!(w->w[i] > 0.0f)) continue;
        before = sum;
        sum += w->w[i];
        *index = i;
    }
    *u = clampf((target - before) / w->w[*index], 0.0f, 0x1.fffffep-1f);
    return w->w[*index] / w->sum;
}

float sheen_chooser_pick(const Chooser *c, Vec3 p, Vec3 n, float *u, uint32_t *light)
{
    *light = 0;
    if (c->n <= 1) return c->n == 1 ? 1.0f : 0.0f; // nothing to compare
    Weights w;
    if (c->n_groups == 0) {
        weigh_lights(c, 0, c->n, p, n, &w);
        return pick(&w, u, light);
    }
    uint32_t group = 0;
    weigh_groups(c, p, n, &w);
    float of_group = pick(&w, u, &group);
    if (of_group == 0.0f) return 0.0f;
    if (group >= c->n_groups) {
        *light = c->n_placed + (group - c->n_groups);
        return of_group;
    }
    uint32_t first = group * c->group_size;
    weigh_lights(c, first, group_count(c, group), p, n, &w);
    float in_group = pick(&w, u, light);
    *light += first;
    return of_group * in_group;
}

static float share(const Weights *w, uint32_t index)
{
    return w->sum > 0.0f ? w->w[index] / w->sum : 0.0f;
}

float sheen_chooser_probability(const Chooser *c, Vec3 p, Vec3 n, uint32_t light)
{
    if (c->n == 1) return 1.0f;
    Weights w;
    if (c->n_groups == 0) {
        weigh_lights(c, 0, c->n, p, n, &w);
        return share(&w, light);
    }
    weigh_groups(c, p, n, &w);
    if (light >= c->n_placed) return share(&w, c->n_groups + (light - c->n_placed));
    uint32_t group = light / c->group_size;
    float of_group = share(&w, group);
    weigh_lights(c, group * c->group_size, group_count(c, group), p, n, &w);
    return of_group * share(&w, light % c->group_size);
}

// ---- groups -----------------------------------------------------------------------------------------------------

// A group is a body that shines every way.
static void set_group(Chooser *c, uint32_t group, const Source sources[])
{
    Bounds box = bounds_empty();
    double power = 0.0;
    uint32_t count = group_count(c, group);
    for (const Source *s = sources + (size_t)group * c->group_size, *end = s + count; s < end; ++s) {
        Vec3 r = v3(s->radius, s->radius, s->radius);
        box = bounds_add(bounds_add(box, v3_sub(s->center, r)), v3_add(s->center, r));
        power += (double)s->power;
    }
    Vec3 center = bounds_center(&box);
    Bodies *b = &c->groups;
    b->x[group] = center.x, b->y[group] = center.y, b->z[group] = center.z;
    b->r2[group] = sqrf(bounds_radius(&box) * 1.0001f);
    b->cos_cone[group] = -1.0f;
    b->power[group] = (float)power;
}

bool sheen_chooser_init(const Source sources[], uint32_t n, SheenArena *arena, Chooser *c)
{
    *c = (Chooser){.n = n};
    if (!sheen_estimate_table_init(sources, n, arena, &c->table)) return false;
    while (c->n_placed < n && !isinf(sources[c->n_placed].radius)) ++c->n_placed;
    if (n <= FLAT_MAX) return true;
    c->group_size = (uint32_t)ceil(sqrt(c->n_placed));
    c->n_groups = (c->n_placed + c->group_size - 1) / c->group_size;
    if (!sheen_bodies_init(c->n_groups, arena, &c->groups)) return false;
    for (uint32_t i = 0; i < c->n_groups; ++i) set_group(c, i, sources);
    return true;
}
