// SPDX-License-Identifier: Apache-2.0
#include "options_json.h"

#include "json_text.h"

#include <string.h>

const char *choice_name(const Choice *choices, int value)
{
    for (const Choice *c = choices; c->name; ++c)
        if (c->value == value) return c->name;
    return "";
}

static json_t *texts_json(const TextList *list)
{
    json_t *texts = json_array();
    for (size_t i = 0; i < list->n; ++i) json_array_append_new(texts, json_text(list->items[i]));
    return texts;
}

static json_t *value_json(const Option *o, const void *field)
{
    switch (o->kind) {
    case OPTION_FLAG:
        return json_boolean(*(const bool *)field);
    case OPTION_COUNT:
        return json_integer(*(const uint32_t *)field);
    case OPTION_NUMBER:
        return json_real(*(const double *)field);
    case OPTION_CHOICE:
    case OPTION_SWITCH:
        return json_string(choice_name(o->choices, *(const int *)field));
    case OPTION_SIZE: {
        const PictureSize *size = field;
        return json_pack("[I, I]", (json_int_t)size->width, (json_int_t)size->height);
    }
    case OPTION_TEXT: {
        const char *text = *(const char *const *)field;
        return text ? json_text(text) : json_null();
    }
    case OPTION_TEXTS:
        return texts_json(field);
    case OPTION_SET: {
        json_t *names = json_array();
        for (const Choice *c = o->choices; c->name; ++c)
            if (c->value >= 0 && *(const unsigned *)field >> c->value & 1u)
                json_array_append_new(names, json_string(c->name));
        return names;
    }
    case OPTION_LATER:
        break;
    }
    return json_null();
}

/** @return the options with a flag, which stands at `flag` in an Option. */
static json_t *flagged_json(const OptionTable *tables, const void *values, size_t flag)
{
    json_t *object = json_object();
    const Option *o;
    size_t offset;
    for (size_t i = 0; object && (o = cli_option(tables, i, &offset)); ++i) {
        if (!*(const bool *)((const char *)o + flag)) continue;
        if (json_object_set_new(object, o->name, value_json(o, (const char *)values + offset)) == 0) continue;
        json_decref(object);
        object = NULL;
    }
    return object;
}

json_t *options_json(const OptionTable *tables, const void *values)
{
    return flagged_json(tables, values, offsetof(Option, recorded));
}

json_t *options_json_of_records(const OptionTable *tables, const void *values)
{
    return flagged_json(tables, values, offsetof(Option, of_records));
}

json_t *options_json_value(const OptionTable *tables, const void *values, const char *name)
{
    const Option *o;
    size_t offset;
    for (size_t i = 0; (o = cli_option(tables, i, &offset)); ++i)
        if (strcmp(o->name, name) == 0) return value_json(o, (const char *)values + offset);
    return NULL;
}
