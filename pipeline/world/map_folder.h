#pragma once

#include <filesystem>

#include "platform/error.h"

namespace cgsr::world {

/// Ours. The folder of a map's file: only what lies in it or below it is read as a part of the map (materials, buffers, loaded models), so that a
/// map from elsewhere opens no other file of this machine and shows nothing of it.
class MapFolder {
 public:
  /// \param map  the map's own file, which is read wherever it is.
  explicit MapFolder(const std::filesystem::path& map);

  /// \param part  a file that the map names, relative to the current folder or absolute.
  /// \return its path without links and '..'; an error when it lies outside, through a link too, or is no regular file. Nothing was opened.
  [[nodiscard]] Result<std::filesystem::path> find(const std::filesystem::path& part) const;

  [[nodiscard]] const std::filesystem::path& map() const { return map_; }

 private:
  std::filesystem::path map_;
  std::filesystem::path folder_;
};

}  // namespace cgsr::world
