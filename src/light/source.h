// SPDX-License-Identifier: Apache-2.0
// A light made ready for sampling, and the functions that each kind of it implements.
#ifndef SHEEN_LIGHT_SOURCE_H
#define SHEEN_LIGHT_SOURCE_H

#include "light/environment.h"
#include "light/light.h"
#include "light/spherical.h"
#include "light/spot.h"
#include "light/sun.h"

/** In the order in which choose.c estimates them. */
typedef enum SourceKind {
    SOURCE_RECTANGLE, // mesh of two triangles that form one
    SOURCE_TRIANGLE,  // mesh of one triangle
    SOURCE_DISK,
    SOURCE_SPHERE,
    SOURCE_MESH, // any other mesh
    SOURCE_POINT,
    SOURCE_SPOT, // and projectors
    SOURCE_DIRECTIONAL,
    SOURCE_SUN, // directional with a disk
    SOURCE_ENVIRONMENT,
    SOURCE_KINDS
} SourceKind;

typedef struct Source {
    SourceKind kind;
    const SheenLight *light;
    const SheenShape *shape;  // area lights
    float brightness;         // mean of the channels of the radiance, over an area light's surface
    Vec3 center;              // of a sphere that holds the light
    float radius;             // infinite for a light without a place
    float power;              // over squared distance, about the irradiance of a surface that faces the light; a light
                              // without a place: the irradiance, at most
    double area;              // area lights, m^2
    SheenRectangle rectangle; // rectangle; the disk's bounding rectangle
    float unit_x, unit_y, skew; // disk: (x, y) metres along its rectangle's axes, from the centre, are the point
                                // ((x - skew y) unit_x, y unit_y) of the unit disk
    double *triangle_cdf;       // meshes: [n_triangles + 1], from 0 to 1
    Vec3 axis;                  // meshes: all normals are within a cone about it
    float cos_cone;             // cosine of the cone's half-angle
    EnvironmentSampler environment;
    SunDisk sun;
} Source;

/** A point on a finite light, seen from a point p. */
typedef struct SourcePoint {
    Vec3 q;            // world space
    Vec3 n;            // unit normal of the front
    Vec3 wi;           // unit, from p to q
    float distance;    // from p to q, metres
    float solid_angle; // one over the density of wi, sr
    uint32_t triangle; // of a mesh, SHEEN_NONE for a rectangle
} SourcePoint;

/**
 * Completes a source from a light of the scene.
 * @param arena  gets tables
 * @return SHEEN_ERR_NOMEM; the area is 0 when the light has none
 */
SHEEN_NODISCARD SheenStatus sheen_source_init(const SheenScene *scene, const SheenLight *light,
                                              SheenEnvironmentSplit split, SheenArena *arena, Source *out);

/** Draws a point of an area light as seen from p. @return false when there is none, or p is behind it. */
bool sheen_source_sample_area(const Source *s, Vec3 p, Vec2 u, SourcePoint *out);

/** @return the density, 1/sr, with which sheen_source_sample_area from p draws the direction to q on the light. */
float sheen_source_pdf_area(const Source *s, Vec3 p, Vec3 q, uint32_t triangle);

/** Mean of the channels: what choices among lights go by, since errors count in all channels alike. */
static inline float rgb_mean(Rgb c)
{
    return (c.r + c.g + c.b) * (1.0f / 3.0f);
}

#endif
