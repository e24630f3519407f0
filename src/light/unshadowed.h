// SPDX-License-Identifier: Apache-2.0
// Estimates of the unshadowed irradiance from each light, cheap enough to be asked for every light at every shading
// point. The lights lie in arrays by kind; each loop over them is without branches, so that the compiler turns it into
// vector instructions.
#ifndef SHEEN_LIGHT_UNSHADOWED_H
#define SHEEN_LIGHT_UNSHADOWED_H

#include "light/source.h"

/** The arrays are longer than their kind by this, zero there, and results may run over by less than this. */
#define ESTIMATE_PADDING 8u

/** Flat convex lights with four vertices; a triangle has its last one twice, a disk is in its bounding rectangle. */
typedef struct Polygons {
    float *x[4], *y[4], *z[4];
    float *nx, *ny, *nz; // unit normal of the front
    float *area;         // of the polygon, m^2
    float *power;        // radiance times the share of the polygon that shines
} Polygons;

typedef struct Spheres {
    float *x, *y, *z, *r2;
    float *outside, *inside; // radiance on either side
} Spheres;

/** Anything within a sphere, with normals within a cone. */
typedef struct Bodies {
    float *x, *y, *z, *r2;
    float *nx, *ny, *nz;        // axis of the cone
    float *cos_cone, *sin_cone; // its half-angle
    float *power;               // as Source.power
} Bodies;

typedef struct Points {
    float *x, *y, *z;
    float *intensity;
} Points;

/** All lights, in the order of the sources. */
typedef struct EstimateTable {
    const Source *sources;
    uint32_t end[5]; // one past the last of: polygons, spheres, meshes, points, and the rest without arrays
    Polygons polygons;
    Spheres spheres;
    Bodies meshes;
    Points points;
} EstimateTable;

/** @param sources  [n] in the order of their kinds; borrowed. @return false when out of memory */
bool sheen_estimate_table_init(const Source sources[], uint32_t n, SheenArena *arena, EstimateTable *out);

/** @param w  [count + ESTIMATE_PADDING] gets the estimates for lights first .. first + count - 1 at (p, n), >= 0 */
void sheen_estimate_table_weigh(const EstimateTable *t, uint32_t first, uint32_t count, Vec3 p, Vec3 n, float w[]);

/** Arrays for n bodies. @return false when out of memory */
bool sheen_bodies_init(uint32_t n, SheenArena *arena, Bodies *out);

/** As sheen_estimate_table_weigh. */
void sheen_bodies_weigh(const Bodies *b, uint32_t first, uint32_t count, Vec3 p, Vec3 n, float w[]);

#endif
