#pragma once

#include <string>
#include <vector>

#include "platform/error.h"

namespace cgsr::app {

/// The command line of `cgsr map refine accept`.
struct AcceptOptions {
  std::string map;           ///< OBJ: the refined one.
  std::string proposals;     ///< OBJ of lines that refine wrote.
  std::string output;        ///< .cgsrmap.
  std::vector<int> numbers;  ///< of the proposals that a person has found to be real.
  bool force = false;
};

/// Writes the map as the robot's loader makes it, with the accepted lines as drawn edges (world::EdgeKind::kDrawn). A line that an edge of the
/// map covers anyway is none of its own. The map's own file stays as it is.
/// \return what cannot be read, is not as expected, or cannot be written; a number that the file of proposals does not have, or that is given twice.
Result<void> run_accept(const AcceptOptions& options);

}  // namespace cgsr::app
