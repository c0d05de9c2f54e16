#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "platform/error.h"

namespace cgsr::lab {

/// \return a path in the folder for temporary files that no other process of the lab uses.
std::filesystem::path scratch_json();

/// Runs a program to its end and reads the JSON that it wrote.
///
/// \param words  the program and its arguments, which make it write `json`. The file is gone afterwards.
/// \return what it wrote; or its exit code and all that it printed.
Result<nlohmann::json> run_for_json(const std::vector<std::string>& words, const std::filesystem::path& json);

/// Runs a robot (`cgsr run`) to its end.
/// \param more  further arguments. \return the run's summary.
Result<nlohmann::json> run_robot(const std::filesystem::path& config, std::uint64_t seed,
                                 const std::vector<std::string>& more = {});

/// Runs a program to its end. \return what it printed, both outputs; or its exit code and that.
Result<std::string> run_for_text(const std::vector<std::string>& words);

/// Runs `cgsr` beside the lab's own program. \return what it printed; or its exit code and that.
Result<std::string> run_cgsr(std::vector<std::string> words);

/// \return the arguments with which a run leaves its film and the CSV of its images in `videos`; none without such a folder, which is made.
std::vector<std::string> filmed(const std::optional<std::filesystem::path>& videos, const std::string& name);

/// Replaces what is there.
Result<void> write_text(const std::filesystem::path& path, const std::string& text);

/// A folder for the files of a table, gone with this.
class TableFolder {
 public:
  explicit TableFolder(const std::string& name);
  ~TableFolder();
  TableFolder(const TableFolder&) = delete;
  TableFolder& operator=(const TableFolder&) = delete;
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace cgsr::lab
