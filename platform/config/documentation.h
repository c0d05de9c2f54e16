#pragma once

#include <string>
#include <vector>

#include "platform/config/catalogue.h"

namespace cgsr::config {

/// \return Markdown: a heading for each section, under it a table of key, unit, range, default and meaning.
std::string to_markdown(const std::vector<Section>& sections);

/// \return the tables of a parameter struct's defaults.
template <class Parameters>
std::string markdown() {
  return to_markdown(catalogue(Parameters()));
}

}  // namespace cgsr::config
