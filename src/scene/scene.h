// SPDX-License-Identifier: Apache-2.0
// The immutable scene: plain arrays, made by a builder (scene/builder.h), read by everybody.
#ifndef SHEEN_SCENE_SCENE_H
#define SHEEN_SCENE_SCENE_H

#include "math/bounds.h"
#include "math/frame.h"
#include "math/microfacet.h"
#include "math/transform.h"
#include "math/vec.h"
#include "scene/filter.h"
#include "scene/texture.h"

#include <stdint.h>

/** "No such index" in all index fields of the scene. */
#define SHEEN_NONE UINT32_MAX

// ---- shapes -----------------------------------------------------------------------------------------------------

typedef enum SheenShapeKind { SHEEN_SHAPE_MESH, SHEEN_SHAPE_SPHERE, SHEEN_SHAPE_DISK } SheenShapeKind;

/** Triangles in world space (or in their group's space). The front side is where the vertices run counter-clockwise. */
typedef struct SheenMesh {
    uint32_t n_vertices, n_triangles;
    const Vec3 *p;                  // [n_vertices + 1], metres; the last is padding for Embree's 16-byte loads
    const Vec3 *n;                  // [n_vertices] unit shading normals, NULL for face normals
    const Vec2 *uv;                 // [n_vertices], NULL when the mesh has none
    const uint32_t (*triangles)[3]; // [n_triangles] indices of vertices
    const Rgb *color;               // [n_vertices], NULL when the mesh has none: for SHEEN_TEXTURE_VERTEX_COLOR
    const Rgb *face_color;          // [n_triangles], NULL: for SHEEN_TEXTURE_FACE_COLOR
} SheenMesh;

/** The front side is outside, or inside when `flip`. */
typedef struct SheenSphere {
    Vec3 center;
    float radius;
    bool flip;
    Frame frame; // object axes in the world, for uv: u = azimuth / 2 pi, v = polar angle / pi about frame.n
} SheenSphere;

/** Points center + x du + y dv with x^2 + y^2 <= 1; an ellipse when du and dv differ. */
typedef struct SheenDisk {
    Vec3 center, du, dv;
    Vec3 n; // unit, du x dv normalized or its negative: the front side
} SheenDisk;

typedef struct SheenShape {
    SheenShapeKind kind;
    union {
        SheenMesh mesh;
        SheenSphere sphere;
        SheenDisk disk;
    };
    uint32_t material; // index into scene->materials
    uint32_t light;    // index into scene->lights of the area light on this shape, or SHEEN_NONE
    const char *name;  // for messages; never NULL
} SheenShape;

/** A run of shapes that is placed as a whole. Group 0 is the world and is placed once, untransformed. */
typedef struct SheenGroup {
    uint32_t first_shape, n_shapes;
} SheenGroup;

/** A copy of a group other than 0. One level only: instances hold no instances. */
typedef struct SheenInstance {
    uint32_t group;
    Transform to_world, to_group; // inverses of each other
} SheenInstance;

// ---- materials --------------------------------------------------------------------------------------------------

typedef enum SheenMaterialKind {
    SHEEN_MATERIAL_DIFFUSE,         // Lambertian: reflectance
    SHEEN_MATERIAL_CONDUCTOR,       // smooth metal: eta, k, specular_reflectance
    SHEEN_MATERIAL_DIELECTRIC,      // smooth glass: ior, specular_reflectance, specular_transmittance
    SHEEN_MATERIAL_THIN_DIELECTRIC, // a pane without thickness: the same parameters
    SHEEN_MATERIAL_ROUGH_CONDUCTOR, // metal of microfacets: as conductor, and distribution, alpha_u, alpha_v
    SHEEN_MATERIAL_ROUGH_DIELECTRIC,
    SHEEN_MATERIAL_PLASTIC, // a smooth interface on a diffuse base: ior, reflectance, specular_reflectance, nonlinear
    SHEEN_MATERIAL_ROUGH_PLASTIC,    // the same, and distribution and alpha_u for both axes
    SHEEN_MATERIAL_DIFFUSE_TRANSMIT, // Lambertian toward the other side: specular_transmittance
    SHEEN_MATERIAL_PHONG,            // reflectance, specular_reflectance, exponent
    SHEEN_MATERIAL_WARD,             // reflectance, specular_reflectance, alpha_u, alpha_v, ward
    SHEEN_MATERIAL_PRINCIPLED,       // reflectance (the base colour), ior, alpha_u (the roughness), principled
    SHEEN_MATERIAL_PRINCIPLED_THIN,  // the same of a sheet without thickness
    SHEEN_MATERIAL_LAFORTUNE,        // reflectance, specular_reflectance, lafortune
    SHEEN_MATERIAL_ROUGH_DIFFUSE,    // Oren and Nayar's: reflectance, alpha_u, fast
    // Materials that hold others.
    SHEEN_MATERIAL_BLEND,   // 1 - weight of nested[0] and weight of nested[1]
    SHEEN_MATERIAL_SIDES,   // nested[0] on the front, nested[1] on the back, seen as if that were the front
    SHEEN_MATERIAL_MASK,    // weight of nested[0], the rest goes straight through
    SHEEN_MATERIAL_BUMP,    // nested[0] on a surface raised by map, metres, times map_scale
    SHEEN_MATERIAL_NORMAL,  // nested[0] about the normals of map, (colour + 1) / 2 in the frame of normal and dp/du
    SHEEN_MATERIAL_COATING, // nested[0] under a smooth interface: ior, absorption, specular_reflectance
    SHEEN_MATERIAL_ROUGH_COATING, // the same, and distribution and alpha_u for both axes
    SHEEN_MATERIAL_COUNT,         // not a kind
} SheenMaterialKind;

/** A material has at most so many elementary BSDFs and wrappers: they are looked up in shading, on the stack. */
enum { SHEEN_MATERIAL_MAX_LOBES = 8, SHEEN_MATERIAL_MAX_WRAPS = 8 };

typedef enum SheenWard { SHEEN_WARD_BALANCED, SHEEN_WARD_DUER, SHEEN_WARD_ORIGINAL } SheenWard;

/** What a principled material has beyond the others' parameters; all in [0, 1] but diff_trans, in [0, 2]. */
typedef struct SheenPrincipled {
    SheenTexture anisotropic, spec_trans, spec_tint, sheen, sheen_tint, flatness;
    SheenTexture metallic, clearcoat, clearcoat_gloss; // not of a sheet
    SheenTexture diff_trans;                           // of a sheet: twice the share of diffuse light that goes through
} SheenPrincipled;

/** A lobe of Lafortune's: f = weight (n + 2) / (2 pi) max(0, c.x wo_x wi_x + c.y wo_y wi_y + c.z wo_z wi_z)^n. */
typedef struct SheenLafortune {
    Vec3 c;
    float exponent; // n
    Rgb weight;
} SheenLafortune;

typedef struct SheenMaterial {
    SheenMaterialKind kind;
    bool two_sided;                      // the back side looks like the front (not where something transmits)
    bool nonlinear;                      // plastics: colour shifts by light that is reflected inside
    bool fast;                           // rough diffuse: the simpler formula
    SheenTexture reflectance;            // diffuse albedo
    SheenTexture specular_reflectance;   // factor on reflection
    SheenTexture specular_transmittance; // factor on transmission
    Rgb eta, k;                          // conductor: complex refractive index relative to outside
    float ior;                           // dielectric: interior over exterior refractive index
    SheenDistribution distribution;      // of microfacets
    SheenTexture alpha_u, alpha_v;       // their roughness along dp/du and across; the luminance counts
    float exponent;                      // phong
    SheenWard ward;                      // which of the formulas
    Rgb absorption;                      // coating: of a perpendicular way through, absorption coefficient x thickness
    SheenTexture weight;                 // blend, mask; the luminance counts
    SheenTexture map;                    // bump: height, its luminance; normal: the normals
    float map_scale;                     // bump: factor on the height
    bool turn_normals;                   // maps: a normal that faces away from the viewer is turned about the surface's
    bool shadow_normals;                 // maps: light along the surface fades out, see conty2019-terminator
    uint32_t nested[2];                  // index of materials that were added before
    const SheenPrincipled *principled;   // in the builder's arena; NULL for other kinds
    const SheenLafortune *lafortune;     // [n_lafortune] in the builder's arena
    uint32_t n_lafortune;                // at most SHEEN_MATERIAL_MAX_LOBES - 1
    const char *name;                    // id in the scene file or plugin name; never NULL
    // Completed by the builder:
    const struct SheenCoat *coat; // rough interfaces with something below: what they let through
    float inside;                 // plastic: reflectance of the interface for diffuse light from below
    uint32_t n_lobes, n_wraps;    // elementary BSDFs that it consists of, and wrappers around them
    bool anisotropic;             // alpha_u and alpha_v differ: shading needs dp/du
    bool has_two_sides;           // some of it is an interface between two media
} SheenMaterial;

// ---- lights -----------------------------------------------------------------------------------------------------

typedef enum SheenLightKind {
    SHEEN_LIGHT_AREA,        // radiance from the front side of a shape
    SHEEN_LIGHT_POINT,       // radiance = intensity, W/sr
    SHEEN_LIGHT_SPOT,        // intensity on the axis, linear falloff in angle between cos_inner and cos_outer; times a
                             // texture, if any
    SHEEN_LIGHT_DIRECTIONAL, // radiance = irradiance on a surface that faces it, W/m^2
    SHEEN_LIGHT_ENVIRONMENT, // constant (environment.width = 0) or an image
    SHEEN_LIGHT_PROJECTOR,   // radiance times texture = intensity on the axis; elsewhere over the cube of the cosine
    SHEEN_LIGHT_KINDS        // not a kind
} SheenLightKind;

typedef struct SheenLight {
    SheenLightKind kind;
    Rgb radiance; // W m^-2 sr^-1 for area and constant environment; see the kinds; factor for an environment image
    const SheenTexture *texture;  // area: the radiance over the shape's uv, of which `radiance` is then the mean; spot,
                                  // projector: over the window; or NULL
    uint32_t shape;               // area: the shape, never inside an instanced group
    Vec3 position;                // point, spot, projector
    Vec3 direction;               // spot: axis; directional: the way the light travels; unit
    float cos_inner, cos_outer;   // spot: full intensity inside, zero outside
    float disk;                   // directional: angular radius of the even disk that it comes from, a sun's, radians
                                  // in [0, pi / 2); 0: a direction alone, which cannot be seen
    float tan_x, tan_y;           // spot and projector with a texture: it fills the window |x| <= tan_x z,
                                  // |y| <= tan_y z of the light's own space, u along x and v against y
    SheenBitmap environment;      // float latitude-longitude image; row 0 is up, +y of its own space
    Transform to_world, to_light; // environment image, and lights with a window. In an image's own space a direction d
                                  // has u = atan2(d.x, -d.z) / 2 pi (wrapped to [0, 1)), v = acos(d.y) / pi
} SheenLight;

// ---- camera -----------------------------------------------------------------------------------------------------

typedef struct SheenCamera {
    const char *name;       // never NULL
    Transform to_world;     // looks along +z, +y up, +x to the left in the picture (Mitsuba's convention); may mirror
    float fov_x;            // full horizontal angle of the whole film, radians; 0 when orthographic
    bool orthographic;      // parallel rays along +z from a film two metres wide in its own space
    float aperture, focus;  // radius of a thin lens, 0 for a pinhole, and distance of the plane in focus; own space
    Vec2 cut_lo, cut_hi;    // parts of the film left out of the picture: left and above, right and below, as fractions
                            // of its width and height; a film that is shifted has one of a pair below zero
    uint32_t width, height; // pixels of the picture, from the scene's film
    uint32_t spp;           // samples per pixel that the scene asks for, 0 when it says nothing
    SheenFilter filter;     // by which samples make pixels
} SheenCamera;

// ---- the whole --------------------------------------------------------------------------------------------------

typedef struct SheenScene {
    const char *name; // file name of the scene
    const SheenShape *shapes;
    uint32_t n_shapes;
    const SheenGroup *groups;
    uint32_t n_groups; // >= 1
    const SheenInstance *instances;
    uint32_t n_instances;
    const SheenMaterial *materials;
    uint32_t n_materials;
    const SheenLight *lights;
    uint32_t n_lights;
    uint32_t environment; // index of the environment light, or SHEEN_NONE; at most one
    const SheenCamera *cameras;
    uint32_t n_cameras;       // >= 1
    Bounds bounds;            // of everything, world space; instances included
    uint64_t n_triangles;     // stored, instances not multiplied
    struct SheenArena *arena; // owns everything above
} SheenScene;

/** Frees the scene and sets *scene to NULL. NULL-safe. */
void sheen_scene_destroy(SheenScene **scene);

#endif
