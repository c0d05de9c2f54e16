#include <cstdio>

#include <fmt/core.h>

#include "src/commands/command.h"

namespace cgsr::app {

int report(const Error& error) {
  fmt::print(stderr, "error: {}\n", error.message);
  return kFailure;
}

}  // namespace cgsr::app
