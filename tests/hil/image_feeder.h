#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "platform/error.h"
#include "platform/time.h"

namespace cgsr::hil {

/// What the images are and where they go.
struct ImageFeed {
  std::string file;       ///< images one after another, YUYV without padding.
  std::size_t count = 0;  ///< of the images; 0: as many as the file holds.
  std::string device;     ///< a video output: vivid's, or v4l2loopback's.
  /// Of the output. vivid keeps one and shows it again while no other comes, and each more delays every image; v4l2loopback gives its reader no
  /// more than these, and fills them by turns, read or not.
  std::uint32_t buffers = 3;
  int width_px = 640;
  int height_px = 480;

  [[nodiscard]] std::size_t bytes() const { return static_cast<std::size_t>(width_px * height_px) * 2; }
};

/// Puts images into a video output by streaming, from memory that was filled before.
///
/// Threads: one at a time.
class ImageFeeder {
 public:
  explicit ImageFeeder(ImageFeed feed) : feed_(std::move(feed)) {}
  ~ImageFeeder() { close(); }
  ImageFeeder(const ImageFeeder&) = delete;
  ImageFeeder& operator=(const ImageFeeder&) = delete;

  /// Maps the file into memory; with `whole`, reads all of it, so that later nothing waits for a disk.
  Result<void> load(bool whole);
  Result<void> load_rest() { return load(true); }

  /// Opens the device and sets the format. \return what is wrong, also while the device is away.
  Result<void> open();
  void close();
  [[nodiscard]] bool is_open() const { return fd_ >= 0; }

  /// Hands an image to the device; waits a little for a buffer. \return what is wrong; the device is closed then, unless it merely has no
  /// buffer to spare.
  Result<void> put(std::size_t image);

  [[nodiscard]] std::size_t images() const { return images_; }

 private:
  struct Buffer {
    void* at = nullptr;
    std::size_t bytes = 0;
  };

  Result<void> set_format();
  Result<void> make_buffers();
  Result<void> take_buffer(std::uint32_t& index);
  Result<void> queue(std::uint32_t index);
  tl::unexpected<Error> failed(const std::string& what);

  ImageFeed feed_;
  int fd_ = -1;
  std::vector<Buffer> buffers_;
  std::uint32_t last_ = 0;    ///< the buffer that was queued last.
  std::uint32_t queued_ = 0;  ///< buffers that were ever queued; from the last one on, the device runs.
  const std::uint8_t* data_ = nullptr;
  std::size_t images_ = 0;
};

}  // namespace cgsr::hil
