// Section 5.4.2: shaded regions beside the ray tracer's, with what is truly so and with what a robot knows; and what they cost.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "hal/sim/render/pixel_rays.h"
#include "hal/sim/render/truth_images.h"
#include "pipeline/stages/shade_stage.h"
#include "platform/count_marks.h"
#include "tools/lab/configurations.h"
#include "tools/lab/counting.h"
#include "tools/lab/experiment.h"
#include "tools/lab/localization/standpoints.h"
#include "tools/lab/shade_trial.h"
#include "tools/lab/shaded_views.h"

namespace cgsr::lab {
namespace {

using Eigen::Vector3d;

constexpr std::array<std::string_view, 3> kWorlds{"home", "occlusion", "people"};
constexpr int kCountedViews = 10;
constexpr double kBallRadius_m = 0.10;
constexpr std::size_t kLeastCells = 100;  // possibly shaded, for a view to count

constexpr StatedErrors kStated;

sim::CalibrationErrors map_errors() {
  sim::CalibrationErrors errors = sim::CalibrationErrors::none();
  errors.map_part_m = 0.005;
  return errors;
}

Vector3d normal3(double sigma, Random& random) {
  const double x = random.normal();
  const double y = random.normal();
  const double z = random.normal();
  return sigma * Vector3d(x, y, z);
}

std::size_t count(const std::vector<std::uint8_t>& mask) {
  return mask.size() - static_cast<std::size_t>(std::count(mask.begin(), mask.end(), std::uint8_t{0}));
}

/// Cells of masks and truth.
struct Overlap {
  double both = 0.0;
  double either = 0.0;

  void add(const std::vector<std::uint8_t>& ours, const std::vector<std::uint8_t>& truth) {
    for (std::size_t i = 0; i < ours.size(); ++i) {
      both += ours[i] != 0 && truth[i] != 0 ? 1.0 : 0.0;
      either += ours[i] != 0 || truth[i] != 0 ? 1.0 : 0.0;
    }
  }
  [[nodiscard]] double iou() const { return both / std::max(either, 1.0); }
};

struct Tally {
  Overlap surface;
  Overlap possibly;
  std::vector<double> surface_iou;  // of images
  std::vector<double> factor;       // area marked over truly possibly-shaded area, of images
  double marked = 0.0;
  double marked_unwidened = 0.0;
  double truly = 0.0;
  double cells = 0.0;
  int views = 0;
  int balls = 0;
  int covered = 0;
  int covered_unwidened = 0;
};

/// Does the map hide the lamp's centre from a place?
bool hidden(const sim::Tracer& tracer, const Vector3d& p_W, const Vector3d& p_WL) {
  return !sim::sees(tracer, p_W.cast<float>(), p_WL.cast<float>(), sim::kMapRays);
}

/// One world as it is and as a robot has it.
class Room {
 public:
  static Result<std::unique_ptr<Room>> make(const std::string& world, const config::Robot& robot, std::uint64_t seed) {
    auto place = Place::make(world);
    if (!place) return tl::unexpected(place.error());
    auto exact = survey(**place, sim::CalibrationErrors::none(), 0);
    if (!exact) return tl::unexpected(exact.error());
    auto told = survey(**place, map_errors(), static_cast<std::uint32_t>(seed));
    if (!told) return tl::unexpected(told.error());
    const shade::ShadeParameters& masks = robot.shade.masks;
    auto renderer = sim::Renderer::make((*place)->scene(), (*place)->camera().scaled_to(masks.width, masks.height), {});
    if (!renderer) return tl::unexpected(renderer.error());
    return std::unique_ptr<Room>(
        new Room(world, robot, std::move(*place), std::move(*exact), std::move(*told), std::move(*renderer)));
  }

  /// A view with shade in it, under a lamp anywhere in the room.
  /// \return false: two hundred draws met none.
  bool draw(Random& random) {
    for (int i = 0; i < 200; ++i) {
      const auto stand = draw_standpoint(*place_, edges_, area_, {}, random);
      if (!stand) return false;
      X_WC_ = stand->X_WC;
      const double x = random.uniform(area_.left_m + 0.3, area_.right_m - 0.3);
      const double y = random.uniform(area_.near_m + 0.3, area_.far_m - 0.3);
      state_.lamps[0].p_WL = {x, y, random.uniform(2.2, 2.8)};
      renderer_->move_to(state_);
      // A lamp behind a wall shades the whole view: nothing to be found out.
      truth_ = sim::shadow_masks(*renderer_, state_, X_WC_, 0);
      const std::size_t possibly = count(truth_.possibly_shaded);
      if (possibly >= kLeastCells && possibly < truth_.possibly_shaded.size() * 9 / 10) return true;
    }
    return false;
  }

  Result<void> judge(Random& random, Tally& tally) {
    const auto exact = masks(exact_, not_widened_, X_WC_, p_WL());
    if (!exact) return tl::unexpected(exact.error());
    add(*exact->masks, tally);
    geometry::Vector6d step;
    step << normal3(kStated.place_sigma_m, random), normal3(kStated.turn_sigma_rad, random);
    const geometry::Pose X_WC = geometry::moved(X_WC_, step);
    const Vector3d p_WL_told = p_WL() + normal3(kStated.lamp_sigma_m, random);
    const auto unwidened = masks(told_, not_widened_, X_WC, p_WL_told);
    if (!unwidened) return tl::unexpected(unwidened.error());
    const auto widened = masks(told_, robot_.shade, X_WC, p_WL_told);
    if (!widened) return tl::unexpected(widened.error());
    add_estimated(widened->masks->possibly_shaded, unwidened->masks->possibly_shaded, random, tally);
    return {};
  }

 private:
  /// What the stage has of the robot's surroundings.
  struct Known {
    geometry::Camera camera;
    std::shared_ptr<const world::Map> map;
  };

  Room(const std::string& world, const config::Robot& robot, std::unique_ptr<Place> place, Survey exact, Survey told,
       std::unique_ptr<sim::Renderer> renderer)
      : robot_(robot),
        not_widened_(robot.shade),
        place_(std::move(place)),
        exact_{exact.camera, std::make_shared<const world::Map>(std::move(exact.map))},
        told_{told.camera, std::make_shared<const world::Map>(std::move(told.map))},
        renderer_(std::move(renderer)),
        edges_(place_->scene()),
        area_(area_of(world)),
        state_(place_->state()) {
    not_widened_.masks.sigmas = 0.0;
  }

  /// The masks of a robot that has just got to know this lamp.
  [[nodiscard]] Result<stages::ShadowMasks> masks(const Known& known, const stages::ShadeStageParameters& parameters,
                                                  const geometry::Pose& X_WC, const Vector3d& p_WL) {
    stages::ShadeStage stage(known.map, known.camera, parameters);
    return masks_of(stage, row_of<stages::ShadeStage>(robot_), X_WC, kStated.pose(), kStated.lamp(p_WL));
  }

  void add(const shade::ShadeMasks& exact, Tally& tally) const {
    ++tally.views;
    Overlap one;
    one.add(exact.surface_shaded, truth_.surface_shaded);
    if (one.either >= static_cast<double>(kLeastCells)) tally.surface_iou.push_back(one.iou());
    tally.surface.add(exact.surface_shaded, truth_.surface_shaded);
    tally.possibly.add(exact.possibly_shaded, truth_.possibly_shaded);
  }

  void add_estimated(const std::vector<std::uint8_t>& widened, const std::vector<std::uint8_t>& unwidened,
                     Random& random, Tally& tally) const {
    const auto truly = static_cast<double>(count(truth_.possibly_shaded));
    tally.marked += static_cast<double>(count(widened));
    tally.marked_unwidened += static_cast<double>(count(unwidened));
    tally.truly += truly;
    tally.cells += static_cast<double>(widened.size());
    tally.factor.push_back(static_cast<double>(count(widened)) / truly);
    if (const auto ball = draw_ball(random)) {
      ++tally.balls;
      tally.covered += covers(widened, *ball) ? 1 : 0;
      tally.covered_unwidened += covers(unwidened, *ball) ? 1 : 0;
    }
  }

  [[nodiscard]] Vector3d p_WL() const { return state_.lamps[0].p_WL; }

  [[nodiscard]] Vector3d ray_of(double column, double row) const {
    const Eigen::Vector2d ideal = exact_.camera.ideal_of({column, row});
    return X_WC_.linear() * Vector3d(ideal.x(), ideal.y(), 1.0);
  }

  [[nodiscard]] bool free(const Vector3d& from, const Vector3d& to) const {
    return sim::sees(renderer_->tracer(), from.cast<float>(), to.cast<float>(), sim::kMapRays);
  }

  /// A place for a ball in view at which some of it is in shade: around a point of a ray that crosses a volume.
  std::optional<Vector3d> draw_ball(Random& random) const {
    const sim::Tracer& tracer = renderer_->tracer();
    for (int i = 0; i < 4000; ++i) {
      const int cell = random.below(static_cast<int>(truth_.possibly_shaded.size()));
      const double depth_m = random.uniform(0.8, 5.0);
      if (truth_.possibly_shaded[static_cast<std::size_t>(cell)] == 0) continue;
      const double scale = static_cast<double>(exact_.camera.width_px) / truth_.width_px;
      const Vector3d ray =
          ray_of((cell % truth_.width_px + 0.5) * scale - 0.5, (cell / truth_.width_px + 0.5) * scale - 0.5);
      const Vector3d middle = X_WC_.translation() + depth_m * ray;
      bool fits = free(X_WC_.translation(), middle);
      bool shaded = hidden(tracer, middle, p_WL());
      for (int k = 0; k < 6 && fits; ++k) {
        const Vector3d end = middle + (k % 2 == 0 ? 1.0 : -1.0) * kBallRadius_m * Vector3d::Unit(k / 2);
        fits = free(middle, end);
        shaded = shaded || hidden(tracer, end, p_WL());
      }
      if (fits && shaded && seen_shaded(middle, [](int, int) { return false; })) return middle;
    }
    return std::nullopt;
  }

  /// Is every pixel of the ball that truly lies in shade in the mask?
  [[nodiscard]] bool covers(const std::vector<std::uint8_t>& mask, const Vector3d& ball) const {
    const int scale = exact_.camera.width_px / truth_.width_px;
    return !seen_shaded(ball, [&](int x, int y) {
      return mask[static_cast<std::size_t>((y / scale) * truth_.width_px + x / scale)] != 0;
    });
  }

  /// Whether some pixel of the camera's shows a shaded point of the ball and is not to be left out.
  template <class LeaveOut>
  [[nodiscard]] bool seen_shaded(const Vector3d& ball, LeaveOut&& leave_out) const {
    const geometry::Camera& camera = exact_.camera;
    const auto centre = camera.pixel_of(X_WC_.inverse() * ball);
    if (!centre) return false;
    const Vector3d arm = ball - X_WC_.translation();
    const double reach_px = 1.4 * camera.fx_px * kBallRadius_m / (X_WC_.inverse() * ball).z() + 2.0;
    const int left = std::max(0, static_cast<int>(centre->x() - reach_px));
    const int right = std::min(camera.width_px - 1, static_cast<int>(centre->x() + reach_px));
    const int top = std::max(0, static_cast<int>(centre->y() - reach_px));
    const int bottom = std::min(camera.height_px - 1, static_cast<int>(centre->y() + reach_px));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        if (leave_out(x, y)) continue;
        const Vector3d ray = ray_of(x, y).normalized();
        const double along = ray.dot(arm);
        const double inside = kBallRadius_m * kBallRadius_m - (arm - along * ray).squaredNorm();
        if (inside <= 0.0) continue;
        const Vector3d p_W = X_WC_.translation() + (along - std::sqrt(inside)) * ray;
        if (hidden(renderer_->tracer(), p_W, p_WL()) && free(X_WC_.translation(), p_W)) return true;
      }
    }
    return false;
  }

  config::Robot robot_;
  stages::ShadeStageParameters not_widened_;
  std::unique_ptr<Place> place_;
  Known exact_;
  Known told_;
  std::unique_ptr<sim::Renderer> renderer_;
  TrueEdges edges_;
  Area area_;
  sim::SceneState state_;
  geometry::Pose X_WC_ = geometry::Pose::Identity();
  sim::ShadowMasks truth_;
};

Row figure(const std::string& row, std::string quantity, std::string unit, double ours, int trials) {
  return {row, std::move(quantity), std::move(unit), {}, ours, {}, trials};
}

void add_rows(const std::string& name, const Tally& tally, std::uint64_t seed, Report& report) {
  const std::string exact = name + ", all known";
  report.rows.push_back(figure(exact, "surface IoU", "", tally.surface.iou(), tally.views));
  report.rows.push_back(mean_row(exact, "surface IoU of an image", "", tally.surface_iou, seed));
  report.rows.push_back(figure(exact, "possibly IoU", "", tally.possibly.iou(), tally.views));
  const std::string told = name + ", estimated";
  report.rows.push_back(share_row(told, "ball's shade covered", tally.covered, tally.balls));
  report.rows.push_back(figure(told, "area factor", "", tally.marked / tally.truly, tally.views));
  report.rows.push_back(mean_row(told, "area factor of an image", "", tally.factor, seed));
  const std::string plain = name + ", estimated, not widened";
  report.rows.push_back(share_row(plain, "ball's shade covered", tally.covered_unwidened, tally.balls));
  report.rows.push_back(figure(plain, "area factor", "", tally.marked_unwidened / tally.truly, tally.views));
  report.rows.push_back(
      figure(name + ", everything marked", "area factor", "", tally.cells / tally.truly, tally.views));
}

/// What is demanded of the widened mask, over the images of all worlds.
struct Pooled {
  double marked = 0.0;
  double truly = 0.0;
  int views = 0;
  int balls = 0;
  int covered = 0;

  void add(const Tally& tally) {
    marked += tally.marked;
    truly += tally.truly;
    views += tally.views;
    balls += tally.balls;
    covered += tally.covered;
  }

  void add_rows(Report& report) const {
    const std::string name = "all worlds pooled, estimated";
    report.rows.push_back(share_row(name, "ball's shade covered", covered, balls));
    report.rows.push_back(figure(name, "area factor", "", marked / truly, views));
  }
};

Result<void> add_cost(const Setting& setting, Report& report) {
  setting.progress("counting instructions");
  const auto counted =
      count_lab({"shade", "--seed", std::to_string(setting.seed), "--views", std::to_string(kCountedViews)}, "");
  if (!counted) return tl::unexpected(counted.error());
  const int turns = counted->images - kCountedViews;
  for (const auto& [stage, cost] : counted->stages) {
    const int images = stage == "new_lamp" ? turns : kCountedViews;
    const std::string row = "home, cost, " + stage;
    report.rows.push_back(figure(row, "mean", "Minstr", cost.mean_minstr, images));
    report.rows.push_back(
        plain_row(row, "worst", "Minstr", cost.worst_minstr, static_cast<std::size_t>(images), Join::kMax));
  }
  report.rows.push_back(figure("home, cost, new_lamp", "turns", "", turns, 1));
  return {};
}

}  // namespace

Result<void> look_at_shade(std::uint64_t seed, int views) {
  const auto robot = lamp_robot({});
  if (!robot) return tl::unexpected(robot.error());
  auto place = Place::make("home");
  if (!place) return tl::unexpected(place.error());
  auto told = survey(**place, sim::CalibrationErrors::none(), 0);
  if (!told) return tl::unexpected(told.error());
  const TrueEdges edges((*place)->scene());
  Random random = Random(seed).fork(0x542);
  const illumination::KnownLamp lamp = kStated.lamp((*place)->state().lamps[0].p_WL);
  stages::ShadeStage stage(std::make_shared<const world::Map>(told->map), told->camera, robot->shade);
  const auto update = [&](const geometry::Pose& X_WC, const char* mark) {
    auto budget = budget_of(row_of<stages::ShadeStage>(*robot));
    count_stage_begin();
    const auto masks = stage.update(budget, X_WC, kStated.pose(), &lamp);
    count_stage_end(mark);
    return masks && masks->masks;
  };
  for (int view = 0; view <= views; ++view) {
    const auto stand = draw_standpoint(**place, edges, area_of("home"), {}, random);
    if (!stand) return fail("there is no standpoint in the home");
    // A new place of the lamp is worked on in the first turns; it gives no masks yet.
    for (bool masked = view > 0; !masked;) {
      masked = update(stand->X_WC, "new_lamp");
      if (!masked) count_image_end();
    }
    if (view > 0) update(stand->X_WC, "new_view");
    update(stand->X_WC, "nothing_moved");
    count_image_end();
  }
  return {};
}

Result<Report> section_5_4_2(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  Report report;
  const int trials = setting.trials;
  report.title =
      fmt::format("shaded regions beside the ray tracer's, {} views a world, each under a lamp of its own", trials);
  Pooled pooled;
  for (const std::string_view world : kWorlds) {
    const std::string name(world);
    auto room = Room::make(name, *robot, setting.seed);
    if (!room) return tl::unexpected(room.error());
    Random random = Random(setting.seed).fork(0x5420 + name.size());
    Tally tally;
    while (tally.views < trials) {
      if (!(*room)->draw(random)) return fail(fmt::format("{}: no view with shade in it was found", name));
      if (auto judged = (*room)->judge(random, tally); !judged) return tl::unexpected(judged.error());
      setting.progress(fmt::format("{}: {} of {}", name, tally.views, trials));
    }
    add_rows(name, tally, setting.seed, report);
    pooled.add(tally);
  }
  pooled.add_rows(report);
  if (setting.count) {
    if (auto done = add_cost(setting, report); !done) return tl::unexpected(done.error());
  }
  report.notes = {
      "Masks have 160x120 cells. A cell's truth is that of the ray through its middle; a point counts as shaded when "
      "the map hides the lamp's "
      "centre from it.",
      "Views are drawn at random on the floor, lamps at random at 2.2 to 2.8 m; a view counts in which 100 cells or "
      "more, but not nine tenths of "
      "all, may be shaded. IoU and area factor are over the cells of all views together, and the mean of the images.",
      fmt::format("Estimated: the map with its corners off by 0.5 cm, the camera by N(0, {:.1f} cm) and N(0, {:.2f} "
                  "deg), the lamp by N(0, {:.1f} "
                  "cm), each axis; the mask is told these errors, not what they were.",
                  100.0 * kStated.place_sigma_m, kStated.turn_sigma_rad * 57.29578, 100.0 * kStated.lamp_sigma_m),
      "A ball of 20 cm hangs anywhere in view where some pixel of it lies in shade, often at a volume's border; "
      "covered: every such pixel is in the "
      "mask.",
      "Pooled: the cells of all views of all worlds together, and all balls; a world by itself may have hardly any "
      "shade.",
      "The stage shade with the robot's units; each view is that of a robot that has just got to know its lamp.",
      "new_view: the lamp stays and the camera moved; new_lamp: a turn that works on a new place of the lamp, or the "
      "first one with its masks."};
  return report;
}

}  // namespace cgsr::lab
