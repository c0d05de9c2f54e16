#pragma once

#include <string>
#include <vector>

#include "platform/config/catalogue.h"
#include "platform/config/sha256.h"

namespace cgsr::config {

/// \return every value as one TOML line `path.to.key = value`, sorted by path. Reading the text gives the values back.
std::string to_canonical(const std::vector<Section>& sections);

/// \return the canonical text of `parameters`: the same for every file that means the same, whatever its comments, order, spelling of numbers,
///         omitted defaults or `extends`. Paths of files are relative to the configuration file. Lists are not supported.
template <class Parameters>
std::string canonical(const Parameters& parameters) {
  return to_canonical(catalogue(parameters));
}

/// \return the configuration hash that every report prints: SHA-256 of the canonical text, 64 hexadecimal digits. The content of files that a
///         path names is not in it.
template <class Parameters>
std::string hash(const Parameters& parameters) {
  return sha256(canonical(parameters));
}

}  // namespace cgsr::config
