#pragma once

#include <map>
#include <string>
#include <vector>

#include "platform/error.h"

namespace cgsr::lab {

struct Cost {
  double mean_minstr = 0.0;
  double worst_minstr = 0.0;
};

/// What tools/count says about a command.
struct Counted {
  std::map<std::string, Cost> stages;
  Cost image;
  int images = 0;
};

/// Runs this very program once more under tools/count. \param arguments  of the command line. \return what went wrong, in words.
Result<Counted> count_self(const std::vector<std::string>& arguments);

}  // namespace cgsr::lab
