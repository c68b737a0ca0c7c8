/* SPDX-License-Identifier: MIT */
/* Errors of calls: thrown, or returned and to be looked at. Part of sphgrad.hpp, which includes it.
 */
#ifndef SPHGRAD_CPP_ERRORS_HPP
#define SPHGRAD_CPP_ERRORS_HPP
#include <sphgrad/sphgrad.h>
#include <stdexcept>
#include <string>

namespace sphgrad
{

class error : public std::runtime_error
{
  public:
    error(sphg_result result, const std::string &message)
        : std::runtime_error(message.empty() ? sphg_result_string(result) : message),
          result_(result)
    {
    }
    sphg_result result() const noexcept
    {
        return result_;
    }

  private:
    sphg_result result_;
};

/* The outcome of a call that does not throw; true if it went well. */
struct [[nodiscard]] status {
    sphg_result result = SPHG_OK;
    std::string message;
    explicit operator bool() const noexcept
    {
        return result == SPHG_OK;
    }
};

/* What becomes of a failure. */
struct throws {
    using type = void;
    static void finish(sphg_result result, const char *message)
    {
        if (result != SPHG_OK)
            throw error(result, message);
    }
};
struct returns {
    using type = status;
    static status finish(sphg_result result, const char *message)
    {
        return result == SPHG_OK ? status{} : status{result, message};
    }
};

} // namespace sphgrad
#endif
