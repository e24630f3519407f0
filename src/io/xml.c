// SPDX-License-Identifier: Apache-2.0
#include "io/xml.h"

#include "image/whole_file.h"
#include "io/file_path.h"

#include <expat.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Parameter {
    const char *name, *value;
    bool used;
    struct Parameter *next;
} Parameter;

/** What all files of one scene share. */
typedef struct Document {
    SheenArena *arena;
    const SheenLog *log;
    Parameter *parameters;
    SheenXmlFolder *folders;
    uint32_t n_includes;
    bool with_files;
} Document;

/** One file being parsed; `outer` is the one that includes it. */
typedef struct Source {
    Document *document;
    const struct Source *outer;
    const char *path; // in the arena
    char *real_path;  // canonical, to see cycles; NULL in memory
    XML_Parser parser;
    SheenXml *open[SHEEN_XML_MAX_DEPTH]; // elements not yet closed
    uint32_t depth, outer_depth;         // here, and of the <include> that led here
    SheenXml *root;
    SheenStatus status;
} Source;

static SheenStatus parse(Source *source, const char *text, size_t size);
static SheenStatus read_source(Document *document, const Source *outer, const char *path, SheenXml **root);

/** Reports at the parser's place and stops it. */
static void stop(Source *s, SheenStatus status, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void stop(Source *s, SheenStatus status, const char *format, ...)
{
    if (s->status) return;
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    s->status = sheen_fail(s->document->log, status, "%s:%lu:%lu: %s", s->path, XML_GetCurrentLineNumber(s->parser),
                           XML_GetCurrentColumnNumber(s->parser) + 1, text);
    XML_StopParser(s->parser, XML_FALSE);
}

static void stop_out_of_memory(Source *s)
{
    stop(s, SHEEN_ERR_NOMEM, "out of memory");
}

// ---- parameters -------------------------------------------------------------------------------------------------

static bool is_name_character(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

static Parameter *find_parameter(const Document *d, const char *name, size_t length)
{
    for (Parameter *p = d->parameters; p; p = p->next)
        if (strlen(p->name) == length && memcmp(p->name, name, length) == 0) return p;
    return NULL;
}

/** @return the value with $parameters put in, in the arena; NULL, and the parser stopped, on failure. */
static const char *expand(Source *s, const char *value)
{
    const char *dollar = strchr(value, '$');
    char *out = NULL;
    if (!dollar) {
        out = sheen_arena_strdup(s->document->arena, value);
        if (!out) stop_out_of_memory(s);
        return out;
    }
    char buffer[SHEEN_XML_MAX_EXPANSION];
    size_t n = 0;
    while (*value) {
        const char *piece = value;
        size_t length = strcspn(value, "$");
        if (length > 0) {
            value += length;
        } else {
            do ++value;
            while (is_name_character(*value));
            Parameter *p = find_parameter(s->document, piece + 1, (size_t)(value - piece) - 1);
            if (!p) {
                stop(s, SHEEN_ERR_PARSE, "the parameter '%.*s' is not defined", (int)(value - piece), piece);
                return NULL;
            }
            p->used = true;
            piece = p->value;
            length = strlen(piece);
        }
        if (length >= sizeof buffer - n) {
            stop(s, SHEEN_ERR_PARSE, "an attribute grows beyond %d bytes", SHEEN_XML_MAX_EXPANSION);
            return NULL;
        }
        memcpy(buffer + n, piece, length);
        n += length;
    }
    buffer[n] = '\0';
    out = sheen_arena_strdup(s->document->arena, buffer);
    if (!out) stop_out_of_memory(s);
    return out;
}

static bool add_parameter(Document *d, const char *name, const char *value)
{
    Parameter *p = SHEEN_ARENA_NEW(d->arena, Parameter, 1);
    if (p) *p = (Parameter){.name = name, .value = value, .next = d->parameters};
    if (p) d->parameters = p;
    return p != NULL;
}

/** <default name= value=>: holds unless the parameter has a value already. */
static void define_parameter(Source *s, const SheenXml *e)
{
    Document *d = s->document;
    const char *name = sheen_xml_attribute(e, "name"), *value = sheen_xml_attribute(e, "value");
    if (!name || !value) {
        stop(s, SHEEN_ERR_PARSE, "<default> needs 'name' and 'value'");
        return;
    }
    if (!find_parameter(d, name, strlen(name)) && !add_parameter(d, name, value)) stop_out_of_memory(s);
}

bool sheen_define_is_valid(const char *text)
{
    const char *end = text;
    while (is_name_character(*end)) ++end;
    return end > text && *end == '=';
}

/** Takes over what is defined from outside. */
static SheenStatus add_defines(Document *d, SheenDefines defines, const char *path)
{
    for (size_t i = 0; i < defines.n; ++i) {
        const char *text = defines.items[i];
        if (!sheen_define_is_valid(text))
            return sheen_fail(d->log, SHEEN_ERR_INVALID, "%s: '%s' is not NAME=VALUE", path, text);
        char *name = sheen_arena_strdup(d->arena, text);
        if (!name) return sheen_fail(d->log, SHEEN_ERR_NOMEM, "%s: out of memory", path);
        char *equals = strchr(name, '=');
        *equals = '\0';
        if (!add_parameter(d, name, equals + 1)) return sheen_fail(d->log, SHEEN_ERR_NOMEM, "%s: out of memory", path);
    }
    return SHEEN_OK;
}

static void warn_of_unused(const Document *d, SheenDefines defines, const char *path)
{
    for (size_t i = 0; i < defines.n; ++i) {
        size_t length = strcspn(defines.items[i], "=");
        if (!find_parameter(d, defines.items[i], length)->used)
            sheen_warn(d->log, "%s: nothing refers to $%.*s", path, (int)length, defines.items[i]);
    }
}

// ---- folders ----------------------------------------------------------------------------------------------------

static const char *find_named(const SheenXmlFolder *folders, SheenArena *arena, const char *beside, const char *name)
{
    for (; folders; folders = folders->next) {
        const char *path = sheen_path_beside(arena, folders->path, name);
        if (path && sheen_path_readable(path)) return path;
    }
    const char *path = sheen_path_beside(arena, beside, name);
    return path && sheen_path_readable(path) ? path : NULL;
}

const char *sheen_xml_find_file(const SheenXmlFolder *folders, SheenArena *arena, const char *beside, const char *name)
{
    const char *path = find_named(folders, arena, beside, name);
    if (path || !strchr(name, '\\')) return path;
    char *slashes = sheen_arena_strdup(arena, name);
    for (char *c = slashes; c && *c; ++c)
        if (*c == '\\') *c = '/';
    return slashes ? find_named(folders, arena, beside, slashes) : NULL;
}

/** Puts a folder before the others. */
static bool add_folder(Document *d, const char *path)
{
    SheenXmlFolder *f = SHEEN_ARENA_NEW(d->arena, SheenXmlFolder, 1);
    if (f) *f = (SheenXmlFolder){path, d->folders};
    if (f) d->folders = f;
    return f != NULL;
}

/** <path value=>: one more folder, named as seen from the file. */
static void add_path(Source *s, const SheenXml *e)
{
    Document *d = s->document;
    const char *value = sheen_xml_attribute(e, "value");
    if (!value || !*value) {
        stop(s, SHEEN_ERR_PARSE, "<path> needs 'value'");
        return;
    }
    if (!d->with_files) return;
    size_t n = strlen(value);
    char *name = sheen_arena_alloc(d->arena, n + 2, 1);
    char *path = NULL;
    if (name) {
        memcpy(name, value, n);
        memcpy(name + n, value[n - 1] == '/' ? "" : "/", 2 - (value[n - 1] == '/'));
        path = sheen_path_beside(d->arena, s->path, name);
    }
    if (!path || !add_folder(d, path))
        stop_out_of_memory(s);
    else if (!sheen_path_is_folder(path))
        sheen_xml_warn(d->log, e, "the folder '%s' is not there", path);
}

// ---- the tree ---------------------------------------------------------------------------------------------------

static SheenXml *new_element(Source *s, const char *tag, const char **attributes)
{
    SheenArena *arena = s->document->arena;
    uint32_t n = 0;
    while (attributes[2 * n]) ++n;
    SheenXml *e = SHEEN_ARENA_NEW(arena, SheenXml, 1);
    SheenXmlAttribute *list = SHEEN_ARENA_NEW(arena, SheenXmlAttribute, n);
    char *tag_copy = sheen_arena_strdup(arena, tag);
    if (!e || !list || !tag_copy) {
        stop_out_of_memory(s);
        return NULL;
    }
    for (uint32_t i = 0; i < n; ++i) {
        char *name = sheen_arena_strdup(arena, attributes[2 * i]);
        if (!name) stop_out_of_memory(s);
        list[i] = (SheenXmlAttribute){name, expand(s, attributes[2 * i + 1])};
        if (!list[i].name || !list[i].value) return NULL;
    }
    *e = (SheenXml){.tag = tag_copy,
                    .attributes = list,
                    .n_attributes = n,
                    .file = s->path,
                    .line = (uint32_t)XML_GetCurrentLineNumber(s->parser),
                    .column = (uint32_t)XML_GetCurrentColumnNumber(s->parser) + 1,
                    .index = UINT32_MAX};
    return e;
}

static void append_children(SheenXml *parent, SheenXml *first, SheenXml *last)
{
    if (!first) return;
    if (parent->last)
        parent->last->next = first;
    else
        parent->first = first;
    parent->last = last;
}

/** The children of the included file's root stand in the place of <include>; a root that is no <scene> does so itself.
 */
static void include(Source *s, const SheenXml *e, SheenXml *parent)
{
    Document *d = s->document;
    const char *name = sheen_xml_attribute(e, "filename");
    if (!name || !parent) {
        stop(s, SHEEN_ERR_PARSE, "<include> needs 'filename' and a place inside another element");
        return;
    }
    if (!d->with_files || ++d->n_includes > SHEEN_XML_MAX_INCLUDES) {
        stop(s, SHEEN_ERR_PARSE, "%s", d->with_files ? "too many includes" : "includes are not allowed here");
        return;
    }
    const char *path = sheen_xml_find_file(d->folders, d->arena, s->path, name);
    if (!path) {
        stop(s, SHEEN_ERR_IO, "cannot open the included file '%s'", name);
        return;
    }
    SheenXml *root = NULL;
    SheenStatus status = read_source(d, s, path, &root);
    if (status == SHEEN_ERR_INVALID) {
        stop(s, SHEEN_ERR_PARSE, "cyclic include of '%s'", path);
    } else if (status) {
        s->status = status; // reported at its own place
        XML_StopParser(s->parser, XML_FALSE);
    } else if (strcmp(root->tag, "scene") == 0) {
        append_children(parent, root->first, root->last);
    } else {
        append_children(parent, root, root);
    }
}

static void XMLCALL on_start(void *user, const char *tag, const char **attributes)
{
    Source *s = user;
    if (s->status) return;
    if (s->outer_depth + s->depth == SHEEN_XML_MAX_DEPTH) {
        stop(s, SHEEN_ERR_PARSE, "elements are nested more than %d deep", SHEEN_XML_MAX_DEPTH);
        return;
    }
    SheenXml *e = new_element(s, tag, attributes);
    if (!e) return;
    SheenXml *parent = s->depth ? s->open[s->depth - 1] : NULL;
    s->open[s->depth++] = e;
    if (!s->root) s->root = e;
    if (strcmp(tag, "include") == 0)
        include(s, e, parent);
    else if (strcmp(tag, "default") == 0)
        define_parameter(s, e);
    else if (strcmp(tag, "path") == 0)
        add_path(s, e);
    else if (parent)
        append_children(parent, e, e);
}

static void XMLCALL on_end(void *user, const char *tag)
{
    (void)tag; // expat has checked that it matches
    Source *s = user;
    if (!s->status) s->depth--;
}

static void XMLCALL on_text(void *user, const char *text, int length)
{
    Source *s = user;
    for (int i = 0; i < length; ++i)
        if (!strchr(" \t\r\n", text[i])) {
            stop(s, SHEEN_ERR_PARSE, "unexpected text between elements: '%.*s'", length - i < 40 ? length - i : 40,
                 text + i);
            return;
        }
}

/** Scenes have no use for entities, and a few lines of them can grow to gigabytes. */
static void XMLCALL on_entity(void *user, const char *name, int is_parameter, const char *value, int value_length,
                              const char *base, const char *system_id, const char *public_id, const char *notation)
{
    (void)is_parameter, (void)value, (void)value_length, (void)base, (void)system_id, (void)public_id, (void)notation;
    stop(user, SHEEN_ERR_PARSE, "the entity '%s' is declared: entities are not allowed", name);
}

/** Encodings that expat does not know, most likely of one byte a letter: read as Latin-1, which names survive. */
static int XMLCALL on_encoding(void *user, const char *name, XML_Encoding *info)
{
    (void)user, (void)name;
    for (int i = 0; i < 256; ++i) info->map[i] = i;
    info->data = NULL;
    info->convert = NULL;
    info->release = NULL;
    return XML_STATUS_OK;
}

// ---- files ------------------------------------------------------------------------------------------------------

static SheenStatus parse(Source *s, const char *text, size_t size)
{
    s->parser = XML_ParserCreate(NULL);
    if (!s->parser) return sheen_fail(s->document->log, SHEEN_ERR_NOMEM, "%s: out of memory", s->path);
    XML_SetUserData(s->parser, s);
    XML_SetElementHandler(s->parser, on_start, on_end);
    XML_SetCharacterDataHandler(s->parser, on_text);
    XML_SetEntityDeclHandler(s->parser, on_entity);
    XML_SetUnknownEncodingHandler(s->parser, on_encoding, NULL);
    // Fed in pieces: expat counts bytes in int.
    const size_t piece = (size_t)1 << 28;
    enum XML_Status ok = XML_STATUS_OK;
    for (size_t at = 0; ok == XML_STATUS_OK; at += piece) {
        size_t n = size - at < piece ? size - at : piece;
        bool last = at + n == size;
        ok = XML_Parse(s->parser, text + at, (int)n, last);
        if (last) break;
    }
    if (ok != XML_STATUS_OK && !s->status) stop(s, SHEEN_ERR_PARSE, "%s", XML_ErrorString(XML_GetErrorCode(s->parser)));
    XML_ParserFree(s->parser);
    return s->status;
}

/** @return SHEEN_ERR_INVALID, without a message, when the file is being read already. */
static SheenStatus read_source(Document *document, const Source *outer, const char *path, SheenXml **root)
{
    char *real_path = realpath(path, NULL);
    for (const Source *o = outer; o && real_path; o = o->outer)
        if (o->real_path && strcmp(o->real_path, real_path) == 0) {
            free(real_path);
            return SHEEN_ERR_INVALID;
        }
    uint8_t *text;
    size_t size;
    SheenStatus status = sheen_file_read(path, document->log, &text, &size);
    if (!status) {
        Source s = {.document = document,
                    .outer = outer,
                    .outer_depth = outer ? outer->outer_depth + outer->depth : 0,
                    .path = sheen_arena_strdup(document->arena, path),
                    .real_path = real_path};
        status = s.path ? parse(&s, (const char *)text, size) : sheen_fail(document->log, SHEEN_ERR_NOMEM, "%s", path);
        *root = s.root;
        free(text);
    }
    free(real_path);
    return status;
}

SheenStatus sheen_xml_read(const char *path, SheenDefines defines, SheenArena *arena, const SheenLog *log,
                           SheenXmlTree *out)
{
    *out = (SheenXmlTree){0};
    Document d = {.arena = arena, .log = log, .with_files = true};
    SheenXml *root = NULL;
    SheenStatus status = add_defines(&d, defines, path);
    if (!status && !add_folder(&d, path)) status = sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", path);
    if (!status) status = read_source(&d, NULL, path, &root);
    if (status) return status;
    warn_of_unused(&d, defines, path);
    *out = (SheenXmlTree){root, d.folders};
    return SHEEN_OK;
}

SheenStatus sheen_xml_parse(const char *text, size_t size, const char *name, bool with_files, SheenArena *arena,
                            const SheenLog *log, SheenXmlTree *out)
{
    *out = (SheenXmlTree){0};
    Document d = {.arena = arena, .log = log, .with_files = with_files};
    Source s = {.document = &d, .path = sheen_arena_strdup(arena, name)};
    if (!s.path || !add_folder(&d, name)) return sheen_fail(log, SHEEN_ERR_NOMEM, "%s: out of memory", name);
    SheenStatus status = parse(&s, text, size);
    if (!status) *out = (SheenXmlTree){s.root, d.folders};
    return status;
}

// ---- use --------------------------------------------------------------------------------------------------------

const char *sheen_xml_attribute(const SheenXml *e, const char *name)
{
    for (uint32_t i = 0; i < e->n_attributes; ++i)
        if (strcmp(e->attributes[i].name, name) == 0) return e->attributes[i].value;
    return NULL;
}

#define FORMAT_AT(text)                                                                                                \
    char text[900];                                                                                                    \
    va_list args;                                                                                                      \
    va_start(args, format);                                                                                            \
    vsnprintf(text, sizeof text, format, args);                                                                        \
    va_end(args)

SheenStatus sheen_xml_fail(const SheenLog *log, SheenStatus status, const SheenXml *at, const char *format, ...)
{
    FORMAT_AT(text);
    return sheen_fail(log, status, "%s:%u:%u: %s", at->file, at->line, at->column, text);
}

void sheen_xml_warn(const SheenLog *log, const SheenXml *at, const char *format, ...)
{
    FORMAT_AT(text);
    sheen_warn(log, "%s:%u:%u: %s", at->file, at->line, at->column, text);
}

void sheen_xml_info(const SheenLog *log, const SheenXml *at, const char *format, ...)
{
    FORMAT_AT(text);
    sheen_info(log, "%s:%u:%u: %s", at->file, at->line, at->column, text);
}
