/* SPDX-License-Identifier: MIT */
/* Result codes in words, and the version. */
#include "internal.h"

const char *sphg_result_string(sphg_result result)
{
    switch (result) {
#define SPHG_X(name, value, text)                                                                  \
    case SPHG_##name:                                                                              \
        return text;
        SPHG_RESULT_LIST(SPHG_X)
#undef SPHG_X
    }
    return "not a result of this library";
}

int32_t sphg_version(void)
{
    return SPHG_VERSION;
}
