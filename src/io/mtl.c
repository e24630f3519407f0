// SPDX-License-Identifier: Apache-2.0
// Format: ramey1995-mtl; what exporters do beyond it is told where it matters.
#include "io/mtl.h"

#include "io/mesh.h"
#include "io/number.h"

#include <stdlib.h>
#include <string.h>

typedef struct Word {
    const char *text;
    size_t length;
} Word;

typedef struct Reader {
    const char *at, *end; // end of the line
    const char *name;
    const SheenLog *log;
    SheenArena *arena;
    uint32_t line, n, capacity;
    MtlMaterial *materials; // from malloc
    bool warned, of_blender;
} Reader;

static SheenStatus no_memory(const Reader *r)
{
    return sheen_fail(r->log, SHEEN_ERR_NOMEM, "%s:%u: out of memory", r->name, r->line);
}

// ---- words and numbers ------------------------------------------------------------------------------------------

static void skip_blanks(Reader *r)
{
    while (r->at < r->end && (unsigned char)*r->at <= ' ') ++r->at;
}

static Word next_word(Reader *r)
{
    skip_blanks(r);
    Word w = {r->at, 0};
    while (r->at < r->end && (unsigned char)*r->at > ' ') ++r->at;
    w.length = (size_t)(r->at - w.text);
    return w;
}

/** Words are compared in any case: exporters write map_Bump and map_bump. */
static bool is(Word w, const char *text)
{
    size_t i = 0;
    for (; i < w.length && text[i]; ++i) {
        char a = w.text[i], b = text[i];
        if ((a >= 'A' && a <= 'Z' ? a + 32 : a) != (b >= 'A' && b <= 'Z' ? b + 32 : b)) return false;
    }
    return i == w.length && !text[i];
}

static bool is_one_of(Word w, const char *const list[], size_t n)
{
    for (size_t i = 0; i < n; ++i)
        if (is(w, list[i])) return true;
    return false;
}

/** Reads up to n finite numbers. @return how many; -1, with a message, when something else stands there. */
static int read_numbers(Reader *r, const char *keyword, int n, float out[])
{
    int i = 0;
    for (; i < n; ++i) {
        double v;
        skip_blanks(r);
        if (r->at == r->end || *r->at == '#') break;
        bool number = sheen_number_parse(&r->at, r->end, &v);
        if (!number || !isfinite((float)v)) {
            (void)sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: '%s' needs finite numbers", r->name, r->line, keyword);
            return -1;
        }
        out[i] = (float)v;
    }
    if (i > 0) return i;
    (void)sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: '%s' needs a number", r->name, r->line, keyword);
    return -1;
}

static SheenStatus read_number(Reader *r, const char *keyword, float *out)
{
    return read_numbers(r, keyword, 1, out) == 1 ? SHEEN_OK : SHEEN_ERR_PARSE;
}

/** Three numbers; one stands for all. Colours by wavelength or as XYZ are not read. */
static SheenStatus read_color(Reader *r, const char *keyword, Rgb *out)
{
    const char *start = r->at;
    Word w = next_word(r);
    if (is(w, "spectral") || is(w, "xyz")) {
        sheen_warn(r->log, "%s:%u: '%s %.*s' is not supported and is ignored", r->name, r->line, keyword, (int)w.length,
                   w.text);
        return SHEEN_OK;
    }
    r->at = start;
    float c[3];
    int n = read_numbers(r, keyword, 3, c);
    if (n < 0) return SHEEN_ERR_PARSE;
    *out = n == 3 ? rgb(c[0], c[1], c[2]) : rgb_gray(c[0]);
    return SHEEN_OK;
}

/** The rest of the line, without blanks at its ends; NULL when out of memory. Names may hold blanks. */
static const char *read_rest(Reader *r)
{
    skip_blanks(r);
    const char *end = r->end;
    while (end > r->at && (unsigned char)end[-1] <= ' ') --end;
    size_t n = (size_t)(end - r->at);
    char *text = sheen_arena_alloc(r->arena, n + 1, 1);
    if (text) memcpy(text, r->at, n);
    r->at = r->end;
    return text;
}

// ---- maps -------------------------------------------------------------------------------------------------------

/** -o and -s take one to three numbers; what follows may be a file whose name begins with a digit. */
static void read_uvw(Reader *r, Vec2 *out)
{
    float *to[3] = {&out->x, &out->y, NULL};
    for (int i = 0; i < 3; ++i) {
        double v;
        skip_blanks(r);
        const char *p = r->at;
        if (!sheen_number_parse(&p, r->end, &v) || (p < r->end && (unsigned char)*p > ' ')) return;
        if (to[i] && isfinite((float)v)) *to[i] = (float)v;
        r->at = p;
    }
}

static void skip_words(Reader *r, int n)
{
    while (n-- > 0) (void)next_word(r);
}

/** Options that the format has before the file's name, and how many words each takes. */
static SheenStatus read_map(Reader *r, MtlMap *out)
{
    static const struct {
        const char *name;
        int n_words;
    } skipped[] = {{"-blendu", 1}, {"-blendv", 1}, {"-boost", 1},   {"-bm", 1},    {"-cc", 1},        {"-mm", 2},
                   {"-texres", 1}, {"-type", 1},   {"-imfchan", 1}, {"-manip", 1}, {"-colorspace", 1}};
    MtlMap map = {.scale = {1.0f, 1.0f}};
    for (;;) {
        skip_blanks(r);
        const char *start = r->at;
        Word w = next_word(r);
        Vec2 ignored = {0, 0};
        bool known = true;
        if (is(w, "-o"))
            read_uvw(r, &map.offset);
        else if (is(w, "-s"))
            read_uvw(r, &map.scale);
        else if (is(w, "-t"))
            read_uvw(r, &ignored);
        else if (is(w, "-clamp"))
            map.clamp = is(next_word(r), "on");
        else {
            known = false;
            for (size_t i = 0; i < sizeof skipped / sizeof *skipped; ++i)
                if (is(w, skipped[i].name)) skip_words(r, skipped[i].n_words), known = true;
        }
        if (known) continue;
        r->at = start;
        break;
    }
    char *file = (char *)(uintptr_t)read_rest(r);
    if (!file) return no_memory(r);
    for (char *c = file; *c; ++c)
        if (*c == '\\') *c = '/'; // exporters on Windows
    if (!*file) {
        sheen_warn(r->log, "%s:%u: a map without a file is ignored", r->name, r->line);
        return SHEEN_OK;
    }
    map.file = file;
    *out = map;
    return SHEEN_OK;
}

// ---- statements -------------------------------------------------------------------------------------------------

MtlMaterial sheen_mtl_default(const char *name)
{
    return (MtlMaterial){.name = name,
                         .library = "",
                         .diffuse = rgb_gray(0.5f),
                         .filter = rgb_gray(1.0f),
                         .ior = 1.0f,
                         .opacity = 1.0f,
                         .roughness = -1.0f,
                         .metallic = -1.0f,
                         .illum = 2};
}

static SheenStatus begin_material(Reader *r)
{
    MtlMaterial m = sheen_mtl_default(read_rest(r));
    m.library = r->name;
    m.line = r->line;
    m.of_blender = r->of_blender;
    if (!m.name || !sheen_reserve((void **)&r->materials, &r->capacity, (uint64_t)r->n + 1, sizeof m))
        return no_memory(r);
    r->materials[r->n++] = m;
    return SHEEN_OK;
}

static SheenStatus read_opacity(Reader *r, MtlMaterial *m, bool transparency)
{
    float v;
    const char *start = r->at;
    if (!is(next_word(r), "-halo")) r->at = start;
    SheenStatus s = read_number(r, transparency ? "Tr" : "d", &v);
    // Files with both mean the same thing twice, or got Tr wrong: d counts.
    if (s || (transparency && m->has_opacity)) return s;
    m->opacity = clampf(transparency ? 1.0f - v : v, 0.0f, 1.0f);
    m->has_opacity = m->has_opacity || !transparency;
    return SHEEN_OK;
}

static SheenStatus read_property(Reader *r, Word w, MtlMaterial *m)
{
    float v;
    SheenStatus s;
    if (is(w, "Kd")) return read_color(r, "Kd", &m->diffuse);
    if (is(w, "Ks")) return read_color(r, "Ks", &m->specular);
    if (is(w, "Ka")) return read_color(r, "Ka", &m->ambient);
    if (is(w, "Ke")) return read_color(r, "Ke", &m->emission);
    if (is(w, "Tf")) {
        m->has_filter = true;
        return read_color(r, "Tf", &m->filter);
    }
    if (is(w, "Pr")) return read_number(r, "Pr", &m->roughness);
    if (is(w, "Pm")) return read_number(r, "Pm", &m->metallic);
    if (is(w, "Ps")) return read_number(r, "Ps", &m->sheen);
    if (is(w, "Pc")) return read_number(r, "Pc", &m->clearcoat);
    if (is(w, "Pcr")) return read_number(r, "Pcr", &m->clearcoat_roughness);
    if (is(w, "aniso")) return read_number(r, "aniso", &m->anisotropy);
    if (is(w, "Ns")) return read_number(r, "Ns", &m->shininess);
    if (is(w, "Ni")) return read_number(r, "Ni", &m->ior);
    if (is(w, "d")) return read_opacity(r, m, false);
    if (is(w, "Tr")) return read_opacity(r, m, true);
    if (is(w, "illum")) {
        s = read_number(r, "illum", &v);
        if (!s) m->illum = (int)clampf(v, -1.0f, 99.0f);
        return s;
    }
    if (is(w, "map_Kd")) return read_map(r, &m->diffuse_map);
    if (is(w, "map_d")) return read_map(r, &m->opacity_map);
    if (is(w, "map_Pr")) return read_map(r, &m->roughness_map);
    if (is(w, "map_Pm")) return read_map(r, &m->metallic_map);
    return read_map(r, &m->normal_map);
}

static SheenStatus read_statement(Reader *r)
{
    static const char *const read[] = {"Kd",   "Ks", "Ka", "Ke",  "Tf",    "Ns",     "Ni",
                                       "d",    "Tr", "Pr", "Pm",  "illum", "map_Kd", "map_d",
                                       "norm", "Ps", "Pc", "Pcr", "aniso", "map_Pr", "map_Pm"};
    // What pictures hardly show, and what programs write beside it.
    static const char *const silent[] = {"map_Ka",  "map_Ks",  "map_Ns",  "map_aat", "sharpness",
                                         "Km",      "Kt",      "anisor",  "map_Ps",  "map_Pc",
                                         "map_Pcr", "map_RMA", "map_ORM", "refl",    "map_refl"};
    Word w = next_word(r);
    if (w.length == 0) return SHEEN_OK;
    if (*w.text == '#') { // "# Blender 4.2.0 MTL File: ..."
        r->of_blender = r->of_blender || (r->line == 1 && is(next_word(r), "Blender"));
        return SHEEN_OK;
    }
    if (is(w, "newmtl")) return begin_material(r);
    bool normals = is(w, "map_Bump") && r->of_blender;
    if (normals || is_one_of(w, read, sizeof read / sizeof *read)) {
        if (r->n == 0)
            return sheen_fail(r->log, SHEEN_ERR_PARSE, "%s:%u: '%.*s' stands before the first 'newmtl'", r->name,
                              r->line, (int)w.length, w.text);
        return read_property(r, w, &r->materials[r->n - 1]);
    }
    if (is_one_of(w, silent, sizeof silent / sizeof *silent)) return SHEEN_OK;
    if (!r->warned)
        sheen_warn(r->log, "%s:%u: '%.*s' is not supported and is ignored, as others may be", r->name, r->line,
                   w.length < 40 ? (int)w.length : 40, w.text);
    r->warned = true;
    return SHEEN_OK;
}

SheenStatus sheen_mtl_parse(const char *text, size_t size, const char *name, SheenArena *arena, const SheenLog *log,
                            MtlLibrary *out)
{
    *out = (MtlLibrary){0};
    Reader r = {.name = name, .log = log, .arena = arena};
    SheenStatus s = SHEEN_OK;
    for (const char *line = text, *end = text + size; !s && line < end;) {
        const char *newline = memchr(line, '\n', (size_t)(end - line));
        r.at = line;
        r.end = newline ? newline : end;
        r.line++;
        s = read_statement(&r);
        line = newline ? newline + 1 : end;
    }
    MtlMaterial *materials = s ? NULL : SHEEN_ARENA_NEW(arena, MtlMaterial, r.n);
    if (!s && !materials) s = no_memory(&r);
    if (!s && r.n) memcpy(materials, r.materials, r.n * sizeof *materials);
    if (!s) *out = (MtlLibrary){materials, r.n};
    free(r.materials);
    return s;
}
