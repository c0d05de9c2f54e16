#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "platform/error.h"
#include "tools/lab/person_cast.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// What the robot said of one image.
struct Seen {
  double time_s = 0.0;  ///< of the table's script, which begins after the robot was trained.
  int number = -1;      ///< who is identified; 0: a stranger, -1: nobody.
  bool by_face = false;
  bool a_face = false;  ///< some face is in view, named or not.
  bool unsure = false;  ///< a face is in view, nobody is identified.
};

/// Runs a people robot as it ships, but for scenario.toml and identities of the folder, the person with number 1 as the one asked for, and `more` keys.
/// \param begins_s  when the script begins.  \return each image's row; or what the program printed.
Result<std::vector<Seen>> watch(const TableFolder& folder, const std::string& shipped, std::uint64_t seed,
                                const std::string& more, double begins_s);

/// While it lives, images of simulated runs are kept in a folder of the table, so that several variants look at the same images, drawn once: where the robot
/// stands.
class SharedImages {
 public:
  explicit SharedImages(const TableFolder& folder);
  ~SharedImages();
  SharedImages(const SharedImages&) = delete;
  SharedImages& operator=(const SharedImages&) = delete;

 private:
  std::filesystem::path cache_;
  std::optional<std::string> before_;
};

/// \return a colour (sRGB) with one low and one high channel: no wall has it.
std::array<double, 3> draw_vivid_shirt(Random& random);

}  // namespace cgsr::lab
