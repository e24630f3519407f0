// SPDX-License-Identifier: Apache-2.0
#include "math/transform.h"

Transform transform_identity(void)
{
    return (Transform){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
}

Transform transform_translate(double x, double y, double z)
{
    return (Transform){{{1, 0, 0, x}, {0, 1, 0, y}, {0, 0, 1, z}, {0, 0, 0, 1}}};
}

Transform transform_scale(double x, double y, double z)
{
    return (Transform){{{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}, {0, 0, 0, 1}}};
}

Transform transform_rotate(Vec3 axis, double angle)
{
    double x = axis.x, y = axis.y, z = axis.z, l = sqrt(x * x + y * y + z * z);
    if (!(l > 0.0)) return transform_identity();
    x /= l, y /= l, z /= l;
    double c = cos(angle), s = sin(angle), k = 1.0 - c;
    return (Transform){{{x * x * k + c, x * y * k - z * s, x * z * k + y * s, 0},
                        {y * x * k + z * s, y * y * k + c, y * z * k - x * s, 0},
                        {z * x * k - y * s, z * y * k + x * s, z * z * k + c, 0},
                        {0, 0, 0, 1}}};
}

Transform transform_look_at(Vec3 origin, Vec3 target, Vec3 up)
{
    Vec3 z = v3_normalize(v3_sub(target, origin));
    Vec3 x = v3_cross(up, z);
    if (!(v3_length(x) > 1e-6f * v3_length(up))) x = v3_cross(fabsf(z.x) < 0.9f ? v3(1, 0, 0) : v3(0, 1, 0), z);
    x = v3_normalize(x);
    Vec3 y = v3_cross(z, x);
    return (Transform){{{x.x, y.x, z.x, origin.x}, {x.y, y.y, z.y, origin.y}, {x.z, y.z, z.z, origin.z}, {0, 0, 0, 1}}};
}

Transform transform_mul(Transform a, Transform b)
{
    Transform r;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            double s = 0.0;
            for (int k = 0; k < 4; ++k) s += a.m[i][k] * b.m[k][j];
            r.m[i][j] = s;
        }
    return r;
}

double transform_determinant(const Transform *t)
{
    const double(*m)[4] = t->m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

bool transform_invert(const Transform *t, Transform *out)
{
    *out = transform_identity();
    const double(*m)[4] = t->m;
    double det = transform_determinant(t);
    double scale = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 4; ++j) {
            if (!isfinite(m[i][j])) return false;
            if (j < 3) scale = fmax(scale, fabs(m[i][j]));
        }
    if (!(fabs(det) > 1e-30 * scale * scale * scale) || !isfinite(1.0 / det)) return false;
    double inv[3][3];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            inv[i][j] = (m[a][c] * m[b][d] - m[a][d] * m[b][c]) / det;
        }
    for (int i = 0; i < 3; ++i) {
        double shift = 0.0;
        for (int j = 0; j < 3; ++j) {
            out->m[i][j] = inv[i][j];
            shift += inv[i][j] * m[j][3];
        }
        out->m[i][3] = -shift;
    }
    return true;
}

Vec3 transform_point(const Transform *t, Vec3 p)
{
    const double(*m)[4] = t->m;
    return v3((float)(m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3]),
              (float)(m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3]),
              (float)(m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]));
}

Vec3 transform_vector(const Transform *t, Vec3 v)
{
    const double(*m)[4] = t->m;
    return v3((float)(m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z),
              (float)(m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z),
              (float)(m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z));
}

Vec3 transform_normal(const Transform *inverse, Vec3 n)
{
    const double(*m)[4] = inverse->m;
    return v3_normalize(v3((float)(m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z),
                           (float)(m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z),
                           (float)(m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z)));
}
