#pragma once

#include <string>

#include "tools/lab/experiment.h"

namespace cgsr::lab {

/// Chapter 6's primary classifier on photographs (6.2.1): of everybody in turn, the first two images enrol and the rest identify.
Result<Report> faces_caltech(const Setting& setting);

/// The hash of what it measures with: the shipped face detector and matcher.
Result<std::string> faces_hash(const Setting& setting);

}  // namespace cgsr::lab
