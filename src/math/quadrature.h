// SPDX-License-Identifier: Apache-2.0
// Rules for integrals over an interval.
#ifndef SHEEN_MATH_QUADRATURE_H
#define SHEEN_MATH_QUADRATURE_H

/**
 * The rule of Gauss and Legendre for [0, 1], exact for polynomials of a degree below 2 n.
 * @param n       at least 1
 * @param node    [n] out, from the upper end down
 * @param weight  [n] out; their sum is 1
 */
void sheen_quadrature_gauss(unsigned n, double node[], double weight[]);

#endif
