// SPDX-License-Identifier: Apache-2.0
// Colours and spectra of Mitsuba scenes as linear sRGB.
#include "image/image.h"
#include "image/whole_file.h"
#include "io/file_path.h"
#include "io/mesh.h"
#include "io/mitsuba.h"
#include "io/number.h"
#include "io/spectrum.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static int hex_digit(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : isxdigit((unsigned char)c) ? tolower((unsigned char)c) - 'a' + 10 : -1;
}

/** "#rrggbb". @return false when it is not. */
static bool parse_hex(const char *text, Rgb *out)
{
    float c[3];
    if (strlen(text) != 7) return false;
    for (int i = 0; i < 3; ++i) {
        int high = hex_digit(text[1 + 2 * i]), low = hex_digit(text[2 + 2 * i]);
        if (high < 0 || low < 0) return false;
        c[i] = (float)(16 * high + low) / 255.0f;
    }
    *out = rgb(c[0], c[1], c[2]);
    return true;
}

static Rgb rgb_of(Mitsuba *m, const SheenXml *e, const char *text, bool encoded)
{
    double v[3];
    Rgb c = rgb_gray(0.0f);
    if (*text == '#') {
        if (!parse_hex(text, &c)) sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "'%.60s' is not a colour #rrggbb", text);
    } else {
        int n = sheen_mi_numbers(text, 3, v);
        if (n == 1)
            c = rgb_gray((float)v[0]);
        else if (n == 3)
            c = rgb((float)v[0], (float)v[1], (float)v[2]);
        else
            sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "<%s> needs one or three finite numbers, not '%.60s'", e->tag, text);
    }
    if (!encoded) return c;
    return rgb(sheen_srgb_decode(c.r), sheen_srgb_decode(c.g), sheen_srgb_decode(c.b));
}

/** Wavelengths and values, interleaved, in a growing array. */
typedef struct Samples {
    double (*pairs)[2];
    uint32_t n, capacity;
} Samples;

static Rgb fold_spectrum(const SheenSpectrum *s, MitsubaColor kind)
{
    return kind == MITSUBA_REFLECTANCE ? sheen_spectrum_reflectance(s) : sheen_spectrum_emission(s);
}

static Rgb fold(const Samples *s, MitsubaColor kind)
{
    double *lambda = malloc(2 * (size_t)s->n * sizeof *lambda + 1);
    if (!lambda) return rgb_gray(0.0f);
    SheenSpectrum spectrum = {s->n, lambda, lambda + s->n};
    for (uint32_t i = 0; i < s->n; ++i) lambda[i] = s->pairs[i][0], lambda[s->n + i] = s->pairs[i][1];
    Rgb c = fold_spectrum(&spectrum, kind);
    free(lambda);
    return c;
}

/** Reads "wavelength SEPARATOR value" until the end of the text, '#' beginning a comment. @return false for others. */
static bool parse_samples(const char *text, const char *end, Samples *s)
{
    for (;;) {
        double pair[2];
        for (int i = 0; i < 2; ++i) {
            while (text < end && (isspace((unsigned char)*text) || *text == ',' || *text == ':' || *text == '#')) {
                if (*text == '#')
                    while (text < end && *text != '\n') ++text;
                else
                    ++text;
            }
            if (text == end) return i == 0 && s->n > 0;
            if (!sheen_number_parse(&text, end, &pair[i]) || !isfinite(pair[i])) return false;
        }
        if (s->n && pair[0] <= s->pairs[s->n - 1][0]) return false; // wavelengths rise
        if (!sheen_reserve((void **)&s->pairs, &s->capacity, (uint64_t)s->n + 1, sizeof pair)) return false;
        memcpy(s->pairs[s->n++], pair, sizeof pair);
    }
}

static Rgb sampled_of(Mitsuba *m, const SheenXml *e, const char *text, size_t size, MitsubaColor kind)
{
    Samples s = {0};
    Rgb c = rgb_gray(0.0f);
    if (parse_samples(text, text + size, &s))
        c = fold(&s, kind);
    else
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the spectrum is not a list of rising wavelengths and finite values");
    free(s.pairs);
    return c;
}

static Rgb spectrum_file(Mitsuba *m, const SheenXml *e, const char *name, MitsubaColor kind)
{
    uint8_t *data;
    size_t size;
    const char *path = m->with_files ? sheen_xml_find_file(m->folders, m->scratch, e->file, name) : NULL;
    if (!path) {
        sheen_mi_fail(m, SHEEN_ERR_IO, e, "cannot open the spectrum '%s'", name);
        return rgb_gray(0.0f);
    }
    SheenStatus status = sheen_file_read(path, m->log, &data, &size);
    if (status) {
        if (!m->status) m->status = status;
        return rgb_gray(0.0f);
    }
    Rgb c = sampled_of(m, e, (const char *)data, size, kind);
    free(data);
    return c;
}

/** One number for all wavelengths: gray, but for a light in Mitsuba 3, where it is the equal-energy white. */
static Rgb uniform(const Mitsuba *m, double value, MitsubaColor kind)
{
    static const double lambda[2] = {300, 900};
    if (kind != MITSUBA_EMISSION || m->version < 3) return rgb_gray((float)value);
    const double values[2] = {1, 1};
    return rgb_scale(sheen_spectrum_emission(&(SheenSpectrum){2, lambda, values}), (float)value);
}

static Rgb spectrum_of(Mitsuba *m, const SheenXml *e, MitsubaColor kind)
{
    const char *name = sheen_xml_attribute(e, "filename"), *text = sheen_xml_attribute(e, "value");
    double v[3];
    if (name) return spectrum_file(m, e, name, kind);
    if (!text) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "<spectrum> has neither 'value' nor 'filename'");
        return rgb_gray(0.0f);
    }
    if (strchr(text, ':')) return sampled_of(m, e, text, strlen(text), kind);
    int n = sheen_mi_numbers(text, 3, v);
    if (n == 1) return uniform(m, v[0], kind);
    return rgb_of(m, e, text, false); // 0.5 takes three numbers for RGB; reports what is neither
}

static Rgb blackbody_of(Mitsuba *m, const SheenXml *e)
{
    const char *temperature = sheen_xml_attribute(e, "temperature"), *scale = sheen_xml_attribute(e, "scale");
    double t, s = 1.0;
    size_t n = temperature ? strlen(temperature) : 0;
    char number[64];
    if (n > 0 && (temperature[n - 1] == 'K' || temperature[n - 1] == 'k')) --n; // "5000K"
    if (n >= sizeof number) n = sizeof number - 1;
    memcpy(number, temperature ? temperature : "", n);
    number[n] = '\0';
    if (sheen_mi_numbers(number, 1, &t) != 1 || t <= 0.0 || (scale && sheen_mi_numbers(scale, 1, &s) != 1)) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "<blackbody> needs a positive 'temperature' and a finite 'scale'");
        return rgb_gray(0.0f);
    }
    return rgb_scale(sheen_spectrum_blackbody(t), (float)s);
}

/** A growing list of finite numbers from a string property. @return false, an error unless there was one, for others */
static bool numbers_of(Mitsuba *m, const SheenXml *e, const char *name, double **out, uint32_t *n)
{
    const char *text = sheen_mi_string(m, e, name, "");
    size_t most = strlen(text) / 2 + 1; // numbers have something between them
    *out = SHEEN_ARENA_NEW(m->scratch, double, most);
    int count = *out && most < INT32_MAX ? sheen_mi_numbers(text, (int)most, *out) : -1;
    *n = count > 0 ? (uint32_t)count : 0;
    if (count <= 0) sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "'%s' of the spectrum is not a list of finite numbers", name);
    return count > 0;
}

/** `regular` has its values at even steps of the wavelength, `irregular` names each wavelength. */
static Rgb listed(Mitsuba *m, const SheenXml *e, bool regular, MitsubaColor kind)
{
    double *values, *lambda;
    uint32_t n, n_lambda;
    bool ok = numbers_of(m, e, "values", &values, &n);
    if (ok && regular) {
        double range[2] = {sheen_mi_float(m, e, "wavelength_min", 360.0),
                           sheen_mi_float(m, e, "wavelength_max", 830.0)};
        const char *text = sheen_mi_string(m, e, "range", NULL);
        ok = (!text || sheen_mi_numbers(text, 2, range) == 2) && range[0] < range[1] && n > 1;
        lambda = ok ? SHEEN_ARENA_NEW(m->scratch, double, n) : NULL;
        for (uint32_t i = 0; lambda && i < n; ++i) lambda[i] = range[0] + (range[1] - range[0]) * i / (n - 1);
        ok = lambda != NULL;
    } else if (ok) {
        ok = numbers_of(m, e, "wavelengths", &lambda, &n_lambda) && n == n_lambda;
        for (uint32_t i = 1; ok && i < n; ++i) ok = lambda[i] > lambda[i - 1];
    }
    if (!ok) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the spectrum needs a finite value for each of its rising wavelengths");
        return rgb_gray(0.0f);
    }
    return fold_spectrum(&(SheenSpectrum){n, lambda, values}, kind);
}

/** One number or three for red, green and blue, whatever they stand for. */
static Rgb raw_constant(Mitsuba *m, const SheenXml *e)
{
    const SheenXml *c = sheen_mi_child(e, "value");
    const char *text = c ? sheen_xml_attribute(c, "value") : NULL;
    if (text) return rgb_of(m, c, text, false);
    sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the spectrum has no 'value'");
    return rgb_gray(0.0f);
}

/** <spectrum type="..."> of Mitsuba 3. */
static Rgb plugin_of(Mitsuba *m, const SheenXml *e, MitsubaColor kind)
{
    const char *type = sheen_mi_type(e);
    if (sheen_mi_same(type, "blackbody")) {
        double t = sheen_mi_float(m, e, "temperature", 5000.0), scale = sheen_mi_float(m, e, "scale", 1.0);
        if (t > 0.0) return rgb_scale(sheen_spectrum_blackbody(t), (float)scale);
        sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the temperature of a black body must be positive");
        return rgb_gray(0.0f);
    }
    if (sheen_mi_same(type, "uniform")) return uniform(m, sheen_mi_float(m, e, "value", 1.0), kind);
    if (sheen_mi_same(type, "rgb") || sheen_mi_same(type, "srgb"))
        return sheen_mi_color(m, e, "color", kind, sheen_mi_color(m, e, "value", kind, rgb_gray(0.5f)));
    if (sheen_mi_same(type, "d65")) return rgb_gray((float)sheen_mi_float(m, e, "scale", 1.0)); // sRGB's white
    if (sheen_mi_same(type, "rawconstant")) return raw_constant(m, e);
    bool regular = sheen_mi_same(type, "regular");
    if (regular || sheen_mi_same(type, "irregular")) return listed(m, e, regular, kind);
    if (!e->warned) sheen_xml_warn(m->log, e, "the spectrum '%s' is not supported: gray 0.5 stands in", type);
    return rgb_gray(0.5f);
}

Rgb sheen_mi_color_of(Mitsuba *m, SheenXml *e, MitsubaColor kind)
{
    SheenXml *value = sheen_mi_resolve(m, e);
    Rgb c = rgb_gray(0.0f);
    if (!value) return c;
    value->used = true;
    const char *text = sheen_xml_attribute(value, "value");
    if (strcmp(value->tag, "texture") == 0 || *sheen_mi_type(value)) {
        if (value->busy) {
            sheen_mi_fail(m, SHEEN_ERR_PARSE, e, "the spectrum refers to itself");
            return c;
        }
        value->busy = true;
        c = plugin_of(m, value, kind);
        value->busy = false;
        value->warned = true;
    } else if (strcmp(value->tag, "spectrum") == 0) {
        c = spectrum_of(m, value, kind);
    } else if (strcmp(value->tag, "blackbody") == 0) {
        c = blackbody_of(m, value);
    } else if (!text) {
        sheen_mi_fail(m, SHEEN_ERR_PARSE, value, "<%s> has no 'value'", value->tag);
    } else {
        c = rgb_of(m, value, text, strcmp(value->tag, "srgb") == 0);
    }
    if (!m->status && !rgb_finite(c)) sheen_mi_fail(m, SHEEN_ERR_PARSE, value, "the colour is not finite");
    return c;
}

Rgb sheen_mi_color(Mitsuba *m, const SheenXml *e, const char *name, MitsubaColor kind, Rgb otherwise)
{
    SheenXml *c = sheen_mi_child(e, name);
    return c ? sheen_mi_color_of(m, c, kind) : otherwise;
}
