#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "platform/error.h"
#include "tools/lab/child.h"
#include "tools/lab/report.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

/// The shipped person arena without its people, as text.
Result<std::string> empty_arena();

/// \return so many different people of those that the simulator draws by their number; nobody is tuned to them.
std::vector<int> draw_people(std::size_t count, Random& random);
/// \return one of them whose skin is about as dark as the darkest that is made by hand.
int draw_dark_person(Random& random);

/// Draws pictures of generated people from which they are enrolled: from near, at several moments of a turning head, each once.
class Portraits {
 public:
  /// \param folder  in which the pictures go; outlives this.
  explicit Portraits(const TableFolder& folder) : folder_(folder) {}

  /// \param identity  0 .. sim::kLastIdentity. \return the folder of the pictures.
  Result<std::filesystem::path> of(int identity);
  /// As many again, for somebody whose face was found in fewer than two: who has a single view counts as a stranger.
  Result<std::filesystem::path> more_of(int identity);
  /// \return how many were photographed again, and how many at all.
  [[nodiscard]] int again() const { return again_; }
  [[nodiscard]] int people() const { return people_; }

 private:
  Result<std::filesystem::path> take(int identity, int first);
  const TableFolder& folder_;
  int people_ = 0, again_ = 0;
};

/// \return the row that says how many needed more pictures than the first four.
Row photographed_again(const Portraits& portraits);

/// Enrols generated people, the first as number 1 and so on.
/// \return how many were taken for somebody who was enrolled already, and enrolled as somebody who looks alike (--alike).
Result<int> enroll_all(const std::vector<int>& identities, Portraits& portraits, const std::filesystem::path& file);

/// Runs a robot's file in lock-step to the end of its scenario, with `identities` of the folder and, where it has one, with its scenario.toml.
///
/// \param shipped  the robot's file.  \param more  further arguments of `cgsr run`.
/// \return the run's summary; or its exit code and what it printed.
Result<nlohmann::json> run_with_people(const TableFolder& folder, const std::string& shipped, std::uint64_t seed,
                                       const std::vector<std::string>& more = {});

}  // namespace cgsr::lab
