// SPDX-License-Identifier: Apache-2.0
// Mitsuba scenes, versions 0.5, 0.6, 2 and 3: what the parts of their reader share. Format: nimierdavid2019-mitsuba2,
// jakob2022-mitsuba3 and jakob2010-mitsuba, their manuals' plugin references; where those leave doubt, the comments say
// what Mitsuba 3 does.
#ifndef SHEEN_IO_MITSUBA_H
#define SHEEN_IO_MITSUBA_H

#include "io/mesh.h"
#include "io/xml.h"
#include "scene/builder.h"

/** A picture file that is in memory already. */
typedef struct MitsubaBitmap {
    const char *path;
    bool floats;  // read as float
    double gamma; // of the table for bytes: 0 sRGB, 1 raw, else the exponent
    SheenBitmap bitmap;
    struct MitsubaBitmap *next;
} MitsubaBitmap;

/**
 * A scene being read. The first error is reported at once and kept in `status`; the functions below then return their
 * defaults, so that only loops need to look at it.
 */
typedef struct Mitsuba {
    const SheenLog *log;
    SheenBuilder *builder;
    SheenArena *arena;   // of the scene
    SheenArena *scratch; // of the tree, gone after reading
    SheenXml *root;
    const SheenXmlFolder *folders; // where files are looked for
    SheenXml **ids;                // hash table of the elements with an id
    uint32_t n_ids;                // its size, a power of two
    int version;                   // major
    bool with_files;
    MitsubaBitmap *bitmaps;
    uint32_t lamp_material, clear_material; // counted from 1; 0 when there is none yet
    bool has_sky;                           // one has been baked into an image
    int material_depth;                     // of the materials inside each other that are being read
    SheenStatus status;
} Mitsuba;

/** Reads a scene file. Errors as in sheen_scene_load. */
SHEEN_NODISCARD SheenStatus sheen_mitsuba_read(const char *path, SheenDefines defines, const SheenLog *log,
                                               SheenScene **out);

/** Reads a scene from memory. @param name stands for the file; @param with_files false makes any other file an error */
SHEEN_NODISCARD SheenStatus sheen_mitsuba_parse(const char *text, size_t size, const char *name, bool with_files,
                                                const SheenLog *log, SheenScene **out);

// ---- mitsuba_value.c: properties --------------------------------------------------------------------------------

/** Reports an error at an element, unless there was one before. */
void sheen_mi_fail(Mitsuba *m, SheenStatus status, const SheenXml *at, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/** @return true when names are the same but for case and underscores: toWorld and to_world, intIOR and int_ior. */
bool sheen_mi_same(const char *a, const char *b);

/** @return the plugin's name, "" when none is given. */
const char *sheen_mi_type(const SheenXml *e);

/** @return the first child of that property name, or NULL; it counts as used. */
SheenXml *sheen_mi_child(const SheenXml *e, const char *name);

/** Marks properties as known but without effect here. `names` are separated by spaces. */
void sheen_mi_ignore(const SheenXml *e, const char *names);

/** Warns once of each child that nobody asked for. */
void sheen_mi_report_unused(Mitsuba *m, const SheenXml *e);

/** Fills the table of ids; one given twice is an error. */
void sheen_mi_collect_ids(Mitsuba *m);

/** @return the element that `e` stands for: itself, or what a <ref> refers to; NULL, an error, when there is none. */
SheenXml *sheen_mi_resolve(Mitsuba *m, SheenXml *e);

/** @return the first child, or target of a <ref> among the children, with that tag; NULL when there is none. */
SheenXml *sheen_mi_nested(Mitsuba *m, const SheenXml *e, const char *tag);

double sheen_mi_float(Mitsuba *m, const SheenXml *e, const char *name, double otherwise);
int64_t sheen_mi_integer(Mitsuba *m, const SheenXml *e, const char *name, int64_t otherwise);
bool sheen_mi_bool(Mitsuba *m, const SheenXml *e, const char *name, bool otherwise);
const char *sheen_mi_string(Mitsuba *m, const SheenXml *e, const char *name, const char *otherwise);
/** <point>, <vector>: x y z, or value. */
Vec3 sheen_mi_vector(Mitsuba *m, const SheenXml *e, const char *name, Vec3 otherwise);
/** <transform>: its parts are applied in the order in which they stand. */
Transform sheen_mi_transform(Mitsuba *m, const SheenXml *e, const char *name);

/** How a spectrum becomes a colour. */
typedef enum MitsubaColor { MITSUBA_REFLECTANCE, MITSUBA_EMISSION, MITSUBA_INDEX } MitsubaColor;

/** Reads numbers separated by commas or spaces. @return how many; -1 when there are more or something is not finite. */
int sheen_mi_numbers(const char *text, int max, double out[]);

// ---- mitsuba_color.c --------------------------------------------------------------------------------------------

/** @return the colour that an element <rgb>, <srgb>, <spectrum>, <blackbody>, <float>, ... gives. */
Rgb sheen_mi_color_of(Mitsuba *m, SheenXml *value, MitsubaColor kind);
Rgb sheen_mi_color(Mitsuba *m, const SheenXml *e, const char *name, MitsubaColor kind, Rgb otherwise);

// ---- mitsuba_value.c: files -------------------------------------------------------------------------------------

/** @return the path of a file named by an element, beside the scene; NULL, an error, when it cannot be read. */
const char *sheen_mi_path(Mitsuba *m, const SheenXml *e, const char *property, const char *what);

// ---- the other parts --------------------------------------------------------------------------------------------

/** mitsuba_texture.c: a property that is a colour or a texture. Reflectances are clamped to [0, 1] with a warning. */
SheenTexture sheen_mi_texture(Mitsuba *m, const SheenXml *e, const char *name, Rgb otherwise);
/** The same of the element itself, resolved. Only reflectances are clamped. */
SheenTexture sheen_mi_texture_of(Mitsuba *m, SheenXml *value, MitsubaColor kind, Rgb otherwise);
/** A property that is a number or a texture; a number outside [lo, hi] is clamped with a warning. */
SheenTexture sheen_mi_factor(Mitsuba *m, const SheenXml *e, const char *name, float otherwise, float lo, float hi);
/** A picture file, read once for all who use it. `floats` for environments. @return false after an error. */
bool sheen_mi_bitmap(Mitsuba *m, const SheenXml *e, bool floats, double gamma, SheenBitmap *out);

/** What a reader of a material fills in. */
typedef void SheenMitsubaMaterialFn(Mitsuba *m, SheenXml *e, SheenMaterial *out);
/** mitsuba_layers.c: materials that hold others. */
SheenMitsubaMaterialFn sheen_mi_twosided, sheen_mi_blend, sheen_mi_mixture, sheen_mi_mask, sheen_mi_bumpmap,
    sheen_mi_normalmap, sheen_mi_coating, sheen_mi_roughcoating;
/** mitsuba_lafortune.c. */
void sheen_mi_lafortune(Mitsuba *m, SheenXml *e, SheenMaterial *out);
/** mitsuba_bsdf.c: diffuse 0.5; reads a <bsdf> into *out; and parts that layers have too. */
SheenMaterial sheen_mi_default_material(void);
void sheen_mi_read_material(Mitsuba *m, SheenXml *e, SheenMaterial *out);
float sheen_mi_relative_ior(Mitsuba *m, const SheenXml *e, double inside);
void sheen_mi_roughness(Mitsuba *m, SheenXml *e, SheenMaterial *out);

/** mitsuba_bsdf.c: the material of a <bsdf>, made when first asked for; NULL is Mitsuba's default, diffuse 0.5. */
uint32_t sheen_mi_material(Mitsuba *m, SheenXml *bsdf);
/** The default of shapes that shine: black. */
uint32_t sheen_mi_lamp_material(Mitsuba *m);
/** Of borders that are not seen. */
uint32_t sheen_mi_clear_material(Mitsuba *m);

/** mitsuba_shape.c: adds a shape of the world, or of the open group; its emitter is left out in a group. */
void sheen_mi_shape(Mitsuba *m, SheenXml *e, bool in_group);
/** Makes a group of a shapegroup; its index is put into e->index. */
void sheen_mi_shape_group(Mitsuba *m, SheenXml *e);

/** Curves that become tubes. */
typedef enum MitsubaCurve { MITSUBA_CURVE_LINEAR, MITSUBA_CURVE_SPLINE, MITSUBA_CURVE_HAIR } MitsubaCurve;
/** mitsuba_curve.c: reads the curves of a shape into world space. @return false after an error */
bool sheen_mi_curves(Mitsuba *m, SheenXml *e, MitsubaCurve kind, MeshData *mesh);

/** mitsuba_heightfield.c: reads a height field into its own space. @return false after an error */
bool sheen_mi_height_field(Mitsuba *m, SheenXml *e, MeshData *mesh);

/** mitsuba_light.c: adds a light that is not on a shape. */
void sheen_mi_emitter(Mitsuba *m, SheenXml *e);

/** mitsuba_sky.c: adds the lights of `sky`, `sun` or `sunsky`. */
void sheen_mi_sky(Mitsuba *m, SheenXml *e);

/** mitsuba_camera.c: full horizontal angle of a picture `aspect` times as wide as high, radians; 0 after an error. */
double sheen_mi_fov(Mitsuba *m, const SheenXml *e, double aspect);
/** mitsuba_camera.c: adds the camera of a <sensor>. */
void sheen_mi_sensor(Mitsuba *m, SheenXml *e);

#endif
