// SPDX-License-Identifier: Apache-2.0
#include "scene/material_check.h"

#include "math/fresnel.h"
#include "scene/coat.h"

#include <stddef.h>

/** What a kind is made of. */
typedef struct Traits {
    uint8_t n_lobes, n_nested, n_wraps; // its own, without what is nested
    bool has_ior, has_alpha, anisotropic, coat, two_sides;
} Traits;

static const Traits traits_of_kind[] = {
    [SHEEN_MATERIAL_DIFFUSE] = {.n_lobes = 1},
    [SHEEN_MATERIAL_CONDUCTOR] = {.n_lobes = 1},
    [SHEEN_MATERIAL_DIELECTRIC] = {.n_lobes = 1, .has_ior = true, .two_sides = true},
    [SHEEN_MATERIAL_THIN_DIELECTRIC] = {.n_lobes = 1, .has_ior = true},
    [SHEEN_MATERIAL_ROUGH_CONDUCTOR] = {.n_lobes = 1, .has_alpha = true, .anisotropic = true},
    [SHEEN_MATERIAL_ROUGH_DIELECTRIC] =
        {.n_lobes = 1, .has_ior = true, .has_alpha = true, .anisotropic = true, .two_sides = true},
    [SHEEN_MATERIAL_PLASTIC] = {.n_lobes = 2, .has_ior = true},
    [SHEEN_MATERIAL_ROUGH_PLASTIC] = {.n_lobes = 2, .has_ior = true, .has_alpha = true, .coat = true},
    [SHEEN_MATERIAL_DIFFUSE_TRANSMIT] = {.n_lobes = 1},
    [SHEEN_MATERIAL_PHONG] = {.n_lobes = 2},
    [SHEEN_MATERIAL_WARD] = {.n_lobes = 2, .has_alpha = true, .anisotropic = true},
    [SHEEN_MATERIAL_PRINCIPLED] = {.n_lobes = 3, .has_ior = true, .anisotropic = true},
    [SHEEN_MATERIAL_PRINCIPLED_THIN] = {.n_lobes = 4, .has_ior = true, .anisotropic = true},
    [SHEEN_MATERIAL_LAFORTUNE] = {.n_lobes = 1, .anisotropic = true},
    [SHEEN_MATERIAL_ROUGH_DIFFUSE] = {.n_lobes = 1},
    [SHEEN_MATERIAL_BLEND] = {.n_nested = 2},
    [SHEEN_MATERIAL_SIDES] = {.n_nested = 2, .n_wraps = 2},
    [SHEEN_MATERIAL_MASK] = {.n_lobes = 1, .n_nested = 1},
    [SHEEN_MATERIAL_BUMP] = {.n_nested = 1, .n_wraps = 1},
    [SHEEN_MATERIAL_NORMAL] = {.n_nested = 1, .n_wraps = 1},
    [SHEEN_MATERIAL_COATING] = {.n_lobes = 1, .n_nested = 1, .n_wraps = 1, .has_ior = true},
    [SHEEN_MATERIAL_ROUGH_COATING] =
        {.n_lobes = 1, .n_nested = 1, .n_wraps = 1, .has_ior = true, .has_alpha = true, .coat = true},
};

_Static_assert(sizeof traits_of_kind / sizeof *traits_of_kind == SHEEN_MATERIAL_COUNT, "each kind has its traits");

typedef struct Check {
    const SheenLog *log;
    const char *scene;
    SheenMaterial *m;
} Check;

/** @return x in [lo, hi], with a warning where that is another number; `otherwise` for NaN. */
static float in_range(const Check *c, const char *what, float x, float lo, float hi, float otherwise)
{
    if (x >= lo && x <= hi) return x;
    float good = x < lo ? lo : x > hi ? hi : otherwise;
    sheen_warn(c->log, "%s: material '%s': %s is %g, outside [%g, %g]: taken as %g", c->scene, c->m->name, what,
               (double)x, (double)lo, (double)hi, (double)good);
    return good;
}

/** The same for the numbers of a texture that counts by its luminance. */
static void texture_in_range(const Check *c, const char *what, SheenTexture *t, float lo, float hi, float otherwise)
{
    if (t->kind == SHEEN_TEXTURE_BITMAP) return;
    Rgb *values[] = {&t->value, &t->value2};
    for (int i = 0; i < (sheen_texture_has_two_values(t) ? 2 : 1); ++i) {
        float x = rgb_luminance(*values[i]);
        // Rounding of the luminance alone is no mistake.
        if (!(x >= lo * (1.0f - 1e-5f) && x <= hi * (1.0f + 1e-5f)))
            *values[i] = rgb_gray(in_range(c, what, x, lo, hi, otherwise));
    }
}

static bool same_texture(const SheenTexture *a, const SheenTexture *b)
{
    bool same = a->kind == b->kind && a->value.r == b->value.r && a->value.g == b->value.g && a->value.b == b->value.b;
    if (!same || a->kind == SHEEN_TEXTURE_CONSTANT) return same;
    for (int i = 0; i < 6; ++i) same = same && a->uv[i / 3][i % 3] == b->uv[i / 3][i % 3];
    return same && a->value2.g == b->value2.g && a->bitmap.bytes == b->bitmap.bytes &&
           a->bitmap.floats == b->bitmap.floats && a->wrap_u == b->wrap_u && a->wrap_v == b->wrap_v &&
           a->nearest == b->nearest && a->line_width == b->line_width && a->scale.r == b->scale.r &&
           a->scale.g == b->scale.g && a->scale.b == b->scale.b;
}

static bool is_zero(const SheenTexture *t)
{
    return t->kind == SHEEN_TEXTURE_CONSTANT && rgb_is_black(t->value);
}

static void check_principled(const Check *c, SheenArena *arena)
{
    SheenPrincipled *p = SHEEN_ARENA_NEW(arena, SheenPrincipled, 1);
    if (!p) return;
    if (c->m->principled) *p = *c->m->principled;
    struct {
        const char *name;
        SheenTexture *texture;
    } all[] = {
        {"anisotropic", &p->anisotropic}, {"metallic", &p->metallic},   {"spec_trans", &p->spec_trans},
        {"spec_tint", &p->spec_tint},     {"sheen", &p->sheen},         {"sheen_tint", &p->sheen_tint},
        {"flatness", &p->flatness},       {"clearcoat", &p->clearcoat}, {"clearcoat_gloss", &p->clearcoat_gloss}};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
        texture_in_range(c, all[i].name, all[i].texture, 0.0f, 1.0f, 0.0f);
    texture_in_range(c, "diff_trans", &p->diff_trans, 0.0f, 2.0f, 0.0f);
    texture_in_range(c, "roughness", &c->m->alpha_u, 0.0f, 1.0f, 0.5f);
    c->m->principled = p;
    bool sheet = c->m->kind == SHEEN_MATERIAL_PRINCIPLED_THIN; // looks alike from both sides
    c->m->has_two_sides = !sheet && !is_zero(&p->spec_trans);
    c->m->two_sided = c->m->two_sided || sheet;
    c->m->anisotropic = !is_zero(&p->anisotropic);
}

/** Numbers beyond the clamps would overflow the power; lobes beyond the room for them are left out. */
static bool check_lafortune(const Check *c, SheenArena *arena)
{
    SheenMaterial *m = c->m;
    uint32_t most = SHEEN_MATERIAL_MAX_LOBES - 1;
    if (m->n_lafortune > most)
        sheen_warn(c->log, "%s: material '%s' has %u lobes: the first %u are used", c->scene, m->name, m->n_lafortune,
                   most);
    m->n_lafortune = m->n_lafortune < most ? m->n_lafortune : most;
    SheenLafortune *lobes = SHEEN_ARENA_NEW(arena, SheenLafortune, m->n_lafortune);
    if (!lobes) return false;
    for (uint32_t i = 0; i < m->n_lafortune; ++i) {
        SheenLafortune *l = &lobes[i];
        *l = m->lafortune[i];
        float *numbers[] = {&l->c.x, &l->c.y, &l->c.z};
        for (int k = 0; k < 3; ++k) *numbers[k] = in_range(c, "a lobe's direction", *numbers[k], -2.0f, 2.0f, 0.0f);
        l->exponent = in_range(c, "the exponent", l->exponent, 0.0f, 1e6f, 10.0f);
        float *weights[] = {&l->weight.r, &l->weight.g, &l->weight.b};
        for (int k = 0; k < 3; ++k) *weights[k] = in_range(c, "a lobe's weight", *weights[k], 0.0f, 1e6f, 0.0f);
        m->anisotropic = m->anisotropic || l->c.x != l->c.y;
    }
    m->lafortune = lobes;
    m->n_lobes += m->n_lafortune;
    return true;
}

static void check_numbers(const Check *c, const Traits *t)
{
    SheenMaterial *m = c->m;
    if (t->has_ior) m->ior = in_range(c, "the refractive index", m->ior, 0.1f, 10.0f, 1.0f);
    if (t->has_alpha) {
        if (!t->anisotropic) m->alpha_v = m->alpha_u;
        texture_in_range(c, "the roughness", &m->alpha_u, SHEEN_ALPHA_MIN, SHEEN_ALPHA_MAX, 0.1f);
        texture_in_range(c, "the roughness", &m->alpha_v, SHEEN_ALPHA_MIN, SHEEN_ALPHA_MAX, 0.1f);
        m->anisotropic = t->anisotropic && !same_texture(&m->alpha_u, &m->alpha_v);
    }
    if (m->kind == SHEEN_MATERIAL_PLASTIC) m->inside = minf(sheen_fresnel_diffuse(1.0f / m->ior), 0.999f);
    if (m->kind == SHEEN_MATERIAL_ROUGH_DIFFUSE) texture_in_range(c, "the roughness", &m->alpha_u, 0.0f, 10.0f, 0.2f);
    if (m->kind == SHEEN_MATERIAL_PHONG) m->exponent = in_range(c, "the exponent", m->exponent, 0.0f, 1e6f, 10.0f);
    if (m->kind == SHEEN_MATERIAL_BLEND) texture_in_range(c, "the weight", &m->weight, 0.0f, 1.0f, 0.5f);
    if (m->kind == SHEEN_MATERIAL_MASK) texture_in_range(c, "the opacity", &m->weight, 0.0f, 1.0f, 0.5f);
    if (m->kind == SHEEN_MATERIAL_BUMP) m->map_scale = in_range(c, "the scale", m->map_scale, -1e6f, 1e6f, 0.0f);
    if (m->kind == SHEEN_MATERIAL_COATING || m->kind == SHEEN_MATERIAL_ROUGH_COATING)
        m->absorption = rgb(in_range(c, "the absorption", m->absorption.r, 0.0f, 1e6f, 0.0f),
                            in_range(c, "the absorption", m->absorption.g, 0.0f, 1e6f, 0.0f),
                            in_range(c, "the absorption", m->absorption.b, 0.0f, 1e6f, 0.0f));
}

/** The table of another material will do where it is the same. */
static bool find_coat(const SheenMaterial earlier[], uint32_t n, SheenMaterial *m, float lo, float hi)
{
    for (uint32_t i = 0; i < n; ++i) {
        const SheenCoat *c = earlier[i].coat;
        if (c && c->ior == m->ior && c->distribution == m->distribution && c->alpha_min == lo && c->alpha_max == hi)
            m->coat = c;
    }
    return m->coat != NULL;
}

static bool make_coat(SheenArena *arena, const SheenMaterial earlier[], uint32_t n, SheenMaterial *m)
{
    float lo = SHEEN_ALPHA_MIN, hi = 1.0f; // of a bitmap
    if (m->alpha_u.kind != SHEEN_TEXTURE_BITMAP && !sheen_texture_is_of_mesh(&m->alpha_u))
        lo = hi = rgb_luminance(m->alpha_u.value);
    if (sheen_texture_has_two_values(&m->alpha_u)) {
        lo = minf(lo, rgb_luminance(m->alpha_u.value2));
        hi = maxf(hi, rgb_luminance(m->alpha_u.value2));
    }
    if (!find_coat(earlier, n, m, lo, hi)) m->coat = sheen_coat_create(arena, m->ior, m->distribution, lo, hi);
    return m->coat != NULL;
}

SheenStatus sheen_material_complete(const SheenLog *log, const char *scene, SheenArena *arena,
                                    const SheenMaterial earlier[], uint32_t n, SheenMaterial *m)
{
    const Traits *t = &traits_of_kind[m->kind];
    Check c = {log, scene, m};
    m->coat = NULL;
    m->anisotropic = false;
    m->has_two_sides = t->two_sides;
    m->n_lobes = t->n_lobes;
    m->n_wraps = t->n_wraps;
    check_numbers(&c, t);
    if (m->kind == SHEEN_MATERIAL_PRINCIPLED || m->kind == SHEEN_MATERIAL_PRINCIPLED_THIN) {
        check_principled(&c, arena);
        if (!m->principled) return SHEEN_ERR_NOMEM;
    }
    if (m->kind == SHEEN_MATERIAL_LAFORTUNE && !check_lafortune(&c, arena)) return SHEEN_ERR_NOMEM;
    for (uint32_t i = 0; i < t->n_nested; ++i) {
        if (m->nested[i] >= n) return SHEEN_ERR_INVALID;
        const SheenMaterial *nested = &earlier[m->nested[i]];
        m->n_lobes += nested->n_lobes;
        m->n_wraps += nested->n_wraps;
        m->has_two_sides = m->has_two_sides || nested->has_two_sides;
    }
    if (m->has_two_sides) m->two_sided = false;
    m->n_wraps += (m->two_sided ? 1u : 0u) + (m->anisotropic ? 1u : 0u);
    if (m->n_lobes > SHEEN_MATERIAL_MAX_LOBES || m->n_wraps > SHEEN_MATERIAL_MAX_WRAPS) {
        sheen_warn(log, "%s: material '%s' has too many parts: the first of them stands in", scene, m->name);
        const char *name = m->name;
        *m = earlier[m->nested[0]];
        m->name = name;
        return SHEEN_OK;
    }
    if (t->coat && !make_coat(arena, earlier, n, m)) return SHEEN_ERR_NOMEM;
    return SHEEN_OK;
}
