// SPDX-License-Identifier: Apache-2.0
#include "io/number.h"

#include <math.h>
#include <stddef.h>

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/** Moves *p behind `word` when it stands there in any case. */
static bool skip_word(const char **p, const char *end, const char *word)
{
    const char *q = *p;
    for (; *word; ++word, ++q)
        if (q == end || (*q | 0x20) != *word) return false;
    *p = q;
    return true;
}

/** 10^n for n >= 0: exact in a 64-bit mantissa up to 10^27, a few units in the last place beyond. */
static long double power_of_ten(int n)
{
    static const long double small[28] = {1e0L,  1e1L,  1e2L,  1e3L,  1e4L,  1e5L,  1e6L,  1e7L,  1e8L,  1e9L,
                                          1e10L, 1e11L, 1e12L, 1e13L, 1e14L, 1e15L, 1e16L, 1e17L, 1e18L, 1e19L,
                                          1e20L, 1e21L, 1e22L, 1e23L, 1e24L, 1e25L, 1e26L, 1e27L};
    long double r = 1.0L;
    for (; n > 27; n -= 27) r *= small[27];
    return r * small[n];
}

typedef struct Digits {
    uint64_t mantissa; // first 19 significant digits
    int exponent;      // of the last of them
    int n;             // digits read, leading zeros included
} Digits;

static const char *read_digits(const char *q, const char *end, bool fraction, Digits *d)
{
    for (; q < end && is_digit(*q); ++q, ++d->n) {
        if (d->mantissa < 1000000000000000000u) {
            d->mantissa = 10 * d->mantissa + (uint64_t)(*q - '0');
            d->exponent -= fraction;
        } else {
            d->exponent += !fraction; // a digit past the 19th: only its place counts
        }
    }
    return q;
}

/** An exponent part is taken only when digits follow, so that "2em" is the number 2. */
static const char *read_exponent(const char *q, const char *end, int *exponent)
{
    if (q == end || (*q | 0x20) != 'e') return q;
    const char *r = q + 1;
    bool minus = r < end && *r == '-';
    if (r < end && (*r == '-' || *r == '+')) ++r;
    if (r == end || !is_digit(*r)) return q;
    int e = 0;
    for (; r < end && is_digit(*r); ++r)
        if (e < 100000) e = 10 * e + (*r - '0');
    *exponent += minus ? -e : e;
    return r;
}

bool sheen_number_parse(const char **p, const char *end, double *out)
{
    const char *q = *p;
    bool minus = q < end && *q == '-';
    if (q < end && (*q == '-' || *q == '+')) ++q;
    double value;
    Digits d = {0, 0, 0};
    if (skip_word(&q, end, "nan")) {
        value = (double)NAN;
    } else if (skip_word(&q, end, "infinity") || skip_word(&q, end, "inf")) {
        value = (double)INFINITY;
    } else {
        q = read_digits(q, end, false, &d);
        if (q < end && *q == '.') q = read_digits(q + 1, end, true, &d);
        if (d.n == 0) return false;
        q = read_exponent(q, end, &d.exponent);
        if (d.mantissa == 0 || d.exponent < -400)
            value = 0.0;
        else if (d.exponent > 400)
            value = (double)INFINITY;
        else if (d.exponent < 0)
            value = (double)((long double)d.mantissa / power_of_ten(-d.exponent));
        else
            value = (double)((long double)d.mantissa * power_of_ten(d.exponent));
    }
    *out = minus ? -value : value;
    *p = q;
    return true;
}

bool sheen_integer_parse(const char **p, const char *end, int64_t *out)
{
    const char *q = *p;
    bool minus = q < end && *q == '-';
    if (q < end && (*q == '-' || *q == '+')) ++q;
    if (q == end || !is_digit(*q)) return false;
    int64_t value = 0;
    for (; q < end && is_digit(*q); ++q)
        if (__builtin_mul_overflow(value, 10, &value) || __builtin_add_overflow(value, *q - '0', &value)) return false;
    *out = minus ? -value : value;
    *p = q;
    return true;
}
