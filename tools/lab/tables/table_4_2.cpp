// Table 4.2: what a correction costs by the edges in the map, in the planar world (4.3.2), and how exact it is in the same run.

#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/world/compact.h"
#include "src/input/camera_file.h"
#include "src/input/pose_file.h"
#include "tools/lab/child.h"
#include "tools/lab/experiment.h"
#include "tools/lab/image.h"
#include "tools/lab/localization/trial.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

constexpr double kRate_hz = 30.0;

/// How the source's two words on what is in view are read, and a third.
enum class Reading {
  kBehind,  ///< the world of 456 edges (fewer: with less detail), all others in boxes behind the camera.
  kHalf,    ///< half of all edges before the camera: more squares; the other half behind.
  kTurned,  ///< as kBehind, and the camera looks at the boxes.
};
constexpr std::array<std::string_view, 3> kReadingNames{"others behind", "half in view", "turned to the others"};

struct Case {
  int edges;
  Reading reading;
  std::optional<double> ours_fps;      ///< glCorrect's of the dissertation; 30: more than that.
  std::optional<double> stronger_fps;  ///< 1: less.
};

constexpr std::array kCases{
    Case{50, Reading::kBehind, 30.0, 30.0},  Case{150, Reading::kBehind, 30.0, 21.7},
    Case{450, Reading::kBehind, 30.0, 5.3},  Case{1250, Reading::kBehind, 25.1, 2.1},
    Case{3725, Reading::kBehind, 20.6, 1.0}, Case{50, Reading::kHalf, 30.0, 30.0},
    Case{150, Reading::kHalf, 30.0, 21.7},   Case{450, Reading::kHalf, 30.0, 5.3},
    Case{1250, Reading::kHalf, 25.1, 2.1},   Case{3725, Reading::kHalf, 20.6, 1.0},
    Case{100000, Reading::kBehind, {}, {}},  Case{1000000, Reading::kBehind, {}, {}},
    Case{100000, Reading::kTurned, {}, {}},  Case{1000000, Reading::kTurned, {}, {}},
};

void scale_world(sim::WorldSpec& spec, const Case& wanted) {
  constexpr int kWhole = 456;
  const int before = wanted.reading == Reading::kHalf ? wanted.edges / 2 : wanted.edges;
  spec.planar.edges = wanted.edges;
  spec.planar.half_behind = false;
  if (wanted.edges > 10000) spec.ambient.corner_reach_m = 0.0;  // which costs a ray per place
  if (wanted.reading != Reading::kHalf) return;
  spec.planar.edges = std::min(before, kWhole);
  spec.planar.half_behind = true;
  // What is more than the world has stands as a board of squares before its far side; as much again goes behind.
  const int more = before - spec.planar.edges;
  const int side = static_cast<int>(std::floor(std::sqrt(more / 2.0)));
  if (side < 2) return;
  const double size_m = 0.085 * side;
  sim::ShapeSpec board;
  board.name = "large board";
  board.kind = sim::ShapeKind::kCheckerboard;
  board.material = "planar black";
  board.second_material = "planar board";
  board.columns = side;
  board.rows = side;
  board.position_m = {7.6, 0.0, 0.05};
  board.size_m = {0.0, size_m, size_m};
  board.heading_deg = 180.0;
  spec.shape.push_back(board);
  const int columns = 8;
  for (int i = 0; i < more / 12; ++i) {
    sim::ShapeSpec box;
    box.name = fmt::format("more {}", i);
    box.material = i % 2 == 0 ? "planar yellow" : "planar blue";
    box.position_m = {-3.0 - 0.5 * std::floor(static_cast<double>(i) / columns), 5.0 + 0.3 * (i % columns), 0.01};
    box.size_m = {0.2, 0.2, 0.3};
    spec.shape.push_back(box);
  }
}

/// The robot's pose on its way: forward, swaying.
geometry::Pose pose_at(int image, Reading reading) {
  const double t = image / kRate_hz;
  const double facing = reading == Reading::kTurned ? std::numbers::pi : 0.0;
  const double heading = facing + 0.12 * std::sin(2.0 * t);
  const double way = 0.4 * t;
  return geometry::pose_on_floor(way * std::cos(facing), 0.05 * std::sin(1.3 * t), heading);
}

/// A film on disk, with all that `cgsr localize` needs to follow it.
struct Film42 {
  std::filesystem::path folder;
  std::vector<geometry::Pose> X_WC;
  std::size_t edges = 0;
};

Result<Film42> shoot(const Setting& setting, const Case& wanted, int images) {
  auto place = Place::make("planar", [&](sim::WorldSpec& spec) { scale_world(spec, wanted); });
  if (!place) return tl::unexpected(place.error());
  auto told = survey(**place, sim::CalibrationErrors::chapter_4(), static_cast<std::uint32_t>(setting.seed));
  if (!told) return tl::unexpected(told.error());
  Film42 film;
  film.folder = std::filesystem::temp_directory_path() / fmt::format("cgsr-lab-{}-film", getpid());
  film.edges = told->map.edges.size();
  std::error_code ignored;
  std::filesystem::remove_all(film.folder, ignored);
  std::filesystem::create_directories(film.folder / "img", ignored);
  if (auto written = world::write_compact(told->map, film.folder / "map.cgsrmap"); !written) {
    return tl::unexpected(written.error());
  }
  Random random = Random(setting.seed).fork(0x42);
  std::string odometry = fmt::format("{}\n", app::kPoseColumns);
  geometry::Pose X_OR = geometry::Pose::Identity();
  for (int i = 0; i < images; ++i) {
    const geometry::Pose X_WR = pose_at(i, wanted.reading);
    film.X_WC.push_back(X_WR * (*place)->X_RC());
    const Photograph photo =
        (*place)->photograph(film.X_WC.back(), static_cast<std::uint32_t>(setting.seed), static_cast<std::uint64_t>(i));
    const Image image = image_of_yuyv(photo.yuyv, photo.width_px, photo.height_px);
    cv::imwrite((film.folder / "img" / fmt::format("{:04}.png", i)).string(), image.bgr);
    if (i > 0) {
      geometry::Pose step = pose_at(i - 1, wanted.reading).inverse() * X_WR;
      step.translation() *= 1.05;  // slip
      X_OR = X_OR * step;
    }
    odometry += app::pose_as_csv(X_OR) + "\n";
  }
  const geometry::Pose X_start =
      believed(film.X_WC.front(), draw_prior_error(0.2, random), (*place)->X_RC(), told->X_RC);
  const std::string head = fmt::format("{}\n", app::kPoseColumns);
  for (const auto& [name, text] :
       {std::pair("odometry.csv", odometry), std::pair("pose.csv", head + app::pose_as_csv(X_start) + "\n"),
        std::pair("mount.csv", head + app::pose_as_csv(told->X_RC) + "\n"),
        std::pair("camera.yaml", app::camera_as_yaml(told->camera, "simulated"))}) {
    if (auto written = write_text(film.folder / name, text); !written) return tl::unexpected(written.error());
  }
  return film;
}

struct Measured {
  double mean_minstr = 0.0;
  double worst_minstr = 0.0;
  int corrected = 0;
  std::vector<double> position_cm;
  std::vector<double> direction_deg;
};

Result<Measured> follow_film(const Film42& film, const std::string& method, bool count) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "cgsr";
  const auto path = [&](const char* name) { return (film.folder / name).string(); };
  const auto json = scratch_json();
  std::vector<std::string> words;
  if (count) words = {source_path("tools/count"), "--json", json.string(), "--"};
  for (const std::string& word : {program.string(),          std::string("localize"),
                                  std::string("--map"),      path("map.cgsrmap"),
                                  std::string("--camera"),   path("camera.yaml"),
                                  std::string("--input"),    path("img"),
                                  std::string("--pose"),     path("pose.csv"),
                                  std::string("--odometry"), path("odometry.csv"),
                                  std::string("--mount"),    path("mount.csv"),
                                  std::string("--method"),   method,
                                  std::string("--config"),   source_path("config/localization/floor.toml"),
                                  std::string("--csv"),      path("answer.csv")}) {
    words.push_back(word);
  }
  if (!count) words.insert(words.end(), {"--json", json.string()});
  const auto result = run_for_json(words, json);
  if (!result) return tl::unexpected(result.error());
  Measured measured;
  if (count) {
    measured.mean_minstr = result->at("image").at("mean_minstr").get<double>();
    measured.worst_minstr = result->at("image").at("worst_minstr").get<double>();
  } else {
    measured.corrected = result->at("corrected").get<int>();
  }
  const auto answers = app::read_poses(film.folder / "answer.csv");
  if (!answers) return tl::unexpected(answers.error());
  for (const app::PoseRow& row : *answers) {
    const PoseError error = error_of(row.X, film.X_WC[static_cast<std::size_t>(*row.frame)]);
    measured.position_cm.push_back(error.position_m * 100.0);
    measured.direction_deg.push_back(error.direction_rad * 180.0 / std::numbers::pi);
  }
  return measured;
}

}  // namespace

Result<Report> table_4_2(const Setting& setting) {
  const auto floor = shipped_localization("floor");
  if (!floor) return tl::unexpected(floor.error());
  const int images = std::max(3, setting.trials);
  Report report;
  report.title = fmt::format("what localisation costs by the edges in the map, {} images of 640x480 each", images);
  for (const Case& wanted : kCases) {
    setting.progress(
        fmt::format("{} edges, {}", wanted.edges, kReadingNames[static_cast<std::size_t>(wanted.reading)]));
    const auto film = shoot(setting, wanted, images);
    if (!film) return tl::unexpected(film.error());
    for (const auto& [name, method] : {std::pair("ours", "glcorrect"), std::pair("Stronger", "stronger")}) {
      const bool ours = std::string_view(method) == "glcorrect";
      const auto measured = follow_film(*film, method, setting.count);
      if (!measured) return tl::unexpected(measured.error());
      const std::string row =
          fmt::format("{} edges, {}, {}", wanted.edges, kReadingNames[static_cast<std::size_t>(wanted.reading)], name);
      const int trials = images - 1;
      if (setting.count) {
        report.rows.push_back({row, "mean", "Minstr", {}, measured->mean_minstr, {}, trials});
        report.rows.push_back(
            plain_row(row, "worst", "Minstr", measured->worst_minstr, static_cast<std::size_t>(trials), Join::kMax));
        report.rows.push_back({row,
                               "at 1 GHz",
                               "frames/s",
                               ours ? wanted.ours_fps : wanted.stronger_fps,
                               1000.0 / measured->mean_minstr,
                               {},
                               trials});
      }
      report.rows.push_back(mean_row(row, "position error", "cm", measured->position_cm, setting.seed));
      report.rows.push_back(mean_row(row, "direction error", "deg", measured->direction_deg, setting.seed));
    }
    std::error_code ignored;
    std::filesystem::remove_all(film->folder, ignored);
  }
  report.notes = {
      "Counted is everything of chapter 4 per image: edge pixels, segments, expectation, matching, pose, for the "
      "camera's "
      "640x480 image on the SSE2 baseline (tools/count). One instruction per clock is assumed for frames/s.",
      "The dissertation says both that about half of the edges are in view and that edges were added behind the "
      "camera: "
      "both readings. Its 30 means 'more than 30', its 1 'less than 1'.",
      "The camera follows a way of 0.4 m/s on odometry with 5 % slip, calibration off as in table-4.1; errors are over "
      "all "
      "images, corrected or carried.",
      "Above 3,725 edges the dissertation has no figures."};
  return report;
}

}  // namespace cgsr::lab
