#include "tools/map/refine_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "pipeline/localization/perceive.h"
#include "pipeline/mapping/moved_parts.h"
#include "pipeline/mapping/obj_map.h"
#include "pipeline/mapping/propose.h"
#include "pipeline/mapping/refine.h"
#include "pipeline/world/load.h"
#include "src/input/camera_file.h"
#include "src/input/image_input.h"
#include "src/input/pose_file.h"
#include "src/input/robot_calibration.h"
#include "src/output/output_claims.h"
#include "src/output/picture.h"
#include "src/output/progress.h"
#include "src/output/text_file.h"
#include "tools/map/proposal_file.h"
#include "tools/map/proposal_sheet.h"

namespace cgsr::app {
namespace {

constexpr std::size_t kFewestViews = 3;
constexpr int kUnseenAfter = 5;  // images that should show an edge, from which on it is reported that none does

Result<void> claim_outputs(const RefineOptions& options) {
  OutputClaims files(options.force);
  files.reads(options.map, "the map");
  files.reads(options.camera, "--camera");
  files.reads(options.input, "--input");
  files.reads(options.poses, "--poses");
  files.reads(options.odometry, "--odometry");
  files.reads(options.mount, "--mount");
  FileKind obj{.name = "an OBJ map",
               .is = [](std::string_view text) { return text.find("\nv ") != text.npos; },
               .endings = {".obj"}};
  files.writes(options.output, "--output", obj);
  files.writes(options.proposals, "--proposals", obj);
  files.writes(options.picture, "--picture", picture_file());
  files.writes(options.json, "--json", json_object());
  return files.claim();
}

const PoseRow* row_of(const std::vector<PoseRow>& rows, std::int64_t frame) {
  if (!rows.front().frame) {
    return static_cast<std::size_t>(frame) < rows.size() ? &rows[static_cast<std::size_t>(frame)] : nullptr;
  }
  const auto found = std::ranges::lower_bound(rows, frame, {}, [](const PoseRow& row) { return *row.frame; });
  return found != rows.end() && *found->frame == frame ? &*found : nullptr;
}

Result<geometry::Pose> mount_of(const RefineOptions& options) {
  if (options.mount.empty()) return geometry::Pose::Identity();
  return std::filesystem::path(options.mount).extension() == ".toml" ? read_mount(options.mount)
                                                                     : read_pose(options.mount);
}

/// What the images show, each with its pose; images without one are passed by.
struct Drive {
  std::vector<mapping::View> views;
  geometry::Camera camera;  ///< that the views' edges are of: without distortion.
  geometry::Camera lens;    ///< of the images.
};

Result<Drive> read_drive(const RefineOptions& options) {
  const auto camera = read_camera(options.camera);
  if (!camera) return tl::unexpected(camera.error());
  const auto poses = read_poses(options.poses);
  if (!poses) return tl::unexpected(poses.error());
  std::vector<PoseRow> odometry;
  if (!options.odometry.empty()) {
    auto read = read_poses(options.odometry);
    if (!read) return tl::unexpected(read.error());
    odometry = std::move(*read);
  }
  const auto X_RC = mount_of(options);
  if (!X_RC) return tl::unexpected(X_RC.error());
  auto input = ImageInput::open({.path = options.input});
  if (!input) return tl::unexpected(input.error());
  if (input->mode().width_px != camera->width_px || input->mode().height_px != camera->height_px) {
    return fail(fmt::format("{}: images of {} x {} px: expected {} x {}, the size of the camera in {}", options.input,
                            input->mode().width_px, input->mode().height_px, camera->width_px, camera->height_px,
                            options.camera));
  }
  localization::Perception perception(*camera);
  Drive drive{{}, perception.camera(), *camera};
  const PoseRow* odometry_before = nullptr;
  for (std::int64_t frame = 0;; ++frame) {
    auto next = input->next();
    if (next.end) break;
    const PoseRow* pose = row_of(*poses, frame);
    if (!next.image || pose == nullptr || !pose->corrected) continue;
    mapping::View view;
    view.number = frame;
    const double m = pose->sigma_m.value_or(options.sigma_m);
    const double rad = pose->sigma_rad.value_or(options.sigma_deg * std::numbers::pi / 180.0);
    constexpr double kLeast = 1e-4;
    view.given = localization::prior_at(pose->X, {.x_m = std::max(m, kLeast),
                                                  .y_m = std::max(m, kLeast),
                                                  .z_m = std::max(m, kLeast),
                                                  .heading_rad = std::max(rad, kLeast),
                                                  .tilt_rad = std::max(rad, kLeast)});
    view.X_WC = pose->X;
    const PoseRow* now = odometry.empty() ? nullptr : row_of(odometry, frame);
    if (now != nullptr && odometry_before != nullptr) {
      view.X_CB = X_RC->inverse() * odometry_before->X.inverse() * now->X * *X_RC;
    }
    odometry_before = now;
    view.edges = localization::SegmentTable(1);
    if (perception.perceive(next.image.view(), nullptr) == localization::Reason::kNone) view.edges = perception.edges();
    drive.views.push_back(std::move(view));
  }
  if (drive.views.size() < kFewestViews) {
    return fail(fmt::format("{}: {} images of {} have a corrected pose: expected {} or more", options.poses,
                            drive.views.size(), options.input, kFewestViews));
  }
  return drive;
}

double mean_over(const mapping::Part& part, const std::vector<double>& values) {
  double sum = 0.0;
  for (const std::uint32_t corner : part.corners) sum += values[corner];
  return sum / static_cast<double>(part.corners.size());
}

nlohmann::ordered_json report_of(const mapping::ElasticMap& map, const mapping::Refined& refined,
                                 const std::vector<mapping::Proposal>& proposals,
                                 const std::vector<mapping::MovedPart>& moved_parts, const Drive& drive,
                                 double map_sigma_m) {
  nlohmann::ordered_json json;
  json["images"] = drive.views.size();
  json["matches"] = refined.observed.matches.size();
  json["parts"] = nlohmann::ordered_json::array();
  std::vector<double> moved(refined.corners.size());
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = (refined.corners[i] - map.measured()[i]).norm();
  std::vector<int> unseen(map.parts().size(), 0);
  for (std::uint32_t i = 0; i < refined.observed.edges.size(); ++i) {
    const mapping::EdgeSeen& seen = refined.observed.edges[i];
    if (seen.expected >= kUnseenAfter && seen.matched == 0) ++unseen[map.part_of(map.ends_of(i)[0])];
  }
  for (std::size_t p = 0; p < map.parts().size(); ++p) {
    const mapping::Part& part = map.parts()[p];
    int observations = 0;
    for (const std::uint32_t corner : part.corners) observations += refined.observations[corner];
    nlohmann::ordered_json entry{{"name", part.name},
                                 {"corners", part.corners.size()},
                                 {"moved_m", mean_over(part, moved)},
                                 {"sigma_before_m", map_sigma_m},
                                 {"sigma_after_m", nullptr},
                                 {"observations", observations},
                                 {"edges_not_seen", unseen[p]}};
    if (!refined.sigma_m.empty()) entry["sigma_after_m"] = mean_over(part, refined.sigma_m);
    json["parts"].push_back(entry);
  }
  json["proposals"] = nlohmann::ordered_json::array();
  for (const mapping::Proposal& line : proposals) {
    json["proposals"].push_back({{"a_m", {line.a.x(), line.a.y(), line.a.z()}},
                                 {"b_m", {line.b.x(), line.b.y(), line.b.z()}},
                                 {"images", line.images},
                                 {"rms_px", line.rms_px},
                                 {"of_moved_part", line.part}});
  }
  json["moved_parts"] = nlohmann::ordered_json::array();
  for (const mapping::MovedPart& part : moved_parts) {
    json["moved_parts"].push_back({{"name", map.parts()[part.part].name},
                                   {"shift_m", {part.shift.x(), part.shift.y(), part.shift.z()}},
                                   {"share_here", part.share_here},
                                   {"share_there", part.share_there},
                                   {"images", part.images}});
  }
  return json;
}

void print(const nlohmann::ordered_json& json) {
  fmt::print("{} images, {} matches\n", json["images"].get<int>(), json["matches"].get<int>());
  fmt::print("{:32} {:>10} {:>10} {:>13} {:>15}\n", "part", "moved cm", "sigma cm", "observations", "edges not seen");
  for (const auto& part : json["parts"]) {
    const double sigma = part["sigma_after_m"].is_null() ? NAN : part["sigma_after_m"].get<double>();
    fmt::print("{:32} {:10.1f} {:10.1f} {:13} {:15}\n", part["name"].get<std::string>(),
               100.0 * part["moved_m"].get<double>(), 100.0 * sigma, part["observations"].get<int>(),
               part["edges_not_seen"].get<int>());
  }
  for (const auto& part : json["moved_parts"]) {
    fmt::print("{} seems to be ({:.2f}, {:.2f}, {:.2f}) m from where it was measured: its edges there are proposed\n",
               part["name"].get<std::string>(), part["shift_m"][0].get<double>(), part["shift_m"][1].get<double>(),
               part["shift_m"][2].get<double>());
  }
  fmt::print("{} new edges proposed, nothing removed\n", json["proposals"].size());
}

std::filesystem::path from_output_to_map(const RefineOptions& options) {
  const auto folder = [](const std::string& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file)).parent_path();
  };
  const auto way = folder(options.map).lexically_relative(folder(options.output));
  return way == "." ? std::filesystem::path() : way;
}

}  // namespace

Result<void> run_refine(const RefineOptions& options) {
  if (auto claimed = claim_outputs(options); !claimed) return claimed;
  const auto file = mapping::read_obj(options.map);
  if (!file) return tl::unexpected(file.error());
  auto loaded = world::load_map(options.map);
  if (!loaded) return tl::unexpected(loaded.error());
  auto map = mapping::ElasticMap::make(*file, std::move(*loaded), options.parameters);
  if (!map) return fail(fmt::format("{}: {}", options.map, map.error().message));
  auto drive = read_drive(options);
  if (!drive) return tl::unexpected(drive.error());
  Progress progress;
  const auto refined =
      mapping::refine(*map, drive->views, drive->camera, options.parameters,
                      [&](int round, const mapping::Adjusted&) { progress.show(fmt::format("round {}", round + 1)); });
  auto proposals = mapping::propose_edges(*map, drive->views, drive->camera, {}, options.parameters);
  const auto moved = mapping::find_moved_parts(*map, drive->views, drive->camera, options.parameters);
  for (const mapping::MovedPart& part : moved) {
    proposals.insert(proposals.end(), part.edges.begin(), part.edges.end());
  }
  const auto text = mapping::obj_text(*file, map->points(*file, refined.corners), from_output_to_map(options));
  if (auto written = write_file(options.output, text); !written) return written;
  if (!options.proposals.empty()) {
    if (auto written = write_file(options.proposals, proposals_as_obj(proposals)); !written) return written;
  }
  if (!options.picture.empty()) {
    const auto sheet = proposal_sheet(proposals, drive->views, drive->lens, options.input);
    if (!sheet) return tl::unexpected(sheet.error());
    if (auto written = write_picture(options.picture, *sheet); !written) return written;
  }
  const auto json = report_of(*map, refined, proposals, moved, *drive, options.parameters.map_sigma_m);
  if (!options.json.empty()) {
    if (auto written = write_file(options.json, json.dump(1) + "\n"); !written) return written;
  }
  print(json);
  return {};
}

}  // namespace cgsr::app
