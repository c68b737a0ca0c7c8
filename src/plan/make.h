/* SPDX-License-Identifier: MIT */
/* From a request to its plan. */
#ifndef SPHGI_MAKE_H
#define SPHGI_MAKE_H
#include "plan.h"

/* Everything in request that is wrong is refused here. The plan lives in context->plan. */
sphg_result sphgi_plan_make(struct sphgi_checker checker, const sphg_scheme *scheme,
                            const sphg_request *request, enum sphgi_purpose purpose,
                            struct sphgi_plan *plan);

#endif
