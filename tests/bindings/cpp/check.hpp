/* SPDX-License-Identifier: MIT */
/* What the tests of the C++ header share. */
#include <sphgrad/sphgrad.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            std::printf("%s:%d: %s\n", __FILE__, __LINE__, #condition);                            \
            std::exit(1);                                                                          \
        }                                                                                          \
    } while (0)

/* The call throws sphgrad::error with that result, and a message that holds the words. */
template <class Call> void check_throws(sphg_result result, const char *words, Call &&call)
{
    try {
        call();
    } catch (const sphgrad::error &error) {
        if (error.result() == result && std::strstr(error.what(), words))
            return;
        std::printf("%d: %s\n", static_cast<int>(error.result()), error.what());
    }
    std::printf("nothing that says '%s' was thrown\n", words);
    std::exit(1);
}
