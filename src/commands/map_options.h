#pragma once

#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "pipeline/world/load.h"
#include "src/commands/option_checks.h"

namespace cgsr::app {

/// Adds --up and --scale: how the numbers of a map file become metres with z up.
inline void add_map_frame_options(CLI::App& command, world::LoadOptions& load) {
  static const std::map<std::string, world::UpAxis> kAxes = [] {
    std::map<std::string, world::UpAxis> axes;
    for (const auto axis : {world::UpAxis::kByFormat, world::UpAxis::kZ, world::UpAxis::kY}) {
      axes.emplace(to_string(axis), axis);
    }
    return axes;
  }();
  command
      .add_option_function<std::string>(
          "--up", [&load](const std::string& word) { load.up = kAxes.at(word); },
          "the map file's axis that points up: format (glTF y, all else z), z or y")
      ->check(CLI::IsMember({"format", "z", "y"}))
      ->default_str("format");
  command.add_option("--scale", load.scale, "metres per unit of the map file")
      ->check(in_range(1e-6, 1e6))
      ->capture_default_str();
}

}  // namespace cgsr::app
