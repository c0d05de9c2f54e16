#pragma once

#include <toml++/toml.h>

#include <string>

namespace cgsr::config {

struct Tree {
  toml::table root;
};

/// \return `value` as one line of TOML in ASCII: safe on a terminal and the same everywhere.
std::string one_line(const toml::node& value);

}  // namespace cgsr::config
