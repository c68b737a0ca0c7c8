/* SPDX-License-Identifier: MIT */
#include "bunny.h"
#include <math.h>

struct ellipsoid {
    double middle[3], radii[3]; /* [m] */
};

static bool is_within(const struct ellipsoid *form, const double *x, double thinnest)
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double radius = fmax(form->radii[k], thinnest);
        const double off = (x[k] - form->middle[k]) / radius;
        sum += off * off;
    }
    return sum < 1;
}

bool bunny_holds(const double *x, double spacing)
{
    static const struct ellipsoid forms[] = {
        {{0, 0.03, -0.005}, {0.105, 0.1, 0.085}},     /* body */
        {{0, 0.15, 0.015}, {0.08, 0.065, 0.07}},      /* head */
        {{-0.04, 0.225, 0}, {0.028, 0.05, 0.022}},    /* ears, leaning apart */
        {{0.04, 0.225, 0}, {0.028, 0.05, 0.022}},     /**/
        {{-0.05, 0.29, 0}, {0.03, 0.06, 0.024}},      /**/
        {{0.05, 0.29, 0}, {0.03, 0.06, 0.024}},       /**/
        {{-0.065, -0.065, 0.05}, {0.04, 0.03, 0.06}}, /* feet */
        {{0.065, -0.065, 0.05}, {0.04, 0.03, 0.06}},  /**/
        {{0, -0.02, -0.09}, {0.035, 0.035, 0.035}},   /* tail */
    };
    for (size_t k = 0; k < sizeof forms / sizeof forms[0]; ++k)
        if (is_within(&forms[k], x, 1.1 * spacing))
            return true;
    return false;
}

/* Paints what lies within the form, and at least the particle that is nearest to its middle. */
static void paint(const struct ellipsoid *form, enum bunny_part with, int32_t count, vector *x,
                  enum bunny_part *part)
{
    double least = INFINITY;
    int32_t nearest = -1;
    for (int32_t i = 0; i < count; ++i) {
        vector off = {x[i][0], x[i][1], x[i][2]};
        add_scaled(off, -1, form->middle);
        if (is_within(form, x[i], 0))
            part[i] = with;
        if (dot(off, off) < least) {
            least = dot(off, off);
            nearest = i;
        }
    }
    if (nearest >= 0)
        part[nearest] = with;
}

void bunny_paint(int32_t count, vector *x, enum bunny_part *part)
{
    static const struct {
        struct ellipsoid form;
        enum bunny_part with;
    } touches[] = {
        {{{-0.05, 0.27, 0.025}, {0.015, 0.055, 0.025}}, BUNNY_EAR},
        {{{0.05, 0.27, 0.025}, {0.015, 0.055, 0.025}}, BUNNY_EAR},
        {{{-0.034, 0.168, 0.085}, {0.012, 0.012, 0.025}}, BUNNY_EYE},
        {{{0.034, 0.168, 0.085}, {0.012, 0.012, 0.025}}, BUNNY_EYE},
        {{{0, 0.138, 0.09}, {0.01, 0.008, 0.02}}, BUNNY_NOSE},
    };
    for (int32_t i = 0; i < count; ++i)
        part[i] = BUNNY_FUR;
    for (size_t k = 0; k < sizeof touches / sizeof touches[0]; ++k)
        paint(&touches[k].form, touches[k].with, count, x, part);
}
