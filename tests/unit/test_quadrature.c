// SPDX-License-Identifier: Apache-2.0
// The rule of Gauss and Legendre: powers up to the degree that it is exact for.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "math/quadrature.h"

#include <math.h>

static void test_powers(void **state)
{
    (void)state;
    enum { MOST = 96 };
    double node[MOST], weight[MOST];
    for (unsigned n = 1; n <= MOST; ++n) {
        sheen_quadrature_gauss(n, node, weight);
        for (unsigned power = 0; power < 2 * n; ++power) {
            double sum = 0.0;
            for (unsigned i = 0; i < n; ++i) sum += weight[i] * pow(node[i], power);
            assert_true(fabs(sum * (power + 1) - 1.0) < 1e-11); // of a sum of doubles, and of nodes to a power
        }
        for (unsigned i = 1; i < n; ++i) assert_true(node[i] < node[i - 1]);
        assert_true(node[0] < 1.0 && node[n - 1] > 0.0);
        if (n == 1) assert_true(fabs(node[0] - 0.5) < 1e-15 && weight[0] == 1.0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_powers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
