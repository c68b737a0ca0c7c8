/* SPDX-License-Identifier: MIT */
/* Compiled as C11 and as C++11: the public header needs nothing before it. */
#include <sphgrad/sphgrad.h>
