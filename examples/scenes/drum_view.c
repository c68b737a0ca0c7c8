/* SPDX-License-Identifier: MIT */
#include "drum_view.h"
#include <math.h>
#include <stdlib.h>

/* What a disc shows; BUNNY_FUR and so on come first. */
enum { SOAP = BUNNY_PARTS, WATER, DRUM, RIB };

static const double cut = -0.045; /* fluids in front of it would hide the bunny [m] */
enum { RIBS = 6 };                /* painted on the drum, so that one sees it turn */

struct disc {
    double right, up, near, radius;
    int what;
};

static int farther_first(const void *a, const void *b)
{
    const struct disc *first = a, *second = b;
    return (first->near > second->near) - (first->near < second->near);
}

/* From a little to the right and above. */
static struct disc disc_at(const double *x, double radius, int what)
{
    static const double toward[3] = {0.24, 0.14, 0.96}, right[3] = {0.97, 0, -0.2425},
                        up[3] = {-0.034, 0.99, -0.136};
    return (struct disc){dot(x, right), dot(x, up), dot(x, toward), radius, what};
}

static int rib_or_drum(const struct drum_view *view, const double *x)
{
    const double part = 6.283185307179586 / RIBS;
    const double angle = atan2(x[1], x[0]) - view->angle;
    const double off = fabs(angle - part * round(angle / part)) * hypot(x[0], x[1]);
    return off < 0.02 ? RIB : DRUM;
}

void drum_view_write(const struct drum_view *view, FILE *table)
{
    const struct load *load = view->load;
    const int32_t count = load->all.count;
    struct disc *discs = array_new(count + view->wall->count, sizeof *discs);
    int32_t shown = 0;
    for (int32_t k = 0; k < view->wall->count; ++k)
        if (view->wall->x[k][2] < 0.3 * view->spacing)
            discs[shown++] =
                disc_at(view->wall->x[k], 0.5 * view->spacing, rib_or_drum(view, view->wall->x[k]));
    for (int32_t i = 0; i < count; ++i)
        if (i < load->body || load->all.x[i][2] < cut)
            discs[shown++] = disc_at(load->all.x[i], (i < load->body ? 0.62 : 0.58) * view->spacing,
                                     i < load->body   ? (int)view->parts[i]
                                     : i < load->soap ? SOAP
                                                      : WATER);
    qsort(discs, (size_t)shown, sizeof *discs, farther_first);
    for (int32_t k = 0; k < shown; ++k)
        fprintf(table, "%.4f %.4f %.4f %d %.3f\n", discs[k].right, discs[k].up, discs[k].radius,
                discs[k].what, discs[k].near);
    free(discs);
}

void drum_view_draw(const struct picture *picture, double time)
{
    FILE *script = picture->script;
    picture_begin(picture, 960, 560);
    /* fur, ears, eyes, nose, soap, water, drum, ribs: they differ in lightness, too */
    fprintf(script,
            "array colours[8] = [0xf4efe8, 0xe79aa8, 0x202020, 0xc25b6e, 0xf0e442, 0x56b4e9, "
            "0xd0d0d0, 0x9a9a9a]\n"
            "share(near) = near < -0.2 ? 0 : near > 0.1 ? 1 : (near + 0.2) / 0.3\n"
            "light(near) = 0.74 + 0.26 * share(near)\n"
            "part(c, shift, l) = int(l * ((c >> shift) & 255)) << shift\n"
            "rgb(what, near) = part(colours[what + 1], 16, light(near)) "
            "+ part(colours[what + 1], 8, light(near)) + part(colours[what + 1], 0, light(near))\n"
            "set size ratio -1\nunset tics\nunset border\nunset colorbox\n"
            "set xrange [-0.45:0.46]\nset yrange [-0.42:0.43]\n"
            "set label 1 'after %.2f s: an elastic bunny, soap (yellow) and water (blue) in a "
            "turning drum, cut open' at screen 0.5, screen 0.06 center\n",
            time);
    for (int k = 0; k < 2; ++k) {
        picture_panel(picture, 0.005 + 0.5 * k, 0.495 + 0.5 * k);
        fprintf(script,
                "set title \"{/:Bold=15 %s}\\nleast det F in the bunny: %.2g (1 at rest)\"\n"
                "plot 'washing_machine_%s_drum%s.dat' using 1:2:3:(rgb($4, $5)) with circles "
                "lc rgb variable fillstyle solid border lc rgb '#80333333' notitle\n"
                "unset label 1\n",
                picture->titles[k], metrics_get(picture->metrics[k], "least_volume_of_body"),
                picture->methods[k], picture->frame);
    }
}
