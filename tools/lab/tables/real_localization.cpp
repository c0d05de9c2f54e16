// Chapter 4 on images of others, beside ViSP's edge tracker: films that are followed from one pose (real_sequences), and ViSP's rendered castle,
// whose poses are exact, corrected from drawn priors.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/world/load.h"
#include "tools/lab/child.h"
#include "tools/lab/experiment.h"
#include "tools/lab/localization/canny_judge.h"
#include "tools/lab/localization/real_pictures.h"
#include "tools/lab/localization/trial.h"
#include "tools/lab/localization/visp_edges.h"
#include "tools/lab/tables/real_sequences.h"

namespace cgsr::lab {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr double kRad = std::numbers::pi / 180.0;
const fs::path kCastle = "/usr/share/visp-images-data/ViSP-images/mbt-depth/Castle-simu";

// --- ViSP's castle -----------------------------------------------------------------------------------------------------------------------

/// Where the cube stands in ViSP's own test: a half turn.
geometry::Pose castle_model() {
  geometry::Pose X = geometry::Pose::Identity();
  X.matrix().topRows<3>() << -1, 0, 0, -0.2, 0, 0, 1, 0.12, 0, 1, 0, -0.15;
  return X;
}

Result<world::Map> castle_map() {
  // A map is read from its own folder only, so both models are copied beside the file that joins them.
  const auto folder = fs::temp_directory_path() / fmt::format("cgsr-lab-{}-castle", getpid());
  std::error_code error;
  fs::copy(kCastle / "Models", folder, fs::copy_options::recursive | fs::copy_options::overwrite_existing, error);
  if (error) return fail(fmt::format("{}: the castle's models cannot be copied: {}", folder.string(), error.message()));
  const Eigen::AngleAxisd turn(castle_model().linear());
  const Vector3d tu = turn.angle() * turn.axis();
  const Vector3d t = castle_model().translation();
  const std::string text = fmt::format(
      "V1\nload(\"chateau.cao\")\nload(\"cube.cao\", t=[{}; {}; {}], tu=[{:.9f}; {:.9f}; {:.9f}])\n0\n0\n0\n0\n0\n0\n",
      t.x(), t.y(), t.z(), tu.x(), tu.y(), tu.z());
  auto written = write_text(folder / "castle.cao", text);
  auto map = written ? world::load_map(folder / "castle.cao") : Result<world::Map>(tl::unexpected(written.error()));
  fs::remove_all(folder, error);
  return map;
}

/// An image of the castle with its exact pose and a prior off by so much.
struct CastleTrial {
  cv::Mat grey;
  geometry::Pose X_WC;
  localization::Prior prior;
};

Result<geometry::Pose> castle_pose(int number) {
  const auto v = numbers_of(kCastle / "CameraPose" / fmt::format("Camera_{:03}.txt", number));
  if (v.size() != 16) return fail(fmt::format("{}: pose {} is missing", kCastle.string(), number));
  geometry::Pose X_CW = geometry::Pose::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) X_CW.matrix()(r, c) = v[static_cast<std::size_t>(4 * r + c)];
  }
  return geometry::normalized(X_CW.inverse());
}

/// \param off  percent of the distance, and degrees about a random axis through the model's centre.
localization::Prior castle_prior(const geometry::Pose& X_WC, const Vector3d& centre, double off, Random random) {
  const double away = (X_WC.translation() - centre).norm();
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
  return prior;
}

/// What one contender made of the castle's images.
struct CastleTally {
  std::vector<std::optional<geometry::Pose>> found;
  std::vector<double> position_percent;
  std::vector<double> direction_deg;
  int good = 0;

  void add(const std::optional<geometry::Pose>& X, const geometry::Pose& X_true, const Vector3d& centre) {
    found.push_back(X);
    if (!X) return;
    const double away = (X_true.translation() - centre).norm();
    const Vector3d moved = X->inverse() * centre - X_true.inverse() * centre;
    position_percent.push_back(100.0 * moved.norm() / away);
    direction_deg.push_back(error_of(*X, X_true).direction_rad / kRad);
    good += position_percent.back() < 1.0 && direction_deg.back() < 1.0 ? 1 : 0;
  }

  void add_rows(const std::string& row, Report& report) const {
    const auto trials = static_cast<int>(found.size());
    report.rows.push_back(share_row(row, "below 1 % and 1 degree", good, trials));
    report.rows.push_back(sampled_row(row, "median position", "%", position_percent, Join::kMedian, 0));
    report.rows.push_back(sampled_row(row, "median direction", "deg", direction_deg, Join::kMedian, 0));
  }
};

/// The pictures of Castle-simu with their true poses, and a prior that is `off` percent and degrees away from each.
Result<std::vector<CastleTrial>> castle_trials(const Setting& setting, const std::vector<fs::path>& pictures,
                                               const Vector3d& centre, double off) {
  std::vector<CastleTrial> trials;
  const int most = std::min(setting.trials, static_cast<int>(pictures.size()));
  for (int i = 0; i < most; ++i) {
    const auto X_WC = castle_pose(i + 1);
    if (!X_WC) return tl::unexpected(X_WC.error());
    const std::string name = pictures[static_cast<std::size_t>(i)].string();
    CastleTrial trial{cv::imread(name, cv::IMREAD_GRAYSCALE), *X_WC, {}};
    if (trial.grey.empty()) return fail(fmt::format("{}: is no picture", name));
    const auto stream = static_cast<std::uint64_t>(1000.0 * off) + static_cast<std::uint64_t>(i);
    trial.prior = castle_prior(*X_WC, centre, off, Random(setting.seed).fork(stream));
    trials.push_back(std::move(trial));
  }
  return trials;
}

/// Where ours was right, and a note on why it did not correct the others.
CastleTally castle_by_ours(stages::LocalizeStage& stage, const std::vector<CastleTrial>& trials, const Vector3d& centre,
                           const std::string& from, Report& report) {
  CastleTally ours;
  std::map<std::string, int> refused;
  for (const CastleTrial& trial : trials) {
    const cv::Mat& grey = trial.grey;
    const ImageView image{grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8};
    const Outcome outcome =
        correct_once(stage, image, trial.prior, {trial.X_WC, trial.X_WC, 0}, geometry::Pose::Identity());
    if (!outcome.answer.corrected) ++refused[std::string(to_string(outcome.answer.reason))];
    ours.add(outcome.answer.corrected ? std::optional(outcome.answer.X_WC) : std::nullopt, trial.X_WC, centre);
  }
  ours.add_rows(fmt::format("Castle-simu, {}, ours", from), report);
  std::string words;
  for (const auto& [reason, count] : refused) words += fmt::format(" {} {}", count, reason);
  report.notes.push_back(fmt::format("Castle-simu, {}: ours not corrected:{}.", from, words.empty() ? " none" : words));
  return ours;
}

/// The best of ViSP's settings, with its name.
Result<std::pair<CastleTally, std::string>> castle_by_visp(const geometry::Camera& camera,
                                                           const std::vector<CastleTrial>& trials,
                                                           const Vector3d& centre, const std::string& from,
                                                           Report& report) {
  std::optional<CastleTally> best;
  std::string best_name;
  for (const VispChoice& choice : kVispChoices) {
    auto visp =
        VispEdges::create({{kCastle / "Models" / "chateau.cao"}, {kCastle / "Models" / "cube.cao", castle_model()}},
                          camera, {choice.range_px, choice.calls});
    if (!visp) return tl::unexpected(visp.error());
    CastleTally theirs;
    for (const CastleTrial& trial : trials)
      theirs.add(visp->begin(trial.grey, trial.prior.X_WC) ? visp->track(trial.grey) : std::nullopt, trial.X_WC,
                 centre);
    theirs.add_rows(fmt::format("Castle-simu, {}, {}", from, choice.name()), report);
    if (best && theirs.good <= best->good) continue;
    best = std::move(theirs);
    best_name = choice.name();
  }
  return std::pair(std::move(*best), best_name);
}

Result<void> add_castle(const Setting& setting, const config::Localization& free, Report& report) {
  const auto map = castle_map();
  if (!map) return tl::unexpected(map.error());
  const geometry::Camera camera{640, 480, 700.0, 700.0, 320.0, 240.0};
  const Vector3d centre = centre_of(*map);
  const auto stage = localize_stage({camera, geometry::Pose::Identity(), *map}, free);
  const auto pictures = pictures_of(kCastle / "Images");
  for (const double off : {2.0, 5.0}) {
    const std::string from = fmt::format("from {:.0f} % and {:.0f} degrees", off, off);
    setting.progress("Castle-simu, " + from);
    const auto trials = castle_trials(setting, pictures, centre, off);
    if (!trials) return tl::unexpected(trials.error());
    const CastleTally ours = castle_by_ours(*stage, *trials, centre, from, report);
    const auto seen = film_of_poses(setting, fmt::format("castle-{:.0f}-ours", off), *map, camera, pictures, ours.found,
                                    "ours, " + from);
    if (!seen) return tl::unexpected(seen.error());
    report.notes.push_back(fmt::format("Film: {}.", seen->string()));
    if (!VispEdges::built()) continue;
    const auto visp = castle_by_visp(camera, *trials, centre, from, report);
    if (!visp) return tl::unexpected(visp.error());
    const auto& [best, name] = *visp;
    const auto filmed = film_of_poses(setting, fmt::format("castle-{:.0f}-visp", off), *map, camera, pictures,
                                      best.found, fmt::format("{}, {}", name, from));
    if (!filmed) return tl::unexpected(filmed.error());
    report.notes.push_back(fmt::format("Film: {} ({}).", filmed->string(), name));
  }
  return {};
}

}  // namespace

Result<Report> real_localization(const Setting& setting) {
  const auto free = shipped_localization("free");
  if (!free) return tl::unexpected(free.error());
  Report report;
  report.title = "images that others made";
  if (setting.data) {
    if (auto added = add_real_sequences(setting, *setting.data, report); !added) return tl::unexpected(added.error());
  } else {
    report.notes.emplace_back("cube, desk and castel: left out, --data or CGSR_DATA names no folder.");
  }
  if (fs::exists(kCastle)) {
    setting.progress("Castle-simu");
    if (auto added = add_castle(setting, *free, report); !added) return tl::unexpected(added.error());
  } else {
    report.notes.emplace_back("Castle-simu: left out, Debian's visp-images-data is not installed.");
  }
  if (!VispEdges::built())
    report.notes.emplace_back("ViSP: left out, libvisp-mbt-dev was not there when this was built.");
  report.notes.emplace_back(
      "An image is followed when, of the visible model edges every 5 px, the median is at most 2 px from the nearest "
      "Canny edge "
      "within 20 degrees of direction and 80 % are within 3 px. Its own few lines judge that, not the tracker's.");
  report.notes.emplace_back(
      "'corrected': the image measured the pose; the other rows also count poses that were only predicted. The width "
      "of "
      "a start pose and min_evidence of free.toml were chosen on cube, castel and desk, on which they are shown here.");
  report.notes.emplace_back(
      "Castle-simu: position errors are those of the model's centre in the camera, as a share of its distance; one "
      "correction "
      "for each image.");
  return report;
}

}  // namespace cgsr::lab
