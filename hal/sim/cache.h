#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/sim/render/photographer.h"
#include "platform/error.h"

namespace cgsr::sim {

struct CacheOptions {
  std::filesystem::path folder;                ///< empty: nothing is kept.
  std::uintmax_t most_bytes = 2'000'000'000U;  ///< of all images together; the ones used longest ago go first.
  bool draws = true;                           ///< false: an image that is not kept is an error, it is not drawn.
};

/// What the environment variable CGSR_SIM_IMAGES says of the images of a simulated run; tools/count sets it.
enum class ImageSource : std::uint8_t {
  kRobotFile,  ///< unset: drawn, and kept where the robot's file says so.
  kRecord,     ///< "record": drawn and kept.
  kRecorded,   ///< "recorded": read; an image that was not kept ends the run with an error.
};
/// \return the word of CGSR_SIM_IMAGES; of kRobotFile, which has none, what it means.
std::string_view to_string(ImageSource source);
/// \return an error that names the words that it may have.
Result<ImageSource> image_source();

/// `cgsr/images` in the user's cache folder: $XDG_CACHE_HOME where that is an absolute path, else ~/.cache. Empty when neither is known.
std::filesystem::path image_cache_folder();

/// Rendered images on disk, one file each, named after what they were made from. Several programs may use one folder at once.
///
/// It never fails: a folder that cannot be written, a full disk, an entry that is damaged, cut short or of another size are misses. After
/// a first image that could not be kept no further one is tried.
///
/// Threads: one caller at a time.
class ImageCache {
 public:
  struct Counts {
    int hits = 0;
    int misses = 0;
    int kept = 0;
    int removed = 0;  ///< to stay within most_bytes.
    bool keeps = true;
  };

  explicit ImageCache(CacheOptions options);

  /// Fills `into` with the image of that key. \return its mean luma; nothing, and `into` as it was, when there is none of that size.
  std::optional<double> find(const std::string& key, const YuyvBuffer& into);

  void keep(const std::string& key, double mean_luma, const YuyvBuffer& image);

  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  [[nodiscard]] std::filesystem::path path_of(const std::string& key) const {
    return options_.folder / (key + ".yuyv");
  }
  void make_room(std::uintmax_t bytes);

  CacheOptions options_;
  Counts counts_;
  std::uintmax_t bytes_ = 0;  // in the folder, as far as this program knows
};

/// A Photographer that looks into the cache first. An image out of it is the image that would be drawn, byte for byte: its key is made of
/// the program, the scene, lens, moments, sensor, seed and image number.
///
/// renderer() has not drawn an image that came from the cache: ask truth_at() for what is there, not geometry().
///
/// Threads: one caller at a time.
class CachedPhotographer {
 public:
  /// `scene` must outlive it and stay as it is.
  static Result<std::unique_ptr<CachedPhotographer>> make(const Scene& scene, const CameraModel& camera,
                                                          const RenderOptions& options, const CacheOptions& cache);

  /// As Photographer::take().
  /// \throws std::runtime_error when the image is not kept and may not be drawn (CacheOptions::draws).
  double take(const std::vector<Moment>& moments, const SensorSettings& settings, const ImageIdentity& identity,
              const YuyvBuffer& buffer);

  Renderer& renderer() { return photographer_->renderer(); }
  [[nodiscard]] const ImageCache::Counts& counts() const { return cache_.counts(); }

 private:
  CachedPhotographer(std::unique_ptr<Photographer> photographer, const CacheOptions& cache, std::string scene_key);

  std::unique_ptr<Photographer> photographer_;
  ImageCache cache_;
  std::string scene_key_;  // of program, scene, lens and edge samples; empty: nothing is kept
  bool draws_;
};

}  // namespace cgsr::sim
