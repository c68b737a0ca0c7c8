/* SPDX-License-Identifier: MIT */
/* The reference of borrowed curvature: docs/theory.md, section 9. */
#ifndef TESTS_SUPPORT_ORACLE_BORROWED_H
#define TESTS_SUPPORT_ORACLE_BORROWED_H
#include "oracle_quadratic.h"

/* What target i lends: c, how far rounding may move it, and whether lenders could change anything;
 * open_blur: how near to being otherwise. */
typedef struct oracle_offer {
    quad confidence, blur;
    int open, sure;
} oracle_offer;

oracle_offer oracle_offer_of(const oracle_scene *scene, const oracle_point *point,
                             const oracle_second *second);
/* lent: of each source c and c times the Hessians of a field's components; NULL: nobody lends. */
oracle_curved oracle_apply_borrowed(oracle *reference, const oracle_field *field,
                                    const double *lent, int i);
/* c of a target that was lent something. */
quad oracle_confidence_lent(const oracle_point *point, quad own, const double *lent, int width);

#endif
