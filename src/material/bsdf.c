// SPDX-License-Identifier: Apache-2.0
#include "material/bsdf.h"

#include "material/bsdf_ops.h"

static const BsdfOps *const ops_of_kind[] = {
    [SHEEN_MATERIAL_DIFFUSE] = &sheen_bsdf_diffuse,
    [SHEEN_MATERIAL_CONDUCTOR] = &sheen_bsdf_conductor,
    [SHEEN_MATERIAL_DIELECTRIC] = &sheen_bsdf_dielectric,
    [SHEEN_MATERIAL_THIN_DIELECTRIC] = &sheen_bsdf_thin_dielectric,
};

static const BsdfOps *ops(const Bsdf *bsdf)
{
    return ops_of_kind[bsdf->material->kind];
}

// Reflectances outside [0, 1] would make energy out of nothing; the comparisons send NaN to 0.
static float unit_or_zero(float x)
{
    return x > 0.0f ? minf(x, 1.0f) : 0.0f;
}

static Rgb reflectance_at(const SheenTexture *t, Vec2 uv)
{
    Rgb c = sheen_texture_eval(t, uv);
    return rgb(unit_or_zero(c.r), unit_or_zero(c.g), unit_or_zero(c.b));
}

Bsdf sheen_bsdf_at(const SheenScene *scene, const SurfacePoint *s)
{
    const SheenMaterial *m = &scene->materials[scene->shapes[s->shape].material];
    Bsdf b = {.material = m};
    switch (m->kind) {
    case SHEEN_MATERIAL_DIFFUSE:
        b.reflectance = reflectance_at(&m->reflectance, s->uv);
        break;
    case SHEEN_MATERIAL_DIELECTRIC:
    case SHEEN_MATERIAL_THIN_DIELECTRIC:
        b.specular_transmittance = reflectance_at(&m->specular_transmittance, s->uv);
        b.specular_reflectance = reflectance_at(&m->specular_reflectance, s->uv);
        break;
    case SHEEN_MATERIAL_CONDUCTOR:
        b.specular_reflectance = reflectance_at(&m->specular_reflectance, s->uv);
        break;
    }
    return b;
}

bool sheen_bsdf_is_delta(const Bsdf *bsdf)
{
    return ops(bsdf)->lobes != NULL;
}

Rgb sheen_bsdf_eval(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l)
{
    const BsdfOps *o = ops(bsdf);
    return o->eval ? o->eval(bsdf, wo_l, wi_l) : rgb_gray(0.0f);
}

float sheen_bsdf_pdf(const Bsdf *bsdf, Vec3 wo_l, Vec3 wi_l)
{
    const BsdfOps *o = ops(bsdf);
    return o->pdf ? o->pdf(bsdf, wo_l, wi_l) : 0.0f;
}

bool sheen_bsdf_sample(const Bsdf *bsdf, Vec3 wo_l, float lobe, Vec2 u, BsdfSample *out)
{
    const BsdfOps *o = ops(bsdf);
    if (!o->lobes) return o->sample(bsdf, wo_l, lobe, u, out);
    BsdfSample lobes[2];
    int n = o->lobes(bsdf, wo_l, lobes);
    if (n == 0) return false;
    *out = lobes[n == 2 && lobe >= lobes[0].pdf ? 1 : 0];
    out->weight = rgb_scale(out->weight, 1.0f / out->pdf);
    return true;
}

int sheen_bsdf_delta_lobes(const Bsdf *bsdf, Vec3 wo_l, BsdfSample out[2])
{
    const BsdfOps *o = ops(bsdf);
    int n = o->lobes ? o->lobes(bsdf, wo_l, out) : 0;
    for (int i = 0; i < n; ++i) out[i].pdf = 1.0f;
    return n;
}

Rgb sheen_bsdf_albedo(const Bsdf *bsdf, Vec3 wo_l)
{
    return ops(bsdf)->albedo(bsdf, wo_l);
}
