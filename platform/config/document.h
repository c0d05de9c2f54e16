#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "platform/error.h"

namespace cgsr::config {

struct Tree;  // the parsed TOML, in tree.h: whoever only reads configurations never compiles toml++

/// A TOML file that parsed. Refused, with `file:line` where there is one: what cannot be read, is larger than
/// kLargestBytes, is not UTF-8, is not TOML, or nests deeper than any configuration does.
class Document {
 public:
  static constexpr std::size_t kLargestBytes = 64 * 1024;
  /// Bounds the depth of dotted keys (a.a.a.a...), which toml++ 3.3 does not: its tree is destroyed recursively.
  static constexpr std::ptrdiff_t kMostDots = 4000;

  static Result<Document> load(const std::filesystem::path& file);

  /// \param name  what messages call the text.
  static Result<Document> parse(std::string_view toml, std::string name);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Tree& tree() const { return *tree_; }

 private:
  Document(std::string name, std::shared_ptr<const Tree> tree) : name_(std::move(name)), tree_(std::move(tree)) {}

  std::string name_;
  std::shared_ptr<const Tree> tree_;
};

/// What a key that holds a path means: relative ones start at the folder of the configuration file. Empty stays empty.
std::filesystem::path path_beside(const std::filesystem::path& config_file, std::string_view path);

}  // namespace cgsr::config
