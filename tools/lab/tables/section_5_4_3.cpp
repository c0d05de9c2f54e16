// 5.4.3 as a whole: the lamp robot runs Algorithm 5.2 by itself, from exploring to tracking, and what it tracks is judged by what was there. In the
// same run, on the same images, a second tracker does without the mask.

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/color/learn/model_file.h"
#include "src/boot/robot.h"
#include "src/output/overlay.h"
#include "tools/lab/ball_scoring.h"
#include "tools/lab/configurations.h"
#include "tools/lab/experiment.h"
#include "tools/lab/shade_trial.h"

namespace cgsr::lab {
namespace {

constexpr double kTheirsWith = 0.742;
constexpr double kTheirsWithout = 0.437;
constexpr std::array kFactors{0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75};
constexpr int kCurveEvery = 4;  // images: the curve needs fourteen trackers more
constexpr double kInShadow = 0.25;
constexpr double kLit = 0.75;

/// A tracker beside the robot's own: the same stage with the same units.
struct Onlooker {
  BallTracker tracker;
  bool with_mask = false;
  BallScore score{};
};

/// What became of the images from which on the robot tracks.
class Judge {
 public:
  Judge(const config::Pinhole& pinhole, int width_px, int height_px)
      : pinhole_(pinhole), overlay_(width_px, height_px) {}

  Result<void> make(const config::Robot& robot, double focal_px, int width_px, int height_px) {
    const auto model = color::load_model(robot.run.model);
    if (!model) return tl::unexpected(model.error());
    const auto add = [&](const color::IntegratedParameters& parameters, bool with_mask,
                         std::vector<Onlooker>& to) -> Result<void> {
      auto tracker = color::IntegratedTracker::create(*model, parameters, width_px, height_px, focal_px);
      if (!tracker) return tl::unexpected(tracker.error());
      to.push_back({BallTracker(std::move(*tracker), row_of<stages::TrackStage>(robot)), with_mask});
      return {};
    };
    if (auto added = add(robot.integrated, false, without_); !added) return added;
    for (const double factor : kFactors) {
      color::IntegratedParameters parameters = robot.integrated;
      parameters.dark_factors.fill(factor);
      for (const bool with_mask : {true, false}) {
        if (auto added = add(parameters, with_mask, curve_); !added) return added;
      }
    }
    return {};
  }

  void look(const ImageView& image, const sinks::ImageReport& report, const std::optional<hal::ImageTruth>& truth) {
    const stages::FrameResult& frame = report.frame;
    const stages::LampReport& lamp = frame.lamp.value;
    const color::TrackedObject& object = frame.objects.value.first().object;
    const shade::ShadeMasks* const masks = report.picture->masks.get();
    ++images_;
    const bool seen = lamp.has_board && reason_of(lamp).empty();
    if (seen && lamp.known) keep("(a) the probes throw shadows, the lamp is found", image, report, 0);
    const bool tracks = frame.decision.value.state == behavior::to_string(behavior::SeekState::kTracking);
    if (!tracks || !truth) return;
    if (masks != nullptr) keep("(b) what may lie in shadow", image, report, 1);

    std::optional<Box> orange;
    if (truth->in_view) orange = truth->box;
    was_there_ = was_there_ || truth->there;
    std::optional<Box> said;
    if (object.found) said = object.box;
    with_.add(orange, {}, said);
    part_of(*truth).add(orange, {}, said);
    const stages::ShadowMasks given{stages::ShadeStatus::kMasked, report.picture->masks};
    for (Onlooker& one : without_) watch(one, image, {}, orange);
    if (images_ % kCurveEvery == 0) {
      for (Onlooker& one : curve_) watch(one, image, one.with_mask ? given : stages::ShadowMasks{}, orange);
    }
    const bool right = orange && said && !intersection(*orange, *said).empty();
    if (right && height_of(*truth) > 0.6) keep("(c) above the table", image, report, 2);
    if (right && height_of(*truth) < 0.3 && truth->object_lit_share < kInShadow) {
      keep("(d) under it, in shadow", image, report, 3);
    }
    if (right && height_of(*truth) < 0.3 && truth->object_lit_share > kLit) {
      keep("(e) under it, lit", image, report, 4);
    }
    if (was_there_ && !truth->there) keep("(f) a brown ball", image, report, 5);
  }

  [[nodiscard]] std::vector<Picture> pictures() const {
    std::vector<Picture> all;
    for (const auto& kept : kept_) {
      if (!kept.best.jpeg.empty()) all.push_back(kept.best);
    }
    return all;
  }

  [[nodiscard]] const BallScore& with() const { return with_; }
  [[nodiscard]] const BallScore& without() const { return without_.front().score; }
  [[nodiscard]] const BallScore& part(std::size_t i) const { return parts_[i]; }
  [[nodiscard]] const std::vector<Onlooker>& curve() const { return curve_; }

  static constexpr std::array kParts{"above the table", "under it, in shadow", "under it, lit", "elsewhere",
                                     "brown ball above it"};

 private:
  /// How high the middle of the object is above the floor, from where it is seen and how far along the floor it is.
  [[nodiscard]] double height_of(const hal::ImageTruth& truth) const {
    const Eigen::Vector3d ray_C(((truth.box.x + 0.5 * truth.box.width) - pinhole_.cx_px) / pinhole_.fx_px,
                                ((truth.box.y + 0.5 * truth.box.height) - pinhole_.cy_px) / pinhole_.fy_px, 1.0);
    const auto& q = truth.camera_wxyz;
    const Eigen::Vector3d ray_W = Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * ray_C;
    return truth.camera_m[2] + ray_W.z() * truth.distance_m / std::max(1e-9, ray_W.head<2>().norm());
  }

  /// A picture of a kind: the fortieth of its images, where there are so many.
  struct Kept {
    int seen = 0;
    Picture best;
  };

  static void watch(Onlooker& one, const ImageView& image, const stages::ShadowMasks& masks,
                    const std::optional<Box>& orange) {
    const color::BallSighting ball = one.tracker.track(image, masks);
    one.score.add(orange, {}, ball.found ? std::optional(ball.box) : std::nullopt);
  }

  BallScore& part_of(const hal::ImageTruth& truth) {
    if (was_there_ && !truth.there) return parts_[4];
    const double height_m = height_of(truth);
    const bool low = height_m < 0.3;
    if (!truth.in_view) return parts_[3];
    if (!low && height_m > 0.6) return parts_[0];
    if (low && truth.object_lit_share < kInShadow) return parts_[1];
    if (low && truth.object_lit_share > kLit) return parts_[2];
    return parts_[3];
  }

  void keep(const char* caption, const ImageView& image, const sinks::ImageReport& report, std::size_t at) {
    Kept& kept = kept_.at(at);
    if (++kept.seen > 40 || (kept.seen > 1 && kept.seen != 40)) return;
    app::OverlayFacts facts;
    facts.image_number = static_cast<std::uint64_t>(images_);
    const color::TrackedObject& object = report.frame.objects.value.first().object;
    if (object.found) facts.box = object.box;
    if (at > 0) facts.shade = report.picture->masks.get();
    facts.lines.emplace_back(report.frame.decision.value.state);
    kept.best.caption = caption;
    kept.best.jpeg.clear();
    cv::imencode(".jpg", overlay_.draw(image, facts), kept.best.jpeg, {cv::IMWRITE_JPEG_QUALITY, 85});
  }

  config::Pinhole pinhole_;
  app::Overlay overlay_;
  int images_ = 0;
  bool was_there_ = false;
  BallScore with_;
  std::array<BallScore, kParts.size()> parts_{};
  std::vector<Onlooker> without_;
  std::vector<Onlooker> curve_;
  std::array<Kept, 6> kept_{};
};

void add_score(const std::string& row, const BallScore& score, std::optional<double> theirs, Report& report) {
  if (score.images > 0) {
    const auto add = [&](const char* quantity, double sum) {
      report.rows.push_back({row, quantity, "", std::nullopt, score.mean(sum), std::nullopt, score.images});
    };
    add("overlap", score.overlap);
    report.rows.back().dissertation = theirs;
    // Of what was found, as Eq. 3.2 has it: an image without an answer has no precision.
    report.rows.push_back({row, "precision", "", std::nullopt, score.found > 0 ? score.precision / score.found : 0.0,
                           std::nullopt, score.found});
    add("IoU", score.iou);
    add("found", score.found);
  }
  report.rows.push_back(
      {row, "false", "", std::nullopt, score.false_share(), std::nullopt, score.images + score.absent});
}

/// What the robot's own statistics say: when each step of its task began, and how far off its lamp was.
void add_run(const boot::Outputs& outputs, int images, Report& report) {
  report.rows.push_back({"the run", "images", "", 1821.0, static_cast<double>(images), std::nullopt, 1});
  for (const sinks::EventRecord& record : outputs.statistics->run().events) {
    if (record.event.source != "task") continue;
    report.rows.push_back({fmt::format("{}: {}", record.event.state, record.event.reason), "begins at", "s",
                           std::nullopt, record.at_s, std::nullopt, 1});
  }
  if (outputs.truth == nullptr || outputs.truth->lamp().compared == 0) return;
  const sinks::LampTruthStatistics& light = outputs.truth->lamp();
  const std::string row = "lamp's error in the world";
  report.rows.push_back({row, "at the end", "cm", std::nullopt, 100.0 * light.last_m, std::nullopt, 1});
  report.rows.push_back(
      {row, "mean", "cm", std::nullopt, 100.0 * light.mean_m, std::nullopt, static_cast<int>(light.compared)});
  report.rows.push_back(
      plain_row(row, "worst", "cm", 100.0 * light.worst_m, static_cast<std::size_t>(light.compared), Join::kMax));
}

void add_scores(const Judge& judge, Report& report) {
  add_score("with the mask", judge.with(), kTheirsWith, report);
  add_score("without a mask", judge.without(), kTheirsWithout, report);
  for (std::size_t i = 0; i < Judge::kParts.size(); ++i) {
    add_score(fmt::format("with the mask: {}", Judge::kParts[i]), judge.part(i), std::nullopt, report);
  }
  const BallScore& brown = judge.part(Judge::kParts.size() - 1);
  report.rows.push_back(
      {"brown ball", "tracked", "images", 0.0, static_cast<double>(brown.found_in_absent), std::nullopt, brown.absent});
}

void add_curve(const Judge& judge, Report& report) {
  Plot plot{"False positives against the darkness factor",
            "factor",
            "share of images",
            {{"with the mask", {}}, {"without a mask", {}}}};
  for (std::size_t i = 0; i < judge.curve().size(); ++i) {
    const Onlooker& one = judge.curve()[i];
    plot.curves[one.with_mask ? 0 : 1].points.push_back({kFactors[i / 2], one.score.false_share(), std::nullopt});
    report.rows.push_back({fmt::format("factor {:.2f}, {}", kFactors[i / 2], one.with_mask ? "with" : "without"),
                           "false", "", std::nullopt, one.score.false_share(), std::nullopt,
                           one.score.images + one.score.absent});
  }
  report.plots = {std::move(plot)};
}

}  // namespace

Result<Report> section_5_4_3(const Setting& setting) {
  auto config = lamp_robot(setting);
  if (!config) return tl::unexpected(config.error());
  config->sim.seed = static_cast<int>(setting.seed);
  const int width_px = config->sim.width_px;
  const int height_px = config->sim.height_px;
  Judge judge(config->camera.pinhole, width_px, height_px);
  const double focal_px = 0.5 * (config->camera.pinhole.fx_px + config->camera.pinhole.fy_px);
  if (auto made = judge.make(*config, focal_px, width_px, height_px); !made) return tl::unexpected(made.error());

  boot::RunOptions options;
  if (setting.videos) {
    std::filesystem::create_directories(*setting.videos);
    options.video = (*setting.videos / fmt::format("section-5.4.3-{}.mkv", setting.seed)).string();
  }
  int images = 0;
  options.observer = [&](const ImageView& image, const sinks::ImageReport& report,
                         const std::optional<hal::ImageTruth>& truth) {
    judge.look(image, report, truth);
    if (++images % 30 == 0) {
      setting.progress(fmt::format("{:.0f} s: {}", images / 30.0, report.frame.decision.value.state));
    }
  };
  auto robot = boot::Robot::build(*config, options);
  if (!robot) return tl::unexpected(robot.error());
  StopRequest stop;
  if (auto done = (*robot)->run(stop); !done) return tl::unexpected(done.error());

  Report report;
  report.title = fmt::format("Algorithm 5.2 from exploring to tracking, {} images", images);
  add_run((*robot)->state().outputs, images, report);
  add_scores(judge, report);
  add_curve(judge, report);
  report.pictures = judge.pictures();
  report.notes = {
      "The robot's own program in the simulated home: it explores, locates the lamp by its probes, backs off, finds "
      "the "
      "shaded regions and tracks. Boxes are judged by the simulator's.",
      "Overlap is |found and true| / |true| over the images in which the ball is in view, nothing found counting as 0: "
      "the dissertation's tracking accuracy. Precision is |found and true| / |found| over the images with an answer.",
      "False: images in which something that does not touch the ball was taken for it, of all. Without a mask dark "
      "histograms are searched everywhere. Every tracker is the stage track with the robot's units.",
      "With --html the six pictures of Figure 5.5, with --videos FOLDER the film with the mask drawn.",
      fmt::format("The curve is of one image in {}; each point has one darkness factor instead of three.",
                  kCurveEvery)};
  return report;
}

}  // namespace cgsr::lab
