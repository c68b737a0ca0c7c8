/* SPDX-License-Identifier: MIT */
#include "column_names.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS = 8, WORD_SIZE = 24 };

/* A name in small letters, cut at signs, brackets, and between letters and digits. */
struct words {
    char at[WORDS][WORD_SIZE];
    int count; /* WORDS + 1: too many */
};

/* What one name says. */
struct meaning {
    enum quantity first; /* X, VX, DENSITY, MASS, VOLUME; QUANTITIES: nothing of interest */
    int synonym;         /* place in the list below: the first are preferred */
    int axis;            /* an index of the axes below; -1: none */
};

static const char axes[] = "xyz0123";
enum { SYNONYMS = 20, AXES = 7, FIRST_INDEX = 3 };

static const char *const positions[SYNONYMS] = {
    "",           "position", "positions", "pos",      "points", "point",  "coordinates",
    "coordinate", "coords",   "coord",     "location", "xyz",    "center", "centre",
    "unwrapped",  "x",        "r",         "p"};
static const char *const velocities[SYNONYMS] = {"v", "velocity", "velocities", "vel", "u", "uvw"};
static const char *const densities[SYNONYMS] = {"density", "densities", "rho",
                                                "rhop",    "dens",      "massdensity"};
static const char *const masses[SYNONYMS] = {"mass", "masses", "m", "pmass"};
static const char *const volumes[SYNONYMS] = {"volume", "volumes", "vol"};

/* Words before a name and after it that say nothing about it. */
static const char *const prefixes[SYNONYMS] = {"particle", "particles", "c", "f", "v", "sph"};
static const char *const units[SYNONYMS] = {"m",   "mm", "cm", "km", "kg", "g",  "s",
                                            "kgm", "ms", "si", "2",  "3",  "per"};

static const struct {
    enum quantity first;
    const char *const *synonyms;
    bool vector;
} subjects[] = {{QUANTITY_X, positions, true},
                {QUANTITY_VX, velocities, true},
                {QUANTITY_DENSITY, densities, false},
                {QUANTITY_MASS, masses, false},
                {QUANTITY_VOLUME, volumes, false}};

/* ---- One name ------------------------------------------------------------------------------- */

static void add_letter(struct words *words, char letter, bool begins)
{
    if (words->count > WORDS)
        return;
    if (begins || words->count == 0)
        ++words->count;
    if (words->count > WORDS)
        return;
    char *word = words->at[words->count - 1];
    const size_t length = strlen(word);
    if (length + 1 < WORD_SIZE)
        word[length] = (char)tolower((unsigned char)letter);
    else
        words->count = WORDS + 1;
}

/* The end of what stands in brackets, if that is a unit and not an axis. */
static const char *skip_unit(const char *at, const char *end)
{
    if (*at != '[' && *at != '(')
        return at;
    const char *close = memchr(at, *at == '[' ? ']' : ')', (size_t)(end - at));
    if (!close)
        return at;
    const struct span inside = span_trim((struct span){at + 1, close});
    const bool axis = inside.end - inside.start == 1 && strchr("xyzXYZ0123", *inside.start) != NULL;
    return axis ? at : close;
}

/* Without the number before it that some give columns: "1:x", "[1]=x", "[01  x]". */
static struct span without_number(struct span name)
{
    const char *at = name.start;
    const bool bracket = at < name.end && *at == '[';
    at += bracket;
    const char *digits = at;
    while (at < name.end && isdigit((unsigned char)*at))
        ++at;
    if (at == digits)
        return name;
    if (bracket && name.end[-1] == ']' && at < name.end && isspace((unsigned char)*at))
        return (struct span){at, name.end - 1};
    const char *closing = bracket ? "]=" : ":";
    const struct span rest = {at, name.end};
    if (!span_begins(rest, closing) || (size_t)(rest.end - rest.start) == strlen(closing))
        return name;
    return (struct span){at + strlen(closing), name.end};
}

static struct words cut(struct span name)
{
    struct words words = {0};
    name = without_number(name);
    char last = ' ';
    for (const char *at = name.start; at < name.end; ++at) {
        at = skip_unit(at, name.end);
        const bool letter = isalpha((unsigned char)*at), digit = isdigit((unsigned char)*at);
        if (letter || digit)
            add_letter(&words, *at,
                       !(letter ? isalpha((unsigned char)last) : isdigit((unsigned char)last)));
        last = *at;
    }
    return words;
}

static int find(const char *const list[SYNONYMS], const char *word)
{
    for (int k = 0; k < SYNONYMS && list[k]; ++k)
        if (strcmp(list[k], word) == 0)
            return k;
    return -1;
}

static int axis_of(const char *word)
{
    const char *found = word[0] && !word[1] ? strchr(axes, word[0]) : NULL;
    return found ? (int)(found - axes) : -1;
}

/* axis: -1 of what has no direction. */
static struct meaning look_up(const char *word, int axis)
{
    for (size_t k = 0; k < sizeof subjects / sizeof subjects[0]; ++k) {
        const int synonym = find(subjects[k].synonyms, word);
        const bool bare_number = word[0] == '\0' && axis >= FIRST_INDEX;
        if (synonym >= 0 && subjects[k].vector == (axis >= 0) && !bare_number)
            return (struct meaning){subjects[k].first, synonym, axis};
    }
    return (struct meaning){QUANTITIES, 0, -1};
}

/* "vx", "posx", "xpos", and x, y, z or u, v, w themselves. */
static struct meaning meaning_of_word(const char *word)
{
    const size_t length = strlen(word);
    const char *component = length == 1 ? strchr("uvw", word[0]) : NULL;
    if (component)
        return look_up("uvw", (int)(component - "uvw"));
    const struct meaning plain = look_up(word, -1);
    if (plain.first != QUANTITIES || length == 0)
        return plain;
    char rest[WORD_SIZE];
    memcpy(rest, word, length);
    rest[length - 1] = '\0';
    const int last = axis_of(word + length - 1), first = axis_of((char[]){word[0], '\0'});
    const bool whole = last < 0 || strcmp(rest, "p") == 0;
    const struct meaning found = whole ? plain : look_up(rest, last);
    if (found.first != QUANTITIES || first < 0)
        return found;
    if (strcmp(word + 1, "u") == 0)
        return look_up("unwrapped", first);
    return length > 3 ? look_up(word + 1, first) : plain;
}

/* Of the words from `first` to before `end`. */
static struct meaning meaning_of_words(const struct words *words, int first, int end)
{
    char joined[WORDS * WORD_SIZE] = "", but_first[WORDS * WORD_SIZE] = "";
    if (end - first == 1)
        return meaning_of_word(words->at[first]);
    for (int k = first; k < end - 1; ++k)
        strcat(joined, words->at[k]);
    for (int k = first + 1; k < end; ++k)
        strcat(but_first, words->at[k]);
    const int last_axis = axis_of(words->at[end - 1]), first_axis = axis_of(words->at[first]);
    if (last_axis >= 0)
        return look_up(joined, last_axis);
    if (first_axis >= 0 && strlen(but_first) > 2)
        return look_up(but_first, first_axis);
    return look_up(strcat(joined, words->at[end - 1]), -1);
}

static struct meaning meaning_of(struct span name)
{
    const struct words words = cut(name);
    const struct meaning nothing = {QUANTITIES, 0, -1};
    if (words.count > WORDS)
        return nothing;
    for (int first = 0; first < words.count; ++first) {
        for (int end = words.count; end > first; --end) {
            const struct meaning found = meaning_of_words(&words, first, end);
            if (found.first != QUANTITIES)
                return found;
            if (find(units, words.at[end - 1]) < 0)
                break;
        }
        if (find(prefixes, words.at[first]) < 0)
            break;
    }
    return nothing;
}

/* ---- All names ------------------------------------------------------------------------------ */

/* The columns that one synonym of one quantity has. */
struct candidate {
    int32_t first[AXES + 1], second[AXES + 1]; /* of each axis, at the end of none; -1 */
};

static struct candidate collect(const struct meaning *meanings, int32_t count, enum quantity first,
                                int synonym)
{
    struct candidate found;
    for (int axis = 0; axis <= AXES; ++axis)
        found.first[axis] = found.second[axis] = -1;
    for (int32_t k = 0; k < count; ++k) {
        if (meanings[k].first != first || meanings[k].synonym != synonym)
            continue;
        const int axis = meanings[k].axis < 0 ? AXES : meanings[k].axis;
        int32_t *place = found.first[axis] < 0 ? found.first : found.second;
        place[axis] = k;
    }
    return found;
}

/* Letters, or numbers from 0 or 1, of which at least two must be there. */
static int start_of_axes(const struct candidate *found)
{
    const int starts[] = {0, found->first[FIRST_INDEX] < 0 ? FIRST_INDEX + 1 : FIRST_INDEX};
    for (int k = 0; k < 2; ++k) {
        const int32_t *at = found->first + starts[k];
        if ((at[0] >= 0) + (at[1] >= 0) + (at[2] >= 0) >= 2)
            return starts[k];
    }
    return -1;
}

static void choose(const struct meaning *meanings, int32_t count, enum quantity first, int width,
                   int32_t columns[QUANTITIES], int32_t *twice)
{
    for (int synonym = 0; synonym < SYNONYMS; ++synonym) {
        const struct candidate found = collect(meanings, count, first, synonym);
        const int start = width > 1 ? start_of_axes(&found) : found.first[AXES] < 0 ? -1 : AXES;
        if (start < 0)
            continue;
        for (int axis = 0; axis < width; ++axis) {
            columns[(int)first + axis] = found.first[start + axis];
            if (found.second[start + axis] >= 0)
                *twice = found.second[start + axis];
        }
        return;
    }
}

static void keep_complete_velocities(int32_t columns[QUANTITIES])
{
    bool complete = true;
    for (int axis = 0; axis < 3; ++axis)
        complete = complete && (columns[QUANTITY_X + axis] < 0 || columns[QUANTITY_VX + axis] >= 0);
    for (int axis = 0; axis < 3; ++axis)
        if (!complete || columns[QUANTITY_X + axis] < 0)
            columns[QUANTITY_VX + axis] = -1;
}

bool columns_find(const struct cells *names, int32_t columns[QUANTITIES], int32_t *twice)
{
    *twice = -1;
    for (int k = 0; k < QUANTITIES; ++k)
        columns[k] = -1;
    struct meaning *meanings = malloc(((size_t)names->count + 1) * sizeof *meanings);
    if (!meanings)
        return false;
    int32_t positions_seen = 0;
    for (int32_t k = 0; k < names->count; ++k) {
        meanings[k] = meaning_of(names->at[k]);
        positions_seen += meanings[k].first == QUANTITY_X;
    }
    for (size_t k = 0; positions_seen > 1 && k < sizeof subjects / sizeof *subjects; ++k)
        choose(meanings, names->count, subjects[k].first, subjects[k].vector ? 3 : 1, columns,
               twice);
    free(meanings);
    keep_complete_velocities(columns);
    return *twice < 0 && (columns[QUANTITY_X] >= 0 || columns[QUANTITY_Y] >= 0);
}
