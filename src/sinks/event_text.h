#pragma once

#include <string>

#include "pipeline/stages/events.h"

namespace cgsr::sinks {

/// \return one line for people: "lamp: located (x 4.02 m, y 3.11 m)", "task: search: the object is lost".
std::string text_of(const stages::Event& event);

}  // namespace cgsr::sinks
