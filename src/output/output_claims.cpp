#include "src/output/output_claims.h"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "platform/replace_file.h"

namespace cgsr::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeadBytes = 64U << 10U;

std::optional<struct stat> status_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

/// Where a file is, or will be, without links and '..'.
fs::path place_of(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  fs::path place = fs::weakly_canonical(absolute.parent_path(), error) / absolute.filename();
  if (fs::is_symlink(place, error)) {
    const fs::path target = fs::read_symlink(place, error);
    place = fs::weakly_canonical(target.is_absolute() ? target : place.parent_path() / target, error);
  }
  return place.lexically_normal();
}

/// Whether both names lead to one file, which exists or not. Devices are never the same: each reader and writer gets its own bytes.
bool same_file(const fs::path& a, const fs::path& b) {
  const auto status_a = status_of(a);
  const auto status_b = status_of(b);
  if (status_a && status_b) {
    return S_ISREG(status_a->st_mode) && status_a->st_dev == status_b->st_dev && status_a->st_ino == status_b->st_ino;
  }
  return !status_a && !status_b && place_of(a) == place_of(b);
}

/// Whether a file lies directly in a folder.
bool lies_in(const fs::path& file, const fs::path& folder) {
  const auto status_a = status_of(place_of(file).parent_path());
  const auto status_b = status_of(folder);
  return status_a && status_b && S_ISDIR(status_b->st_mode) && status_a->st_dev == status_b->st_dev &&
         status_a->st_ino == status_b->st_ino;
}

std::string head_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(kHeadBytes, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head;
}

bool is_regular(const fs::path& path) {
  const auto status = status_of(path);
  return status && S_ISREG(status->st_mode);
}

}  // namespace

void OutputClaims::reads(const fs::path& path, std::string option) {
  if (!path.empty()) inputs_.push_back({path, std::move(option)});
}

void OutputClaims::writes(const fs::path& path, std::string option, FileKind kind) {
  if (!path.empty()) outputs_.push_back({path, std::move(option), std::move(kind)});
}

Result<void> OutputClaims::claim() const {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (auto claimed = claim(i); !claimed) return claimed;
  }
  return {};
}

Result<void> OutputClaims::claim(std::size_t number) const {
  const Output& output = outputs_[number];
  if (auto good = check_ending(output); !good) return good;
  if (auto good = check_inputs(output); !good) return good;
  for (std::size_t i = 0; i < number; ++i) {
    if (same_file(output.path, outputs_[i].path)) {
      return fail(fmt::format("{} {}: is the output of {} too; expected a file for each", output.option,
                              output.path.string(), outputs_[i].option));
    }
  }
  if (auto good = check_content(output); !good) return good;
  return check_writable(output.path);
}

Result<void> OutputClaims::check_ending(const Output& output) {
  std::string ending = output.path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const auto& endings = output.kind.endings;
  if (endings.empty() || std::ranges::find(endings, ending) != endings.end()) return {};
  return fail(fmt::format("{} {}: expected the name of {} to end in {}", output.option, output.path.string(),
                          output.kind.name, fmt::join(endings, ", ")));
}

Result<void> OutputClaims::check_inputs(const Output& output) const {
  for (const Input& input : inputs_) {
    const bool same = same_file(output.path, input.path);
    // Only what a folder of images holds already is its input: another file may be put beside them.
    const bool image =
        is_regular(output.path) && lies_in(output.path, input.path) && picture_file().is(head_of(output.path));
    if (!same && !image) continue;
    return fail(fmt::format("{} {}: is read as {} ({}); it would be destroyed. Give another file", output.option,
                            output.path.string(), input.option, input.path.string()));
  }
  return {};
}

Result<void> OutputClaims::check_content(const Output& output) const {
  if (force_ || !is_regular(output.path)) return {};
  const std::string head = head_of(output.path);
  if (head.empty() || output.kind.is(head)) return {};
  return fail(fmt::format("{} {}: exists and is not {}; it is not replaced. Give another file, or --force",
                          output.option, output.path.string(), output.kind.name));
}

}  // namespace cgsr::app
