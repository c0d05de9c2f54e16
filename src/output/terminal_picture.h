#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "platform/image_view.h"

namespace cgsr::app {

/// \param image  YUYV. \param columns  characters per line, 8..400. \param colors  24-bit escape sequences; false: letters
/// from dark to light. \return the image as text, a line per row of characters.
std::string terminal_picture(const ImageView& image, int columns, bool colors);

/// \return a line for each entry: its label, a bar whose length is relative to the largest, and the value.
struct Bar {
  std::string label;
  double value = 0.0;
  std::string text;  ///< of the value.
};
std::string bar_chart(std::span<const Bar> bars, int columns = 50);

}  // namespace cgsr::app
