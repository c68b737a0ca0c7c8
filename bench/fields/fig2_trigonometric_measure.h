/* SPDX-License-Identifier: MIT */
/* The study behind Figs. 2 and 4 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933: velocity
 * fields on the square [-1, 1]^2 or the cube [-1, 1]^3, full of particles with nothing around, and
 * how far computed gradients and curls are from the true ones. Volumes are V_j = 1 / sum_k W_jk, j
 * included. Particles of a file may take the lattice's place. */
#ifndef SPHGRAD_BENCH_FIG2_TRIGONOMETRIC_MEASURE_H
#define SPHGRAD_BENCH_FIG2_TRIGONOMETRIC_MEASURE_H
#include "particles/names.h"
#include "scene.h"

enum study_field {
    FIELD_ROTATION,      /* v = (-y, x), in 3D (-y, x, 2z) */
    FIELD_TRIGONOMETRIC, /* v = (cos 2x, cos y - sin 3x), in 3D with cos 2z */
    FIELD_WAVES          /* v_a = sin(k x_a) cos(k x_b), b the axis after a */
};

const char *study_field_name(enum study_field field);
const char *study_field_formula(enum study_field field); /* in 2D */

/* v and J where a particle stands. wave: the length of FIELD_WAVES. J is row-major: d v_a / d x_b
 * at dimension a + b. */
void study_exact_at(const struct scene *scene, enum study_field field, double wave,
                    int32_t particle, double v[3], double j[9]);
void study_fill_table(const struct scene *scene, enum study_field field, double wave,
                      struct numbers *velocities);

/* A way to a gradient. */
struct study_way {
    const char *name;
    sphg_method method;
    int32_t order;
    bool lent; /* order 2: a second call lends curvature to those who cannot resolve it */
};

struct study_setting {
    int32_t dimension, threads; /* threads 0: the library's default */
    int32_t side;               /* N particles an axis, in the centres of as many cells */
    double support;             /* H in spacings d = 2 / N; of a file's particles in its unit */
    double jitter;              /* each coordinate moves by up to this share of the spacing */
    sphg_kernel kernel;
    enum precision precision;
};

/* On a lattice the boundary is the two outermost layers. A file's particles are told apart by their
 * rank of order 2: slopes not all resolved, slopes alone, curvature too. */
enum { STUDY_BOUNDARY, STUDY_INSIDE };
enum { STUDY_NEITHER, STUDY_SLOPES, STUDY_CURVATURE, STUDY_GROUPS };

struct study {
    struct study_setting setting;
    enum study_field field;
    struct scene scene;
    struct numbers curls; /* in 2D */
    struct numbers lent;
    uint8_t *groups, *borrows;
    struct held *mark; /* of what is held for it alone */
};

struct study_errors {
    double most[STUDY_GROUPS], mean[STUDY_GROUPS]; /* |J_i - J|_F; 0 of nobody */
    double curl_max;                               /* |curl_i - curl|, everywhere; in 2D */
    int32_t counts[STUDY_GROUPS];
};

struct study study_open(const struct study_setting *setting);
/* volumes may be empty. */
struct study study_of_particles(const struct study_setting *setting, struct numbers positions,
                                struct numbers volumes);
void study_close(struct study *study); /* the last one that was opened */

/* The steps of a measurement, difference form. gradient_errors, curl_errors: one number per
 * particle, or NULL. */
void study_fill(struct study *study, enum study_field field);
void study_search(const struct study *study);
void study_derive(const struct study *study, const struct study_way *way);
struct study_errors study_compare(const struct study *study, double *gradient_errors,
                                  double *curl_errors);
#endif
