// SPDX-License-Identifier: Apache-2.0
// Scenes with something glossy in them and what the radiance integrator makes of them, against paths. Include after
// cmocka.h.
#ifndef SHEEN_TESTS_GLOSSY_KIT_H
#define SHEEN_TESTS_GLOSSY_KIT_H

#include "analytic/irradiance_kit.h"
#include "material/lobe_table.h"

// ---- materials and scenes ---------------------------------------------------------------------------------------

/** What a glossy surface is made of. */
typedef struct Gloss {
    const char *name;
    SheenMaterialKind kind;
    float alpha_u, alpha_v, exponent;
    float diffuse; // albedo of the diffuse lobe, if the kind has one
} Gloss;

static const Gloss phong = {"phong", SHEEN_MATERIAL_PHONG, 0, 0, 10, 0.2f};
static const Gloss sharp = {"sharp phong", SHEEN_MATERIAL_PHONG, 0, 0, 60, 0.2f}; // half of it is cached
static const Gloss metal = {"metal", SHEEN_MATERIAL_ROUGH_CONDUCTOR, 0.5f, 0.5f, 0, 0};
static const Gloss brushed = {"brushed metal", SHEEN_MATERIAL_ROUGH_CONDUCTOR, 0.4f, 0.8f, 0, 0};
static const Gloss narrow = {"narrow metal", SHEEN_MATERIAL_ROUGH_CONDUCTOR, 0.02f, 0.02f, 0, 0};

static inline uint32_t add_gloss(SheenBuilder *b, const Gloss *g)
{
    SheenMaterial m = {.kind = g->kind,
                       .two_sided = true,
                       .reflectance = sheen_texture_constant(rgb_gray(g->diffuse)),
                       .specular_reflectance = sheen_texture_constant(rgb(0.7f, 0.6f, 0.5f)),
                       .specular_transmittance = sheen_texture_constant(rgb_gray(1.0f)),
                       .alpha_u = sheen_texture_constant(rgb_gray(g->alpha_u)),
                       .alpha_v = sheen_texture_constant(rgb_gray(g->alpha_v)),
                       .distribution = SHEEN_DISTRIBUTION_GGX,
                       .weight = sheen_texture_constant(rgb_gray(0.5f)),
                       .eta = rgb_gray(0.2f),
                       .k = rgb_gray(3.0f),
                       .ior = 1.5f,
                       .exponent = g->exponent,
                       .name = g->name};
    return sheen_builder_add_material(b, &m);
}

/** The glossy thing in a room. */
typedef enum Thing { BOARD, BOARD_BEHIND, BALL, BALL_BEHIND, THINGS } Thing;
static const char *const thing_name[THINGS] = {"board", "board from behind", "ball", "ball from behind"};

static inline bool is_board(Thing t)
{
    return t == BOARD || t == BOARD_BEHIND;
}

// From behind is with normals that point away from the camera; the surfaces are two-sided, so that it looks the same.
static inline void add_thing(SheenBuilder *b, Thing thing, uint32_t material)
{
    Vec3 p = v3(-1, 0.9f, -1), x = v3(2, 0, 0), z = v3(0, 0, 2);
    if (thing == BOARD) kit_quad(b, p, x, z, material);
    if (thing == BOARD_BEHIND) kit_quad(b, v3_add(p, z), x, v3_neg(z), material);
    if (!is_board(thing)) kit_sphere(b, v3(0, 0.3f, 0), 0.5f, thing == BALL_BEHIND, material);
}

static inline void add_lamp(SheenBuilder *b, float brightness)
{
    uint32_t lamp = kit_quad(b, v3(-0.3f, -0.6f, 0.97f), v3(0, 0.6f, 0), v3(0.6f, 0, 0), kit_diffuse(b, 0.0f));
    sheen_builder_add_area_light(b, lamp, rgb_scale(rgb(4.0f, 5.0f, 3.0f), brightness));
}

// The inside of the cube [-1, 1]^3 but for its back, y = 1, which is the board's place: walls of different albedos, so
// that what a lobe shows depends on where it points.
static inline void add_walls(SheenBuilder *b)
{
    kit_quad(b, v3(-1, -1, -1), v3(2, 0, 0), v3(0, 2, 0), kit_diffuse(b, 0.7f)); // floor
    kit_quad(b, v3(-1, -1, 1), v3(0, 2, 0), v3(2, 0, 0), kit_diffuse(b, 0.5f));  // ceiling
    kit_quad(b, v3(-1, -1, -1), v3(0, 2, 0), v3(0, 0, 2), kit_diffuse(b, 0.8f)); // left
    kit_quad(b, v3(1, -1, -1), v3(0, 0, 2), v3(0, 2, 0), kit_diffuse(b, 0.2f));  // right
    kit_quad(b, v3(-1, -1, -1), v3(0, 0, 2), v3(2, 0, 0), kit_diffuse(b, 0.5f)); // behind the camera
}

static inline void add_camera(SheenBuilder *b, Thing thing)
{
    if (is_board(thing))
        kit_camera(b, v3(0.1f, -0.7f, 0.1f), v3(0, 1, -0.1f), v3(0, 0, 1), 1.0f);
    else
        kit_camera(b, v3(0.2f, -0.95f, 0.2f), v3(0, 0.3f, 0), v3(0, 0, 1), 0.6f);
}

static inline Stage room_lit(Thing thing, const Gloss *gloss, float brightness)
{
    SheenBuilder *b = kit_begin();
    add_walls(b);
    if (!is_board(thing)) kit_quad(b, v3(-1, 1, -1), v3(2, 0, 0), v3(0, 0, 2), kit_diffuse(b, 0.5f));
    add_lamp(b, brightness);
    add_thing(b, thing, add_gloss(b, gloss));
    add_camera(b, thing);
    return stage_end(b, 2);
}

static inline Stage room(Thing thing, const Gloss *gloss)
{
    return room_lit(thing, gloss, 1.0f);
}

static inline SheenRenderSettings small(uint32_t bounces)
{
    SheenRenderSettings s = small_settings(bounces);
    s.integrator = SHEEN_INTEGRATOR_RADIANCE;
    s.width = s.height = 16;
    s.options.order = 7; // enough for these lobes, and the tables are soon filled
    s.options.brdf_error = 0.05f;
    s.options.spp = 8;
    s.options.gather_rays = 256;
    return s;
}

// ---- against paths ----------------------------------------------------------------------------------------------

/** A picture by paths and the relative noise of its blocks. */
typedef struct Reference {
    SheenFilm *film;
    double noise; // root mean square relative standard error of a block of 8 x 8 pixels
} Reference;

static inline Reference reference(const Stage *stage, const SheenRenderSettings *s, uint32_t spp)
{
    SheenFilm *a = stage_reference(stage, s, spp / 2, 11), *b = stage_reference(stage, s, spp / 2, 12);
    double noise = 0.5 * film_blocks(a, b).rms;
    for (size_t i = 0; i < (size_t)a->width * a->height; ++i)
        a->color[i] = rgb_scale(rgb_add(a->color[i], b->color[i]), 0.5f);
    sheen_film_destroy(&b);
    return (Reference){a, noise};
}

// The mean within 3 standard errors of the reference and `mean`, each block within 4.5 and `block`, relative.
static inline void assert_agrees(const SheenFilm *film, const Reference *r, double mean, double block, const char *what,
                                 const char *how)
{
    double blocks = (double)(film->width / 8) * (film->height / 8), noise = r->noise / sqrt(blocks);
    double off = film_mean(film) / film_mean(r->film) - 1.0;
    BlockDifference d = film_blocks(film, r->film);
    bool ok = fabs(off) <= 3.0 * noise + mean && d.worst <= 4.5 * r->noise + block && r->noise < block;
    if (!ok || getenv("SHEEN_SHOW"))
        fprintf(stderr, "%s, %s: mean off by %.2g, worst block by %.2g, noise of a block %.2g\n", what, how, off,
                d.worst, r->noise);
    assert_true(ok);
}

static inline void check(const Stage *stage, const SheenRenderSettings *s, const Reference *r, double mean,
                         double block, const char *what, const char *how)
{
    SheenStats stats;
    SheenFilm *film = stage_render(stage, s, &stats);
    assert_true(stats.radiance_records > 0);
    assert_agrees(film, r, mean, block, what, how);
    sheen_film_destroy(&film);
}

static const char *const basis_name[] = {"auto", "hsh", "sh"};

// From the front and from behind, in each basis, against one reference.
static inline void check_both_sides(Stage (*make)(Thing, const Gloss *), Thing front, const Gloss *gloss,
                                    const SheenRenderSettings *settings, double mean, double block)
{
    Reference r = {0};
    for (Thing thing = front; thing <= front + 1; ++thing) {
        Stage stage = make(thing, gloss);
        if (thing == front) r = reference(&stage, settings, 128);
        SheenRenderSettings s = *settings;
        for (int basis = SHEEN_BASIS_ALL_HSH; basis <= SHEEN_BASIS_ALL_SH; ++basis) {
            s.options.basis = (SheenBasisChoice)basis;
            check(&stage, &s, &r, mean, block, thing_name[thing], basis_name[basis]);
        }
        stage_free(&stage);
    }
    sheen_film_destroy(&r.film);
}

/** @return the share of the first glossy lobe that is cached, seen in some direction. */
static inline float share_of(const Stage *stage, uint32_t shape, float cos_theta)
{
    SheenLobeTables *tables = NULL;
    static Rgb c[SHEEN_BASIS_MAX];
    LobeReading reading;
    const SheenLobeTableDesc desc = {0};
    assert_int_equal(sheen_lobe_tables_create(&kit_log_sink, stage->scene, &desc, stage->pool, NULL, &tables),
                     SHEEN_OK);
    SurfacePoint s = {.shape = shape, .ng = v3(0, 0, 1), .ns = v3(0, 0, 1), .instance = SHEEN_NONE};
    Bsdf bsdf = sheen_bsdf_at(stage->scene, &s);
    Vec3 wo = v3(sqrtf(1.0f - cos_theta * cos_theta), 0, cos_theta);
    sheen_lobe_table_read(tables, SHEEN_BASIS_HSH, &bsdf, wo, c, &reading);
    float most = 0.0f;
    for (uint32_t i = 0; i < bsdf.n_lobes; ++i) most = maxf(most, reading.share[i]);
    sheen_lobe_tables_destroy(&tables);
    return most;
}

static inline void add_light(SheenBuilder *b, SheenLightKind kind, Vec3 at, float disk)
{
    SheenLight light = {.kind = kind,
                        .radiance = rgb_gray(2.0f),
                        .shape = SHEEN_NONE,
                        .position = at,
                        .disk = disk,
                        .direction = v3_normalize(v3(0.1f, -1, -1)),
                        .to_world = transform_identity(),
                        .to_light = transform_identity()};
    sheen_builder_add_light(b, &light);
}

#endif
