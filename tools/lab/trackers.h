#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "src/config/color.h"
#include "tools/lab/box_tracker.h"
#include "tools/lab/film.h"

namespace cgsr::lab {

/// Every tracker that the tables compare, by the name it has there and on the command line.
struct NamedTracker {
  std::string_view name;
  std::unique_ptr<BoxTracker> (*make)(const config::Color&);
  std::string_view options;  ///< of a peer, all that its boxes depend on besides the images; empty: ours, which changes
};

std::span<const NamedTracker> trackers();

/// Learns from image 0 of a film and follows the object through its first `images` images.
///
/// \param learn_from  the film whose first image shows the object; another one than `film` asks for an object that is not there.
/// \return a box or nothing per image; of image 0 the box learned from. An image that cannot be read or an object that cannot be learned,
///         in words.
Result<Boxes> follow(BoxTracker& tracker, const Film& film, int images, const Film& learn_from);

}  // namespace cgsr::lab
