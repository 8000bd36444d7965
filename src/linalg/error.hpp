// The one exception type of the core. The C shim turns it into a status code and the context's error details.
#pragma once
#include "linalg/status.hpp"
#include <cstdint>
#include <stdexcept>
#include <string>

namespace plm {

/// A failure that the caller can read: status, a reason a program can branch on, the argument and index it
/// concerns, and the code of the library underneath.
class Error : public std::runtime_error {
  public:
    Error(Status status, const std::string &message) : std::runtime_error(message), status_(status) {}
    Error &argument(const std::string &name) { return argument_ = name, *this; }
    Error &index(std::int64_t i) { return index_ = i, *this; }
    Error &library_code(std::int64_t c) { return library_code_ = c, *this; }
    Error &reason(std::int32_t r) { return reason_ = r, *this; }

    Status status() const { return status_; }
    std::int32_t reason() const { return reason_; }
    const std::string &argument() const { return argument_; }
    std::int64_t index() const { return index_; }
    std::int64_t library_code() const { return library_code_; }

  private:
    Status status_;
    std::int32_t reason_ = 0;
    std::string argument_;
    std::int64_t index_ = -1;
    std::int64_t library_code_ = 0;
};

/// printf-style std::string, for error texts with numbers in them.
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
std::string
format(const char *pattern, ...);

} // namespace plm
