// SPDX-License-Identifier: Apache-2.0
// Milliseconds to tabulate the lobes of a scene, on one thread, and nanoseconds of a reading.
#include "base/hash.h"
#include "io/mitsuba.h"
#include "material/lobe_table.h"
#include "timing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { N_READINGS = 100000, N_COPIES = 20 };

#define F(name, value) "<float name='" #name "' value='" #value "'/>"
#define BSDF(type, inside) "<bsdf type='" type "'>" inside "</bsdf>"
#define GOLD "<string name='material' value='Au'/>"
#define GGX "<string name='distribution' value='ggx'/>"
#define TEXTURED                                                                                                       \
    "<texture type='checkerboard' name='roughness'><float name='color0' value='0.01'/><float name='color1' "           \
    "value='1'/></texture>"

/** A scene of squares, one of each material. */
static SheenScene *scene_of(const char *const bsdf[], size_t n)
{
    char text[65536];
    SheenScene *scene = NULL;
    size_t at = (size_t)snprintf(text, sizeof text, "<scene version='3.0.0'>");
    for (size_t i = 0; i < n; ++i)
        at += (size_t)snprintf(text + at, sizeof text - at, "<shape type='rectangle'>%s</shape>", bsdf[i]);
    at += (size_t)snprintf(text + at, sizeof text - at, "</scene>");
    if (at >= sizeof text || sheen_mitsuba_parse(text, at, "bench", false, NULL, &scene)) exit(1);
    return scene;
}

static double reading_time(const SheenScene *scene, const SheenLobeTables *tables, SheenBasis basis)
{
    static Rgb c[SHEEN_BASIS_MAX];
    SurfacePoint point = {.ns = {0, 0, 1}, .ng = {0, 0, 1}, .instance = SHEEN_NONE};
    Bsdf bsdf = sheen_bsdf_at(scene, &point);
    double start = processor_seconds();
    for (uint32_t i = 0; i < N_READINGS; ++i) {
        float z = 0.1f + 0.9f * hash_to_unit(hash_u32(i)), phi = 6.28f * hash_to_unit(hash_u32(~i));
        LobeReading reading;
        sheen_lobe_table_read(tables, basis, &bsdf, v3(sqrtf(1 - z * z) * cosf(phi), sqrtf(1 - z * z) * sinf(phi), z),
                              c, &reading);
    }
    return (processor_seconds() - start) / N_READINGS * 1e9;
}

static void run(const char *name, const char *const bsdf[], size_t n, unsigned order)
{
    SheenScene *scene = scene_of(bsdf, n);
    SheenPool *pool;
    SheenLobeTables *tables;
    const SheenLobeTableDesc desc = {.order = order};
    if (sheen_pool_create(1, &pool)) exit(1);
    double start = processor_seconds();
    if (sheen_lobe_tables_create(NULL, scene, &desc, pool, NULL, &tables)) exit(1);
    double time = processor_seconds() - start;
    printf("%-34s order %2u: %8.2f ms, reading %6.0f ns HSH %6.0f ns SH\n", name, order, time * 1e3,
           reading_time(scene, tables, SHEEN_BASIS_HSH), reading_time(scene, tables, SHEEN_BASIS_SH));
    sheen_lobe_tables_destroy(&tables);
    sheen_pool_destroy(&pool);
    sheen_scene_destroy(&scene);
}

int main(void)
{
    static const char *const usual[] = {
        BSDF("phong", F(exponent, 15)),        BSDF("roughplastic", F(alpha, 0.3)),
        BSDF("roughplastic", F(alpha, 0.1)),   BSDF("roughconductor", GOLD GGX F(alpha, 0.4)),
        BSDF("principled", F(roughness, 0.6)), BSDF("principled", F(roughness, 0.7) F(metallic, 1)),
        BSDF("principled", TEXTURED),          BSDF("ward", F(alpha_u, 0.6) F(alpha_v, 0.25)),
    };
    char smooth[N_COPIES][256];
    const char *all[N_COPIES];
    for (int i = 0; i < N_COPIES; ++i) {
        snprintf(smooth[i], sizeof smooth[i], BSDF("roughconductor", GOLD GGX "<float name='alpha' value='%g'/>"),
                 0.08 + 0.001 * i);
        all[i] = smooth[i];
    }
    for (unsigned order = 10; order <= 20; order += 10) {
        run("phong", &usual[0], 1, order);
        run("plastic", &usual[1], 1, order);
        run("gold", &usual[3], 1, order);
        run("principled", &usual[4], 1, order);
        run("principled, textured roughness", &usual[6], 1, order);
        run("ward, anisotropic", &usual[7], 1, order);
        run("all of these", usual, sizeof usual / sizeof *usual, order);
        run("20 kinds of gold, alpha 0.1", all, N_COPIES, order);
    }
    return 0;
}
