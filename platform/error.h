#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace cgsr {

/// What went wrong, in words for the person who can mend it: what was attempted on which file, line or device, the value met, and
/// what was expected. Used where trouble is rare and off the frame path; on it, an enum names the cause.
struct Error {
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

/// \return the unexpected value that any Result turns into.
inline tl::unexpected<Error> fail(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace cgsr
