#include "hal/replay/image_source.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

namespace cgsr::hal {
namespace {

namespace fs = std::filesystem;

Result<std::unique_ptr<ImageSource>> open_folder(const std::string& path) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
    if (named_like_image(entry->path().filename().string()) && !entry->is_directory(error)) {
      files.push_back(entry->path().string());
    }
    error.clear();  // a dangling link is refused when it is read, like any other unreadable image
  }
  if (error) return fail(fmt::format("cannot read the folder '{}': {}", path, error.message()));
  if (files.empty()) {
    return fail(fmt::format("the folder '{}' holds no image (jpg, png, ppm, pgm, bmp, tif, webp)", path));
  }
  std::sort(files.begin(), files.end());
  return open_images(std::move(files));
}

}  // namespace

std::string_view to_string(ReadOutcome outcome) {
  switch (outcome) {
    case ReadOutcome::kImage:
      return "image";
    case ReadOutcome::kRefused:
      return "refused";
    case ReadOutcome::kEnd:
      return "end";
  }
  return "";
}

bool named_like_image(const std::string& file_name) {
  if (file_name.empty() || file_name.front() == '.') return false;  // "._0001.jpg" is what macOS leaves behind
  std::string extension = fs::path(file_name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  constexpr const char* kExtensions[] = {".jpg", ".jpeg", ".jpe", ".png", ".ppm",  ".pgm",
                                         ".pbm", ".pnm",  ".bmp", ".tif", ".tiff", ".webp"};
  return std::any_of(std::begin(kExtensions), std::end(kExtensions),
                     [&](const char* known) { return extension == known; });
}

Result<std::unique_ptr<ImageSource>> open_source(const std::string& path) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return fail(fmt::format("there is no file or folder '{}'", path));
  if (error) return fail(fmt::format("cannot look at '{}': {}", path, error.message()));
  if (fs::is_directory(status)) return open_folder(path);
  if (!fs::is_regular_file(status)) return fail(fmt::format("'{}' is neither a file nor a folder", path));

  if (!std::ifstream(path)) return fail(fmt::format("cannot open '{}': {}", path, std::strerror(errno)));
  if (fs::file_size(path, error) == 0) return fail(fmt::format("'{}' is empty: 0 bytes", path));
  if (named_like_image(fs::path(path).filename().string())) return open_images({path});
  return open_video(path);
}

}  // namespace cgsr::hal
