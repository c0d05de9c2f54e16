#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "platform/error.h"
#include "tools/lab/child.h"

namespace cgsr::lab {

/// The shipped person arena without its people, as text.
Result<std::string> empty_arena();

/// Draws pictures of generated people from which they are enrolled: from near, at several moments of a turning head, each once.
class Portraits {
 public:
  /// \param folder  in which the pictures go; outlives this.
  explicit Portraits(const TableFolder& folder) : folder_(folder) {}

  /// \param identity  0 .. sim::kIdentities - 1. \return the folder of the pictures.
  Result<std::filesystem::path> of(int identity);

 private:
  const TableFolder& folder_;
};

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
