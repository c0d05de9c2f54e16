#include "tools/sim/home_report.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/sim/generator/home.h"
#include "hal/sim/home/plan.h"
#include "hal/sim/scene/map_count.h"
#include "hal/sim/worlds/world.h"
#include "src/output/text_file.h"
#include "tools/sim/generate_home.h"
#include "tools/sim/truth_pictures.h"

namespace cgsr::sim {
namespace {

namespace fs = std::filesystem;

constexpr int kDrawn = 12;
constexpr int kAcross = 4;
constexpr int kCell_px = 460;
constexpr int kCaption_px = 26;
constexpr int kMargin_px = 12;

/// What is counted of the homes, a value each.
struct Counted {
  std::string name;
  std::vector<double> values;
};

/// All homes of a report.
struct Homes {
  std::vector<Counted> numbers{{"rooms", {}},     {"area_m2", {}},        {"doors", {}},    {"windows", {}},
                               {"furniture", {}}, {"pictures", {}},       {"clutter", {}},  {"map_edges", {}},
                               {"lamps", {}},     {"lamp_radius_cm", {}}, {"daylight", {}}, {"ambient_share", {}},
                               {"route_m", {}},   {"draws", {}}};
  std::map<std::string, int> graphs;
  std::map<std::string, int> layouts;
  std::vector<std::string> rows;
};

double windows_of(const FloorPlan& plan) {
  double count = 0.0;
  for (const Wall& wall : plan.walls) {
    count += static_cast<double>(std::ranges::count(wall.openings, OpeningKind::kWindow, &Opening::kind));
  }
  return count;
}

void add(const GeneratedHome& home, const World& world, Homes& homes) {
  double radius_m = 0.0;
  for (std::size_t i = 0; i < home.lights.lamps.size(); ++i) radius_m += home.world.lamp[i].radius_m;
  const auto lamps = static_cast<double>(home.lights.lamps.size());
  const std::vector<double> values{static_cast<double>(home.plan.rooms.size()),
                                   home.plan.outline.area(),
                                   static_cast<double>(home.plan.doors().size()),
                                   windows_of(home.plan),
                                   static_cast<double>(home.furnished.furniture),
                                   static_cast<double>(home.furnished.pictures),
                                   static_cast<double>(home.furnished.clutter),
                                   static_cast<double>(count_map(world.scene).edges),
                                   lamps,
                                   100.0 * radius_m / lamps,
                                   home.lights.day ? 1.0 : 0.0,
                                   home.lights.ambient_share,
                                   home.route.length_m,
                                   1.0 + static_cast<double>(home.rejected.size())};
  const std::string graph = home.plan.door_graph();
  ++homes.graphs[graph];
  ++homes.layouts[home.plan.layout()];
  std::string row = fmt::format("{},\"{}\"", home.seed, graph);
  for (std::size_t i = 0; i < values.size(); ++i) {
    homes.numbers[i].values.push_back(values[i]);
    row += fmt::format(",{:.6g}", values[i]);
  }
  homes.rows.push_back(std::move(row));
}

cv::Scalar bgr(const std::array<float, 3>& rgb) {
  return {255.0 * static_cast<double>(rgb[2]), 255.0 * static_cast<double>(rgb[1]),
          255.0 * static_cast<double>(rgb[0])};
}

/// A home from above, x to the right and y up, its way in red, its lamps in yellow as large as they are but for 6 px at least.
void draw_from_above(const GeneratedHome& home, const World& world, cv::Mat cell) {
  const FloorRect area = home.plan.outline.inset(-0.3);
  const double scale =
      std::min((cell.cols - 2 * kMargin_px) / area.width(), (cell.rows - 2 * kMargin_px - kCaption_px) / area.depth());
  constexpr int kFine = 3;  // bits of a pixel
  const auto at = [&](double x, double y) {
    const double u = kMargin_px + (x - area.x0) * scale;
    const double v = kCaption_px + kMargin_px + (area.y1 - y) * scale;
    return cv::Point(cvRound(u * (1 << kFine)), cvRound(v * (1 << kFine)));
  };
  for (const hal::PlanPiece& piece : make_plan(world.scene).pieces) {
    std::vector<cv::Point> corners;
    for (const auto& corner : piece.corners_m) {
      corners.push_back(at(static_cast<double>(corner[0]), static_cast<double>(corner[1])));
    }
    cv::fillConvexPoly(cell, corners, bgr(piece.srgb), cv::LINE_AA, kFine);
  }
  cv::Point last = at(home.route.start.x, home.route.start.y);
  for (const FloorPoint& place : home.route.places) {
    const cv::Point next = at(place.x, place.y);
    cv::line(cell, last, next, {40, 40, 220}, 2, cv::LINE_AA, kFine);
    last = next;
  }
  for (std::size_t i = 0; i < home.lights.lamps.size(); ++i) {
    const LampSpec& lamp = home.world.lamp[i];
    const int radius = cvRound(std::max(6.0, lamp.radius_m * scale) * (1 << kFine));
    const cv::Point middle = at(lamp.position_m[0], lamp.position_m[1]);
    cv::circle(cell, middle, radius, {60, 230, 255}, cv::FILLED, cv::LINE_AA, kFine);
    cv::circle(cell, middle, radius, {0, 0, 0}, 1, cv::LINE_AA, kFine);
  }
  const std::string caption = fmt::format("home {}: {} rooms, {:.0f} m2, {} lamps", home.seed, home.plan.rooms.size(),
                                          home.plan.outline.area(), home.lights.lamps.size());
  cv::putText(cell, caption, {kMargin_px, kCaption_px - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {20, 20, 20}, 1,
              cv::LINE_AA);
}

/// Minimum, tenth, half, nine tenths, maximum and mean.
std::vector<std::pair<std::string, double>> spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double sum = 0.0;
  for (const double value : values) sum += value;
  const auto quantile = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {{"min", quantile(0.0)}, {"p10", quantile(0.1)}, {"median", quantile(0.5)},
          {"p90", quantile(0.9)}, {"max", quantile(1.0)}, {"mean", sum / static_cast<double>(values.size())}};
}

int most_alike(const std::map<std::string, int>& counts) {
  int most = 0;
  for (const auto& [name, count] : counts) most = std::max(most, count);
  return most;
}

std::string as_text(const HomeReportRequest& request, const Homes& homes) {
  std::string text =
      fmt::format("{} homes, seeds {} to {}\n{} door graphs; {} floor plans, the most frequent one {} times\n\n",
                  request.homes, request.first_seed, request.first_seed + static_cast<std::uint32_t>(request.homes) - 1,
                  homes.graphs.size(), homes.layouts.size(), most_alike(homes.layouts));
  text += fmt::format("{:<16}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "", "min", "p10", "median", "p90", "max", "mean");
  for (const Counted& counted : homes.numbers) {
    text += fmt::format("{:<16}", counted.name);
    for (const auto& [name, value] : spread(counted.values)) text += fmt::format("{:>9.4g}", value);
    text += '\n';
  }
  std::vector<std::pair<int, std::string>> graphs;
  for (const auto& [graph, count] : homes.graphs) graphs.emplace_back(-count, graph);
  std::sort(graphs.begin(), graphs.end());
  text += "\nhomes  doors between rooms\n";
  for (const auto& [count, graph] : graphs) text += fmt::format("{:>5}  {}\n", -count, graph);
  return text;
}

std::string as_json(const HomeReportRequest& request, const Homes& homes) {
  nlohmann::ordered_json json;
  json["homes"] = request.homes;
  json["first_seed"] = request.first_seed;
  for (const Counted& counted : homes.numbers) {
    for (const auto& [name, value] : spread(counted.values)) json["spread"][counted.name][name] = value;
  }
  for (const double rooms : homes.numbers[0].values) {
    auto& count = json["rooms"][fmt::format("{:.0f}", rooms)];
    count = (count.is_null() ? 0 : count.get<int>()) + 1;
  }
  json["door_graphs"] = homes.graphs;
  json["floor_plans"] = {{"different", homes.layouts.size()}, {"most_frequent", most_alike(homes.layouts)}};
  return json.dump(2) + "\n";
}

std::string as_csv(const Homes& homes) {
  std::string csv = "seed,door_graph";
  for (const Counted& counted : homes.numbers) csv += "," + counted.name;
  csv += "\n";
  for (const std::string& row : homes.rows) csv += row + "\n";
  return csv;
}

}  // namespace

Result<std::string> report_homes(const HomeReportRequest& request) {
  if (auto claimed = claim_folder(request.folder, request.force); !claimed) return tl::unexpected(claimed.error());
  const int drawn = std::min(kDrawn, request.homes);
  cv::Mat picture((drawn + kAcross - 1) / kAcross * kCell_px, kAcross * kCell_px, CV_8UC3, cv::Scalar(245, 245, 245));
  Homes homes;
  for (int i = 0; i < request.homes; ++i) {
    const auto home = generate_home(request.first_seed + static_cast<std::uint32_t>(i));
    if (!home) return tl::unexpected(home.error());
    const auto world = build_world(home->world, home->world.name);
    if (!world) return tl::unexpected(world.error());
    add(*home, *world, homes);
    if (i >= drawn) continue;
    draw_from_above(*home, *world,
                    picture(cv::Rect(i % kAcross * kCell_px, i / kAcross * kCell_px, kCell_px, kCell_px)));
  }
  std::error_code error;
  fs::create_directories(request.folder, error);
  if (error) return fail(fmt::format("--output {}: {}", request.folder.string(), error.message()));
  std::string text = as_text(request, homes);
  for (const auto& [name, content] : {std::pair<const char*, std::string>{"homes.csv", as_csv(homes)},
                                      {"distributions.json", as_json(request, homes)},
                                      {"distributions.txt", text}}) {
    if (auto done = app::write_file(request.folder / name, content); !done) return tl::unexpected(done.error());
  }
  if (auto done = write_picture(request.folder / "homes.png", picture); !done) return tl::unexpected(done.error());
  return text;
}

}  // namespace cgsr::sim
