// The profile as a terminal shows it: `cgsr profile` after a run, `cgsr top` of a run that goes on.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <fmt/format.h>

#include "src/sinks/profile.h"

namespace cgsr::sinks {
namespace {

using Json = nlohmann::ordered_json;

/// A value of the file, or its absence: a file of another version is no reason to fail.
double number(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : 0.0;
}

std::string word(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string times_text(const Json& row) {
  return fmt::format("{:>9.0f} {:>9.0f} {:>9.0f} {:>9.0f}", number(row, "mean_us"), number(row, "p50_us"),
                     number(row, "p99_us"), number(row, "worst_us"));
}

std::string stages_text(const Json& profile) {
  std::string text = fmt::format("{:<16} {:>8} {:>7} {:>8} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "stage",
                                 "runs", "skips", "overruns", "faults", "by budget", "mean/µs", "p50/µs", "p99/µs",
                                 "worst/µs", "budget/µs", "share");
  const Json stages = profile.value("stages", Json::object());
  for (const auto& [name, row] : stages.items()) {
    text += fmt::format("{:<16} {:>8} {:>7} {:>8} {:>7} {:>9} {} {:>9} {:>5.0f} %\n", name, number(row, "runs"),
                        number(row, "skips"), number(row, "overruns"), number(row, "faults"),
                        number(row, "ended_by_budget"), times_text(row), number(row, "budget_us"),
                        100.0 * number(row, "share_of_budget"));
  }
  const Json frame = profile.value("frame", Json::object());
  const double budget_us = number(frame, "budget_us");
  text +=
      fmt::format("{:<16} {:>8} {:>34} {} {:>9.0f} {:>5.0f} %\n", "whole frame", number(frame, "frames"), "",
                  times_text(frame), budget_us, budget_us > 0.0 ? 100.0 * number(frame, "mean_us") / budget_us : 0.0);
  return text + fmt::format("{} frames longer than the time between two images, {} without an image\n",
                            number(frame, "late"), number(frame, "without_image"));
}

/// Frames by their length, in tenths of the time between two images.
std::string histogram_text(const Json& profile) {
  const Json frame = profile.value("frame", Json::object());
  const Json bins = frame.value("tenths_of_period", Json::array());
  const double period_ms = number(frame, "budget_us") / 1000.0;
  double largest = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double count = bins[i].is_number() ? bins[i].get<double>() : 0.0;
    largest = std::max(largest, count);
    if (count > 0.0) last = i;
  }
  if (largest <= 0.0) return {};
  std::string text = "\nframes by length\n";
  for (std::size_t i = 0; i <= last; ++i) {
    const double count = bins[i].is_number() ? bins[i].get<double>() : 0.0;
    const auto length = static_cast<std::size_t>(std::lround(50.0 * count / largest));
    text += fmt::format("{:>6.1f} ms{} |{:<50}| {}\n", period_ms * static_cast<double>(i) / 10.0,
                        i + 1 == bins.size() ? "+" : " ", std::string(length, '#'), count);
  }
  return text;
}

std::string motion_text(const Json& profile) {
  const Json motion = profile.value("motion", Json::object());
  const Json latency = profile.value("exposure_to_command", Json::object());
  std::string text =
      fmt::format("\nexposure to wheel command: mean {:.1f}, p50 {:.1f}, p99 {:.1f}, worst {:.1f} ms ({} images)\n",
                  number(latency, "mean_us") / 1e3, number(latency, "p50_us") / 1e3, number(latency, "p99_us") / 1e3,
                  number(latency, "worst_us") / 1e3, number(latency, "images"));
  text += fmt::format("motion: {} control cycles, {} late; {}, {:+.2f} m/s {:+.2f} rad/s, stop cause: {}",
                      number(motion, "control_cycles"), number(motion, "late_cycles"),
                      motion.value("armed", false) ? "armed" : "disarmed", number(motion, "commanded_mps"),
                      number(motion, "commanded_radps"), word(motion, "stop_cause"));
  if (const std::string latched = word(motion, "latched"); !latched.empty()) {
    text += fmt::format(", latched: {}, base: {}", latched, word(motion, "drive_fault"));
  }
  text += "\ncycles by cause:";
  const Json causes = profile.value("stop_causes", Json::object());
  for (const auto& [cause, cycles] : causes.items()) {
    text += fmt::format("  {} {}", cycles.is_number() ? cycles.get<double>() : 0.0, cause);
  }
  return text + "\n";
}

std::string rings_text(const Json& profile) {
  const Json rings = profile.value("rings", Json::object());
  if (rings.empty()) return {};
  std::string text = "\nring             capacity  high water   pushed  dropped  skipped\n";
  for (const auto& [name, ring] : rings.items()) {
    text += fmt::format("{:<16} {:>8} {:>11} {:>8} {:>8} {:>8}\n", name, number(ring, "capacity"),
                        number(ring, "high_water"), number(ring, "pushed"), number(ring, "dropped"),
                        number(ring, "skipped"));
  }
  return text;
}

}  // namespace

std::string profile_text(const Json& profile) {
  return stages_text(profile) + histogram_text(profile) + motion_text(profile) + rings_text(profile);
}

}  // namespace cgsr::sinks
