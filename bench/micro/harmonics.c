// SPDX-License-Identifier: Apache-2.0
// Time and share of the machine's peak of what radiance caching does with harmonics, on one thread.
//
//     bench_harmonics [ORDER]        (10 when none is given)
//
// The peak is that of a loop of independent multiplications and additions on floats, compiled with the flags of the
// rest: no fused operations. "mul" is the number of multiplications that the task needs, each but a few with its
// addition; padding to whole vectors and loads do not count, so that a share tells what is left to gain:
//
//     evaluate       3 for each step of the recurrence, 4 for each power of x + i y, 1 for each function
//     derive         the same, and 3 for each function
//     project        a direction and its radiance: recurrence and powers, 6 for each W_m, 3 for each function
//     dot            a lobe and a record: 3 for each function
//     rotate z       4 for each pair +-m
//     rotate         spherical: three times that and the entries of two quarter turns that are not 0
//     block matrix   the same with a full matrix for each band, which is given: making it is not part of the time
//     tilt           hemispherical: two turns about z, and two matrices between which it interpolates
//
// Each number is the median of 7 runs, in CPU time of this process.
#include "base/hash.h"
#include "basis/rotation.h"
#include "timing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { N_RUNS = 7, DIRECTIONS = 1024, LANES = 16, CHAINS = 12 };

// Of one run.
static const double RUN_SECONDS = 0.03;

typedef struct Bench {
    unsigned n;
    SheenRotation *sh, *hsh; // hsh is NULL for orders without tables
    SheenEuler turn[64];
    Vec3 w[DIRECTIONS];
    Rgb radiance[DIRECTIONS], projected[SHEEN_BASIS_MAX];
    float values[SHEEN_BASIS_MAX], more[SHEEN_BASIS_MAX];
    float in[3 * SHEEN_BASIS_MAX], out[3 * SHEEN_BASIS_MAX];
    float *blocks; // a matrix for each band, column after column
    double peak;   // multiplications a nanosecond
    double sum;    // of results: what is read cannot be left out by the compiler
} Bench;

// ---- time -------------------------------------------------------------------------------------------------------

// Does something `count` times.
typedef void Task(Bench *b, size_t count);

// Nanoseconds of one.
static double time_of(Bench *b, Task *task)
{
    size_t count = 1;
    double t = 0.0, run[N_RUNS];
    for (; t < 0.3 * RUN_SECONDS; count *= 4) {
        double start = processor_seconds();
        task(b, count);
        t = processor_seconds() - start;
    }
    for (int i = 0; i < N_RUNS; ++i) {
        double start = processor_seconds();
        task(b, count);
        run[i] = 1e9 * (processor_seconds() - start) / (double)count;
    }
    qsort(run, N_RUNS, sizeof *run, by_value);
    return run[N_RUNS / 2];
}

static void report(Bench *b, const char *name, Task *task, double mul)
{
    double t = time_of(b, task);
    printf("%-40s %10.1f %10.0f %9.2f %8.1f %%\n", name, t, mul, mul / t, 100.0 * mul / t / b->peak);
}

// ---- tasks ------------------------------------------------------------------------------------------------------

static void peak(Bench *b, size_t count)
{
    float sum[CHAINS][LANES], factor[LANES], term[LANES];
    for (int i = 0; i < LANES; ++i) {
        factor[i] = 1.0f - 1e-3f * (float)(i + (int)b->n);
        term[i] = (float)i;
        for (int c = 0; c < CHAINS; ++c) sum[c][i] = (float)(i * c);
    }
    for (size_t k = 0; k < count; ++k)
        for (int c = 0; c < CHAINS; ++c)
            for (int i = 0; i < LANES; ++i) sum[c][i] = sum[c][i] * factor[i] + term[i];
    for (int c = 0; c < CHAINS; ++c)
        for (int i = 0; i < LANES; ++i) b->sum += (double)sum[c][i];
}

static void evaluate_sh(Bench *b, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        sheen_basis_eval(SHEEN_BASIS_SH, b->n, b->w[k % DIRECTIONS], b->values);
        b->sum += (double)b->values[0];
    }
}

static void evaluate_hsh(Bench *b, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        sheen_basis_eval(SHEEN_BASIS_HSH, b->n, b->w[k % DIRECTIONS], b->values);
        b->sum += (double)b->values[0];
    }
}

static void derive_hsh(Bench *b, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        sheen_basis_derive(SHEEN_BASIS_HSH, b->n, b->w[k % DIRECTIONS], b->values, b->more);
        b->sum += (double)(b->values[0] + b->more[0]);
    }
}

static void project(Bench *b, SheenBasis basis, size_t count)
{
    for (size_t k = 0; k < count; k += DIRECTIONS) {
        size_t n = count - k < DIRECTIONS ? count - k : DIRECTIONS;
        sheen_basis_project(basis, b->n, n, b->w, b->radiance, b->projected);
        b->sum += (double)b->projected[0].g;
    }
}
static void project_sh(Bench *b, size_t count)
{
    project(b, SHEEN_BASIS_SH, count);
}
static void project_hsh(Bench *b, size_t count)
{
    project(b, SHEEN_BASIS_HSH, count);
}

// What sheen_basis_project is measured against.
static void project_singly(Bench *b, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        sheen_basis_eval(SHEEN_BASIS_HSH, b->n, b->w[k % DIRECTIONS], b->values);
        for (size_t i = 0; i < basis_size(b->n); ++i)
            b->projected[i] = rgb_mad(b->projected[i], b->values[i], b->radiance[k % DIRECTIONS]);
    }
    b->sum += (double)b->projected[0].g;
}

static void dot(Bench *b, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        b->values[k % b->n] += 1e-3f;
        b->sum += (double)sheen_basis_dot(b->n, b->values, b->projected).g;
    }
}

static void rotate_z(Bench *b, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        sheen_rotate_z(b->n, b->turn[k % 64].alpha, 1, b->in, b->out);
        b->sum += (double)b->out[0];
    }
}

static void rotate(Bench *b, const SheenRotation *r, unsigned channels, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        sheen_rotation_apply(r, b->turn[k % 64], channels, b->in, b->out);
        b->sum += (double)b->out[0];
    }
}
static void rotate_sh(Bench *b, size_t count)
{
    rotate(b, b->sh, 1, count);
}
static void rotate_sh_colors(Bench *b, size_t count)
{
    rotate(b, b->sh, 3, count);
}
static void rotate_hsh(Bench *b, size_t count)
{
    rotate(b, b->hsh, 1, count);
}

static void multiply_blocks(Bench *b, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        const float *column = b->blocks;
        for (unsigned l = 0; l < b->n; ++l) {
            const float *in = b->in + (size_t)l * l;
            float sum[2 * SHEEN_ORDER_MAX] = {0};
            for (unsigned j = 0; j < 2 * l + 1; ++j, column += 2 * l + 1)
                for (unsigned i = 0; i < 2 * l + 1; ++i) sum[i] += column[i] * in[j];
            for (unsigned i = 0; i < 2 * l + 1; ++i) b->out[(size_t)l * l + i] = sum[i];
        }
        b->sum += (double)b->out[0];
    }
}

// ---- set up and table -------------------------------------------------------------------------------------------

static float random_unit(uint32_t i)
{
    return 2.0f * hash_to_unit(hash_u32(i)) - 1.0f;
}

static void fill_blocks(Bench *b)
{
    float unit[SHEEN_BASIS_MAX], *column = b->blocks;
    for (unsigned l = 0; l < b->n; ++l)
        for (unsigned j = 0; j < 2 * l + 1; ++j, column += 2 * l + 1) {
            for (size_t i = 0; i < SHEEN_BASIS_MAX; ++i) unit[i] = i == l * l + j;
            sheen_rotation_apply(b->sh, b->turn[0], 1, unit, b->out);
            for (unsigned i = 0; i < 2 * l + 1; ++i) column[i] = b->out[l * l + i];
        }
}

static bool set_up(unsigned n, Bench *b)
{
    b->n = n;
    if (sheen_rotation_create(SHEEN_BASIS_SH, n, 0.0f, &b->sh)) return false;
    if (n <= SHEEN_TILT_ORDER_MAX && sheen_rotation_create(SHEEN_BASIS_HSH, n, 0.44f, &b->hsh)) return false;
    b->blocks = malloc((size_t)n * (2 * n - 1) * (2 * n + 1) / 3 * sizeof *b->blocks);
    if (!b->blocks) return false;
    for (uint32_t i = 0; i < 64; ++i) {
        float a = 3.0f * random_unit(i), t = 0.2f + 0.2f * random_unit(i + 64), c = 3.0f * random_unit(i + 128);
        b->turn[i] = (SheenEuler){v2(cosf(a), sinf(a)), v2(cosf(t), sinf(t)), v2(cosf(c), sinf(c))};
    }
    for (uint32_t i = 0; i < DIRECTIONS; ++i) {
        Vec3 d = v3(random_unit(3 * i), random_unit(3 * i + 1), 1.0f + random_unit(3 * i + 2));
        b->w[i] = v3_normalize(d);
        b->radiance[i] = rgb(1.0f, 0.5f, 1.0f + random_unit(i));
    }
    for (uint32_t i = 0; i < 3 * SHEEN_BASIS_MAX; ++i) b->in[i] = random_unit(i);
    fill_blocks(b);
    return true;
}

static void print_table(Bench *b)
{
    double n = b->n, size = n * n, pairs = n * (n - 1) / 2, steps = 3 * pairs, powers = 4 * n, quarter = 0, blocks = 0;
    for (unsigned l = 0; l < b->n; ++l) {
        blocks += (2.0 * l + 1) * (2 * l + 1);
        quarter += floor(((l + 1.0) * (l + 1) + 1) / 2) + floor((l * l + 1.0) / 2); // of cosines, of sines
    }
    double cosines = pairs + n, tilt = cosines * cosines + pairs * pairs;
    b->peak = CHAINS * LANES / time_of(b, peak);
    printf("order %u, %.0f functions; peak: %.1f multiplications and as many additions a nanosecond\n\n", b->n, size,
           b->peak);
    printf("%-40s %10s %10s %9s %10s\n", "", "ns", "mul", "mul/ns", "of peak");
    report(b, "evaluate, spherical", evaluate_sh, steps + powers + size);
    report(b, "evaluate, hemispherical", evaluate_hsh, steps + powers + size);
    report(b, "derive, hemispherical", derive_hsh, steps + powers + 4 * size);
    report(b, "project, spherical, per direction", project_sh, steps + powers + 6 * n + 3 * size);
    report(b, "project, hemispherical, per direction", project_hsh, steps + powers + 6 * n + 3 * size);
    report(b, "(one direction at a time)", project_singly, steps + powers + 4 * size);
    report(b, "dot product with three colours", dot, 3 * size);
    report(b, "rotate about z", rotate_z, 4 * pairs);
    report(b, "rotate, spherical", rotate_sh, 12 * pairs + 2 * quarter);
    report(b, "rotate, spherical, three colours", rotate_sh_colors, 3 * (12 * pairs + 2 * quarter));
    report(b, "block matrix", multiply_blocks, blocks);
    if (b->hsh) report(b, "rotate and tilt, hemispherical", rotate_hsh, 8 * pairs + 2 * tilt);
    printf("\n(%g)\n", b->sum);
}

int main(int argc, char **argv)
{
    long n = argc > 1 ? strtol(argv[1], NULL, 10) : 10;
    if (argc > 2 || n < 1 || n > SHEEN_ORDER_MAX) {
        fprintf(stderr, "usage: bench_harmonics [ORDER], 1 to %d\n", SHEEN_ORDER_MAX);
        return 2;
    }
    static Bench b; // too large for the stack of some systems
    if (!set_up((unsigned)n, &b)) {
        fprintf(stderr, "bench_harmonics: out of memory\n");
        return 1;
    }
    print_table(&b);
    sheen_rotation_destroy(&b.sh);
    sheen_rotation_destroy(&b.hsh);
    free(b.blocks);
    return 0;
}
