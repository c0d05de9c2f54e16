#include "src/input/camera_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "platform/parameters.h"
#include "src/input/small_file.h"
#include "src/input/yaml_reader.h"

namespace cgsr::app {
namespace {

constexpr std::size_t kLargest_bytes = 65536;
constexpr double kZero = 1e-9;               // what counts as 0 in a camera matrix
constexpr double kMostRatio = 2.0;           // of both focal lengths: pixels are nearly square
constexpr double kWidestHalfTangent = 20.0;  // 174 degrees across
constexpr double kReturns_px = 1e-3;         // a pixel's direction shows at the pixel again to so much

Result<int> image_side(const YamlReader& yaml, std::string_view key) {
  const auto value = yaml.number_at(key, "the size of the images in pixels");
  if (!value) return tl::unexpected(value.error());
  if (*value != std::floor(*value) || *value < 16.0 || *value > 8192.0) {
    return tl::unexpected(yaml.wrong(yaml.root()[std::string(key)],
                                     fmt::format("{} is {}: expected a whole number, 16..8192 px", key, *value)));
  }
  return static_cast<int>(*value);
}

Result<void> read_pinhole(const YamlReader& yaml, geometry::Camera& camera) {
  constexpr std::string_view kExpected = "3 x 3: fx 0 cx 0 fy cy 0 0 1";
  const auto K = yaml.matrix("camera_matrix", kExpected);
  if (!K) return tl::unexpected(K.error());
  const YAML::Node at = yaml.root()["camera_matrix"]["data"];
  if (K->size() != 9) {
    return tl::unexpected(
        yaml.wrong(at, fmt::format("camera_matrix has {} numbers: expected {}", K->size(), kExpected)));
  }
  const std::array zeros{(*K)[1], (*K)[3], (*K)[6], (*K)[7], (*K)[8] - 1.0};
  const auto bad = std::ranges::find_if(zeros, [](double value) { return std::abs(value) > kZero; });
  if (bad != zeros.end()) {
    return tl::unexpected(yaml.wrong(
        at, fmt::format("camera_matrix is [{}]: expected {}, without skew", fmt::join(*K, ", "), kExpected)));
  }
  camera.fx_px = (*K)[0];
  camera.cx_px = (*K)[2];
  camera.fy_px = (*K)[4];
  camera.cy_px = (*K)[5];
  for (const auto& [name, focal, side] :
       {std::tuple("fx", camera.fx_px, camera.width_px), std::tuple("fy", camera.fy_px, camera.height_px)}) {
    if (focal < 10.0 || focal > 20000.0 || side / (2.0 * focal) > kWidestHalfTangent) {
      return tl::unexpected(
          yaml.wrong(at, fmt::format("{} is {}: expected the focal length in pixels, {:.0f}..20000", name, focal,
                                     std::max(10.0, side / (2.0 * kWidestHalfTangent)))));
    }
  }
  const double ratio = camera.fx_px / camera.fy_px;
  if (ratio > kMostRatio || ratio < 1.0 / kMostRatio) {
    return tl::unexpected(yaml.wrong(at, fmt::format("fx is {} and fy {}: expected about the same (a ratio of 0.5..2)",
                                                     camera.fx_px, camera.fy_px)));
  }
  if (camera.cx_px < 0.0 || camera.cx_px > camera.width_px - 1 || camera.cy_px < 0.0 ||
      camera.cy_px > camera.height_px - 1) {
    return tl::unexpected(yaml.wrong(
        at, fmt::format("the optical axis meets the image at ({}, {}): expected a place inside of {} x {} px",
                        camera.cx_px, camera.cy_px, camera.width_px, camera.height_px)));
  }
  return {};
}

std::array<Eigen::Vector2d, 4> corners_of(const geometry::Camera& camera) {
  const double right = camera.width_px - 1;
  const double bottom = camera.height_px - 1;
  return {Eigen::Vector2d(0, 0), Eigen::Vector2d(right, 0), Eigen::Vector2d(0, bottom), Eigen::Vector2d(right, bottom)};
}

/// Whether the lens maps the image one to one: what is farther out in the world is so in the image, along the way to each corner.
bool folds(const geometry::Camera& camera) {
  constexpr int kSteps = 32;
  for (const Eigen::Vector2d& corner : corners_of(camera)) {
    const Eigen::Vector2d end((corner.x() - camera.cx_px) / camera.fx_px, (corner.y() - camera.cy_px) / camera.fy_px);
    if (end.norm() < kZero) continue;
    const Eigen::Vector2d out = end.normalized();
    double reached = 0.0;
    // Until the distorted point is as far out as the corner.
    for (int i = 1; reached < end.norm(); ++i) {
      const double next = camera.distorted(end * (static_cast<double>(i) / kSteps)).dot(out);
      if (next <= reached || i > 4 * kSteps) return true;
      reached = next;
    }
  }
  return false;
}

/// The first of a camera's numbers outside of the range that its description states; empty: none.
class OutOfRange {
 public:
  void number(std::string_view name, int value, Range<int> range, std::string_view, std::string_view) {
    note(name, value, range);
  }
  void number(std::string_view name, double value, Range<double> range, std::string_view, std::string_view) {
    note(name, value, range);
  }
  [[nodiscard]] const std::string& words() const { return words_; }

 private:
  template <class Number>
  void note(std::string_view name, Number value, Range<Number> range) {
    if (!words_.empty() || (value >= range.minimum && value <= range.maximum)) return;
    words_ = fmt::format("{} is {}: expected {}..{}", name, value, range.minimum, range.maximum);
  }

  std::string words_;
};

/// The image's corner whose direction the lens does not lead back to it; nothing: there is none.
std::optional<Eigen::Vector2d> corner_that_is_lost(const geometry::Camera& camera) {
  for (const Eigen::Vector2d& corner : corners_of(camera)) {
    const Eigen::Vector2d bent = camera.distorted(camera.ideal_of(corner));
    const Eigen::Vector2d back(camera.fx_px * bent.x() + camera.cx_px, camera.fy_px * bent.y() + camera.cy_px);
    if (!((back - corner).norm() <= kReturns_px)) return corner;
  }
  return std::nullopt;
}

Result<void> read_lens(const YamlReader& yaml, geometry::Camera& camera) {
  const YAML::Node model = yaml.root()["distortion_model"];
  if (!model) return tl::unexpected(yaml.missing("distortion_model", "plumb_bob"));
  if (!model.IsScalar() || model.Scalar() != "plumb_bob") {
    return tl::unexpected(yaml.wrong(
        model, fmt::format("distortion_model is '{}': expected plumb_bob (k1 k2 p1 p2 k3)", YamlReader::shown(model))));
  }
  const auto D = yaml.matrix("distortion_coefficients", "k1 k2 p1 p2 k3");
  if (!D) return tl::unexpected(D.error());
  const YAML::Node at = yaml.root()["distortion_coefficients"]["data"];
  if (D->size() != 4 && D->size() != 5) {
    return tl::unexpected(
        yaml.wrong(at, fmt::format("distortion_coefficients has {} numbers: expected 5: k1 k2 p1 p2 k3", D->size())));
  }
  camera.k1 = (*D)[0];
  camera.k2 = (*D)[1];
  camera.p1 = (*D)[2];
  camera.p2 = (*D)[3];
  camera.k3 = D->size() == 5 ? (*D)[4] : 0.0;
  OutOfRange beyond;
  geometry::Camera::describe(std::as_const(camera), beyond);
  if (!beyond.words().empty()) {
    return tl::unexpected(yaml.wrong(at, fmt::format("distortion_coefficients: {}", beyond.words())));
  }
  if (folds(camera)) {
    return tl::unexpected(yaml.wrong(at, fmt::format("distortion_coefficients [{}] fold the image over itself before "
                                                     "its corners: expected a lens that shows every direction once",
                                                     fmt::join(*D, ", "))));
  }
  if (const auto lost = corner_that_is_lost(camera)) {
    return tl::unexpected(
        yaml.wrong(at, fmt::format("distortion_coefficients [{}] cannot be taken out again at the corner ({}, {}): "
                                   "expected a lens that shows every direction once",
                                   fmt::join(*D, ", "), lost->x(), lost->y())));
  }
  return {};
}

/// Shortest text that reads back exactly, with a point, so that every YAML reader takes it for a number.
std::string exact(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

std::string matrix_as_yaml(std::string_view key, int rows, int columns, const std::vector<double>& values) {
  std::string data;
  for (const double value : values) data += (data.empty() ? "" : ", ") + exact(value);
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", key, rows, columns, data);
}

}  // namespace

Result<geometry::Camera> parse_camera(const std::string& text, std::string_view name) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    return fail(fmt::format("{}:{}: is not YAML: {}", name, error.mark.line + 1, error.msg));
  }
  if (!root.IsMap()) return fail(fmt::format("{}: is no camera file: expected image_width: and so on", name));
  try {
    const YamlReader yaml(root, name);
    if (auto once = yaml.refuse_doubled_keys(); !once) return tl::unexpected(once.error());
    geometry::Camera camera;
    const auto width = image_side(yaml, "image_width");
    if (!width) return tl::unexpected(width.error());
    const auto height = image_side(yaml, "image_height");
    if (!height) return tl::unexpected(height.error());
    camera.width_px = *width;
    camera.height_px = *height;
    if (auto read = read_pinhole(yaml, camera); !read) return tl::unexpected(read.error());
    if (auto read = read_lens(yaml, camera); !read) return tl::unexpected(read.error());
    return camera;
  } catch (const YAML::Exception& error) {  // a node of another kind than its neighbours'
    return fail(fmt::format("{}:{}: is no camera file: {}", name, error.mark.line + 1, error.msg));
  }
}

Result<geometry::Camera> read_camera(const std::filesystem::path& file) {
  const auto text = read_small_file(file, kLargest_bytes, "a camera file");
  if (!text) return tl::unexpected(text.error());
  return parse_camera(*text, file.string());
}

std::string camera_as_yaml(const geometry::Camera& c, std::string_view name) {
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", c.width_px, c.height_px, name) +
         matrix_as_yaml("camera_matrix", 3, 3, {c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1}) +
         "distortion_model: plumb_bob\n" +
         matrix_as_yaml("distortion_coefficients", 1, 5, {c.k1, c.k2, c.p1, c.p2, c.k3}) +
         matrix_as_yaml("rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}) +
         matrix_as_yaml("projection_matrix", 3, 4, {c.fx_px, 0, c.cx_px, 0, 0, c.fy_px, c.cy_px, 0, 0, 0, 1, 0});
}

}  // namespace cgsr::app
