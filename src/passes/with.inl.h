/* SPDX-License-Identifier: MIT */
/* The one dispatcher: from what is known when the library runs to what the compiler knows.
 * Templates take flags as constants; whoever calls one asks for each flag by a WITH, one inside the
 * other. */

/* `call` with a constant of that name, true or false as the value is: branches on it are decided
 * when the call is compiled, once for each. */
#define WITH(name, value, call)                                                                    \
    do                                                                                             \
        if (value) {                                                                               \
            enum { name = true };                                                                  \
            call;                                                                                  \
        } else {                                                                                   \
            enum { name = false };                                                                 \
            call;                                                                                  \
        }                                                                                          \
    while (0)
