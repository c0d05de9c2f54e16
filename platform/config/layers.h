#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "platform/config/document.h"
#include "platform/error.h"

namespace cgsr::config {

/// A configuration file and the files that it extends, the file itself first. A key has the value of the first layer that names it. Each file
/// may extend one other:
///
///     extends = "home-base.toml"   # relative to the file in which it stands
class Layers {
 public:
  struct Layer {
    Document document;
    /// Its folder, relative to the folder of the first file, which makes paths independent of where a checkout lies. Absolute where `extends`
    /// was absolute.
    std::filesystem::path folder;
  };

  static constexpr std::size_t kMaxLayers = 16;

  /// One document that stands alone: `extends` is an unknown key in it.
  explicit Layers(Document document);

  /// Loads `file` and all that it extends. Errors name the file and line of the `extends` that cannot be followed: its value is no text, the
  /// file is missing or no TOML, a file extends itself by a cycle, or there are more than kMaxLayers.
  static Result<Layers> load(const std::filesystem::path& file);

  [[nodiscard]] const std::vector<Layer>& all() const { return layers_; }

  /// \return whether the key `extends` is known.
  [[nodiscard]] bool may_extend() const { return may_extend_; }

 private:
  Layers() = default;

  std::vector<Layer> layers_;
  bool may_extend_ = false;
};

}  // namespace cgsr::config
