// SPDX-License-Identifier: Apache-2.0
#include "math/quadrature.h"

#include <math.h>

// Newton's method on the Legendre polynomial.
void sheen_quadrature_gauss(unsigned n, double node[], double weight[])
{
    for (unsigned i = 0; i < n; ++i) {
        double x = cos(3.141592653589793 * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 8; ++step) {
            double before = 0.0, p = 1.0;
            for (unsigned l = 1; l <= n; ++l) {
                double next = ((2 * l - 1) * x * p - (l - 1) * before) / l;
                before = p;
                p = next;
            }
            slope = n * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        node[i] = 0.5 * (x + 1);
        weight[i] = 1 / ((1 - x * x) * slope * slope);
    }
}
