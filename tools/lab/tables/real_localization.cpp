// Chapter 4 on images of others: a cube followed from one pose, and ViSP's rendered castle, whose poses are exact, corrected from drawn priors.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/world/load.h"
#include "platform/config/canonical.h"
#include "src/input/camera_file.h"
#include "src/input/pose_file.h"
#include "tools/lab/child.h"
#include "tools/lab/experiment.h"
#include "tools/lab/localization/trial.h"

namespace cgsr::lab {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRad = std::numbers::pi / 180.0;
const fs::path kCastle = "/usr/share/visp-images-data/ViSP-images/mbt-depth/Castle-simu";

std::vector<double> numbers_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<double> numbers;
  for (double number = 0.0; file >> number;) numbers.push_back(number);
  return numbers;
}

Result<void> write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) return fail(fmt::format("{}: cannot be written", path.string()));
  return {};
}

std::vector<fs::path> pictures_of(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

Vector3d centre_of(const world::Map& map) {
  Vector3d low = Vector3d::Constant(1e9);
  Vector3d high = -low;
  for (const Eigen::Vector3f& p : map.vertices) {
    low = low.cwiseMin(p.cast<double>());
    high = high.cwiseMax(p.cast<double>());
  }
  return (low + high) / 2.0;
}

// --- a film that is followed -----------------------------------------------------------------------------------------------------------

struct Sequence {
  std::string name;
  fs::path map;
  fs::path images;
  geometry::Camera camera;
  geometry::Pose X_WC;  ///< at the first image.
};

std::optional<Sequence> cube_of(const fs::path& data) {
  const fs::path folder = data / "localization" / "cube";
  const auto v = numbers_of(folder / "cube.0.pos");
  if (v.size() != 6) return std::nullopt;
  Sequence sequence{"cube", folder / "cube.cao", folder / "img", {}, {}};
  sequence.camera = {640, 480, 547.7367575, 542.0744058, 338.7036994, 234.5083345};  // cube.xml
  geometry::Pose X_CW = geometry::Pose::Identity();
  X_CW.translation() = Vector3d(v[0], v[1], v[2]);
  X_CW.linear() = geometry::rotation_of({v[3], v[4], v[5]});
  sequence.X_WC = X_CW.inverse();
  return sequence;
}

std::optional<Sequence> desk_of(const fs::path& data) {
  const fs::path folder = data / "localization" / "desk";
  std::ifstream file(folder / "sequence" / "init" / "cube.json");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  Sequence sequence{"desk", folder / "models" / "cube" / "cube.obj", folder / "img", {}, {}};
  sequence.camera = {640, 480, 607.178466796875, 607.2342529296875, 321.39129638671875, 241.91822814941406};
  geometry::Pose X_CW = geometry::Pose::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) X_CW.matrix()(r, c) = json[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
  }
  sequence.X_WC = geometry::normalized(X_CW.inverse());
  return sequence;
}

/// The distances of a convex body's visible edges, every 5 px, to the nearest Canny edge of about their direction: knows nothing of any
/// tracker. [px], at most kFarthest_px.
std::vector<double> distances(const cv::Mat& grey, const world::Map& map, const geometry::Camera& camera,
                              const geometry::Pose& X_WC) {
  constexpr double kStep_px = 5.0;
  constexpr int kFarthest_px = 20;
  const double least_cosine = std::cos(20.0 * kRad);
  cv::Mat smooth;
  cv::Mat edges;
  cv::Mat dx;
  cv::Mat dy;
  cv::GaussianBlur(grey, smooth, {5, 5}, 1.0);
  cv::Sobel(smooth, dx, CV_32F, 1, 0);
  cv::Sobel(smooth, dy, CV_32F, 0, 1);
  cv::Canny(smooth, edges, 20, 60);
  const Vector3d centre = centre_of(map);
  const geometry::Pose X_CW = X_WC.inverse();
  const auto faces = [&](std::uint32_t s) {
    if (s == world::kNone) return false;
    const world::Surface& surface = map.surfaces[s];
    const Vector3d n = surface.normal.cast<double>();
    const double outward = n.dot(centre) < static_cast<double>(surface.offset_m) ? 1.0 : -1.0;
    return outward * (n.dot(X_WC.translation()) - static_cast<double>(surface.offset_m)) > 0.0;
  };
  std::vector<double> found;
  for (const world::Edge& edge : map.edges) {
    if (!faces(edge.surfaces[0]) && !faces(edge.surfaces[1])) continue;
    const auto a = camera.pixel_of(X_CW * map.vertices[edge.vertices[0]].cast<double>());
    const auto b = camera.pixel_of(X_CW * map.vertices[edge.vertices[1]].cast<double>());
    if (!a || !b || (*b - *a).norm() < kStep_px) continue;
    const Vector2d along = (*b - *a).normalized();
    const Vector2d normal(-along.y(), along.x());
    const int steps = static_cast<int>((*b - *a).norm() / kStep_px);
    for (int i = 0; i <= steps; ++i) {
      const Vector2d p = *a + along * (kStep_px * i);
      if (p.x() < 3 || p.y() < 3 || p.x() > grey.cols - 4 || p.y() > grey.rows - 4) continue;
      double nearest = kFarthest_px;
      for (int y = static_cast<int>(p.y()) - kFarthest_px; y <= static_cast<int>(p.y()) + kFarthest_px; ++y) {
        for (int x = static_cast<int>(p.x()) - kFarthest_px; x <= static_cast<int>(p.x()) + kFarthest_px; ++x) {
          if (x < 0 || y < 0 || x >= grey.cols || y >= grey.rows || edges.at<std::uint8_t>(y, x) == 0) continue;
          const Vector2d gradient(dx.at<float>(y, x), dy.at<float>(y, x));
          if (std::abs(gradient.normalized().dot(normal)) < least_cosine) continue;
          nearest = std::min(nearest, (Vector2d(x, y) - p).norm());
        }
      }
      found.push_back(nearest);
    }
  }
  return found;
}

Result<void> add_sequence(const Setting& setting, const Sequence& sequence, Report& report) {
  const auto folder = fs::temp_directory_path() / fmt::format("cgsr-lab-{}-real", getpid());
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const auto camera = write_text(folder / "camera.yaml", app::camera_as_yaml(sequence.camera, sequence.name));
  const auto pose =
      write_text(folder / "pose.csv", fmt::format("{}\n{}\n", app::kPoseColumns, app::pose_as_csv(sequence.X_WC)));
  if (!camera || !pose) return camera ? pose : camera;
  const auto program = fs::read_symlink("/proc/self/exe").parent_path() / "cgsr";
  const auto json = scratch_json();
  const auto result = run_for_json(
      {program.string(), "localize", "--map", sequence.map.string(), "--camera", (folder / "camera.yaml").string(),
       "--input", sequence.images.string(), "--pose", (folder / "pose.csv").string(), "--config",
       std::string(CGSR_LOCALIZATION) + "/free.toml", "--csv", (folder / "answer.csv").string(), "--video",
       (fs::temp_directory_path() / fmt::format("cgsr-{}.mkv", sequence.name)).string(), "--json", json.string()},
      json);
  if (!result) return tl::unexpected(result.error());
  const auto answers = app::read_poses(folder / "answer.csv");
  const auto map = world::load_map(sequence.map);
  fs::remove_all(folder, ignored);
  if (!answers) return tl::unexpected(answers.error());
  if (!map) return tl::unexpected(map.error());
  const auto pictures = pictures_of(sequence.images);
  std::vector<double> medians;
  int followed = 0;
  int near = 0;
  int points = 0;
  for (const app::PoseRow& row : *answers) {
    const auto at = static_cast<std::size_t>(*row.frame);
    if (at >= pictures.size()) break;
    auto d = distances(cv::imread(pictures[at].string(), cv::IMREAD_GRAYSCALE), *map, sequence.camera, row.X);
    if (d.empty()) continue;
    std::ranges::sort(d);
    medians.push_back(d[d.size() / 2]);
    const auto within = std::ranges::count_if(d, [](double px) { return px <= 3.0; });
    near += static_cast<int>(within);
    points += static_cast<int>(d.size());
    followed += d[d.size() / 2] <= 2.0 && static_cast<double>(within) >= 0.8 * static_cast<double>(d.size()) ? 1 : 0;
  }
  report.rows.push_back(share_row(sequence.name + ", ours", "corrected", result->at("corrected").get<int>(),
                                  result->at("images").get<int>()));
  report.rows.push_back(
      share_row(sequence.name + ", ours", "followed (Canny)", followed, static_cast<int>(medians.size())));
  report.rows.push_back(mean_row(sequence.name + ", ours", "median distance", "px", medians, setting.seed));
  report.rows.push_back(share_row(sequence.name + ", ours", "within 3 px", near, points));
  return {};
}

// --- ViSP's castle -----------------------------------------------------------------------------------------------------------------------

Result<world::Map> castle_map() {
  const auto path = fs::temp_directory_path() / fmt::format("cgsr-lab-{}-castle.cao", getpid());
  // The cube stands where ViSP's own test puts it: rows (-1, 0, 0, -0.2), (0, 0, 1, 0.12), (0, 1, 0, -0.15), a half turn.
  const double half = std::numbers::pi / std::numbers::sqrt2;
  const std::string text = fmt::format(
      "V1\nload(\"{}\")\nload(\"{}\", t=[-0.2; 0.12; -0.15], tu=[0; {:.9f}; {:.9f}])\n0\n0\n0\n0\n0\n0\n",
      (kCastle / "Models" / "chateau.cao").string(), (kCastle / "Models" / "cube.cao").string(), half, half);
  if (auto written = write_text(path, text); !written) return tl::unexpected(written.error());
  auto map = world::load_map(path);
  std::error_code ignored;
  fs::remove(path, ignored);
  return map;
}

Result<void> add_castle(const Setting& setting, const config::Localization& free, Report& report) {
  const auto map = castle_map();
  if (!map) return tl::unexpected(map.error());
  const geometry::Camera camera{640, 480, 700.0, 700.0, 320.0, 240.0};
  const Vector3d centre = centre_of(*map);
  localization::Localizer localizer(*map, camera, free.localizer);
  const auto pictures = pictures_of(kCastle / "Images");
  const int most = setting.trials.value_or(static_cast<int>(pictures.size()));
  for (const double off : {2.0, 5.0}) {
    std::vector<double> position;
    std::vector<double> direction;
    std::map<std::string, int> refused;
    int good = 0;
    int trials = 0;
    for (int i = 0; i < std::min(most, static_cast<int>(pictures.size())); ++i) {
      const auto v = numbers_of(kCastle / "CameraPose" / fmt::format("Camera_{:03}.txt", i + 1));
      const cv::Mat grey = cv::imread(pictures[static_cast<std::size_t>(i)].string(), cv::IMREAD_GRAYSCALE);
      if (v.size() != 16 || grey.empty())
        return fail(fmt::format("{}: image or pose {} is missing", kCastle.string(), i + 1));
      geometry::Pose X_CW = geometry::Pose::Identity();
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) X_CW.matrix()(r, c) = v[static_cast<std::size_t>(4 * r + c)];
      }
      const geometry::Pose X_WC = geometry::normalized(X_CW.inverse());
      const double away = (X_WC.translation() - centre).norm();
      Random random =
          Random(setting.seed).fork(static_cast<std::uint64_t>(1000.0 * off) + static_cast<std::uint64_t>(i));
      const auto any = [&] { return Vector3d(random.normal(), random.normal(), random.normal()).normalized().eval(); };
      const Vector3d turn = any() * off * kRad;
      const Vector3d shift = any() * off / 100.0 * away;
      geometry::Pose X_prior = X_WC;
      X_prior.translation() = centre + geometry::rotation_of(turn) * (X_WC.translation() - centre) + shift;
      X_prior.linear() = geometry::rotation_of(turn) * X_WC.linear();
      // The belief: a turn about the centre and a shift, either way as likely.
      Eigen::Matrix<double, 6, 3> J;
      const Vector3d arm = X_prior.translation() - centre;
      J << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(), 0.0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
      localization::Prior prior{X_prior, J * J.transpose() * std::pow(off * kRad, 2) / 3.0};
      prior.covariance.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity() * std::pow(off / 100.0 * away, 2) / 3.0;
      const ImageView image{grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step),
                            PixelFormat::kGrey8};
      const Outcome outcome = correct_once(localizer, image, prior, {X_WC, X_WC, 0}, geometry::Pose::Identity());
      ++trials;
      if (!outcome.answer.corrected) {
        ++refused[std::string(name_of(outcome.answer.reason))];
        continue;
      }
      const Vector3d moved = outcome.answer.X_WC.inverse() * centre - X_WC.inverse() * centre;
      position.push_back(100.0 * moved.norm() / away);
      direction.push_back(outcome.error.direction_rad / kRad);
      good += position.back() < 1.0 && direction.back() < 1.0 ? 1 : 0;
    }
    const std::string row = fmt::format("Castle-simu, ours, from {:.0f} % and {:.0f} degrees", off, off);
    report.rows.push_back(share_row(row, "below 1 % and 1 degree", good, trials));
    const auto median = [](std::vector<double> values) {
      if (values.empty()) return 0.0;
      std::ranges::sort(values);
      return values[values.size() / 2];
    };
    report.rows.push_back({row, "median position", "%", {}, median(position), {}, trials});
    report.rows.push_back({row, "median direction", "deg", {}, median(direction), {}, trials});
    std::string words;
    for (const auto& [reason, count] : refused) words += fmt::format(" {} {}", count, reason);
    report.notes.push_back(fmt::format("{}: not corrected:{}.", row, words.empty() ? " none" : words));
  }
  return {};
}

}  // namespace

Result<Report> real_localization(const Setting& setting) {
  const auto free = shipped_localization("free");
  if (!free) return tl::unexpected(free.error());
  Report report;
  report.name = "real-localization";
  report.title = "images that others made";
  report.config_sha256 = config::hash(*free);
  report.seed = setting.seed;
  if (setting.data) {
    for (const auto& sequence : {cube_of(*setting.data), desk_of(*setting.data)}) {
      if (!sequence) continue;
      setting.progress(sequence->name);
      if (auto added = add_sequence(setting, *sequence, report); !added) return tl::unexpected(added.error());
    }
  } else {
    report.notes.emplace_back("cube and desk: left out, --data or CGSR_DATA names no folder.");
  }
  if (fs::exists(kCastle)) {
    setting.progress("Castle-simu");
    if (auto added = add_castle(setting, *free, report); !added) return tl::unexpected(added.error());
  } else {
    report.notes.emplace_back("Castle-simu: left out, Debian's visp-images-data is not installed.");
  }
  report.notes.emplace_back(
      "An image is followed when, of the visible model edges every 5 px, the median is at most 2 px from the nearest "
      "Canny edge "
      "within 20 degrees of direction and 80 % are within 3 px. Its own few lines judge that, not the tracker's.");
  report.notes.emplace_back(
      "Castle-simu: position errors are those of the model's centre in the camera, as a share of its distance; one "
      "correction "
      "for each image.");
  return report;
}

}  // namespace cgsr::lab
