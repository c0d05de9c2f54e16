#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "platform/error.h"

namespace cgsr::app {

/// A text file that is written line by line and readable at every moment: each line is flushed, so a killed process leaves whole
/// lines behind, and a full disk is noticed at the line that did not fit.
class TextFile {
 public:
  static Result<TextFile> create(const std::filesystem::path& path);

  /// Appends `line` and a line feed.
  Result<void> add_line(std::string_view line);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  TextFile(std::filesystem::path path, std::ofstream stream) : path_(std::move(path)), stream_(std::move(stream)) {}

  std::filesystem::path path_;
  std::ofstream stream_;
};

/// Writes a whole file so that nobody ever reads half of it (platform/replace_file.h).
Result<void> write_file(const std::filesystem::path& path, std::string_view text);

}  // namespace cgsr::app
