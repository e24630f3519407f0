// SPDX-License-Identifier: Apache-2.0
// The material `lafortune`, which Mitsuba does not have: a diffuse part and numbered lobes, lobe_1, exponent_1,
// weight_1, and so on.
#include "io/mitsuba.h"

#include <stdio.h>

static const SheenXml *lobe_child(const SheenXml *e, const char *what, unsigned i, char name[32])
{
    snprintf(name, 32, "%s_%u", what, i + 1);
    return sheen_mi_child(e, name);
}

static SheenLafortune read_lobe(Mitsuba *m, const SheenXml *e, unsigned i)
{
    char name[32];
    SheenLafortune lobe = {.c = v3(-1.0f, -1.0f, 1.0f)}; // the mirror direction
    if (lobe_child(e, "lobe", i, name)) lobe.c = sheen_mi_vector(m, e, name, lobe.c);
    lobe_child(e, "exponent", i, name);
    lobe.exponent = (float)sheen_mi_float(m, e, name, 30.0);
    lobe_child(e, "weight", i, name);
    lobe.weight = sheen_mi_color(m, e, name, MITSUBA_REFLECTANCE, rgb_gray(0.2f));
    return lobe;
}

void sheen_mi_lafortune(Mitsuba *m, SheenXml *e, SheenMaterial *out)
{
    out->kind = SHEEN_MATERIAL_LAFORTUNE;
    out->reflectance = sheen_mi_texture(m, e, "diffuse_reflectance", rgb_gray(0.5f));
    out->specular_reflectance = sheen_mi_texture(m, e, "specular_reflectance", rgb_gray(1.0f));
    SheenLafortune *lobes = SHEEN_ARENA_NEW(m->arena, SheenLafortune, SHEEN_MATERIAL_MAX_LOBES);
    unsigned n = 0;
    char name[32];
    // One more than fits is read, so that it is told that it does not.
    while (lobes && n < SHEEN_MATERIAL_MAX_LOBES &&
           (lobe_child(e, "lobe", n, name) || lobe_child(e, "exponent", n, name) || lobe_child(e, "weight", n, name)))
        lobes[n] = read_lobe(m, e, n), ++n;
    if (n == 0 && !e->warned) sheen_xml_warn(m->log, e, "the material has no 'lobe_1': it is diffuse");
    out->lafortune = lobes;
    out->n_lafortune = n;
}
