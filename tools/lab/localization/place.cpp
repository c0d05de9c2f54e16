#include "tools/lab/localization/place.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "hal/sim/calibration/map_file.h"
#include "pipeline/world/load.h"
#include "platform/config/reader.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {

Result<std::unique_ptr<Place>> Place::make(const std::string& world, const Change& change) {
  const std::filesystem::path file = std::filesystem::path(source_path("config/worlds")) / (world + ".toml");
  auto spec = config::read_file<sim::WorldSpec>(file);
  if (!spec) return tl::unexpected(spec.error());
  return make(std::move(*spec), file.string(), change);
}

Result<std::unique_ptr<Place>> Place::make(sim::WorldSpec spec, const std::string& name, const Change& change) {
  spec.ball.clear();
  spec.object.clear();
  spec.person.clear();
  if (change) change(spec);
  auto built = sim::build_world(spec, name);
  if (!built) return tl::unexpected(built.error());
  std::unique_ptr<Place> place(new Place(std::move(*built)));
  sim::SwitchStates on;
  for (const sim::Lamp& lamp : place->scene().lamps) on[lamp.switch_name] = true;
  place->state_ = sim::state_at(place->scene(), 0.0, on);  // no robot: the camera hangs in the air
  auto photographer =
      sim::CachedPhotographer::make(place->scene(), place->camera(), {}, {.folder = sim::image_cache_folder()});
  if (!photographer) return tl::unexpected(photographer.error());
  place->photographer_ = std::move(*photographer);
  place->renderer().move_to(place->state_);
  return place;
}

Photograph Place::photograph(const geometry::Pose& X_WC, std::uint32_t seed, std::uint64_t number) {
  Photograph photo;
  photo.width_px = camera().width_px;
  photo.height_px = camera().height_px;
  photo.yuyv.resize(std::size_t{2} * static_cast<std::size_t>(photo.width_px * photo.height_px));
  photographer_->take({{state_, X_WC}}, world_.sensor, {seed, number},
                      {photo.yuyv.data(), photo.width_px, photo.height_px, std::ptrdiff_t{2} * photo.width_px});
  return photo;
}

geometry::Camera camera_of(const sim::CameraModel& c) {
  return {c.width_px, c.height_px, c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3};
}

Result<world::Map> map_of(const sim::Scene& measured) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("cgsr-lab-{}-map", getpid());
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  auto written = sim::write_map(measured, folder / "map.obj", "a measured copy");
  auto map = written ? world::load_map(folder / "map.obj") : tl::unexpected(written.error());
  std::filesystem::remove_all(folder, ignored);
  return map;
}

Result<Survey> survey(const Place& place, const sim::CalibrationErrors& errors, std::uint32_t seed,
                      const std::function<void(sim::Scene&)>& change) {
  sim::CalibratedCopy copy = sim::calibrated_copy(place.scene(), 0, errors, seed);
  if (change) change(copy.map);
  auto map = map_of(copy.map);
  if (!map) return tl::unexpected(map.error());
  return Survey{camera_of(copy.camera), copy.X_RC, std::move(*map)};
}

}  // namespace cgsr::lab
