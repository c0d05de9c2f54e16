#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/world/map.h"
#include "platform/error.h"
#include "tools/lab/experiment.h"

// What tables over pictures of others share. Ours.
namespace cgsr::lab {

/// The numbers that a text file begins with; none where it cannot be read.
std::vector<double> numbers_of(const std::filesystem::path& path);

/// The files of a folder, by name.
std::vector<std::filesystem::path> pictures_of(const std::filesystem::path& folder);

/// ViSP's settings that are compared: every search range with one call and ten.
struct VispChoice {
  unsigned range_px;
  int calls;

  [[nodiscard]] std::string name() const;
};
inline constexpr std::array kVispChoices{VispChoice{8, 1}, VispChoice{8, 10}, VispChoice{25, 1}, VispChoice{25, 10}};

/// Films the poses that one contender found over the pictures. \return the film's path.
Result<std::filesystem::path> film_of_poses(const Setting& setting, const std::string& name, const world::Map& map,
                                            const geometry::Camera& camera,
                                            const std::vector<std::filesystem::path>& pictures,
                                            const std::vector<std::optional<geometry::Pose>>& found,
                                            const std::string& who);

}  // namespace cgsr::lab
