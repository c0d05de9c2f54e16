#pragma once

#include <functional>
#include <map>
#include <string>

namespace cgsr::config {

/// The place in a file that gives a value.
struct Origin {
  std::string file;
  int line = 0;
};

/// What a configuration remembers of the files that it was read from. A parameter struct that has a member `Provenance provenance` is
/// hashed by its paths as they are written.
struct Provenance {
  /// By the path of the key, such as "motion.max_forward_mps". A key that is not in it has its default.
  std::map<std::string, Origin, std::less<>> origins;
  /// The paths of files: from the path that the program opens to the path relative to the folder of the first file, which is the same
  /// wherever a checkout lies.
  std::map<std::string, std::string, std::less<>> written_paths;
};

}  // namespace cgsr::config
