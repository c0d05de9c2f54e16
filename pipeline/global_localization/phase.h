#pragma once

#include <cstdint>
#include <string_view>

namespace cgsr::global_localization {

/// How far the search for the first pose has come.
enum class Phase : std::uint8_t {
  kTurning,    ///< the robot should turn on the spot; images of all around are collected.
  kComparing,  ///< from here on it should stand: they are compared with the map from everywhere.
  kTrying,     ///< the localizer tries the most alike places.
  kSettling,   ///< the best one is corrected by the images that come now.
  kFound,
  kAmbiguous,  ///< more than one place explains the images.
  kNotFound,   ///< none does.
};

/// \return lower_case word.
std::string_view to_string(Phase phase);

}  // namespace cgsr::global_localization
