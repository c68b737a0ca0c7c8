/* SPDX-License-Identifier: MIT */
/* Compiled as C11 and as C++11: each public header needs nothing before it. */
#include PUBLIC_HEADER
