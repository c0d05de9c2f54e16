// Truth as a table: one row for each tick, what is not there stays empty.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "hal/sim/scene/portable_math.h"
#include "hal/sim/truth.h"

namespace cgsr::sim {
namespace {

// A name becomes part of a column's; RFC 4180 quotes what would break the row.
std::string column(std::string_view name, std::string_view what) {
  std::string plain = fmt::format("{}.{}", name, what);
  if (plain.find_first_of(",\"\r\n") == std::string::npos) return plain;
  std::string quoted = "\"";
  for (const char c : plain) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

void name_columns(std::string& header, std::string_view name, std::initializer_list<std::string_view> whats) {
  for (const std::string_view what : whats) header += ',' + column(name, what);
}

double turned_deg(double rad) {
  return rad * (180.0 / kPi);
}

void add_pose(std::string& row, const Pose& X) {
  const Eigen::Vector3d p = X.translation();
  Eigen::Quaterniond q(X.linear());
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  row +=
      fmt::format(",{:.6f},{:.6f},{:.6f},{:.8f},{:.8f},{:.8f},{:.8f}", p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
}

void add_box(std::string& row, const Box& box, bool there) {
  row += there ? fmt::format(",{:.0f},{:.0f},{:.0f},{:.0f}", box.x, box.y, box.width, box.height) : ",,,,";
}

void add_actor(std::string& row, const ActorTruth& actor) {
  row += fmt::format(",{},{},{:.4f},{:.4f},{:.4f},{:.3f},{:.3f}", actor.present ? 1 : 0, actor.outfit, actor.p_WF.x(),
                     actor.p_WF.y(), actor.p_WF.z(), turned_deg(actor.heading_rad), actor.speed_mps);
  row += fmt::format(",{},{},{}", actor.view.visible_px, actor.view.whole_px, actor.view.lit_px);
  add_box(row, actor.view.visible, actor.view.in_view);
  add_box(row, actor.view.whole, actor.view.whole_px > 0);
}

void add_probe(std::string& row, const ProbeShadow& probe) {
  row += fmt::format(",{}", probe.visible ? 1 : 0);
  row += probe.lamp_above ? fmt::format(",{:.6f},{:.6f},{:.6f},{:.3f},{:.3f}", probe.p_WS.x(), probe.p_WS.y(),
                                        probe.p_WS.z(), probe.at_px.x(), probe.at_px.y())
                          : ",,,,,";
}

}  // namespace

std::string truth_csv_header(const Scene& scene, const TruthOptions& options) {
  std::string header = "image,time_s";
  name_columns(header, "camera", {"tx", "ty", "tz", "qw", "qx", "qy", "qz"});
  name_columns(header, "robot", {"tx", "ty", "tz", "qw", "qx", "qy", "qz"});
  for (const Lamp& lamp : scene.lamps) name_columns(header, lamp.name, {"x", "y", "z", "on"});
  for (const Figure& figure : scene.figures) {
    if (figure.kind == FigureKind::kRobot) continue;
    name_columns(header, figure.name,
                 {"present", "outfit", "x", "y", "z", "heading_deg", "speed_mps", "visible_px", "whole_px", "lit_px"});
    name_columns(header, figure.name, {"visible_left", "visible_top", "visible_width", "visible_height"});
    name_columns(header, figure.name, {"whole_left", "whole_top", "whole_width", "whole_height"});
  }
  for (int i = 0; i < cone_count(scene, options.robot); ++i) {
    name_columns(header, fmt::format("probe{}", i),
                 {"visible", "shadow_x", "shadow_y", "shadow_z", "shadow_u_px", "shadow_v_px"});
  }
  return header + '\n';
}

std::string truth_csv_row(int image, const Truth& truth) {
  std::string row = fmt::format("{},{:.6f}", image, truth.time_s);
  add_pose(row, truth.X_WC);
  if (truth.X_WR) {
    add_pose(row, *truth.X_WR);
  } else {
    row += ",,,,,,,";
  }
  for (const LampTruth& lamp : truth.lamps) {
    row += fmt::format(",{:.4f},{:.4f},{:.4f},{}", lamp.p_WL.x(), lamp.p_WL.y(), lamp.p_WL.z(), lamp.on() ? 1 : 0);
  }
  for (const ActorTruth& actor : truth.actors) add_actor(row, actor);
  for (const ProbeShadow& probe : truth.probes) add_probe(row, probe);
  return row + '\n';
}

}  // namespace cgsr::sim
