// SPDX-License-Identifier: Apache-2.0
// Values of a scene's first material, for comparison with other renderers (bench/peers/materials).
//
// usage: bench_bsdf SCENE < PAIRS
//
// Each line of PAIRS is `u v  wo.x wo.y wo.z  wi.x wi.y wi.z`, directions in the frame of the first shape's shading
// normal. Each line of the answer is `r g b pdf`: f |cos(wi)| of all smooth lobes and the density of sampling wi.
#include "material/bsdf.h"
#include "io/load.h"

#include <stdio.h>

static void print_line(void *user, SheenLogLevel level, const char *text)
{
    (void)user;
    if (level != SHEEN_LOG_INFO) fprintf(stderr, "%s\n", text);
}

int main(int argc, char **argv)
{
    const SheenLog log = {print_line, NULL};
    SheenScene *scene;
    if (argc != 2) {
        fprintf(stderr, "usage: bench_bsdf SCENE < PAIRS\n");
        return 2;
    }
    if (sheen_scene_load(argv[1], &log, &scene)) return 1;
    SurfacePoint s = {.ng = {0, 0, 1}, .ns = {0, 0, 1}, .instance = SHEEN_NONE};
    Vec3 o, i;
    while (scanf("%f %f %f %f %f %f %f %f", &s.uv.x, &s.uv.y, &o.x, &o.y, &o.z, &i.x, &i.y, &i.z) == 8) {
        Bsdf bsdf = sheen_bsdf_at(scene, &s);
        Rgb f = sheen_bsdf_eval(&bsdf, o, i);
        printf("%.9g %.9g %.9g %.9g\n", (double)f.r, (double)f.g, (double)f.b, (double)sheen_bsdf_pdf(&bsdf, o, i));
    }
    sheen_scene_destroy(&scene);
    return 0;
}
