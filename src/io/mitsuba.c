// SPDX-License-Identifier: Apache-2.0
#include "io/mitsuba.h"

#include <stdlib.h>
#include <string.h>

static bool is_one_of(const char *word, const char *const list[], size_t n)
{
    for (size_t i = 0; i < n; ++i)
        if (strcmp(list[i], word) == 0) return true;
    return false;
}

/** Warns of attributes that no element of Mitsuba has: most likely misspelled. */
static void check_attributes(const Mitsuba *m, const SheenXml *e)
{
    static const char *const known[] = {"version", "type",        "id",    "name",   "value",  "as",    "x",
                                        "y",       "z",           "angle", "origin", "target", "up",    "filename",
                                        "scale",   "temperature", "unit",  "time",   "intent", "begin", "end"};
    for (uint32_t i = 0; i < e->n_attributes; ++i)
        if (!is_one_of(e->attributes[i].name, known, sizeof known / sizeof *known))
            sheen_xml_warn(m->log, e, "the attribute '%s' of <%s> is not known and is ignored", e->attributes[i].name,
                           e->tag);
    for (const SheenXml *c = e->first; c; c = c->next) check_attributes(m, c);
}

/** Version 0.6 and those before write toWorld, 2 and 3 to_world. */
static bool has_old_names(const SheenXml *e)
{
    const char *name = sheen_xml_attribute(e, "name");
    bool found = name && (strcmp(name, "toWorld") == 0 || strcmp(name, "sampleCount") == 0);
    for (const SheenXml *c = e->first; c && !found; c = c->next) found = has_old_names(c);
    return found;
}

/** The number before the first dot: 0 (0.5 and 0.6), 2 or 3. A scene without one is taken for the newest. */
static int major_version(const Mitsuba *m)
{
    const char *version = sheen_xml_attribute(m->root, "version");
    if (version && *version >= '0' && *version <= '9') return *version - '0';
    bool old = has_old_names(m->root);
    sheen_xml_warn(m->log, m->root, "<scene> has no version: taken for %s", old ? "0.6.0" : "3.0.0");
    return old ? 0 : 3;
}

static void read_instance(Mitsuba *m, SheenXml *e)
{
    Transform t = sheen_mi_transform(m, e, "to_world");
    SheenXml *group = sheen_mi_nested(m, e, "shape");
    if (m->status) return;
    if (!group || !sheen_mi_same(sheen_mi_type(group), "shapegroup") || group->index == SHEEN_NONE) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "an instance needs a reference to a shapegroup of the scene");
        return;
    }
    sheen_mi_report_unused(m, e);
    sheen_builder_add_instance(m->builder, group->index, &t);
}

static void read_shape(Mitsuba *m, SheenXml *e)
{
    const char *type = sheen_mi_type(e);
    if (sheen_mi_same(type, "shapegroup")) return; // read before
    if (sheen_mi_same(type, "instance")) {
        read_instance(m, e);
    } else if (sheen_mi_same(type, "merge")) { // a bundle that only Mitsuba's speed asks for
        for (SheenXml *c = e->first; c && !m->status; c = c->next) {
            if (strcmp(c->tag, "shape") == 0) read_shape(m, c);
        }
    } else {
        sheen_mi_shape(m, e, false);
    }
}

static void read_integrator(Mitsuba *m, const SheenXml *e)
{
    sheen_xml_info(m->log, e, "the scene's integrator '%s' is ignored: the caller chooses one", sheen_mi_type(e));
    const SheenXml *inner = e;
    for (int depth = 0; inner && depth < SHEEN_XML_MAX_DEPTH && !m->status; ++depth) {
        if (sheen_mi_bool(m, inner, "hide_emitters", false))
            sheen_xml_warn(m->log, sheen_mi_child(inner, "hide_emitters"),
                           "'hide_emitters' is not supported: lights stay visible");
        inner = sheen_mi_nested(m, inner, "integrator");
    }
}

static void read_top_level(Mitsuba *m, SheenXml *e)
{
    // Materials, textures and the like are read when something refers to them.
    static const char *const definitions[] = {"bsdf",    "texture", "medium", "phase",     "volume",    "spectrum",
                                              "rgb",     "srgb",    "color",  "blackbody", "float",     "integer",
                                              "boolean", "string",  "point",  "vector",    "transform", "alias"};
    if (strcmp(e->tag, "shape") == 0)
        read_shape(m, e);
    else if (strcmp(e->tag, "emitter") == 0)
        sheen_mi_emitter(m, e);
    else if (strcmp(e->tag, "sensor") == 0)
        sheen_mi_sensor(m, e);
    else if (strcmp(e->tag, "integrator") == 0)
        read_integrator(m, e);
    else if (!is_one_of(e->tag, definitions, sizeof definitions / sizeof *definitions))
        sheen_xml_warn(m->log, e, "<%s> is not supported and is ignored", e->tag);
}

static void read_scene(Mitsuba *m)
{
    if (strcmp(m->root->tag, "scene") != 0) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, m->root, "not a Mitsuba scene: it begins with <%s>", m->root->tag);
        return;
    }
    m->version = major_version(m);
    check_attributes(m, m->root);
    sheen_mi_collect_ids(m);
    for (SheenXml *e = m->root->first; e && !m->status; e = e->next)
        if (strcmp(e->tag, "shape") == 0 && sheen_mi_same(sheen_mi_type(e), "shapegroup")) sheen_mi_shape_group(m, e);
    for (SheenXml *e = m->root->first; e && !m->status; e = e->next) read_top_level(m, e);
}

/** Takes over a tree in m->scratch. */
static SheenStatus finish(Mitsuba *m, const SheenXmlTree *tree, const char *name, SheenScene **out)
{
    m->root = tree->root;
    m->folders = tree->folders;
    SheenStatus s = sheen_builder_create(m->log, name, &m->builder);
    if (s) return s;
    m->arena = sheen_builder_arena(m->builder);
    read_scene(m);
    if (m->status) {
        sheen_builder_destroy(&m->builder);
        return m->status;
    }
    return sheen_builder_commit(&m->builder, out);
}

SheenStatus sheen_mitsuba_read(const char *path, SheenDefines defines, const SheenLog *log, SheenScene **out)
{
    *out = NULL;
    Mitsuba m = {.log = log, .with_files = true, .scratch = sheen_arena_create()};
    if (!m.scratch) return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", path);
    SheenXmlTree tree;
    SheenStatus s = sheen_xml_read(path, defines, m.scratch, log, &tree);
    if (!s) s = finish(&m, &tree, path, out);
    sheen_arena_destroy(&m.scratch);
    return s;
}

SheenStatus sheen_mitsuba_parse(const char *text, size_t size, const char *name, bool with_files, const SheenLog *log,
                                SheenScene **out)
{
    *out = NULL;
    Mitsuba m = {.log = log, .with_files = with_files, .scratch = sheen_arena_create()};
    if (!m.scratch) return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", name);
    SheenXmlTree tree;
    SheenStatus s = sheen_xml_parse(text, size, name, with_files, m.scratch, log, &tree);
    if (!s) s = finish(&m, &tree, name, out);
    sheen_arena_destroy(&m.scratch);
    return s;
}
