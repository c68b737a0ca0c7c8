/* SPDX-License-Identifier: MIT */
/* The study behind Figs. 2 and 4 of Westhofen, Jeske, Bender 2023, doi:10.1145/3606933: velocity
 * fields on the square [-1, 1]^2, full of particles with nothing around, and how far computed
 * gradients and curls are from the true ones. Volumes are V_j = 1 / sum_k W_jk, j included. */
#ifndef SPHGRAD_BENCH_FIELD_STUDY_H
#define SPHGRAD_BENCH_FIELD_STUDY_H
#include "particles/names.h"
#include "numbers.h"
#include <stdbool.h>

enum study_field {
    FIELD_ROTATION,     /* v = (-y, x) */
    FIELD_TRIGONOMETRIC /* v = (cos 2x, cos y - sin 3x) */
};

const char *study_field_name(enum study_field field);
const char *study_field_formula(enum study_field field);

struct study_setting {
    int32_t side;   /* N: N x N particles in the centres of as many square cells */
    double support; /* H in spacings d = 2 / N */
    double jitter;  /* each coordinate moves by up to this share of the spacing */
    sphg_kernel kernel;
    enum precision precision;
};

struct study {
    struct study_setting setting;
    int32_t count;
    double spacing;
    struct numbers positions, volumes;
    sphg_context *context;
    sphg_neighbors *neighbors;
};

/* The boundary is the two outermost layers, the inside is the rest. */
struct study_errors {
    double boundary_max, boundary_mean; /* |J_i - J|_F */
    double inside_max, inside_mean;     /* 0 if there is no inside */
    double curl_max;                    /* |curl_i - curl|, everywhere */
};

struct study study_open(const struct study_setting *setting);
void study_close(struct study *study);

bool study_on_boundary(const struct study *study, int32_t particle);
void study_velocity(const struct study *study, enum study_field field, int32_t particle,
                    double velocity[2]);

/* Difference form. gradient_errors, curl_errors: one number per particle, or NULL. */
struct study_errors study_measure(const struct study *study, enum study_field field,
                                  sphg_method method, double *gradient_errors, double *curl_errors);
#endif
