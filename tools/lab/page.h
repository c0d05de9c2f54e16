#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/error.h"
#include "tools/lab/store.h"

namespace cgsr::lab {

/// A table of the register as the page shows it.
struct PageEntry {
  const Experiment* experiment = nullptr;
  std::optional<Report> stored;  ///< nothing: it has not been measured.
  Staleness staleness = Staleness::kFresh;
};

/// \return every table of the register with what the store has of it; or which file cannot be read.
Result<std::vector<PageEntry>> entries_of(const Store& store);

/// \return docs/results.md: one table per chapter with the rows that have a requirement or a figure of the dissertation's.
std::string page_of(const std::vector<PageEntry>& entries);

/// \return the page without its marks of what is stale, which depend on the tree and not on the results.
std::string without_stale_marks(const std::string& page);

}  // namespace cgsr::lab
