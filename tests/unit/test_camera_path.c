// SPDX-License-Identifier: Apache-2.0
// The curve of a moving camera: through its keys, exact on parabolas, smooth, soft where it stands, turned as they are.
#include "scene/camera_path.h"

#include "io_kit.h"

enum { n_keys = 5 };

static SheenCamera plain_camera(void)
{
    return (SheenCamera){.name = "c",
                         .to_world = transform_look_at(v3(0, 0, 0), v3(0, 0, 1), v3(0, 1, 0)),
                         .fov_x = 1.0f,
                         .width = 8,
                         .height = 6};
}

static SheenCameraKey key(double frame, double x, double y, double z)
{
    return (SheenCameraKey){
        .frame = frame, .origin = {x, y, z}, .target = {x, y, z + 100.0}, .up = {0, 1, 0}, .fov = 1.0};
}

static SheenCameraPath *path_of(const SheenCamera *base, const SheenCameraKey *keys, size_t n)
{
    SheenCameraPath *path;
    assert_int_equal(sheen_camera_path_create(base, keys, n, &path), SHEEN_OK);
    return path;
}

static SheenCamera camera_at(const SheenCameraPath *path, double frame)
{
    SheenCamera c;
    assert_int_equal(sheen_camera_path_at(path, frame, &c), SHEEN_CAMERA_FINE);
    return c;
}

static double origin_at(const SheenCameraPath *path, double frame, int axis)
{
    SheenCamera c = camera_at(path, frame);
    return c.to_world.m[axis][3];
}

static void test_keys_are_hit(void **state)
{
    (void)state;
    SheenCamera base = plain_camera();
    SheenCameraKey keys[n_keys];
    for (int i = 0; i < n_keys; ++i) {
        keys[i] = key(i * i, sin(i), 0.1 * i * i, cos(3.0 * i));
        keys[i].fov = 0.5 + 0.1 * i;
    }
    SheenCameraPath *path = path_of(&base, keys, n_keys);
    for (int i = 0; i < n_keys; ++i) {
        SheenCamera c = camera_at(path, i * i);
        for (int a = 0; a < 3; ++a) assert_true(c.to_world.m[a][3] == keys[i].origin[a]);
        assert_true(c.fov_x == (float)keys[i].fov);
        // It looks along +z of its own; a direction is unit to a few roundings of float.
        kit_assert_v3(transform_vector(&c.to_world, v3(0, 0, 1)), v3(0, 0, 1), 1e-6f);
        assert_int_equal(c.width, base.width);
    }
    double first, last;
    sheen_camera_path_range(path, &first, &last);
    assert_true(first == 0.0 && last == 16.0);
    assert_true(origin_at(path, -3.0, 0) == keys[0].origin[0]);
    assert_true(origin_at(path, 99.0, 2) == keys[n_keys - 1].origin[2]);
    assert_true(origin_at(path, (double)NAN, 2) == keys[0].origin[2]); // no number is before all
    sheen_camera_path_destroy(&path);
    assert_null(path);
}

static void test_two_keys_are_a_line(void **state)
{
    (void)state;
    SheenCamera base = plain_camera();
    SheenCameraKey keys[] = {key(10, 1, 2, 3), key(20, 5, 2, -3)};
    SheenCameraPath *path = path_of(&base, keys, 2);
    for (int i = 0; i <= 10; ++i) { // exact but for roundings of double
        assert_true(fabs(origin_at(path, 10 + i, 0) - (1.0 + 0.4 * i)) < 1e-14);
        assert_true(fabs(origin_at(path, 10 + i, 2) - (3.0 - 0.6 * i)) < 1e-14);
    }
    sheen_camera_path_destroy(&path);
}

// Keys at uneven frames on a parabola that is never three times as fast as beside: the curve is the parabola itself.
static void test_parabolas_are_exact(void **state)
{
    (void)state;
    static const double frames[n_keys] = {0.0, 1.0, 2.5, 3.0, 5.0};
    SheenCamera base = plain_camera();
    SheenCameraKey keys[n_keys];
    for (int i = 0; i < n_keys; ++i) {
        double t = frames[i];
        keys[i] = key(t, 1.0 + 2.0 * t + 0.3 * t * t, 4.0 - t * t * 0.2, 7.0 * t);
    }
    SheenCameraPath *path = path_of(&base, keys, n_keys);
    for (double t = 0.0; t <= 5.0; t += 0.0625) {
        assert_true(fabs(origin_at(path, t, 0) - (1.0 + 2.0 * t + 0.3 * t * t)) < 1e-12);
        assert_true(fabs(origin_at(path, t, 1) - (4.0 - t * t * 0.2)) < 1e-12);
        assert_true(fabs(origin_at(path, t, 2) - 7.0 * t) < 1e-12);
    }
    sheen_camera_path_destroy(&path);
}

static void test_velocity_is_continuous(void **state)
{
    (void)state;
    SheenCamera base = plain_camera();
    SheenCameraKey keys[n_keys];
    for (int i = 0; i < n_keys; ++i) keys[i] = key(i + 0.3 * i * i, sin(2.0 * i), 0.0, cos(2.0 * i));
    SheenCameraPath *path = path_of(&base, keys, n_keys);
    const double h = 1e-5;
    for (int i = 1; i + 1 < n_keys; ++i) {
        double at = keys[i].frame, x = keys[i].origin[0];
        double before = (x - origin_at(path, at - h, 0)) / h, after = (origin_at(path, at + h, 0) - x) / h;
        // One-sided differences err by h / 2 times the second derivative, which is below 20 here.
        assert_true(fabs(after - before) < 20.0 * h);
        assert_true(fabs(after) + fabs(before) > 1e-3); // it does not pass by standing still
    }
    sheen_camera_path_destroy(&path);
}

static void test_it_stands_still_between_equal_keys(void **state)
{
    (void)state;
    SheenCamera base = plain_camera();
    SheenCameraKey keys[] = {key(0, 0, 0, 0), key(10, 3, 0, 1), key(20, 3, 0, 1), key(30, 9, 5, 0)};
    SheenCameraPath *path = path_of(&base, keys, 4);
    for (int i = 0; i <= 10; ++i) assert_true(fabs(origin_at(path, 10 + i, 0) - 3.0) < 1e-14);
    // It arrives softly: on the last hundredth of the way it goes far less than that of the distance.
    assert_true(3.0 - origin_at(path, 9.9, 0) < 0.003 * 3.0);
    sheen_camera_path_destroy(&path);
}

static void test_the_curve_turns_with_its_keys(void **state)
{
    (void)state;
    SheenCamera base = plain_camera();
    SheenCameraKey keys[n_keys], turned[n_keys];
    Transform turn = transform_rotate(v3(1, 2, 3), 0.8);
    for (int i = 0; i < n_keys; ++i) {
        // The last chord is so short that the limit of three chords counts.
        keys[i] = key(i, i == 4 ? 3.01 : i, i % 2, 0.2 * i * i);
        turned[i] = keys[i];
        for (int r = 0; r < 3; ++r) {
            turned[i].origin[r] = turned[i].target[r] = turned[i].up[r] = 0.0;
            for (int k = 0; k < 3; ++k) {
                turned[i].origin[r] += turn.m[r][k] * keys[i].origin[k];
                turned[i].target[r] += turn.m[r][k] * keys[i].target[k];
                turned[i].up[r] += turn.m[r][k] * keys[i].up[k];
            }
        }
    }
    SheenCameraPath *a = path_of(&base, keys, n_keys), *b = path_of(&base, turned, n_keys);
    for (double t = 0.0; t <= 4.0; t += 0.125) {
        SheenCamera ca = camera_at(a, t), cb = camera_at(b, t);
        Vec3 z = transform_vector(&turn, transform_vector(&ca.to_world, v3(0, 0, 1)));
        Vec3 y = transform_vector(&turn, transform_vector(&ca.to_world, v3(0, 1, 0)));
        // Views pass through float.
        kit_assert_v3(transform_vector(&cb.to_world, v3(0, 0, 1)), z, 1e-6f);
        kit_assert_v3(transform_vector(&cb.to_world, v3(0, 1, 0)), y, 1e-6f);
        for (int r = 0; r < 3; ++r) {
            double x = 0.0;
            for (int k = 0; k < 3; ++k) x += turn.m[r][k] * ca.to_world.m[k][3];
            assert_true(fabs(x - cb.to_world.m[r][3]) < 1e-12);
        }
    }
    sheen_camera_path_destroy(&a);
    sheen_camera_path_destroy(&b);
}

static void test_angles_stay_between_keys(void **state)
{
    (void)state;
    static const double frames[] = {0, 1, 9, 10, 30, 31}, fov[] = {3.0, 0.01, 0.01, 3.1, 3.0, 0.2};
    SheenCamera base = plain_camera();
    SheenCameraKey keys[6];
    for (int i = 0; i < 6; ++i) {
        keys[i] = key(frames[i], 0, 0, i);
        keys[i].fov = fov[i];
    }
    SheenCameraPath *path = path_of(&base, keys, 6);
    for (int i = 0; i < 5; ++i)
        for (double t = 0.0; t <= 1.0; t += 0.03125) {
            double x = (double)camera_at(path, frames[i] + t * (frames[i + 1] - frames[i])).fov_x;
            // A rounding to float.
            assert_true(x >= fmin(fov[i], fov[i + 1]) - 1e-6 && x <= fmax(fov[i], fov[i + 1]) + 1e-6);
        }
    sheen_camera_path_destroy(&path);
}

static void test_what_keys_do_not_tell_is_the_scenes(void **state)
{
    (void)state;
    SheenCamera base = plain_camera();
    // A scene in centimetres whose picture is mirrored, with a lens.
    base.to_world = transform_mul(base.to_world, transform_scale(-0.01, 0.01, 0.01));
    base.aperture = 2.0f, base.focus = 300.0f, base.cut_lo = v2(0.1f, 0.0f);
    SheenCameraKey keys[] = {key(0, 1, 2, 3), key(4, 3, 3, 3)};
    SheenCameraPath *path = path_of(&base, keys, 2);
    SheenCamera c = camera_at(path, 1.5);
    assert_true(c.aperture == 2.0f && c.focus == 300.0f && c.cut_lo.x == 0.1f);
    assert_true(fabs(transform_determinant(&c.to_world) + 1e-6) < 1e-11);
    kit_assert_v3(transform_vector(&c.to_world, v3(0, 0, 300)), v3(0, 0, 3), 1e-5f);
    kit_assert_v3(transform_vector(&c.to_world, v3(1, 0, 0)), v3(-0.01f, 0, 0), 1e-8f);
    sheen_camera_path_destroy(&path);

    base = plain_camera();
    base.orthographic = true, base.fov_x = 0.0f;
    base.to_world = transform_scale(4, 4, 1);
    path = path_of(&base, keys, 2);
    c = camera_at(path, 2.0);
    assert_true(c.orthographic && c.fov_x == 0.0f);
    kit_assert_v3(transform_vector(&c.to_world, v3(1, 0, 0)), v3(4, 0, 0), 1e-5f);
    sheen_camera_path_destroy(&path);
}

static void test_up_of_a_camera(void **state)
{
    (void)state;
    SheenCamera c = plain_camera();
    // It looks down from a corner but stands level: up is the vertical, not the camera's own tilted one.
    c.to_world = transform_look_at(v3(3, 5, 2), v3(0, 0, 0), v3(0.0f, 1, 0.0f));
    SheenCameraKey k = sheen_camera_key_of(&c);
    assert_true(k.up[0] == 0.0 && k.up[1] == 1.0 && k.up[2] == 0.0);
    assert_true(k.fov == (double)c.fov_x);
    c.to_world = transform_look_at(v3(3, 5, 2), v3(0, 0, 0), v3(0, 0, -1));
    k = sheen_camera_key_of(&c);
    assert_true(k.up[0] == 0.0 && k.up[1] == 0.0 && k.up[2] == -1.0);
    // One that is rolled keeps its roll.
    c.to_world = transform_look_at(v3(0, 0, 0), v3(0, 0, 1), v3(0.6f, 0.8f, 0));
    k = sheen_camera_key_of(&c);
    kit_assert_v3(v3((float)k.up[0], (float)k.up[1], (float)k.up[2]), v3(0.6f, 0.8f, 0), 1e-6f);
}

static void test_faults(void **state)
{
    (void)state;
    SheenCamera base = plain_camera(), c = {.width = 77};
    SheenCameraKey k = key(0, 1, 2, 3);
    assert_int_equal(sheen_camera_key_fault(&k), SHEEN_CAMERA_FINE);
    k.fov = 3.2;
    assert_int_equal(sheen_camera_key_fault(&k), SHEEN_CAMERA_BAD_ANGLE);
    k = key(0, 1, 2, 3), memcpy(k.target, k.origin, sizeof k.target);
    assert_int_equal(sheen_camera_key_fault(&k), SHEEN_CAMERA_AT_TARGET);
    k = key(0, 1, 2, 3), k.up[1] = 0.0, k.up[2] = -5.0;
    assert_int_equal(sheen_camera_key_fault(&k), SHEEN_CAMERA_UP_ALONG_VIEW);
    k.up[2] = 0.0;
    assert_int_equal(sheen_camera_key_fault(&k), SHEEN_CAMERA_UP_ALONG_VIEW);
    k.up[1] = (double)NAN;
    assert_int_equal(sheen_camera_key_fault(&k), SHEEN_CAMERA_UP_ALONG_VIEW);

    // Two good keys between which the camera walks through its target, and two whose ups are opposite.
    SheenCameraKey through[] = {key(0, 0, 0, 0), key(2, 0, 0, 4)};
    for (int i = 0; i < 2; ++i) through[i].target[2] = 2.0;
    SheenCameraPath *path = path_of(&base, through, 2);
    assert_int_equal(sheen_camera_path_at(path, 0.5, &c), SHEEN_CAMERA_FINE);
    c.width = 77;
    assert_int_equal(sheen_camera_path_at(path, 1.0, &c), SHEEN_CAMERA_AT_TARGET);
    assert_int_equal(c.width, 77);
    sheen_camera_path_destroy(&path);
    SheenCameraKey over[] = {key(0, 0, 0, 0), key(2, 0, 0, 0)};
    over[1].up[1] = -1.0;
    path = path_of(&base, over, 2);
    assert_int_equal(sheen_camera_path_at(path, 1.0, &c), SHEEN_CAMERA_UP_ALONG_VIEW);
    sheen_camera_path_destroy(&path);
    for (int f = SHEEN_CAMERA_FINE; f <= SHEEN_CAMERA_BAD_ANGLE; ++f)
        assert_true(strlen(sheen_camera_fault_text((SheenCameraFault)f)) > 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys_are_hit),
        cmocka_unit_test(test_two_keys_are_a_line),
        cmocka_unit_test(test_parabolas_are_exact),
        cmocka_unit_test(test_velocity_is_continuous),
        cmocka_unit_test(test_it_stands_still_between_equal_keys),
        cmocka_unit_test(test_the_curve_turns_with_its_keys),
        cmocka_unit_test(test_angles_stay_between_keys),
        cmocka_unit_test(test_what_keys_do_not_tell_is_the_scenes),
        cmocka_unit_test(test_up_of_a_camera),
        cmocka_unit_test(test_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
