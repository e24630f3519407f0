// SPDX-License-Identifier: Apache-2.0
// The collection of OBJ files with which tinyobjloader tests itself: each loads as its text says, or is refused by one
// line that names the place. The collection is not in the repository: SHEEN_SCENES names the folder above it, else
// ../shared/scenes is tried; what is absent is skipped and counted.
#include "io/file_path.h"
#include "io_kit.h"

typedef struct Expected {
    const char *file;
    uint32_t n_triangles, n_shapes; // those without area left out
    const char *words;              // of a warning, or of the error; NULL: none but that nothing shines
    bool refused;
} Expected;

static const Expected files[] = {
    {"catmark_torus_creases0.obj", 64, 1, ":94: 't' is not known", false},
    {"colorspace-issue-184.obj", 1, 1, "cannot open the picture 'diffuse.jpg'", false},
    {"cornell_box.obj", 36, 4, NULL, false},
    {"cornell_box_multimaterial.obj", 36, 4, NULL, false},
    {"cube-vertexcol.obj", 12, 3, NULL, false},
    {"cube.obj", 12, 3, NULL, false},
    {"invalid-face-definition.obj", 0, 0, ":15: a face of 1 vertices is left out", false},
    {"issue-138.obj", 12, 2, NULL, false},
    {"issue-140-zero-face-idx.obj", 0, 0, ":16: vertex index 0 is out of range: there are 4 so far", true},
    {"issue-161-inconsistent-f.obj", 12, 1, "the material 'cube' is defined nowhere", false},
    {"issue-162-smoothing-group.obj", 12, 2, NULL, false},
    {"issue-235-usemtl-then-o.obj", 2, 2, NULL, false},
    {"issue-244-mtl-searchpaths.obj", 2, 2, "cannot open the material library 'issue-244.mtl'", false},
    {"issue-246-usemtl-whitespace.obj", 1, 1, NULL, false},
    {"issue-248-texres-texopt.obj", 12, 3, "cannot open the picture 'input.jpg'", false},
    {"issue-295-trianguation-failure.obj", 28, 1, NULL, false},
    {"issue-92.obj", 1, 1, "cannot open the picture 'tmp.png'", false},
    {"issue-95-2.obj", 1, 1, NULL, false},
    {"issue-95.obj", 1, 1, NULL, false},
    {"leading-decimal-dot-issue-201.obj", 1, 1, NULL, false},
    {"leading-zero-in-exponent-notation-issue-210.obj", 1, 1, NULL, false},
    {"line-prim.obj", 0, 0, NULL, false},
    {"map-bump.obj", 400, 2, "'map_Bump' is not supported", false},
    {"missing_material_file.obj", 36, 4, "the material 'white' and others are defined nowhere", false},
    {"mtl filename with whitespace issue46.obj", 12, 1, NULL, false},
    {"mtllib-multiple-files-issue-112.obj", 1, 1, "cannot open the picture 'tmp.png'", false},
    {"no_material.obj", 36, 1, NULL, false},
    {"norm-texopt.obj", 1, 1, "cannot open the picture 'normalmap.jpg'", false},
    {"pbr-mat-ext.obj", 2, 1, "cannot open the picture", false},
    {"points-prim.obj", 0, 0, NULL, false},
    {"refl.obj", 12, 3, NULL, false},
    {"skin-weight.obj", 12, 3, "'vw' is not known", false},
    {"smoothing-group-two-squares.obj", 3, 1, "normal index 1 is out of range", false},
    {"smoothing-normal.obj", 6, 1, NULL, false},
    {"test-nan.obj", 0, 0, ":14: ", true},
    {"texture-filename-with-whitespace.obj", 12, 3, "cannot open the picture 'texture 01.png'", false},
    {"texture-options-issue-85.obj", 1, 1, "cannot open the picture 'diffuse.jpg'", false},
    {"tr-and-d-issue-43.obj", 400, 2, NULL, false},
    {"usemtl-issue-104.obj", 6, 1, NULL, false},
    {"usemtl-issue-68.obj", 400, 2, NULL, false},
};

static void check(Kit *k, const Expected *e, const char *path)
{
    kit_reset(k);
    SheenStatus s = sheen_scene_load(path, &k->log, &k->scene);
    if (e->refused) {
        char place[600];
        snprintf(place, sizeof place, "%s%s", path, e->words);
        if (s != SHEEN_ERR_PARSE || k->n_errors != 1 || strncmp(k->error, place, strlen(place)) != 0)
            fail_msg("%s: status %d: '%s'", e->file, s, k->error);
        return;
    }
    if (s) fail_msg("%s", k->error);
    if (k->scene->n_triangles != e->n_triangles || k->scene->n_shapes != e->n_shapes)
        fail_msg("%s: %llu triangles in %u shapes", e->file, (unsigned long long)k->scene->n_triangles,
                 k->scene->n_shapes);
    bool alone = k->n_warnings == 1 && strstr(k->warnings, "no material emits light");
    if (e->words ? !strstr(k->warnings, e->words) : !alone) fail_msg("%s: said '%s'", e->file, k->warnings);
}

static void each_loads_or_is_refused(void **state)
{
    Kit *k = *state;
    int skipped = 0, n = (int)(sizeof files / sizeof *files);
    for (int i = 0; i < n; ++i) {
        char name[256], path[512];
        snprintf(name, sizeof name, "obj/tinyobj-models/%s", files[i].file);
        kit_shared_path(name, path);
        if (sheen_path_readable(path))
            check(k, &files[i], path);
        else
            ++skipped;
    }
    print_message("%d of %d files skipped: not there\n", skipped, n);
}

int main(void)
{
    const struct CMUnitTest tests[] = {KIT_TEST(each_loads_or_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
