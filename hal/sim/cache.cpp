#include "hal/sim/cache.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "hal/sim/fingerprint.h"

namespace cgsr::sim {
namespace {

namespace fs = std::filesystem;

// An entry: this head, the rows of the image, and the sum (64 hexadecimal digits) over the key and all before it.
struct Head {
  std::array<char, 8> magic{'c', 'g', 's', 'r', 'i', 'm', 'g', '1'};
  std::int32_t width_px = 0;
  std::int32_t height_px = 0;
  double mean_luma = 0.0;
};
static_assert(sizeof(Head) == 24, "no padding");
constexpr std::size_t kSumDigits = 64;

std::size_t row_bytes(const YuyvBuffer& image) {
  return static_cast<std::size_t>(image.width_px) * 2;
}

std::uint8_t* row_of(const YuyvBuffer& image, int row) {
  return image.data + row * image.stride_bytes;
}

std::size_t entry_bytes(const YuyvBuffer& image) {
  return sizeof(Head) + row_bytes(image) * static_cast<std::size_t>(image.height_px) + kSumDigits;
}

std::string sum_of(const std::string& key, std::string_view entry) {
  config::Sha256 sum;
  sum.add(key.data(), key.size());
  sum.add(entry.data(), entry.size());
  return sum.hex();
}

// Half-written files of programs that ended too early go with the rest once they are the oldest.
struct Kept {
  fs::path path;
  std::uintmax_t bytes;
  fs::file_time_type used;
};

std::vector<Kept> entries_of(const fs::path& folder) {
  std::vector<Kept> entries;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    std::error_code gone;  // by another program, meanwhile
    const Kept entry{at->path(), at->file_size(gone), at->last_write_time(gone)};
    if (!gone) entries.push_back(entry);
  }
  return entries;
}

}  // namespace

std::string_view to_string(ImageSource source) {
  switch (source) {
    case ImageSource::kRobotFile:
      return "robot file";
    case ImageSource::kRecord:
      return "record";
    case ImageSource::kRecorded:
      return "recorded";
  }
  return "";
}

Result<ImageSource> image_source() {
  const char* value = std::getenv("CGSR_SIM_IMAGES");
  const std::string_view word = value == nullptr ? "" : value;
  if (word.empty()) return ImageSource::kRobotFile;
  for (const ImageSource source : {ImageSource::kRecord, ImageSource::kRecorded}) {
    if (word == to_string(source)) return source;
  }
  return fail(fmt::format("CGSR_SIM_IMAGES = '{}': expected 'record' or 'recorded', or no such variable", word));
}

fs::path image_cache_folder() {
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg != nullptr && fs::path(xdg).is_absolute()) return fs::path(xdg) / "cgsr/images";
  const char* home = std::getenv("HOME");
  if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".cache/cgsr/images";
  return {};
}

ImageCache::ImageCache(CacheOptions options) : options_(std::move(options)) {
  counts_.keeps = !options_.folder.empty();
  if (!counts_.keeps) return;
  std::error_code error;
  fs::create_directories(options_.folder, error);  // if it failed, the first image shows it
  for (const Kept& entry : entries_of(options_.folder)) bytes_ += entry.bytes;
}

std::optional<double> ImageCache::find(const std::string& key, const YuyvBuffer& into) {
  ++counts_.misses;  // until it is known better
  if (options_.folder.empty()) return std::nullopt;
  std::ifstream file(path_of(key), std::ios::binary);
  std::string entry(entry_bytes(into), '\0');
  file.read(entry.data(), static_cast<std::streamsize>(entry.size()));
  if (!file || file.peek() != std::ifstream::traits_type::eof()) return std::nullopt;
  const std::string_view content = std::string_view(entry).substr(0, entry.size() - kSumDigits);
  if (sum_of(key, content) != entry.substr(content.size())) return std::nullopt;
  Head head;
  std::memcpy(&head, entry.data(), sizeof head);
  if (head.magic != Head().magic || head.width_px != into.width_px || head.height_px != into.height_px)
    return std::nullopt;
  for (int row = 0; row < into.height_px; ++row) {
    std::memcpy(row_of(into, row), entry.data() + sizeof head + row_bytes(into) * static_cast<std::size_t>(row),
                row_bytes(into));
  }
  --counts_.misses;
  ++counts_.hits;
  std::error_code error;  // used now, so it goes last; no matter if that cannot be noted
  fs::last_write_time(path_of(key), fs::file_time_type::clock::now(), error);
  return head.mean_luma;
}

void ImageCache::keep(const std::string& key, double mean_luma, const YuyvBuffer& image) {
  if (!counts_.keeps || entry_bytes(image) > options_.most_bytes) return;
  make_room(entry_bytes(image));
  Head head;
  head.width_px = image.width_px;
  head.height_px = image.height_px;
  head.mean_luma = mean_luma;
  std::string entry(sizeof head, '\0');
  std::memcpy(entry.data(), &head, sizeof head);
  for (int row = 0; row < image.height_px; ++row) {
    entry.append(reinterpret_cast<const char*>(row_of(image, row)), row_bytes(image));
  }
  entry += sum_of(key, entry);

  // Written aside and moved into place: nobody ever finds half an image.
  const fs::path aside = options_.folder / fmt::format("{}.{}", key, getpid());
  std::ofstream file(aside, std::ios::binary);
  file << entry;
  file.close();
  std::error_code error;
  if (file) fs::rename(aside, path_of(key), error);
  if (!file || error) {
    counts_.keeps = false;
    fs::remove(aside, error);
    return;
  }
  ++counts_.kept;
  bytes_ += entry.size();
}

void ImageCache::make_room(std::uintmax_t bytes) {
  if (bytes_ + bytes <= options_.most_bytes) return;
  std::vector<Kept> entries = entries_of(options_.folder);  // other programs have added and removed
  std::sort(entries.begin(), entries.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  bytes_ = 0;
  for (const Kept& entry : entries) bytes_ += entry.bytes;
  const std::uintmax_t goal = options_.most_bytes - std::max(bytes, options_.most_bytes / 10);  // not every time anew
  for (const Kept& entry : entries) {
    if (bytes_ <= goal) break;
    std::error_code error;
    if (fs::remove(entry.path, error)) ++counts_.removed;
    bytes_ -= entry.bytes;
  }
}

Result<std::unique_ptr<CachedPhotographer>> CachedPhotographer::make(const Scene& scene, const CameraModel& camera,
                                                                     const RenderOptions& options,
                                                                     const CacheOptions& cache) {
  auto photographer = Photographer::make(scene, camera, options);
  if (!photographer) return tl::unexpected(photographer.error());
  std::string scene_key;
  if (!cache.folder.empty()) {
    Fingerprint sum;
    sum.text(program_fingerprint());
    sum.text(fingerprint(scene));
    add(sum, camera);
    sum.number(options.edge_samples);
    scene_key = sum.hex();
  }
  return std::unique_ptr<CachedPhotographer>(
      new CachedPhotographer(std::move(*photographer), cache, std::move(scene_key)));
}

CachedPhotographer::CachedPhotographer(std::unique_ptr<Photographer> photographer, const CacheOptions& cache,
                                       std::string scene_key)
    : photographer_(std::move(photographer)), cache_(cache), scene_key_(std::move(scene_key)), draws_(cache.draws) {}

double CachedPhotographer::take(const std::vector<Moment>& moments, const SensorSettings& settings,
                                const ImageIdentity& identity, const YuyvBuffer& buffer) {
  if (scene_key_.empty()) return photographer_->take(moments, settings, identity, buffer);
  Fingerprint sum;
  sum.text(scene_key_);
  sum.number(moments.size());
  for (const Moment& moment : moments) add(sum, moment);
  add(sum, settings);
  sum.number(identity.seed);
  sum.number(identity.number);
  const std::string key = sum.hex();
  if (const auto luma = cache_.find(key, buffer)) return *luma;
  if (!draws_) {
    throw std::runtime_error(
        fmt::format("image {} of the simulated run is not in the cache {} and must not be rendered now: run the same "
                    "command with CGSR_SIM_IMAGES=record first (tools/count does)",
                    identity.number, image_cache_folder().string()));
  }
  const double luma = photographer_->take(moments, settings, identity, buffer);
  cache_.keep(key, luma, buffer);
  return luma;
}

}  // namespace cgsr::sim
