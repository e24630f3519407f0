// SPDX-License-Identifier: Apache-2.0
// Which lobes a scene has, and how their tables are filled.
#include "material/lobe_table.h"

#include "material/lobe_grid.h"

#include <stdlib.h>
#include <string.h>

enum {
    ORDER_DEFAULT = 10,
    MEMORY_DEFAULT = 64 << 20,
    NODE_MAX = LOBE_SHAPES_MAX * SHEEN_BASIS_MAX + (SHEEN_ORDER_MAX + 1) * LOBE_SHAPES_MAX * (LOBE_SHAPES_MAX + 1) / 2
};
#define ERROR_DEFAULT 0.05f
#define ERROR_MAX 0.5f
#define LEVEL_STEP 0.3466f // of the logarithm of the roughness: half an octave; see docs/materials.md

// ---- which lobes there are --------------------------------------------------------------------------------------

static void set_levels(LobeTable *t)
{
    const LobeKey *key = &t->family.key;
    t->n_levels = 1;
    if (!key->varies) return;
    float range = logf(key->alpha_hi[0] / key->alpha_lo[0]);
    t->n_levels = (unsigned)ceilf(range / LEVEL_STEP - 1e-3f) + 1;
    if (t->n_levels < 2) t->n_levels = 2;
    t->log_alpha = logf(key->alpha_hi[0]);
    t->log_step = range / (float)(t->n_levels - 1);
}

/** @return the table of a lobe, counted from 1, made when there is none yet; 0 when out of memory. */
static uint32_t table_of(SheenLobeTables *all, uint32_t *capacity, const LobeFamily *family)
{
    for (uint32_t i = 0; i < all->n_tables; ++i)
        if (memcmp(&all->tables[i].family.key, &family->key, sizeof family->key) == 0) return i + 1;
    if (all->n_tables == *capacity) {
        uint32_t more = *capacity ? *capacity * 2 : 16;
        LobeTable *tables = realloc(all->tables, more * sizeof *tables);
        if (!tables) return 0;
        all->tables = tables;
        *capacity = more;
    }
    LobeTable *t = &all->tables[all->n_tables];
    *t = (LobeTable){.family = *family, .node = sheen_lobe_node(all->n, family)};
    // Lobes of order n have details of about pi / n; a disk of nodes is dearer than a line and gets by with fewer.
    t->last = t->node.isotropic ? 16 + all->n : 8 + all->n;
    t->n_nodes = (t->last + 1) * (t->node.isotropic ? 1 : t->last + 1);
    set_levels(t);
    return ++all->n_tables;
}

/** Finds the lobes of a material and of those in it that are not seen through a map or a layer. */
static bool find_lobes(SheenLobeTables *all, uint32_t *capacity, uint32_t material, bool seen[])
{
    if (seen[material]) return true;
    seen[material] = true;
    const SheenMaterial *m = &all->scene->materials[material];
    for (unsigned slot = 0; slot < sheen_lobe_slots(m); ++slot) {
        LobeFamily family;
        if (!sheen_lobe_family(m, slot, &family)) continue;
        all->slots[material][slot] = table_of(all, capacity, &family);
        if (all->slots[material][slot] == 0) return false;
    }
    switch (m->kind) {
    case SHEEN_MATERIAL_BLEND:
    case SHEEN_MATERIAL_SIDES:
        return find_lobes(all, capacity, m->nested[0], seen) && find_lobes(all, capacity, m->nested[1], seen);
    case SHEEN_MATERIAL_MASK:
        return find_lobes(all, capacity, m->nested[0], seen);
    default:
        return true;
    }
}

static SheenStatus find_all_lobes(SheenLobeTables *all)
{
    const SheenScene *scene = all->scene;
    uint32_t capacity = 0;
    bool good = true, *seen = calloc((size_t)scene->n_materials + 1, sizeof *seen);
    if (!seen) return SHEEN_ERR_NOMEM;
    for (uint32_t i = 0; i < scene->n_shapes && good; ++i)
        good = find_lobes(all, &capacity, scene->shapes[i].material, seen);
    free(seen);
    return good ? SHEEN_OK : SHEEN_ERR_NOMEM;
}

// ---- the work ---------------------------------------------------------------------------------------------------

/** One node of a level of a table, or a level alone. */
typedef struct Item {
    uint32_t table, level, node;
    bool good;
} Item;

typedef struct Work {
    SheenLobeTables *all;
    const LobeQuadrature *quadrature;
    Item *items;
} Work;

static BsdfLobe prototype_of(const LobeTable *t, unsigned level)
{
    float alpha[2];
    sheen_lobe_level(t, level, alpha);
    return sheen_lobe_prototype(&t->family, alpha);
}

/** What order n misses of a shape, over its energy. */
static float error_of(const LobeNode *node, const float *at, unsigned shape, unsigned n)
{
    unsigned pair = lobe_pair(node, shape, shape);
    float energy = at[node->missing + pair];
    return energy > 0.0f ? at[node->missing + n * node->n_pairs + pair] / energy : 1.0f;
}

// Two views tell whether a level is hopeless: from the normal, where most lobes are easiest to represent, being round,
// and from 60 degrees for those that are not there at the normal. Both err on the side of filling a table in vain.
static void probe(void *user, size_t i, unsigned worker)
{
    (void)worker;
    Work *w = user;
    Item *item = &w->items[i];
    const LobeTable *t = &w->all->tables[item->table];
    BsdfLobe prototype = prototype_of(t, item->level);
    const Vec3 views[2] = {{0.0f, 0.0f, 1.0f}, {0.8660254f, 0.0f, 0.5f}};
    float hsh[NODE_MAX], sh[NODE_MAX], *const out[2] = {hsh, sh}, allowed = 1.25f * w->all->error;
    for (int k = 0; k < 2 && !item->good; ++k) {
        sheen_lobe_project(w->quadrature, &t->node, &t->family, &prototype, views[k], out);
        item->good =
            error_of(&t->node, hsh, 0, t->node.n) <= allowed || error_of(&t->node, sh, 0, t->node.n) <= allowed;
    }
}

static void fill(void *user, size_t i, unsigned worker)
{
    (void)worker;
    Work *w = user;
    const Item *item = &w->items[i];
    const LobeTable *t = &w->all->tables[item->table];
    BsdfLobe prototype = prototype_of(t, item->level);
    size_t at = ((size_t)item->level * t->n_nodes + item->node) * t->node.size;
    float *const out[2] = {t->data[0] + at, t->data[1] + at};
    sheen_lobe_project(w->quadrature, &t->node, &t->family, &prototype, sheen_lobe_node_direction(t, item->node), out);
}

/** The levels to look at, or the nodes to fill. @return their number; items may be NULL to count them */
static size_t list_items(const SheenLobeTables *all, bool nodes, Item *items)
{
    size_t n = 0;
    for (uint32_t i = 0; i < all->n_tables; ++i) {
        const LobeTable *t = &all->tables[i];
        for (uint32_t level = 0; level < t->n_levels; ++level)
            for (uint32_t node = 0; node < (nodes ? t->n_nodes : 1); ++node, ++n)
                if (items) items[n] = (Item){.table = i, .level = level, .node = node};
    }
    return n;
}

static SheenStatus run_items(Work *w, bool nodes, SheenPool *pool, const atomic_bool *cancel)
{
    size_t n = list_items(w->all, nodes, NULL);
    free(w->items);
    w->items = malloc((n + 1) * sizeof *w->items);
    if (!w->items) return SHEEN_ERR_NOMEM;
    list_items(w->all, nodes, w->items);
    return sheen_pool_run(pool, n, nodes ? fill : probe, w, cancel) ? SHEEN_OK : SHEEN_ERR_CANCELLED;
}

// A ladder of levels ends at the first that is hopeless, which is kept: toward it the share falls.
static void cut_levels(const Work *w)
{
    const Item *item = w->items;
    for (uint32_t i = 0; i < w->all->n_tables; ++i) {
        LobeTable *t = &w->all->tables[i];
        unsigned good = 0, n = t->n_levels;
        while (good < n && item[good].good) ++good;
        item += n;
        t->n_levels = good == 0 ? 0 : good < n ? good + 1 : n;
    }
}

static SheenStatus allocate(const SheenLog *log, SheenLobeTables *all, size_t memory)
{
    size_t used = 0;
    for (uint32_t i = 0; i < all->n_tables; ++i) {
        LobeTable *t = &all->tables[i];
        size_t floats = (size_t)t->n_levels * t->n_nodes * t->node.size, bytes = 2 * floats * sizeof(float);
        if (bytes == 0) continue;
        if (bytes > memory - used) {
            sheen_info(log, "%s: no room for the harmonics of a lobe of material '%s': it is sampled", all->scene->name,
                       t->family.material->name);
            t->n_levels = 0;
            continue;
        }
        used += bytes;
        if (!(t->data[0] = malloc(bytes))) return SHEEN_ERR_NOMEM;
        t->data[1] = t->data[0] + floats;
    }
    return SHEEN_OK;
}

// ---- what they are good for -------------------------------------------------------------------------------------

/** The smallest order that represents a shape at a node well, or the largest; 0 where that does not represent it. */
static unsigned order_of(const SheenLobeTables *all, const LobeTable *t, const float *at, unsigned shape)
{
    if (!(error_of(&t->node, at, 0, all->n) <= all->error)) return 0;
    for (unsigned n = 1; n < all->n; ++n)
        if (error_of(&t->node, at, shape, n) <= LOBE_FINE * all->error) return n;
    return all->n;
}

/** Between the nodes one order more may be needed. */
static void set_orders(SheenLobeTables *all, LobeTable *t)
{
    for (int b = 0; b < 2; ++b) {
        for (size_t i = 0; i < (size_t)t->n_levels * t->n_nodes; ++i)
            for (unsigned shape = 0; shape < t->node.n_shapes; ++shape) {
                unsigned n = order_of(all, t, t->data[b] + i * t->node.size, shape);
                if (n > 0 && n < all->n) ++n;
                if (n > t->order[b]) t->order[b] = n;
            }
        if (t->order[b] > all->order) all->order = t->order[b];
    }
}

static bool material_has(const SheenLobeTables *all, uint32_t material)
{
    const SheenMaterial *m = &all->scene->materials[material];
    for (unsigned slot = 0; slot < LOBE_SLOTS_MAX; ++slot) {
        uint32_t i = all->slots[material][slot];
        if (i != 0 && (all->tables[i - 1].order[0] > 0 || all->tables[i - 1].order[1] > 0)) return true;
    }
    switch (m->kind) {
    case SHEEN_MATERIAL_BLEND:
    case SHEEN_MATERIAL_SIDES:
        return all->has[m->nested[0]] || all->has[m->nested[1]];
    case SHEEN_MATERIAL_MASK:
        return all->has[m->nested[0]];
    default:
        return false;
    }
}

static SheenStatus build(const SheenLog *log, SheenLobeTables *all, size_t memory, SheenPool *pool,
                         const atomic_bool *cancel)
{
    SheenStatus status = find_all_lobes(all);
    if (status || all->n_tables == 0) return status;
    LobeQuadrature *quadrature = sheen_lobe_quadrature(all->n);
    Work work = {all, quadrature, NULL};
    if (!quadrature) return SHEEN_ERR_NOMEM;
    status = run_items(&work, false, pool, cancel);
    if (!status) {
        cut_levels(&work);
        status = allocate(log, all, memory);
    }
    if (!status) status = run_items(&work, true, pool, cancel);
    free(work.items);
    free(quadrature);
    if (status) return status;
    for (uint32_t i = 0; i < all->n_tables; ++i) set_orders(all, &all->tables[i]);
    // Nested materials come first.
    for (uint32_t i = 0; i < all->scene->n_materials; ++i) all->has[i] = material_has(all, i);
    return SHEEN_OK;
}

SheenStatus sheen_lobe_tables_create(const SheenLog *log, const SheenScene *scene, const SheenLobeTableDesc *desc,
                                     SheenPool *pool, const atomic_bool *cancel, SheenLobeTables **out)
{
    *out = NULL;
    unsigned n = desc->order ? desc->order : ORDER_DEFAULT;
    float error = desc->error != 0.0f ? desc->error : ERROR_DEFAULT;
    if (n > SHEEN_ORDER_MAX || !(error > 0.0f && error <= ERROR_MAX)) return SHEEN_ERR_INVALID;
    SheenLobeTables *all = calloc(1, sizeof *all);
    if (!all) return SHEEN_ERR_NOMEM;
    *all = (SheenLobeTables){.scene = scene, .n = n, .error = error};
    all->slots = calloc((size_t)scene->n_materials + 1, sizeof *all->slots);
    all->has = calloc((size_t)scene->n_materials + 1, sizeof *all->has);
    SheenStatus status = all->slots && all->has
                             ? build(log, all, desc->memory ? desc->memory : MEMORY_DEFAULT, pool, cancel)
                             : SHEEN_ERR_NOMEM;
    if (status) sheen_lobe_tables_destroy(&all);
    *out = all;
    return status;
}

void sheen_lobe_tables_destroy(SheenLobeTables **tables)
{
    SheenLobeTables *all = *tables;
    if (!all) return;
    for (uint32_t i = 0; i < all->n_tables; ++i) free(all->tables[i].data[0]);
    free(all->tables);
    free(all->slots);
    free(all->has);
    free(all);
    *tables = NULL;
}

unsigned sheen_lobe_tables_order(const SheenLobeTables *tables)
{
    return tables ? tables->order : 0;
}

bool sheen_lobe_tables_has(const SheenLobeTables *tables, uint32_t material)
{
    return tables && tables->has[material];
}
