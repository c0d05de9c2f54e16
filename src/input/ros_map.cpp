#include "src/input/ros_map.h"

#include <optional>
#include <string>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/world/map_folder.h"
#include "src/input/small_file.h"
#include "src/input/yaml_reader.h"
#include "src/output/picture_size.h"

namespace cgsr::app {
namespace {

constexpr std::size_t kLargest_bytes = 65536;

struct MapFile {
  world::OccupancyGrid grid;
  std::filesystem::path image;
  bool negate = false;
  double occupied_threshold = 0.65;
};

Result<std::string> text_at(const YamlReader& yaml, const char* key, const char* expected) {
  const YAML::Node node = yaml.root()[key];
  if (!node) return tl::unexpected(yaml.missing(key, expected));
  if (!node.IsScalar() || node.Scalar().empty()) {
    return tl::unexpected(
        yaml.wrong(node, fmt::format("{} holds '{}': expected {}", key, YamlReader::shown(node), expected)));
  }
  return node.Scalar();
}

Result<void> read_place(const YamlReader& yaml, world::OccupancyGrid& grid) {
  const auto resolution = yaml.number_at("resolution", "the side of a cell in metres");
  if (!resolution) return tl::unexpected(resolution.error());
  if (*resolution < 0.001 || *resolution > 1.0) {
    return tl::unexpected(
        yaml.wrong(yaml.root()["resolution"], fmt::format("resolution is {}: expected 0.001..1 m", *resolution)));
  }
  const YAML::Node node = yaml.root()["origin"];
  constexpr const char* kExpected = "[x, y, yaw] of the lower left corner";
  if (!node) return tl::unexpected(yaml.missing("origin", kExpected));
  if (!node.IsSequence() || node.size() != 3) {
    return tl::unexpected(
        yaml.wrong(node, fmt::format("origin holds '{}': expected {}", YamlReader::shown(node), kExpected)));
  }
  const auto origin = yaml.numbers(node, "origin");
  if (!origin) return tl::unexpected(origin.error());
  grid.cell_m = *resolution;
  grid.p_WO = {(*origin)[0], (*origin)[1]};
  grid.yaw_rad = (*origin)[2];
  return {};
}

Result<void> read_thresholds(const YamlReader& yaml, MapFile& map) {
  if (const YAML::Node mode = yaml.root()["mode"]; mode && (!mode.IsScalar() || mode.Scalar() != "trinary")) {
    return tl::unexpected(yaml.wrong(mode, fmt::format("mode is '{}': expected trinary", YamlReader::shown(mode))));
  }
  const auto threshold = yaml.number_at("occupied_thresh", "the darkness, 0..1, from which a cell is occupied");
  if (!threshold) return tl::unexpected(threshold.error());
  if (*threshold < 0.0 || *threshold >= 1.0) {
    return tl::unexpected(
        yaml.wrong(yaml.root()["occupied_thresh"],
                   fmt::format("occupied_thresh is {}: expected at least 0 and less than 1", *threshold)));
  }
  map.occupied_threshold = *threshold;
  const auto negate = text_at(yaml, "negate", "0 or 1");
  if (!negate) return tl::unexpected(negate.error());
  map.negate = *negate == "1" || *negate == "true";
  if (!map.negate && *negate != "0" && *negate != "false") {
    return tl::unexpected(yaml.wrong(yaml.root()["negate"], fmt::format("negate is '{}': expected 0 or 1", *negate)));
  }
  return {};
}

Result<MapFile> parse(const YamlReader& yaml, const std::filesystem::path& file) {
  if (auto once = yaml.refuse_doubled_keys(); !once) return tl::unexpected(once.error());
  MapFile map;
  const auto image = text_at(yaml, "image", "the name of the map's image");
  if (!image) return tl::unexpected(image.error());
  const auto found = world::MapFolder(file).find(file.parent_path() / *image);
  if (!found) return tl::unexpected(yaml.wrong(yaml.root()["image"], found.error().message));
  map.image = *found;
  if (auto read = read_place(yaml, map.grid); !read) return tl::unexpected(read.error());
  if (auto read = read_thresholds(yaml, map); !read) return tl::unexpected(read.error());
  return map;
}

Result<MapFile> read_map_file(const std::filesystem::path& file) {
  const auto text = read_small_file(file, kLargest_bytes, "a ROS map");
  if (!text) return tl::unexpected(text.error());
  const std::string name = file.string();
  try {
    const YAML::Node root = YAML::Load(*text);
    if (!root.IsMap()) return fail(fmt::format("{}: is no ROS map: expected image:, resolution: and so on", name));
    return parse(YamlReader(root, name), file);
  } catch (const YAML::Exception& error) {
    return fail(fmt::format("{}:{}: is no ROS map: {}", name, error.mark.line + 1, error.msg));
  }
}

}  // namespace

Result<world::OccupancyGrid> read_ros_map(const std::filesystem::path& file) {
  auto map = read_map_file(file);
  if (!map) return tl::unexpected(map.error());
  const std::string name = map->image.string();
  const std::optional<cv::Size> size = size_in_header(name);
  if (!size) return fail(fmt::format("{}: no image that can be read: expected PGM, PNG or BMP", name));
  if (size->height > kMaxMapCells / size->width) {
    return fail(
        fmt::format("{}: {} x {} cells: expected at most {} in all", name, size->width, size->height, kMaxMapCells));
  }
  const cv::Mat grey = cv::imread(name, cv::IMREAD_GRAYSCALE);
  if (grey.empty()) return fail(fmt::format("{}: no image that can be read: expected PGM, PNG or BMP", name));
  world::OccupancyGrid grid = map->grid;
  grid.columns = grey.cols;
  grid.rows = grey.rows;
  grid.occupied.reserve(grey.total());
  for (int row = 0; row < grey.rows; ++row) {
    for (int column = 0; column < grey.cols; ++column) {
      const double value = grey.at<std::uint8_t>(row, column) / 255.0;
      grid.occupied.push_back((map->negate ? value : 1.0 - value) > map->occupied_threshold ? 1 : 0);
    }
  }
  return grid;
}

}  // namespace cgsr::app
