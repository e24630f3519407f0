// SPDX-License-Identifier: Apache-2.0
#include "material/bsdf.h"

#include "material/bsdf_ops.h"
#include "math/warp.h"

static bool counts(const BsdfLobe *lobe, unsigned classes)
{
    return (lobe->ops->class & classes) != 0;
}

unsigned sheen_bsdf_classes(const Bsdf *bsdf)
{
    unsigned classes = 0;
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) classes |= bsdf->lobes[i].ops->class;
    return classes;
}

bool sheen_bsdf_is_delta(const Bsdf *bsdf)
{
    return sheen_bsdf_classes(bsdf) == SHEEN_BSDF_DELTA;
}

bool sheen_bsdf_transmits(const Bsdf *bsdf)
{
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) {
        const BsdfLobe *lobe = &bsdf->lobes[i];
        bool opaque = lobe->ops == &sheen_lobe_principled_specular && lobe->principled.spec_trans == 0.0f;
        if (lobe->ops->transmits && !opaque) return true;
    }
    return false;
}

// ---- one lobe, from outside its wrappers ------------------------------------------------------------------------

static Rgb eval_lobe(const Bsdf *bsdf, const BsdfLobe *lobe, Vec3 wo, Vec3 wi)
{
    BsdfWay way;
    Rgb factor;
    float density;
    if (!sheen_bsdf_way(bsdf, lobe, wo, &way) || !sheen_bsdf_way_in(&way, &wi, &factor, &density))
        return rgb_gray(0.0f);
    Rgb f = rgb_scale(lobe->ops->eval(lobe, bsdf_way_wo(&way), wi), lobe->weight);
    return way.n == 0 ? f : rgb_scale(rgb_mul(f, factor), density);
}

static float pdf_lobe(const Bsdf *bsdf, const BsdfLobe *lobe, Vec3 wo, Vec3 wi)
{
    BsdfWay way;
    Rgb factor;
    float density;
    if (!sheen_bsdf_way(bsdf, lobe, wo, &way) || !sheen_bsdf_way_in(&way, &wi, &factor, &density)) return 0.0f;
    return lobe->ops->pdf(lobe, bsdf_way_wo(&way), wi) * density;
}

static float lobe_roughness(const BsdfLobe *lobe)
{
    switch (lobe->ops->class) {
    case SHEEN_BSDF_DELTA:
        return 0.0f;
    case SHEEN_BSDF_GLOSSY:
        return sqrtf(lobe->microfacet.alpha_u * lobe->microfacet.alpha_v);
    default:
        return 1.0f;
    }
}

bool sheen_bsdf_is_rough(const Bsdf *bsdf, float least, float least_layer)
{
    bool glossy = false;
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) {
        const BsdfLobe *lobe = &bsdf->lobes[i];
        const BsdfOps *ops = lobe->ops;
        if (ops->class == SHEEN_BSDF_DELTA || ops->transmits ||
            lobe_roughness(lobe) < (ops->layer ? least_layer : least))
            return false;
        glossy = glossy || ops->class == SHEEN_BSDF_GLOSSY;
    }
    return glossy;
}

// Whether shadow rays pass the lobe's hole as well. Maps and coatings around a hole turn or weaken what passes.
static bool is_passage(const BsdfLobe *lobe, const BsdfWay *way)
{
    if (lobe->ops != &sheen_lobe_passage) return false;
    for (int i = 0; i < way->n; ++i)
        if (way->wraps[i]->kind == SHEEN_WRAP_FRAME || way->wraps[i]->kind == SHEEN_WRAP_COAT) return false;
    return true;
}

// The weight is that of the lobe alone, its share included.
static bool sample_lobe(const Bsdf *bsdf, const BsdfLobe *lobe, Vec3 wo, float choice, Vec2 u, BsdfSample *out)
{
    BsdfWay way;
    *out = (BsdfSample){.pdf = 0.0f};
    if (!sheen_bsdf_way(bsdf, lobe, wo, &way)) return false;
    if (lobe->ops->lobes) {
        BsdfSample deltas[2];
        int n = lobe->ops->lobes(lobe, bsdf_way_wo(&way), deltas);
        if (n == 0) return false;
        *out = deltas[n == 2 && choice >= deltas[0].pdf ? 1 : 0];
        out->weight = rgb_scale(out->weight, 1.0f / out->pdf);
    } else if (!lobe->ops->sample(lobe, bsdf_way_wo(&way), choice, u, out)) {
        return false;
    }
    if (!sheen_bsdf_way_out(&way, out)) return false;
    out->weight = rgb_scale(out->weight, lobe->weight);
    out->transmit = out->wi_l.z * wo.z < 0.0f;
    out->passage = is_passage(lobe, &way);
    out->roughness = lobe_roughness(lobe);
    out->layer = lobe->ops->layer;
    return true;
}

static float importance_of(const Bsdf *bsdf, const BsdfLobe *lobe, Vec3 wo)
{
    BsdfWay way;
    if (!sheen_bsdf_way(bsdf, lobe, wo, &way)) return 0.0f;
    float x = lobe->weight * rgb_max(way.factor) * lobe->ops->importance(lobe, bsdf_way_wo(&way));
    return x > 0.0f && isfinite(x) ? x : 0.0f;
}

// ---- the choice among lobes -------------------------------------------------------------------------------------

// Probabilities of the lobes of some classes.
typedef struct Shares {
    float p[SHEEN_BSDF_MAX_LOBES];
    uint32_t n_counting, only; // lobes with a share, and the last of them
} Shares;

static void share_out(const Bsdf *bsdf, unsigned classes, Vec3 wo, Shares *s)
{
    float sum = 0.0f;
    s->n_counting = s->only = 0;
    if (bsdf->n_lobes == 1 && counts(&bsdf->lobes[0], classes)) { // the choice is simple
        s->p[0] = 1.0f;
        s->n_counting = 1;
        return;
    }
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) {
        s->p[i] = counts(&bsdf->lobes[i], classes) ? importance_of(bsdf, &bsdf->lobes[i], wo) : 0.0f;
        if (!(s->p[i] > 0.0f)) continue;
        sum += s->p[i];
        s->only = i;
        ++s->n_counting;
    }
    if (s->n_counting == 1) s->p[s->only] = 1.0f; // without rounding
    for (uint32_t i = 0; s->n_counting > 1 && i < bsdf->n_lobes; ++i) s->p[i] /= sum;
}

// The last lobe with a share takes what rounding leaves over. *u becomes a number for use within the lobe.
static uint32_t choose(const Shares *s, uint32_t n, float *u)
{
    if (s->n_counting == 1) return s->only;
    float before = 0.0f;
    uint32_t i = 0;
    for (; i < n; ++i) {
        if (i == s->only || *u < before + s->p[i]) break;
        before += s->p[i];
    }
    *u = clampf((*u - before) / s->p[i], 0.0f, 0x1.fffffep-1f);
    return i;
}

// ---- the whole --------------------------------------------------------------------------------------------------

Rgb sheen_bsdf_eval_of(const Bsdf *bsdf, unsigned classes, Vec3 wo_l, Vec3 wi_l)
{
    Rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) {
        const BsdfLobe *lobe = &bsdf->lobes[i];
        if (lobe->ops->eval && counts(lobe, classes)) sum = rgb_add(sum, eval_lobe(bsdf, lobe, wo_l, wi_l));
    }
    return sum;
}

static float pdf_of_shares(const Bsdf *bsdf, const Shares *s, Vec3 wo, Vec3 wi)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) {
        const BsdfLobe *lobe = &bsdf->lobes[i];
        if (lobe->ops->pdf && s->p[i] > 0.0f) sum += s->p[i] * pdf_lobe(bsdf, lobe, wo, wi);
    }
    return sum;
}

float sheen_bsdf_pdf_of(const Bsdf *bsdf, unsigned classes, Vec3 wo_l, Vec3 wi_l)
{
    Shares s;
    share_out(bsdf, classes, wo_l, &s);
    return pdf_of_shares(bsdf, &s, wo_l, wi_l);
}

bool sheen_bsdf_sample_of(const Bsdf *bsdf, unsigned classes, Vec3 wo_l, float lobe, Vec2 u, BsdfSample *out)
{
    Shares s;
    share_out(bsdf, classes, wo_l, &s);
    if (s.n_counting == 0) return false;
    uint32_t i = choose(&s, bsdf->n_lobes, &lobe);
    if (!sample_lobe(bsdf, &bsdf->lobes[i], wo_l, lobe, u, out)) return false;
    if (s.n_counting == 1) return true;
    if (out->delta) {
        out->weight = rgb_scale(out->weight, 1.0f / s.p[i]);
        out->pdf *= s.p[i];
        return true;
    }
    // Other lobes could have drawn the direction too: all of them count, with the density of all.
    out->pdf = pdf_of_shares(bsdf, &s, wo_l, out->wi_l);
    if (!(out->pdf > 0.0f)) return false;
    out->weight = rgb_scale(sheen_bsdf_eval_of(bsdf, classes, wo_l, out->wi_l), 1.0f / out->pdf);
    return true;
}

// Adds a delta lobe, or its weight to one of the same direction.
static int add_delta(const BsdfSample *d, int n, BsdfSample out[])
{
    for (int i = 0; i < n; ++i)
        if (v3_dot(d->wi_l, out[i].wi_l) > 1.0f - 1e-6f && d->passage == out[i].passage) {
            out[i].weight = rgb_add(out[i].weight, d->weight);
            return n;
        }
    out[n] = *d;
    out[n].pdf = 1.0f;
    return n + 1;
}

int sheen_bsdf_delta_lobes(const Bsdf *bsdf, Vec3 wo_l, BsdfSample out[SHEEN_BSDF_MAX_DELTA])
{
    int n = 0;
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) {
        const BsdfLobe *lobe = &bsdf->lobes[i];
        BsdfWay way;
        BsdfSample deltas[2];
        if (!lobe->ops->lobes || !sheen_bsdf_way(bsdf, lobe, wo_l, &way)) continue;
        int n_deltas = lobe->ops->lobes(lobe, bsdf_way_wo(&way), deltas);
        for (int k = 0; k < n_deltas; ++k) {
            if (!sheen_bsdf_way_out(&way, &deltas[k])) continue;
            deltas[k].weight = rgb_scale(deltas[k].weight, lobe->weight);
            deltas[k].transmit = deltas[k].wi_l.z * wo_l.z < 0.0f;
            deltas[k].passage = is_passage(lobe, &way);
            n = add_delta(&deltas[k], n, out);
        }
    }
    return n;
}

// ---- albedos ----------------------------------------------------------------------------------------------------

enum { ALBEDO_SAMPLES = 256 };

// The i-th of a fixed set of samples: even places, choices spread over them.
static void albedo_numbers(uint32_t i, float *choice, Vec2 *u)
{
    *u = warp_hammersley(i, ALBEDO_SAMPLES);
    *choice = fmodf((float)i * 0.618034f, 1.0f);
}

static Rgb at_most_one(Rgb c)
{
    return rgb(clampf(c.r, 0.0f, 1.0f), clampf(c.g, 0.0f, 1.0f), clampf(c.b, 0.0f, 1.0f));
}

Rgb sheen_bsdf_albedo_by_samples(const BsdfLobe *b, Vec3 wo, float ior)
{
    Rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < ALBEDO_SAMPLES; ++i) {
        float choice;
        Vec2 u;
        BsdfSample s = {.pdf = 0.0f};
        albedo_numbers(i, &choice, &u);
        if (!b->ops->sample(b, wo, choice, u, &s)) continue;
        float spread = s.wi_l.z * wo.z < 0.0f ? sqrf(wo.z > 0.0f ? ior : 1.0f / ior) : 1.0f;
        sum = rgb_mad(sum, spread / (float)ALBEDO_SAMPLES, s.weight);
    }
    return at_most_one(sum);
}

static bool is_coated(const BsdfWay *way)
{
    for (int i = 0; i < way->n; ++i)
        if (way->wraps[i]->kind == SHEEN_WRAP_COAT) return true;
    return false;
}

static Rgb albedo_of(const Bsdf *bsdf, const BsdfLobe *lobe, Vec3 wo)
{
    BsdfWay way;
    if (!sheen_bsdf_way(bsdf, lobe, wo, &way)) return rgb_gray(0.0f);
    if (!is_coated(&way)) return rgb_scale(lobe->ops->albedo(lobe, bsdf_way_wo(&way)), lobe->weight);
    Rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < ALBEDO_SAMPLES; ++i) {
        float choice;
        Vec2 u;
        BsdfSample s;
        albedo_numbers(i, &choice, &u);
        if (sample_lobe(bsdf, lobe, wo, choice, u, &s)) sum = rgb_mad(sum, 1.0f / (float)ALBEDO_SAMPLES, s.weight);
    }
    return sum;
}

Rgb sheen_bsdf_albedo(const Bsdf *bsdf, Vec3 wo_l)
{
    Rgb sum = rgb_gray(0.0f);
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) sum = rgb_add(sum, albedo_of(bsdf, &bsdf->lobes[i], wo_l));
    return at_most_one(sum);
}

// ---- for caches -------------------------------------------------------------------------------------------------

Rgb sheen_bsdf_diffuse(const Bsdf *bsdf, Vec3 wo_l, Vec3 *n_l)
{
    Rgb sum = rgb_gray(0.0f);
    float heaviest = 0.0f;
    if (n_l) *n_l = v3(0.0f, 0.0f, wo_l.z < 0.0f ? -1.0f : 1.0f);
    for (uint32_t i = 0; i < bsdf->n_lobes; ++i) {
        const BsdfLobe *lobe = &bsdf->lobes[i];
        if (lobe->ops->class != SHEEN_BSDF_DIFFUSE) continue;
        BsdfWay way;
        if (!sheen_bsdf_way(bsdf, lobe, wo_l, &way)) continue;
        Rgb albedo = rgb_scale(albedo_of(bsdf, lobe, wo_l), sheen_bsdf_way_terminator(&way));
        sum = rgb_add(sum, albedo);
        if (n_l && rgb_max(albedo) > heaviest) {
            heaviest = rgb_max(albedo);
            *n_l = sheen_bsdf_way_normal(&way);
        }
    }
    return at_most_one(sum);
}

bool sheen_bsdf_is_mapped(const Bsdf *bsdf)
{
    for (uint32_t i = 0; i < bsdf->n_wraps; ++i)
        if (bsdf->wraps[i].kind == SHEEN_WRAP_FRAME && bsdf->wraps[i].material) return true;
    return false;
}
