#pragma once

#include <string>
#include <vector>

namespace cgsr::app {

/// Becomes the program `name` beside this one, with these arguments. Some commands need what the robot's program must not link: other
/// people's trackers, a ray tracer.
///
/// \return only if that did not work: the reason is reported, kFailure.
int hand_over(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace cgsr::app
