// SPDX-License-Identifier: Apache-2.0
// Mitsuba's XML as a tree of elements with their places; <include>, <path>, <default> and $parameters are already
// resolved.
#ifndef SHEEN_IO_XML_H
#define SHEEN_IO_XML_H

#include "base/arena.h"
#include "base/log.h"
#include "io/defines.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Files included in one scene, depth of elements, and bytes of one attribute after parameters are put in. */
enum { SHEEN_XML_MAX_INCLUDES = 1000, SHEEN_XML_MAX_DEPTH = 64, SHEEN_XML_MAX_EXPANSION = 1 << 16 };

typedef struct SheenXmlAttribute {
    const char *name, *value;
} SheenXmlAttribute;

typedef struct SheenXml {
    const char *tag;
    const SheenXmlAttribute *attributes;
    uint32_t n_attributes;
    const char *file; // the file that the element stands in
    uint32_t line, column;
    struct SheenXml *first, *last, *next; // children in order, next sibling
    // For the reader of the tree:
    bool used;      // someone asked for it
    bool busy;      // is being read: met again, it refers to itself
    bool warned;    // its warnings have been given
    uint32_t index; // of what was made of it, SHEEN_NONE (UINT32_MAX) before
} SheenXml;

/** A folder in which files are looked for: a path that ends in '/', or a file of it. */
typedef struct SheenXmlFolder {
    const char *path;
    struct SheenXmlFolder *next;
} SheenXmlFolder;

/** What a file and its includes hold. */
typedef struct SheenXmlTree {
    SheenXml *root;          // the outermost element
    SheenXmlFolder *folders; // those of <path>, the last first, then that of the scene
} SheenXmlTree;

/**
 * Parses a file.
 * @param defines  parameters that are given already; one that nothing refers to is told in a warning
 * @param arena    holds the tree
 * Errors: SHEEN_ERR_IO, SHEEN_ERR_PARSE (not well-formed, an entity declared, an undefined parameter, a cyclic include,
 * a limit above exceeded), SHEEN_ERR_NOMEM; each with the place.
 */
SHEEN_NODISCARD SheenStatus sheen_xml_read(const char *path, SheenDefines defines, SheenArena *arena,
                                           const SheenLog *log, SheenXmlTree *out);

/**
 * Parses text in memory.
 * @param name        stands for the file in messages
 * @param with_files  false makes <include> an error
 */
SHEEN_NODISCARD SheenStatus sheen_xml_parse(const char *text, size_t size, const char *name, bool with_files,
                                            SheenArena *arena, const SheenLog *log, SheenXmlTree *out);

/**
 * Looks for a file in the folders of the scene, then beside the file `beside` that names it. A backslash in a name that
 * is nowhere parts folders, as where the scene was written.
 * @return its path, in the arena; NULL when there is none that can be read, or no memory
 */
const char *sheen_xml_find_file(const SheenXmlFolder *folders, SheenArena *arena, const char *beside, const char *name);

/** @return the attribute's value, or NULL. */
const char *sheen_xml_attribute(const SheenXml *e, const char *name);

/** Reports `FILE:LINE:COLUMN: ...` at an element and returns `status`. */
SheenStatus sheen_xml_fail(const SheenLog *log, SheenStatus status, const SheenXml *at, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
void sheen_xml_warn(const SheenLog *log, const SheenXml *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void sheen_xml_info(const SheenLog *log, const SheenXml *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
