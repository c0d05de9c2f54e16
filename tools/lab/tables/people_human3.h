#pragma once

#include <string>

#include "tools/lab/experiment.h"

namespace cgsr::lab {

/// Chapter 6's colour classifiers on a recorded person who shows no face: learned from the first box, then followed by shirt, skin and hair (6.2.2, 6.3).
Result<Report> people_human3(const Setting& setting);

/// The hash of what it measures with: the shipped person tracker.
Result<std::string> person_tracker_hash(const Setting& setting);

}  // namespace cgsr::lab
