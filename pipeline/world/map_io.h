#pragma once

#include <string>
#include <utility>

#include <assimp/DefaultIOSystem.h>

#include "pipeline/world/map_folder.h"

namespace cgsr::world {

/// Ours. Lets assimp open the map's own file and what MapFolder finds, for reading, and nothing else.
class MapIo final : public Assimp::DefaultIOSystem {
 public:
  explicit MapIo(MapFolder folder) : folder_(std::move(folder)) {}

  bool Exists(const char* file) const override;
  Assimp::IOStream* Open(const char* file, const char* mode) override;

  /// The first file that was refused, and why; empty: none.
  [[nodiscard]] const std::string& refused() const { return refused_; }

 private:
  [[nodiscard]] bool may_open(const char* file) const;

  MapFolder folder_;
  mutable std::string refused_;
};

}  // namespace cgsr::world
