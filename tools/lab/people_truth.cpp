#include "tools/lab/people_truth.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "hal/sim/render/truth_images.h"
#include "platform/config/reader.h"

namespace cgsr::lab {
namespace {

constexpr int kWidth_px = 160, kHeight_px = 120;                  // enough for a quarter of a shirt
constexpr double kFrontal_rad = 30.0 * std::numbers::pi / 180.0;  // to which the cascade finds faces
constexpr int kMinSilhouette_px = 12;  // of a shirt or head inside the image: less is a sliver at its edge

double share(const sim::FigureView& view) {
  return view.whole_px >= kMinSilhouette_px ? static_cast<double>(view.visible_px) / view.whole_px : 0.0;
}

bool faces(const sim::Pose& X_WH, const sim::Pose& X_WC) {
  const Eigen::Vector3d to_camera = X_WC.translation() - X_WH.translation();
  const Eigen::Vector3d ahead = X_WH.linear().col(0);
  const double aside = std::atan2(ahead.y(), ahead.x()) - std::atan2(to_camera.y(), to_camera.x());
  return std::abs(std::remainder(aside, 2.0 * std::numbers::pi)) <= kFrontal_rad;
}

}  // namespace

Result<PeopleTruth> PeopleTruth::of(const std::filesystem::path& world) {
  const auto spec = config::read_file<sim::WorldSpec>(world);
  if (!spec) return tl::unexpected(spec.error());
  auto built = sim::build_world(*spec, world);
  if (!built) return tl::unexpected(built.error());
  PeopleTruth truth(std::make_unique<sim::World>(std::move(*built)));
  const sim::Scene& scene = truth.world_->scene;
  if (scene.robots.size() != 1) return fail(fmt::format("{}: has {} robots", world.string(), scene.robots.size()));
  for (const sim::PersonSpec& person : spec->person) {
    Person& found = truth.people_.emplace_back();
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      const sim::Part& part = scene.parts[i];
      if (part.name != person.name + "/head" && part.name != person.name + "/shirt") continue;
      found.figure = part.figure;
      const bool is_head = part.name == person.name + "/head";
      if (is_head) found.head_joint = part.joint;
      (is_head ? found.head : found.shirt).push_back(static_cast<int>(i));
    }
    if (found.head.empty() || found.shirt.empty())
      return fail(fmt::format("{}: '{}' has no head or no shirt", world.string(), person.name));
  }
  auto photographer = sim::Photographer::make(scene, scene.robots.front().camera.scaled_to(kWidth_px, kHeight_px), {});
  if (!photographer) return tl::unexpected(photographer.error());
  truth.photographer_ = std::move(*photographer);
  return truth;
}

std::vector<PersonView> PeopleTruth::at(double time_s) {
  const std::vector<sim::Pose> X_WR = sim::scripted_robots(*world_, time_s);
  const sim::Pose X_WC = X_WR.front() * sim::mount_of(world_->scene.robots.front());
  const sim::SceneState state = sim::state_at(world_->scene, time_s, {}, X_WR);
  sim::Renderer& renderer = photographer_->renderer();
  renderer.move_to(state);
  std::vector<PersonView> views;
  for (const Person& person : people_) {
    const sim::Pose& X_WH =
        state.X_WJ[static_cast<std::size_t>(person.figure)][static_cast<std::size_t>(person.head_joint)];
    views.push_back({share(sim::figure_view(renderer, state, X_WC, person.figure, person.shirt)),
                     share(sim::figure_view(renderer, state, X_WC, person.figure, person.head)), faces(X_WH, X_WC)});
  }
  return views;
}

}  // namespace cgsr::lab
