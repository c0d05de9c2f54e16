#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "hal/sim/render/photographer.h"
#include "hal/sim/worlds/world.h"
#include "platform/error.h"

namespace cgsr::lab {

/// How much of a person the robot's camera sees.
struct PersonView {
  double shirt = 0.0;  ///< share of the shirt inside the image that nothing hides; 0: not there.
  double face = 0.0;   ///< the same of the head.
  bool frontal = false;

  /// "A quarter of shirt or face": the person is visible.
  [[nodiscard]] bool is_visible() const { return shirt >= 0.25 || face >= 0.25; }
  /// "The shirt or a frontal face": something is visible by which the person can be told.
  [[nodiscard]] bool is_identifiable() const { return shirt >= 0.25 || (face >= 0.25 && frontal); }
};

/// Who is visible to a robot that stands, as the simulator knows it.
class PeopleTruth {
 public:
  /// \param world  a world's file with one robot.  \return why it cannot be used.
  static Result<PeopleTruth> of(const std::filesystem::path& world);

  /// \return one entry per person of the file, in its order.
  std::vector<PersonView> at(double time_s);

 private:
  struct Person {
    int figure = -1;
    int head_joint = 0;
    std::vector<int> head, shirt;  // parts
  };
  explicit PeopleTruth(std::unique_ptr<sim::World> world) : world_(std::move(world)) {}

  std::unique_ptr<sim::World> world_;  // the photographer keeps a reference
  std::unique_ptr<sim::Photographer> photographer_;
  std::vector<Person> people_;
};

}  // namespace cgsr::lab
