#include "tests/hal/recordings.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace cgsr::hal {

namespace fs = std::filesystem;

TempFolder::TempFolder() {
  std::string pattern = (fs::temp_directory_path() / "cgsr-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

namespace {
constexpr int kGreyStep = 4;  // between two numbers
}

cv::Mat numbered_image(int index, cv::Size size) {
  cv::Mat image(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      image.at<cv::Vec3b>(y, x) = {static_cast<std::uint8_t>(40 + 160 * x / size.width),
                                   static_cast<std::uint8_t>(40 + 160 * y / size.height),
                                   static_cast<std::uint8_t>(128 + 100 * std::sin(0.05 * (x + y) + index))};
    }
  }
  const int grey = kGreyStep * (index % 60) + 8;
  cv::rectangle(image, {0, 0, size.width / 2, size.height / 2}, cv::Scalar::all(grey), cv::FILLED);
  return image;
}

int number_of(const ImageView& view) {
  double sum = 0;
  int count = 0;
  for (int y = view.height_px / 8; y < view.height_px * 3 / 8; ++y) {
    for (int x = view.width_px / 8; x < view.width_px * 3 / 8; ++x, ++count) sum += view.row(y)[2 * x];
  }
  const double grey = (sum / count - 16.0) * 255.0 / 219.0;  // full range again
  return static_cast<int>(std::lround((grey - 8.0) / kGreyStep));
}

void write_folder(const std::string& folder, int images, cv::Size size, const std::string& extension) {
  fs::create_directories(folder);
  for (int i = 0; i < images; ++i) {
    if (!cv::imwrite(fmt::format("{}/{:05}{}", folder, i, extension), numbered_image(i, size))) {
      throw std::runtime_error("cannot write " + extension);
    }
  }
}

void write_video(const std::string& path, int images, cv::Size size, double rate_hz, bool color,
                 const std::string& codec) {
  const int fourcc = cv::VideoWriter::fourcc(codec.at(0), codec.at(1), codec.at(2), codec.at(3));
  cv::VideoWriter video(path, cv::CAP_FFMPEG, fourcc, rate_hz, size, color);
  if (!video.isOpened()) throw std::runtime_error("cannot write " + path);
  for (int i = 0; i < images; ++i) {
    cv::Mat image = numbered_image(i, size);
    if (!color) cv::cvtColor(image, image, cv::COLOR_BGR2GRAY);
    video.write(image);
  }
}

std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

void truncate(const std::string& path, double part) {
  fs::resize_file(path, static_cast<std::uintmax_t>(static_cast<double>(fs::file_size(path)) * part));
}

}  // namespace cgsr::hal
