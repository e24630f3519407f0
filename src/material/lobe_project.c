// SPDX-License-Identifier: Apache-2.0
#include "material/lobe_project.h"

#include "math/quadrature.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Rows of directions alike in theta, each of evenly spaced phi. With cos(theta) = s^2 the harmonics of the hemisphere,
// which go as cos^(m/2) at the horizon, are polynomials or nearly, and Gauss's nodes in s crowd where lobes are narrow:
// near the normal and the horizon. Lobes that order n represents are wider than the steps; those that are narrower are
// found to be missing nearly all their energy, as a quadrature's few nodes cannot look like a basis function.
struct LobeQuadrature {
    unsigned n, n_rows, n_columns; // columns of the half 0 < phi < pi
    float *cosine, *weight;        // [n_rows], the weight in cos(theta)
    float *zenith[2];              // [n_rows][n (n + 1) / 2] of each basis
    float *x, *y;                  // [n_columns] cos(phi), sin(phi)
    float *cos_phi, *sin_phi;      // [n_columns][n]: cos(m phi), sin(m phi)
};

LobeQuadrature *sheen_lobe_quadrature(unsigned n)
{
    enum { ROWS_MAX = 20 + 2 * SHEEN_ORDER_MAX };
    const unsigned rows = 20 + 2 * n, columns = 16 + 2 * n;
    const size_t zenith = (size_t)rows * n * (n + 1) / 2, azimuth = (size_t)columns * n;
    LobeQuadrature *q = malloc(sizeof *q + (2 * rows + 2 * zenith + 2 * columns + 2 * azimuth) * sizeof(float));
    if (!q) return NULL;
    float *at = (float *)(q + 1);
    q->n = n, q->n_rows = rows, q->n_columns = columns;
    q->cosine = at, q->weight = at + rows;
    q->zenith[0] = at + 2 * rows, q->zenith[1] = q->zenith[0] + zenith;
    q->x = q->zenith[1] + zenith, q->y = q->x + columns;
    q->cos_phi = q->y + columns, q->sin_phi = q->cos_phi + azimuth;
    double s[ROWS_MAX], w[ROWS_MAX];
    sheen_quadrature_gauss(rows, s, w);
    for (unsigned i = 0; i < rows; ++i) {
        q->cosine[i] = (float)(s[i] * s[i]);
        q->weight[i] = (float)(2.0 * s[i] * w[i]);
        for (int b = 0; b < 2; ++b)
            sheen_basis_zenith((SheenBasis)b, n, q->cosine[i], q->zenith[b] + (size_t)i * n * (n + 1) / 2);
    }
    for (unsigned i = 0; i < columns; ++i) {
        double phi = 3.14159265358979324 * (i + 0.5) / columns;
        q->x[i] = (float)cos(phi), q->y[i] = (float)sin(phi);
        for (unsigned m = 0; m < n; ++m) {
            q->cos_phi[(size_t)i * n + m] = (float)cos(m * phi);
            q->sin_phi[(size_t)i * n + m] = (float)sin(m * phi);
        }
    }
    return q;
}

LobeNode sheen_lobe_node(unsigned n, const LobeFamily *family)
{
    LobeNode node = {.n = n, .n_shapes = family->n_shapes, .isotropic = !family->key.anisotropic};
    node.n_pairs = node.n_shapes * (node.n_shapes + 1) / 2;
    node.coefficients = node.isotropic ? n * (n + 1) / 2 : n * n;
    node.missing = node.n_shapes * node.coefficients;
    node.size = node.missing + (n + 1) * node.n_pairs;
    return node;
}

/** One row: sums over phi of each shape times t_m, m = 0 .. n - 1, and with sin(m phi); and of products of shapes. */
typedef struct Row {
    float even[LOBE_SHAPES_MAX][SHEEN_ORDER_MAX], odd[LOBE_SHAPES_MAX][SHEEN_ORDER_MAX];
    float products[LOBE_SHAPES_MAX * (LOBE_SHAPES_MAX + 1) / 2];
} Row;

static void add_column(const LobeQuadrature *q, const LobeNode *node, unsigned column, float side, const float s[],
                       Row *row)
{
    const float *cos_phi = q->cos_phi + (size_t)column * q->n, *sin_phi = q->sin_phi + (size_t)column * q->n;
    for (unsigned k = 0, pair = 0; k < node->n_shapes; ++k) {
        for (unsigned j = k; j < node->n_shapes; ++j) row->products[pair++] += s[k] * s[j];
        if (s[k] == 0.0f) continue;
        for (unsigned m = 0; m < node->n; ++m) row->even[k][m] += s[k] * cos_phi[m];
        if (node->isotropic) continue;
        for (unsigned m = 0; m < node->n; ++m) row->odd[k][m] += side * s[k] * sin_phi[m];
    }
}

static void sum_row(const LobeQuadrature *q, const LobeNode *node, const LobeFamily *family, const BsdfLobe *prototype,
                    Vec3 wo, unsigned i, Row *row)
{
    memset(row, 0, sizeof *row);
    float z = q->cosine[i], r = safe_sqrtf(1.0f - z * z), s[LOBE_SHAPES_MAX];
    for (unsigned k = 0; k < q->n_columns; ++k) {
        float x = r * q->x[k], y = r * q->y[k];
        sheen_lobe_shapes(family, prototype, wo, v3(x, y, z), s);
        add_column(q, node, k, 1.0f, s, row);
        if (node->isotropic) continue; // the other half is alike
        sheen_lobe_shapes(family, prototype, wo, v3(x, -y, z), s);
        add_column(q, node, k, -1.0f, s, row);
    }
}

/** Adds a row to the coefficients of one shape. @param scale  the row's weight */
static void add_row(const LobeNode *node, const float zenith[], const float even[], const float odd[], float scale,
                    double out[])
{
    const float root2 = 1.41421356237309505f;
    for (unsigned l = 0; l < node->n; ++l)
        for (unsigned m = 0; m <= l; ++m) {
            float k = zenith[basis_zenith_index(l, m)] * scale * (m == 0 ? 1.0f : root2);
            if (node->isotropic) {
                out[basis_zenith_index(l, m)] += (double)(k * even[m]);
            } else {
                out[basis_index(l, (int)m)] += (double)(k * even[m]);
                if (m > 0) out[basis_index(l, -(int)m)] += (double)(k * odd[m]);
            }
        }
}

/** The energies that are missing at each order, from the coefficients and the energies of the shapes. */
static void set_missing(const LobeNode *node, double (*const c)[SHEEN_BASIS_MAX], const double energy[], float out[])
{
    for (unsigned i = 0, pair = 0; i < node->n_shapes; ++i)
        for (unsigned j = i; j < node->n_shapes; ++j, ++pair) {
            double left = energy[pair];
            out[pair] = (float)left;
            for (unsigned l = 0; l < node->n; ++l) {
                unsigned first = node->isotropic ? l * (l + 1) / 2 : l * l;
                unsigned last = node->isotropic ? (l + 1) * (l + 2) / 2 : (l + 1) * (l + 1);
                for (unsigned a = first; a < last; ++a) left -= c[i][a] * c[j][a];
                out[(l + 1) * node->n_pairs + pair] = (float)left;
            }
        }
}

void sheen_lobe_project(const LobeQuadrature *q, const LobeNode *node, const LobeFamily *family,
                        const BsdfLobe *prototype, Vec3 wo, float *const out[2])
{
    double c[2][LOBE_SHAPES_MAX][SHEEN_BASIS_MAX], energy[LOBE_SHAPES_MAX * (LOBE_SHAPES_MAX + 1) / 2] = {0};
    for (int b = 0; b < 2; ++b)
        for (unsigned k = 0; k < node->n_shapes; ++k) memset(c[b][k], 0, node->coefficients * sizeof c[b][k][0]);
    for (unsigned i = 0; i < q->n_rows; ++i) {
        Row row;
        sum_row(q, node, family, prototype, wo, i, &row);
        float scale = q->weight[i] * SHEEN_PI / (float)q->n_columns * (node->isotropic ? 2.0f : 1.0f);
        for (unsigned pair = 0; pair < node->n_pairs; ++pair) energy[pair] += (double)(scale * row.products[pair]);
        for (int b = 0; b < 2; ++b)
            for (unsigned k = 0; k < node->n_shapes; ++k)
                add_row(node, q->zenith[b] + (size_t)i * q->n * (q->n + 1) / 2, row.even[k], row.odd[k], scale,
                        c[b][k]);
    }
    for (int b = 0; b < 2; ++b) {
        for (unsigned k = 0; k < node->n_shapes; ++k)
            for (unsigned a = 0; a < node->coefficients; ++a) out[b][k * node->coefficients + a] = (float)c[b][k][a];
        set_missing(node, c[b], energy, out[b] + node->missing);
    }
}
