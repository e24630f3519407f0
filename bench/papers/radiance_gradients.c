// SPDX-License-Identifier: Apache-2.0
// Bias of the translational gradients of radiance coefficients, by method and number of rays.
//
//     bench_radiance_gradients
//
// The gradient of krivanek2005-improved-radiance-gradients as printed takes basis and width of a cell at its jittered
// sample; the library integrates the basis along the walls. Each number is the length of (mean over repeated gathers -
// exact gradient) over the length of the exact one, all coefficients together; the exact one is a quadrature,
// differentiated. What stands in brackets is the same from an independent program (NumPy, other random numbers, as many
// repeats). The noise that the mean leaves is a part of both.
//
//     printed, per cell       each cell has jitter of its own
//     printed, literal        one number for each ring and one for each sector, as the indices are printed
//     cell center             basis and width at the center of the cell, jitter per cell
//     walls, nearer           basis at the middles of the walls, which move by the smaller of two distances
//     walls, mean             the same; distances that are near each other by the mean of their inverses
//     library                 the same, and integrals of the basis along the walls between sectors
//     analytical, numerical   of krivanek2005-radiance-caching; blind to occlusion
//
// The scenes: a box without anything hidden, a bright sphere on black, a dark sphere under a bright ceiling.
#include "analytic/radiance_walls.h"

#include <stdio.h>
#include <stdlib.h>

enum { ORDER = 10, SIZES = 3, METHODS = 8 };
static const unsigned rings[SIZES] = {16, 32, 64}, repeats[SIZES] = {100, 40, 12};

typedef struct Method {
    const char *name;
    Jitter jitter;
    int walls;                         // a WallForm, or -1 for the library
    bool mean;                         // of the inverses of near distances
    SheenGradient gradient;            // of the library
    double known[KIT_CASES][2][SIZES]; // of order 10 and 4; 0 where there is none
} Method;

static const Method methods[METHODS] = {
    {"printed, per cell",
     JITTER_CELL,
     WALLS_PRINTED,
     false,
     SHEEN_GRADIENT_NONE,
     {{{1.54, 1.72, 1.30}, {.68, .71, .54}}}},
    {"printed, literal",
     JITTER_RINGS_SECTORS,
     WALLS_PRINTED,
     false,
     SHEEN_GRADIENT_NONE,
     {{{.28, .17, .08}, {.18, .10, .04}}}},
    {"cell center", JITTER_CELL, WALLS_CENTER, false, SHEEN_GRADIENT_NONE, {{{.29, .16, .09}, {.17, .09, .04}}}},
    {"walls, nearer",
     JITTER_CELL,
     WALLS_EDGE,
     false,
     SHEEN_GRADIENT_NONE,
     {{{.20, .076, .027}, {.049, .021, .010}}, {{0}, {.147, .105, .078}}, {{0}, {.171, .113, .083}}}},
    {"walls, mean", JITTER_CELL, WALLS_EDGE, true, SHEEN_GRADIENT_NONE, {{{0}, {0, 0, .003}}}},
    {"library", JITTER_CELL, -1, false, SHEEN_GRADIENT_STRATIFIED, {{{0}}}},
    {"analytical", JITTER_CELL, -1, false, SHEEN_GRADIENT_ANALYTICAL, {{{0}}}},
    {"numerical", JITTER_CELL, -1, false, SHEEN_GRADIENT_NUMERICAL, {{{0}}}},
};

typedef double Slopes[2][KIT_BASIS_MAX];

static void add_library(const KitGather *g, SheenGradient gradient, Slopes sum)
{
    static Rgb lambda[KIT_BASIS_MAX], slope[2][KIT_BASIS_MAX];
    SheenRadianceTables *tables;
    if (sheen_radiance_tables_create(g->strata, SHEEN_BASIS_HSH, ORDER, &tables) != SHEEN_OK) exit(1);
    RadianceSamples samples = kit_samples(g);
    RadianceEstimate e = {.lambda = lambda, .dx = slope[0], .dy = slope[1]};
    sheen_estimate_radiance(tables, &samples, gradient, &e);
    sheen_radiance_tables_destroy(&tables);
    for (int axis = 0; axis < 2; ++axis)
        for (int i = 0; i < ORDER * ORDER; ++i) sum[axis][i] += (double)slope[axis][i].r;
}

static void mean_slopes(const KitCase *c, const Method *m, int size, Slopes mean)
{
    static KitGather g;
    memset(mean, 0, sizeof(Slopes));
    for (unsigned r = 0; r < repeats[size]; ++r) {
        kit_gather(c, rings[size], 4 * rings[size], m->jitter, 1000 + r, &g);
        Slopes one = {{0}};
        if (m->walls < 0)
            add_library(&g, m->gradient, one);
        else
            kit_wall_gradient(&g, SHEEN_BASIS_HSH, ORDER, (WallForm)m->walls, m->mean, one);
        for (int axis = 0; axis < 2; ++axis)
            for (int i = 0; i < ORDER * ORDER; ++i) mean[axis][i] += one[axis][i] / repeats[size];
    }
}

static double bias(Slopes mean, Slopes exact, int count)
{
    double off = 0.0, length = 0.0;
    for (int axis = 0; axis < 2; ++axis)
        for (int i = 0; i < count; ++i) {
            double d = mean[axis][i] - exact[axis][i];
            off += d * d;
            length += exact[axis][i] * exact[axis][i];
        }
    return sqrt(off / length);
}

static void print_scene(int scene)
{
    static KitTruth truth;
    kit_truth(&kit_cases[scene], SHEEN_BASIS_HSH, ORDER, &truth);
    printf("\n%-18s %-45sorder 4\n%-18s", kit_cases[scene].name, "order 10", "");
    for (int column = 0; column < 2 * SIZES; ++column) {
        unsigned M = rings[column % SIZES];
        printf(" %6ux%-7u", M, 4 * M);
    }
    for (int m = 0; m < METHODS; ++m) {
        double measured[2][SIZES];
        printf("\n%-18s", methods[m].name);
        fflush(stdout); // a row takes a second or two
        for (int size = 0; size < SIZES; ++size) {
            static Slopes mean;
            mean_slopes(&kit_cases[scene], &methods[m], size, mean);
            measured[0][size] = bias(mean, truth.slope, ORDER * ORDER);
            measured[1][size] = bias(mean, truth.slope, 16);
        }
        for (int column = 0; column < 2 * SIZES; ++column) {
            double known = methods[m].known[scene][column / SIZES][column % SIZES];
            printf(" %6.3f", measured[column / SIZES][column % SIZES]);
            if (known > 0.0)
                printf("[%5.3g]", known);
            else
                printf("       ");
        }
    }
    printf("\n");
}

int main(void)
{
    for (int scene = 0; scene < KIT_CASES; ++scene) print_scene(scene);
    return 0;
}
