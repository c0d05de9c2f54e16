#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "platform/error.h"

namespace cgsr::lab {

inline constexpr int kFolds = 5;

/// Which fold a sequence is in: fixed by its name, and a scene is in one fold only, so that what was chosen on four folds is judged on
/// scenes that it was not chosen on.
class Folds {
 public:
  /// Reads a list (folds.txt): lines of fold (1..5), scene and the names of its sequences; # begins a comment.
  /// \return the line that is anything else, or that puts a scene or a sequence into a second place.
  static Result<Folds> read(const std::filesystem::path& path);

  /// The list of this folder.
  static Result<Folds> shipped();

  /// \return 1..5. A sequence that is not in the list: the fold of its scene, or of a hash of it.
  [[nodiscard]] int of(std::string_view sequence) const;

  /// \return the scene in the list; or else the name in lower case without the digits and dashes at its end.
  [[nodiscard]] std::string scene_of(std::string_view sequence) const;

 private:
  std::map<std::string, int, std::less<>> fold_of_scene_;
  std::map<std::string, std::string, std::less<>> scene_of_sequence_;
};

}  // namespace cgsr::lab
