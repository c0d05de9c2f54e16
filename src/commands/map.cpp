#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/render/depth_raster.h"
#include "pipeline/world/clean.h"
#include "pipeline/world/compact.h"
#include "pipeline/world/index.h"
#include "pipeline/world/load.h"
#include "platform/clock.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/hand_over.h"
#include "src/commands/map_options.h"
#include "src/commands/option_checks.h"
#include "src/input/camera_file.h"
#include "src/input/pose_file.h"
#include "src/input/ros_map.h"
#include "src/output/map_view.h"
#include "src/output/picture.h"

namespace cgsr::app {
namespace {

struct Options {
  std::string file;
  world::LoadOptions load;
  std::optional<double> wall_height_m;  ///< of a ROS map.
  world::WallParameters walls;
  bool json = false;
  std::string output;
  std::string camera;
  std::string pose;
  std::string image;
  bool force = false;
};

Result<void> claim_output(const Options& options, const FileKind& kind) {
  OutputClaims files(options.force);
  files.reads(options.file, "the map");
  files.reads(options.camera, "--camera");
  files.reads(options.pose, "--pose");
  files.reads(options.image, "--image");
  files.writes(options.output, "--output", kind);
  return files.claim();
}

Result<world::Map> load(const Options& options) {
  return world::load_map(options.file, options.load);
}

struct Summary {
  world::Bounds box;
  std::array<int, 4> kinds{};
  int against_something = 0;  ///< borders that end at or lie on a surface.
  double index_ms = 0.0;
  std::size_t index_bytes = 0;
  std::size_t index_nodes = 0;
};

constexpr std::array<const char*, 4> kKinds = {"crease", "border", "material", "drawn"};

Summary summary_of(const world::Map& map) {
  Summary summary;
  for (const Eigen::Vector3f& p : map.vertices) summary.box.add(p);
  for (const world::Edge& edge : map.edges) {
    ++summary.kinds[static_cast<std::size_t>(edge.kind)];
    summary.against_something += edge.kind == world::EdgeKind::kBorder && edge.sides[1] != world::kNone ? 1 : 0;
  }
  const RealClock clock;
  const MonoTime begin = clock.now();
  const world::Index index(map);
  summary.index_ms = 1e3 * to_seconds(clock.now() - begin);
  summary.index_bytes = index.bytes();
  summary.index_nodes = index.nodes();
  return summary;
}

nlohmann::ordered_json json_of(const Options& options, const world::Map& map, const Summary& summary) {
  nlohmann::ordered_json json;
  json["file"] = options.file;
  json["vertices"] = map.vertices.size();
  json["triangles"] = map.triangles.size();
  json["surfaces"] = map.surfaces.size();
  json["edges"] = map.edges.size();
  for (std::size_t i = 0; i < kKinds.size(); ++i) json["edges_by_kind"][kKinds[i]] = summary.kinds[i];
  json["borders_on_a_surface"] = summary.against_something;
  for (const auto& [name, corner] : {std::pair{"low_m", summary.box.low}, std::pair{"high_m", summary.box.high}})
    json[name] = {corner[0], corner[1], corner[2]};
  json["materials"] = nlohmann::ordered_json::array();
  for (const world::Material& material : map.materials) {
    nlohmann::ordered_json entry;
    entry["name"] = material.name;
    entry["known_color"] = material.known_color;
    entry["color"] = {material.color[0], material.color[1], material.color[2]};
    json["materials"].push_back(entry);
  }
  json["index"] = {{"nodes", summary.index_nodes}, {"bytes", summary.index_bytes}, {"build_ms", summary.index_ms}};
  return json;
}

void print(const world::Map& map, const Summary& summary) {
  const auto& [low, high] = summary.box;
  fmt::print("surfaces  {} of {} triangles, {} vertices\n", map.surfaces.size(), map.triangles.size(),
             map.vertices.size());
  fmt::print("edges     {}", map.edges.size());
  for (std::size_t i = 0; i < kKinds.size(); ++i)
    fmt::print("{} {} {}", i == 0 ? ":" : ",", summary.kinds[i], kKinds[i]);
  fmt::print("; {} borders lie on a surface or end at one\n", summary.against_something);
  fmt::print("extent    x {:.3f} to {:.3f} m, y {:.3f} to {:.3f} m, z {:.3f} to {:.3f} m\n", low[0], high[0], low[1],
             high[1], low[2], high[2]);
  fmt::print("index     {} nodes, {:.1f} kB, built in {:.1f} ms\n", summary.index_nodes,
             static_cast<double>(summary.index_bytes) / 1e3, summary.index_ms);
  for (const world::Material& material : map.materials) {
    if (material.known_color) {
      fmt::print("material  {}  {:.3f} {:.3f} {:.3f}\n", material.name, material.color[0], material.color[1],
                 material.color[2]);
    } else {
      fmt::print("material  {}  colour not known\n", material.name);
    }
  }
}

int run_info(const Options& options) {
  const auto map = load(options);
  if (!map) return report(map.error());
  const Summary summary = summary_of(*map);
  if (options.json) {
    fmt::print("{}\n", json_of(options, *map, summary).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    print(*map, summary);
  }
  return kSuccess;
}

bool is_ros_map(const std::string& file) {
  const auto ending = std::filesystem::path(file).extension();
  return ending == ".yaml" || ending == ".yml";
}

/// Walls of the given height along the borders of a ROS map's occupied cells, and how well they keep to them.
Result<world::Map> walls_of_ros_map(const Options& options) {
  if (!options.wall_height_m) {
    return fail(fmt::format("{}: a ROS map says nothing of heights: expected --wall-height METRES", options.file));
  }
  const auto grid = read_ros_map(options.file);
  if (!grid) return tl::unexpected(grid.error());
  const auto plan = world::walls_of(*grid, options.walls);
  if (!plan) return fail(fmt::format("{}: {}", options.file, plan.error().message));
  fmt::print(
      "walls     {} of {:.1f} m in all; {:.1f} % of {} border cells lie at a wall, {:.1f} % of the walls at an "
      "occupied cell (within {:.3f} m)\n",
      plan->walls.size(), plan->length_m, 100.0 * plan->covered, plan->border_cells, 100.0 * plan->supported,
      options.walls.tolerance_m + grid->cell_m);
  return world::clean(world::soup_of(*plan, *options.wall_height_m), options.load.weld_m, options.load.lies_on_m);
}

int run_import(const Options& options) {
  if (const auto claimed = claim_output(options, compact_map()); !claimed) return report(claimed.error());
  const auto map = is_ros_map(options.file) ? walls_of_ros_map(options) : load(options);
  if (!map) return report(map.error());
  if (const auto written = world::write_compact(*map, options.output); !written) return report(written.error());
  const auto back = world::load_map(options.output);
  if (!back) return report(back.error());
  print(*back, summary_of(*back));
  return kSuccess;
}

/// The map's edges as a camera at the pose sees them, over an image or over the map's own surfaces.
int run_picture(const Options& options) {
  if (const auto claimed = claim_output(options, picture_file()); !claimed) return report(claimed.error());
  const auto map = load(options);
  if (!map) return report(map.error());
  const auto camera = read_camera(options.camera);
  if (!camera) return report(camera.error());
  const auto X_WC = read_pose(options.pose);
  if (!X_WC) return report(X_WC.error());
  cv::Mat picture;
  if (options.image.empty()) {
    picture = draw_surfaces(*map, world::Index(*map), *X_WC, *camera);
  } else {
    auto image = read_picture(options.image, *camera, options.camera);
    if (!image) return report(image.error());
    picture = std::move(*image);
  }
  render::RasterParameters parameters;
  parameters.width = 640;
  parameters.height = 480;
  parameters.max_surfaces = parameters.max_triangles = parameters.max_edges = parameters.max_visited = 10'000'000;
  render::DepthRaster raster(*map, parameters);
  std::vector<render::VisiblePiece> pieces;
  pieces.reserve(map->edges.size() + 10'000);
  raster.look(*X_WC, *camera, pieces);
  draw_pieces(*map, pieces, *camera, picture);
  if (const auto written = write_picture(options.output, picture); !written) return report(written.error());
  fmt::print("{}: {} visible pieces of {} edges\n", options.output, pieces.size(), map->edges.size());
  return kSuccess;
}

void add_load_options(CLI::App& command, Options& options) {
  command.add_option("map", options.file, ".obj, .gltf, .glb, .cao or .cgsrmap")->required();
  add_map_frame_options(command, options.load);
  command.add_option("--weld", options.load.weld_m, "corners closer than this are one, in metres")
      ->check(in_range(1e-6, 1.0))
      ->capture_default_str();
  command
      .add_option("--lies-on", options.load.lies_on_m, "what is closer than this to a surface lies on it, in metres")
      ->check(in_range(1e-3, 1.0))
      ->capture_default_str();
}

/// Bundle adjustment links Ceres, the robot's program does not.
void add_refine(CLI::App& map, int& exit_code) {
  auto* command = map.add_subcommand("refine", "move the map's parts to where the images of a drive show them");
  command->footer("cgsr map refine --help explains the rest.");
  command->set_help_flag();  // --help too is for the program that answers
  command->allow_extras();
  command->prefix_command();
  command->callback([command, &exit_code] { exit_code = hand_over("cgsr-map", command->remaining()); });
}

}  // namespace

void add_map_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("map", "a robot's map: what is in it, a compact copy, how it looks");
  command->require_subcommand(1);

  auto* info = command->add_subcommand("info", "surfaces, edges, extent, materials, and what the index costs");
  add_load_options(*info, *options);
  info->add_flag("--json", options->json, "as JSON");
  info->callback([options, &exit_code] { exit_code = run_info(*options); });

  auto* importing =
      command->add_subcommand("import", "write the cleaned-up map with its edges as a compact, checked copy");
  add_load_options(*importing, *options);
  importing->add_option("--output", options->output, "the copy: NAME.cgsrmap")->required();
  importing
      ->add_option("--wall-height", options->wall_height_m,
                   "of a ROS map (map.yaml): how high its walls are, in metres")
      ->check(in_range(0.1, 20.0));
  importing
      ->add_option("--wall-tolerance", options->walls.tolerance_m,
                   "of a ROS map: how far a straight wall may leave the border of the occupied cells, in metres")
      ->check(in_range(1e-3, 1.0))
      ->capture_default_str();
  importing
      ->add_option("--min-wall", options->walls.min_length_m,
                   "of a ROS map: shorter groups of occupied cells are left out, in metres")
      ->check(in_range(0.0, 10.0))
      ->capture_default_str();
  add_force_option(*importing, options->force);
  importing->callback([options, &exit_code] { exit_code = run_import(*options); });

  const auto add_view = [&](CLI::App& view) {
    add_load_options(view, *options);
    view.add_option("--camera", options->camera, "intrinsics (YAML, as ROS writes them)")->required();
    view.add_option("--pose", options->pose, "where the camera is in the map: CSV of one row")->required();
    view.add_option("--output", options->output, "the picture")->required();
    add_force_option(view, options->force);
    view.callback([options, &exit_code] { exit_code = run_picture(*options); });
  };
  add_view(*command->add_subcommand("render", "the map and its visible edges, seen from a pose"));
  auto* overlay = command->add_subcommand("overlay", "the map's visible edges over an image");
  overlay->add_option("--image", options->image, "of the camera's size")->required();
  add_view(*overlay);
  add_refine(*command, exit_code);
}

}  // namespace cgsr::app
