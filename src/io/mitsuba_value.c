// SPDX-License-Identifier: Apache-2.0
// Properties of plugins: numbers, vectors, names.
#include "io/mitsuba.h"

#include "base/hash.h"
#include "io/file_path.h"
#include "io/number.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void sheen_mi_fail(Mitsuba *m, SheenStatus status, const SheenXml *at, const char *format, ...)
{
    if (m->status) return;
    char text[800];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    m->status = sheen_xml_fail(m->log, status, at, "%s", text);
}

bool sheen_mi_same(const char *a, const char *b)
{
    for (;; ++a, ++b) {
        while (*a == '_') ++a;
        while (*b == '_') ++b;
        if (tolower((unsigned char)*a) != tolower((unsigned char)*b)) return false;
        if (!*a) return true;
    }
}

const char *sheen_mi_type(const SheenXml *e)
{
    const char *type = sheen_xml_attribute(e, "type");
    return type ? type : "";
}

/** People disable a property by giving its element another tag. */
static bool is_property(const SheenXml *e)
{
    static const char *const tags[] = {"float", "integer", "boolean",   "string",    "point",   "vector", "rgb",
                                       "srgb",  "color",   "spectrum",  "blackbody", "texture", "ref",    "transform",
                                       "bsdf",  "emitter", "animation", "medium",    "shape",   "volume", "phase",
                                       "film",  "sampler", "rfilter",   "sensor"};
    for (size_t i = 0; i < sizeof tags / sizeof *tags; ++i)
        if (strcmp(e->tag, tags[i]) == 0) return true;
    return false;
}

SheenXml *sheen_mi_child(const SheenXml *e, const char *name)
{
    for (SheenXml *c = e->first; c; c = c->next) {
        const char *n = sheen_xml_attribute(c, "name");
        if (n && sheen_mi_same(n, name) && is_property(c)) {
            c->used = true;
            return c;
        }
    }
    return NULL;
}

void sheen_mi_ignore(const SheenXml *e, const char *names)
{
    while (*names) {
        char name[64];
        size_t n = strcspn(names, " ");
        snprintf(name, sizeof name, "%.*s", (int)n, names);
        sheen_mi_child(e, name);
        names += n + (names[n] == ' ');
    }
}

void sheen_mi_report_unused(Mitsuba *m, const SheenXml *e)
{
    for (SheenXml *c = e->first; c; c = c->next) {
        if (c->used || c->warned) continue;
        c->warned = true;
        const char *name = sheen_xml_attribute(c, "name");
        sheen_xml_warn(m->log, c, "<%s%s%s%s> is not supported in <%s%s%s%s> and is ignored", c->tag,
                       name ? " name=\"" : "", name ? name : "", name ? "\"" : "", e->tag,
                       *sheen_mi_type(e) ? " type=\"" : "", sheen_mi_type(e), *sheen_mi_type(e) ? "\"" : "");
    }
}

// ---- references -------------------------------------------------------------------------------------------------

/** @return the name under which others refer to an element, or NULL. */
static const char *own_id(const SheenXml *e)
{
    if (strcmp(e->tag, "ref") == 0) return NULL; // its id is another's
    return sheen_xml_attribute(e, strcmp(e->tag, "alias") == 0 ? "as" : "id");
}

static uint32_t hash_text(const char *text)
{
    uint32_t h = 0;
    for (; *text; ++text) h = hash_combine(h, (unsigned char)*text);
    return h;
}

/** @return the slot of the hash table that holds `id`, or the empty one where it belongs. */
static SheenXml **id_slot(const Mitsuba *m, const char *id)
{
    uint32_t slot = hash_text(id) & (m->n_ids - 1);
    while (m->ids[slot] && strcmp(own_id(m->ids[slot]), id) != 0) slot = (slot + 1) & (m->n_ids - 1);
    return &m->ids[slot];
}

static uint32_t count_ids(const SheenXml *e)
{
    uint32_t n = own_id(e) != NULL;
    for (const SheenXml *c = e->first; c; c = c->next) n += count_ids(c);
    return n;
}

static void collect_ids(Mitsuba *m, SheenXml *e)
{
    const char *id = own_id(e);
    if (id) {
        SheenXml **slot = id_slot(m, id);
        if (*slot)
            sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the id '%s' is given already at %s:%u", id, (*slot)->file,
                          (*slot)->line);
        else
            *slot = e;
    }
    for (SheenXml *c = e->first; c && !m->status; c = c->next) collect_ids(m, c);
}

void sheen_mi_collect_ids(Mitsuba *m)
{
    uint32_t n = count_ids(m->root);
    for (m->n_ids = 16; m->n_ids / 2 < n;) m->n_ids *= 2;
    m->ids = SHEEN_ARENA_NEW(m->scratch, SheenXml *, m->n_ids);
    if (!m->ids)
        sheen_mi_fail(m, SHEEN_ERR_NOMEM, m->root, "out of memory");
    else
        collect_ids(m, m->root);
}

SheenXml *sheen_mi_resolve(Mitsuba *m, SheenXml *e)
{
    SheenXml *target = e;
    // An alias may name an alias; more steps than ids lead in a circle.
    for (uint32_t i = 0; target && (strcmp(target->tag, "ref") == 0 || strcmp(target->tag, "alias") == 0); ++i) {
        const char *id = sheen_xml_attribute(target, "id");
        target = id && i <= m->n_ids ? *id_slot(m, id) : NULL;
        if (!target && i > m->n_ids)
            sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the reference leads to itself");
        else if (!target)
            sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "no element has the id '%s'", id ? id : "");
    }
    return target;
}

SheenXml *sheen_mi_nested(Mitsuba *m, const SheenXml *e, const char *tag)
{
    for (SheenXml *c = e->first; c && !m->status; c = c->next) {
        SheenXml *target = sheen_mi_resolve(m, c);
        if (!target || strcmp(target->tag, tag) != 0) continue;
        c->used = true;
        return target;
    }
    return NULL;
}

// ---- numbers ----------------------------------------------------------------------------------------------------

static bool is_separator(char c)
{
    return c == ',' || isspace((unsigned char)c);
}

int sheen_mi_numbers(const char *text, int max, double out[])
{
    const char *end = text + strlen(text);
    int n = 0;
    for (;;) {
        while (text < end && is_separator(*text)) ++text;
        if (text == end) return n;
        if (n == max || !sheen_number_parse(&text, end, &out[n])) return -1;
        if (text < end && !is_separator(*text)) return -1;
        if (!isfinite(out[n++])) return -1;
    }
}

static const char *value_of(Mitsuba *m, const SheenXml *e)
{
    const char *value = sheen_xml_attribute(e, "value");
    if (!value) sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "<%s> has no 'value'", e->tag);
    return value;
}

/** One finite number from an attribute; `otherwise` when it is not there. */
static double attribute_number(Mitsuba *m, const SheenXml *e, const char *name, double otherwise)
{
    const char *text = sheen_xml_attribute(e, name);
    double v;
    if (!text) return otherwise;
    if (sheen_mi_numbers(text, 1, &v) == 1) return v;
    sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "'%s' in <%s> is not a finite number: '%.60s'", name, e->tag, text);
    return otherwise;
}

double sheen_mi_float(Mitsuba *m, const SheenXml *e, const char *name, double otherwise)
{
    const SheenXml *c = sheen_mi_child(e, name);
    if (!c || !value_of(m, c)) return otherwise;
    return attribute_number(m, c, "value", otherwise);
}

int64_t sheen_mi_integer(Mitsuba *m, const SheenXml *e, const char *name, int64_t otherwise)
{
    const SheenXml *c = sheen_mi_child(e, name);
    const char *text = c ? value_of(m, c) : NULL;
    if (!text) return otherwise;
    const char *p = text + strspn(text, " \t\r\n"), *end = text + strlen(text);
    int64_t v;
    if (sheen_integer_parse(&p, end, &v) && p[strspn(p, " \t\r\n")] == '\0') return v;
    sheen_mi_fail(m, SHEEN_ERR_PARSE, c, "'%s' is not an integer: '%.60s'", name, text);
    return otherwise;
}

bool sheen_mi_bool(Mitsuba *m, const SheenXml *e, const char *name, bool otherwise)
{
    const SheenXml *c = sheen_mi_child(e, name);
    const char *text = c ? value_of(m, c) : NULL;
    if (!text) return otherwise;
    char word[8];
    size_t start = strspn(text, " \t\r\n"), n = strcspn(text + start, " \t\r\n");
    bool single = n < sizeof word && text[start + n + strspn(text + start + n, " \t\r\n")] == '\0';
    snprintf(word, sizeof word, "%.*s", single ? (int)n : 0, text + start);
    if (sheen_mi_same(word, "true")) return true;
    if (!sheen_mi_same(word, "false"))
        sheen_mi_fail(m, SHEEN_ERR_PARSE, c, "'%s' is neither true nor false: '%.60s'", name, text);
    return false;
}

const char *sheen_mi_string(Mitsuba *m, const SheenXml *e, const char *name, const char *otherwise)
{
    const SheenXml *c = sheen_mi_child(e, name);
    const char *text = c ? value_of(m, c) : NULL;
    return text ? text : otherwise;
}

/** x, y, z, or `value` with three numbers, or with one for all three where that makes sense. */
static Vec3 vector_of(Mitsuba *m, const SheenXml *e, double otherwise, bool spread)
{
    const char *text = sheen_xml_attribute(e, "value");
    double v[3];
    if (!text)
        return v3((float)attribute_number(m, e, "x", otherwise), (float)attribute_number(m, e, "y", otherwise),
                  (float)attribute_number(m, e, "z", otherwise));
    int n = sheen_mi_numbers(text, 3, v);
    if (n == 1 && spread) return v3((float)v[0], (float)v[0], (float)v[0]);
    if (n != 3) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "<%s> needs three finite numbers, not '%.60s'", e->tag, text);
        return v3(0, 0, 0);
    }
    return v3((float)v[0], (float)v[1], (float)v[2]);
}

Vec3 sheen_mi_vector(Mitsuba *m, const SheenXml *e, const char *name, Vec3 otherwise)
{
    const SheenXml *c = sheen_mi_child(e, name);
    return c ? vector_of(m, c, 0.0, false) : otherwise;
}

// ---- transforms -------------------------------------------------------------------------------------------------

static Transform matrix_of(Mitsuba *m, const SheenXml *e)
{
    Transform t = transform_identity();
    const char *text = value_of(m, e);
    double v[16];
    int n = text ? sheen_mi_numbers(text, 16, v) : -1;
    if (n != 9 && n != 16) {
        if (text) sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "<matrix> needs 9 or 16 finite numbers");
        return t;
    }
    int side = n == 9 ? 3 : 4;
    for (int i = 0; i < n; ++i) t.m[i / side][i % side] = v[i];
    if (n == 16 && (v[12] != 0.0 || v[13] != 0.0 || v[14] != 0.0 || v[15] != 1.0)) {
        sheen_xml_warn(m->log, e, "the last row of the matrix is not 0 0 0 1 and is ignored");
        for (int j = 0; j < 4; ++j) t.m[3][j] = j == 3;
    }
    return t;
}

static Vec3 attribute_vector(Mitsuba *m, const SheenXml *e, const char *name, Vec3 otherwise)
{
    const char *text = sheen_xml_attribute(e, name);
    double v[3];
    if (!text) return otherwise;
    if (sheen_mi_numbers(text, 3, v) == 3) return v3((float)v[0], (float)v[1], (float)v[2]);
    sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "'%s' needs three finite numbers, not '%.60s'", name, text);
    return otherwise;
}

static Transform look_at_of(Mitsuba *m, const SheenXml *e)
{
    Vec3 origin = attribute_vector(m, e, "origin", v3(0, 0, 0));
    Vec3 target = attribute_vector(m, e, "target", v3(0, 0, 1));
    Vec3 up = attribute_vector(m, e, "up", v3(0, 0, 0)); // zero lets transform_look_at choose
    if (!(v3_length(v3_sub(target, origin)) > 0.0f)) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "<lookat> has its target at its origin");
        return transform_identity();
    }
    return transform_look_at(origin, target, up);
}

static Transform part_of(Mitsuba *m, const SheenXml *e)
{
    if (strcmp(e->tag, "matrix") == 0) return matrix_of(m, e);
    if (sheen_mi_same(e->tag, "lookat")) return look_at_of(m, e);
    if (strcmp(e->tag, "translate") == 0) {
        Vec3 v = vector_of(m, e, 0.0, false);
        return transform_translate((double)v.x, (double)v.y, (double)v.z);
    }
    if (strcmp(e->tag, "scale") == 0) {
        Vec3 v = vector_of(m, e, 1.0, true);
        return transform_scale((double)v.x, (double)v.y, (double)v.z);
    }
    if (strcmp(e->tag, "rotate") == 0)
        return transform_rotate(vector_of(m, e, 0.0, false),
                                attribute_number(m, e, "angle", 0.0) * (3.14159265358979323846 / 180.0));
    sheen_xml_warn(m->log, e, "<%s> is not a known transform and is ignored", e->tag);
    return transform_identity();
}

Transform sheen_mi_transform(Mitsuba *m, const SheenXml *e, const char *name)
{
    Transform t = transform_identity();
    SheenXml *c = sheen_mi_child(e, name);
    for (SheenXml *a = c || !sheen_mi_same(name, "to_world") ? NULL : e->first; a && !c; a = a->next)
        if (strcmp(a->tag, "animation") == 0) c = a; // Mitsuba 3 names it as it likes
    if (c && strcmp(c->tag, "animation") == 0) {
        c->used = true;
        sheen_xml_warn(m->log, c, "the animation is not supported: its first transform stands in");
        c = c->first;
    }
    for (const SheenXml *part = c ? c->first : NULL; part && !m->status; part = part->next)
        t = transform_mul(part_of(m, part), t);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j)
            if (!(fabs(t.m[i][j]) <= 1e30)) {
                sheen_mi_fail(m, SHEEN_ERR_PARSE, c ? c : e, "the transform overflows");
                return transform_identity();
            }
    return t;
}

// ---- files ------------------------------------------------------------------------------------------------------

const char *sheen_mi_path(Mitsuba *m, const SheenXml *e, const char *property, const char *what)
{
    const SheenXml *c = sheen_mi_child(e, property);
    const char *name = c ? value_of(m, c) : NULL;
    if (!name) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "%s has no '%s'", what, property);
        return NULL;
    }
    const char *path = m->with_files ? sheen_xml_find_file(m->folders, m->scratch, c->file, name) : NULL;
    if (path) return path;
    path = sheen_path_beside(m->scratch, c->file, name);
    sheen_mi_fail(m, SHEEN_ERR_IO, c, "cannot open the %s '%s'", what, path ? path : name);
    return NULL;
}
