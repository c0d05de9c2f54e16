#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/lab/scoring.h"

namespace cgsr::lab {

/// `cgsr/tracking` in the user's cache folder: $XDG_CACHE_HOME where that is an absolute path, else ~/.cache. Empty when neither is known.
std::filesystem::path run_cache_folder();

/// The boxes of runs on disk, a text file each, named after a hash of all that they depend on. It never fails: a folder that cannot be
/// written, or an entry that is cut short, is a miss. Several programs may use one folder at once.
class RunCache {
 public:
  /// \param folder  empty: nothing is kept.
  explicit RunCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// \return the boxes kept under this key; nothing where there are none, or not so many.
  [[nodiscard]] std::optional<Boxes> find(const std::string& key, std::size_t images) const;

  void keep(const std::string& key, const Boxes& boxes) const;

 private:
  [[nodiscard]] std::filesystem::path path_of(const std::string& key) const { return folder_ / (key + ".txt"); }

  std::filesystem::path folder_;
};

}  // namespace cgsr::lab
