/* SPDX-License-Identifier: MIT */
/* Every rule about arguments. The door of the library: nothing behind it looks at them again. */
#ifndef SPHGI_CHECK_H
#define SPHGI_CHECK_H
#include "context.h"

/* Who is checked, for messages. */
struct sphgi_checker {
    sphg_context *context;
    const char *function;
};

/* A scheme with its defaults filled in. */
struct sphgi_scheme {
    int32_t dimension;
    sphg_method method;
    sphg_kernel kernel;
    sphg_policy policy;
    double radius, threshold;
    int32_t order; /* 1 or 2 */
    bool radii;    /* of their own: `radius` is one of these, not the scheme's */
};

bool sphgi_is_classic(sphg_method method);

/* Numbers per item of a correction table. */
int32_t sphgi_correction_width(sphg_method method, int32_t dimension, int32_t order);

sphg_result sphgi_check_pointer(struct sphgi_checker checker, const void *pointer,
                                const char *name);
sphg_result sphgi_check_scheme(struct sphgi_checker checker, const sphg_scheme *scheme,
                               struct sphgi_scheme *checked);
/* The same where particles have radii of their own: that of the scheme is not read, and left 0. */
sphg_result sphgi_check_scheme_beside_radii(struct sphgi_checker checker, const sphg_scheme *scheme,
                                            struct sphgi_scheme *checked);

/* 1/H^d and H^2 must be normal numbers of the type. */
sphg_result sphgi_check_range(struct sphgi_checker checker, const struct sphgi_scheme *scheme,
                              sphg_type type);

enum sphgi_use { SPHGI_INPUT, SPHGI_OUTPUT };

/* numbers: per item; 0: as many as shape holds. An absent view passes; required: it does not. */
struct sphgi_expected {
    const char *name;
    sphg_type type;
    sphg_shape shape; /* or 0, with flat numbers */
    int32_t numbers, dimension, count;
    enum sphgi_use use;
    bool required;
};
sphg_result sphgi_check_view(struct sphgi_checker checker, const sphg_view *view,
                             const struct sphgi_expected *expected);
/* Of what is there; where nothing is, as a view or the geometry names it. */
sphg_type sphgi_type_of_positions(const sphg_geometry *geometry);
/* What reads no radius; then what does, with the scheme's, or the largest. */
sphg_result sphgi_check_geometry(struct sphgi_checker checker, const sphg_geometry *geometry,
                                 const struct sphgi_scheme *scheme, bool searched);
sphg_result sphgi_check_extent(struct sphgi_checker checker, const sphg_geometry *geometry,
                               const struct sphgi_scheme *scheme);
sphg_result sphgi_check_lists(struct sphgi_checker checker, const sphg_lists *lists,
                              int32_t target_count);
/* A list turned out to be wrong: it holds `index`, which is no source, or has no valid length. */
#define SPHGI_BAD_LENGTH INT64_MIN
sphg_result sphgi_refuse_list(struct sphgi_checker checker, int32_t target, int64_t index);
sphg_result sphgi_check_subset(struct sphgi_checker checker, const sphg_subset *subset,
                               int32_t target_count);

#endif
