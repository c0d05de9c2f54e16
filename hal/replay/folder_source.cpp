// A folder of images, or a single one, as an ImageSource.

#include <algorithm>
#include <cstring>
#include <exception>
#include <fstream>

#include <fmt/format.h>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>

#include "hal/replay/image_source.h"
#include "hal/replay/jpeg_check.h"

namespace cgsr::hal {
namespace {

constexpr std::streamoff kLargestFile_bytes = 256 << 20;

class FolderSource final : public ImageSource {
 public:
  explicit FolderSource(std::vector<std::string> files) : files_(std::move(files)) {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);  // what it says is said better by problem()
    if (!std::is_sorted(files_.begin(), files_.end(),
                        [](const auto& a, const auto& b) { return strverscmp(a.c_str(), b.c_str()) < 0; })) {
      notes_.emplace_back(
          "images are read in the order of their names, which is not that of the numbers in them: "
          "10.png comes before 2.png");
    }
  }

  ReadOutcome read(cv::Mat& bgr) override {
    problem_.clear();
    if (next_ >= files_.size()) return ReadOutcome::kEnd;
    const std::string& file = files_[next_++];
    try {
      problem_ = decode(file, bgr);
    } catch (const std::exception& thrown) {
      problem_ = fmt::format("'{}': {}", file, thrown.what());
    }
    return problem_.empty() ? ReadOutcome::kImage : ReadOutcome::kRefused;
  }

  ReadOutcome skip() override {
    problem_.clear();
    if (next_ >= files_.size()) return ReadOutcome::kEnd;
    ++next_;
    return ReadOutcome::kImage;
  }

  Result<void> rewind() override {
    next_ = 0;
    return {};
  }

  [[nodiscard]] double claimed_rate_hz() const override { return 0.0; }
  [[nodiscard]] const std::string& problem() const override { return problem_; }
  [[nodiscard]] const std::vector<std::string>& notes() const override { return notes_; }

 private:
  // \return what is wrong, empty when the image was decoded. Grey becomes B = G = R, 16 bits become 8, transparency is dropped.
  std::string decode(const std::string& file, cv::Mat& bgr) {
    const auto wrong = [&](const std::string& what) { return fmt::format("'{}': {}", file, what); };
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in) return wrong(std::strerror(errno));
    const std::streamoff size = in.tellg();
    if (size == 0) return wrong("the file is empty");
    if (size < 0 || size > kLargestFile_bytes) return wrong("no image: the file has more than 256 MB");
    in.seekg(0);
    if (in.get() != 0xFF || in.get() != 0xD8) return read_image_file(file, bgr);

    // JPEG stays with libjpeg, as everywhere else: other decoders differ in the last bit.
    bytes_.resize(static_cast<std::size_t>(size));
    if (!in.seekg(0).read(reinterpret_cast<char*>(bytes_.data()), size)) return wrong("cannot be read to its end");
    if (const std::string damage = jpeg_.problem(bytes_); !damage.empty()) return wrong(damage);
    const bool decoded = !cv::imdecode(bytes_, cv::IMREAD_COLOR, &bgr).empty();  // turns it as EXIF says
    return decoded ? "" : wrong("cannot be decoded");
  }

  std::vector<std::string> files_;
  std::size_t next_ = 0;
  std::vector<std::uint8_t> bytes_;
  JpegCheck jpeg_;
  std::string problem_;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<ImageSource> open_images(std::vector<std::string> files) {
  return std::make_unique<FolderSource>(std::move(files));
}

}  // namespace cgsr::hal
