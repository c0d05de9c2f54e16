#include "tools/lab/tables/real_sequences.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/world/load.h"
#include "src/input/camera_file.h"
#include "src/input/pose_file.h"
#include "tools/lab/child.h"
#include "tools/lab/localization/canny_judge.h"
#include "tools/lab/localization/real_pictures.h"
#include "tools/lab/localization/visp_edges.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

struct Sequence {
  std::string name;
  fs::path map;
  fs::path images;
  geometry::Camera camera;
  geometry::Pose X_WC;                                 ///< at the first image.
  VispSettings visp;                                   ///< its configuration's sampling, angles and clipping.
  std::vector<std::optional<geometry::Pose>> board{};  ///< X_WC by a marker board in each picture.
  std::string board_note{};                            ///< how well these agree with the board's own corners.
};

geometry::Pose pose_in(const nlohmann::json& rows) {
  geometry::Pose X = geometry::Pose::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) X.matrix()(r, c) = rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
  }
  return geometry::normalized(X);
}

/// How far a marker's corners lie from where a pose of it has them, mean. [px] \param corners  rows and columns, in any order round.
double marker_distance_px(const geometry::Camera& camera, const geometry::Pose& X_CM, double size_m,
                          const nlohmann::json& corners) {
  std::array<Eigen::Vector2d, 4> expected;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d corner(i == 0 || i == 3 ? -0.5 : 0.5, i < 2 ? 0.5 : -0.5, 0.0);
    expected[i] = camera.pixel_of(X_CM * (size_m * corner)).value_or(Eigen::Vector2d(-1e3, -1e3));
  }
  double least = 1e9;
  for (std::size_t first = 0; first < 4; ++first) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{3}}) {
      double sum = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& corner = corners[(first + step * i) % 4];
        sum += (Eigen::Vector2d(corner[0], corner[1]) - expected[i]).norm() / 4.0;
      }
      least = std::min(least, sum);
    }
  }
  return least;
}

/// The desk's marker board: its pose in each picture moves the model's of the first one. Those that do not agree with the board's corners, as the first
/// picture has them on the board, are left out.
void take_board(const fs::path& file, Sequence& sequence) {
  constexpr double kAgree_px = 5.0;
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (json.is_discarded()) return;
  const auto& poses = json.at("grid");
  const auto& seen = json.at("detections");
  const geometry::Pose X_C0B = pose_in(poses.at(0));
  std::string words;
  for (std::size_t k = 0; k < std::min(poses.size(), seen.size()); ++k) {
    const geometry::Pose X_CB = pose_in(poses[k]);
    double sum = 0.0;
    int markers = 0;
    for (const auto& [name, marker] : seen[k].items()) {
      if (!seen[0].contains(name)) continue;
      const geometry::Pose X_BM = X_C0B.inverse() * pose_in(seen[0][name].at("cMo"));
      auto corners = marker.at("tag_corners");
      for (auto& corner : corners) corner = {corner[1], corner[0]};
      sum += marker_distance_px(sequence.camera, X_CB * X_BM, json.at("tag_size"), corners);
      ++markers;
    }
    const bool agrees = markers > 0 && sum / markers <= kAgree_px;
    words += fmt::format("{}{} {:.1f}", k == 0 ? "" : ", ", k, markers > 0 ? sum / markers : -1.0);
    sequence.board.push_back(agrees ? std::optional((X_CB * X_C0B.inverse() * sequence.X_WC.inverse()).inverse())
                                    : std::nullopt);
  }
  sequence.board_note =
      fmt::format("{}: board poses used where they agree with the board's corners within {:.0f} px; image and px: {}.",
                  sequence.name, kAgree_px, words);
}

/// A film of ViSP's: a folder with `<model>.cao`, the pictures in `img` and `<model>.0.pos`, the start pose: translation and rotation vector of the
/// model in the camera. \param camera, visp  of its `.xml`. \return nothing: the folder is not there, or its start pose is none.
std::optional<Sequence> visp_film(const fs::path& folder, const std::string& model, const geometry::Camera& camera,
                                  const VispSettings& visp) {
  const auto v = numbers_of(folder / (model + ".0.pos"));
  if (v.size() != 6) return std::nullopt;
  geometry::Pose X_CW = geometry::Pose::Identity();
  X_CW.translation() = Vector3d(v[0], v[1], v[2]);
  X_CW.linear() = geometry::rotation_of({v[3], v[4], v[5]});
  return Sequence{folder.filename().string(), folder / (model + ".cao"), folder / "img", camera, X_CW.inverse(), visp};
}

std::optional<Sequence> cube_of(const fs::path& data) {
  return visp_film(data / "localization" / "cube", "cube",
                   {640, 480, 547.7367575, 542.0744058, 338.7036994, 234.5083345}, {8, 1, 4.0, 65.0, 75.0, 0.1, 0.9});
}

std::optional<Sequence> castel_of(const fs::path& data) {
  return visp_film(data / "localization" / "castel", "chateau",
                   {640, 480, 615.1674804688, 615.1675415039, 312.1889953613, 243.4373779297},
                   {8, 1, 5.0, 70.0, 80.0, 0.01, 2.0});
}

std::optional<Sequence> desk_of(const fs::path& data) {
  const fs::path folder = data / "localization" / "desk";
  std::ifstream file(folder / "sequence" / "init" / "cube.json");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  Sequence sequence{"desk", folder / "models" / "cube" / "cube.obj", folder / "all", {}, {}, {}};
  sequence.camera = {640, 480, 607.178466796875, 607.2342529296875, 321.39129638671875, 241.91822814941406};
  sequence.X_WC = pose_in(json).inverse();
  const fs::path board = folder / "sequence" / "apriltag_data.json";
  try {
    take_board(board, sequence);
  } catch (const nlohmann::json::exception& wrong) {
    sequence.board.clear();
    sequence.board_note =
        fmt::format("{}: no rows beside the marker board: {}: {}", sequence.name, board.string(), wrong.what());
  }
  return sequence;
}

/// The poses of a film's pictures.
struct FollowedPoses {
  std::vector<std::optional<geometry::Pose>> X_WC;  ///< also where it was only predicted.
  std::vector<bool> measured;                       ///< of each picture.

  explicit FollowedPoses(std::size_t pictures = 0) : X_WC(pictures), measured(pictures) {}
  [[nodiscard]] int corrected() const { return static_cast<int>(std::ranges::count(measured, true)); }
};

Result<FollowedPoses> follow_ours(const Sequence& sequence, std::size_t count) {
  const auto folder = fs::temp_directory_path() / fmt::format("cgsr-lab-{}-real", getpid());
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const auto camera = write_text(folder / "camera.yaml", app::camera_as_yaml(sequence.camera, sequence.name));
  const auto pose =
      write_text(folder / "pose.csv", fmt::format("{}\n{}\n", app::kPoseColumns, app::pose_as_csv(sequence.X_WC)));
  if (!camera) return tl::unexpected(camera.error());
  if (!pose) return tl::unexpected(pose.error());
  const auto program = fs::read_symlink("/proc/self/exe").parent_path() / "cgsr";
  const auto json = scratch_json();
  const auto result =
      run_for_json({program.string(), "localize", "--map", sequence.map.string(), "--camera",
                    (folder / "camera.yaml").string(), "--input", sequence.images.string(), "--pose",
                    (folder / "pose.csv").string(), "--config", source_path("config/localization/free.toml"), "--csv",
                    (folder / "answer.csv").string(), "--json", json.string()},
                   json);
  const auto answers = app::read_poses(folder / "answer.csv");
  fs::remove_all(folder, ignored);
  if (!result) return tl::unexpected(result.error());
  if (!answers) return tl::unexpected(answers.error());
  FollowedPoses followed(count);
  for (const app::PoseRow& row : *answers) {
    const auto at = static_cast<std::size_t>(*row.frame);
    if (at >= count) continue;
    followed.X_WC[at] = row.X;
    followed.measured[at] = row.corrected;
  }
  return followed;
}

Result<FollowedPoses> follow_visp(const Sequence& sequence, const VispChoice& choice,
                                  const std::vector<fs::path>& pictures) {
  VispSettings settings = sequence.visp;
  settings.range_px = choice.range_px;
  settings.calls = choice.calls;
  auto visp = VispEdges::create({{sequence.map}}, sequence.camera, settings);
  if (!visp) return tl::unexpected(visp.error());
  FollowedPoses followed(pictures.size());
  bool begun = false;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const cv::Mat grey = cv::imread(pictures[i].string(), cv::IMREAD_GRAYSCALE);
    if (i == 0) begun = visp->begin(grey, sequence.X_WC);
    if (!begun) break;
    followed.X_WC[i] = visp->track(grey);
    followed.measured[i] = followed.X_WC[i].has_value();
  }
  return followed;
}

/// How one contender's poses fit the pictures.
struct SequenceScore {
  std::string who;
  double near = 0.0;  ///< share of the visible edges within 3 px, over those.
  CannyTally tally;
  FollowedPoses followed;

  /// More pictures, then a better fit.
  [[nodiscard]] bool is_better_than(const SequenceScore& other) const {
    return followed.corrected() != other.followed.corrected() ? followed.corrected() > other.followed.corrected()
                                                              : near > other.near;
  }
};

SequenceScore score_of(const std::string& who, const Sequence& sequence, const world::Map& map,
                       const std::vector<fs::path>& pictures, FollowedPoses followed) {
  SequenceScore score;
  score.who = who;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (!followed.X_WC[i]) continue;
    const cv::Mat grey = cv::imread(pictures[i].string(), cv::IMREAD_GRAYSCALE);
    score.tally.add(distances_to_canny(grey, map, sequence.camera, *followed.X_WC[i]));
  }
  score.near = score.tally.places > 0 ? static_cast<double>(score.tally.near) / score.tally.places : 0.0;
  score.followed = std::move(followed);
  return score;
}

void add_score(const Setting& setting, const Sequence& sequence, const SequenceScore& score, Report& report) {
  const std::string row = sequence.name + ", " + score.who;
  const auto pictures = static_cast<int>(score.followed.X_WC.size());
  report.rows.push_back(share_row(row, "corrected", score.followed.corrected(), pictures));
  report.rows.push_back(share_row(row, "followed (Canny)", score.tally.followed, pictures));
  report.rows.push_back(mean_row(row, "median distance", "px", score.tally.medians, setting.seed));
  report.rows.push_back(share_row(row, "within 3 px", score.tally.near, score.tally.places));
}

Result<void> add_film(const Setting& setting, const Sequence& sequence, const world::Map& map,
                      const std::vector<fs::path>& pictures, const SequenceScore& score, const std::string& name,
                      Report& report) {
  const auto seen = film_of_poses(setting, name, map, sequence.camera, pictures, score.followed.X_WC, score.who);
  if (!seen) return tl::unexpected(seen.error());
  report.notes.push_back(fmt::format("Film: {} ({}).", seen->string(), score.who));
  return {};
}

/// The distance of the map's corners in the image between two poses of the camera, mean. [px]
double corner_distance_px(const world::Map& map, const geometry::Camera& camera, const geometry::Pose& a,
                          const geometry::Pose& b) {
  double sum = 0.0;
  for (const Eigen::Vector3f& corner : map.vertices) {
    const auto here = camera.pixel_of(a.inverse() * corner.cast<double>());
    const auto there = camera.pixel_of(b.inverse() * corner.cast<double>());
    sum += here && there ? (*here - *there).norm() : 1e3;
  }
  return sum / static_cast<double>(map.vertices.size());
}

/// Ours beside a marker board's poses, where the film has them; the first picture is the one that it begins with.
void add_board_rows(const Setting& setting, const Sequence& sequence, const world::Map& map, const FollowedPoses& ours,
                    Report& report) {
  constexpr double kNear_px = 15.0, kFar_px = 30.0, kNear_m = 0.015;
  if (!sequence.board_note.empty()) report.notes.push_back(sequence.board_note);
  std::vector<double> distances_px, distances_cm;
  int judged = 0, near = 0, near_in_image = 0, far_and_claimed = 0;
  for (std::size_t i = 1; i < std::min(sequence.board.size(), ours.X_WC.size()); ++i) {
    if (!sequence.board[i] || !ours.X_WC[i]) continue;
    ++judged;
    if (!ours.measured[i]) continue;
    const geometry::Pose& X_WC = *sequence.board[i];
    distances_px.push_back(corner_distance_px(map, sequence.camera, *ours.X_WC[i], X_WC));
    const Vector3d centre = centre_of(map);
    distances_cm.push_back(100.0 * (ours.X_WC[i]->inverse() * centre - X_WC.inverse() * centre).norm());
    near_in_image += distances_px.back() <= kNear_px ? 1 : 0;
    near += distances_px.back() <= kNear_px && distances_cm.back() <= 100.0 * kNear_m ? 1 : 0;
    far_and_claimed += distances_px.back() > kFar_px ? 1 : 0;
  }
  if (judged == 0) return;
  const std::string row = sequence.name + ", ours, beside the marker board";
  report.rows.push_back(share_row(row, "within 15 px and 1.5 cm", near, judged));
  report.rows.push_back(share_row(row, "within 15 px", near_in_image, judged));
  report.rows.push_back(share_row(row, "claimed over 30 px off", far_and_claimed, judged));
  report.rows.push_back(mean_row(row, "corners off", "px", distances_px, setting.seed));
  report.rows.push_back(mean_row(row, "position off", "cm", distances_cm, setting.seed));
}

Result<void> add_sequence(const Setting& setting, const Sequence& sequence, Report& report) {
  const auto map = world::load_map(sequence.map);
  if (!map) return tl::unexpected(map.error());
  const auto pictures = pictures_of(sequence.images);
  auto followed = follow_ours(sequence, pictures.size());
  if (!followed) return tl::unexpected(followed.error());
  const SequenceScore ours = score_of("ours", sequence, *map, pictures, std::move(*followed));
  add_score(setting, sequence, ours, report);
  add_board_rows(setting, sequence, *map, ours.followed, report);
  if (auto film = add_film(setting, sequence, *map, pictures, ours, sequence.name + "-ours", report); !film)
    return film;
  if (!VispEdges::built() || sequence.map.extension() != ".cao") return {};  // ViSP's tracker reads no .obj
  std::optional<SequenceScore> best;
  for (const VispChoice& choice : kVispChoices) {
    auto theirs_followed = follow_visp(sequence, choice, pictures);
    if (!theirs_followed) return tl::unexpected(theirs_followed.error());
    SequenceScore theirs = score_of(choice.name(), sequence, *map, pictures, std::move(*theirs_followed));
    add_score(setting, sequence, theirs, report);
    if (!best || theirs.is_better_than(*best)) best = std::move(theirs);
  }
  report.rows.push_back(plain_row(fmt::format("{}, ours less the best of ViSP", sequence.name), "within 3 px", "",
                                  ours.near - best->near, pictures.size()));
  return add_film(setting, sequence, *map, pictures, *best, sequence.name + "-visp", report);
}

}  // namespace

Result<void> add_real_sequences(const Setting& setting, const fs::path& data, Report& report) {
  for (const auto& sequence : {cube_of(data), castel_of(data), desk_of(data)}) {
    if (!sequence) continue;
    setting.progress(sequence->name);
    if (auto added = add_sequence(setting, *sequence, report); !added) return added;
  }
  return {};
}

}  // namespace cgsr::lab
