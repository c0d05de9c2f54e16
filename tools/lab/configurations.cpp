#include "tools/lab/configurations.h"

#include "platform/config/canonical.h"
#include "tools/lab/localization/trial.h"
#include "tools/lab/shade_trial.h"
#include "tools/lab/source_path.h"
#include "tools/lab/tables/people_tables.h"

namespace cgsr::lab {
namespace {

/// What a table uses of two files.
struct BothLocalizations {
  config::Localization floor, free;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("floor", self.floor, "A robot on a floor");
    visit.section("free", self.free, "Six free numbers");
  }
};

struct ProbesAndLamp {
  illumination::ProbesParameters probes;
  illumination::LampParameters lamp;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("probes", self.probes, "The probe board");
    visit.section("lamp", self.lamp, "The lamp");
  }
};

struct Ball {
  config::Color color;
  color::IntegratedParameters integrated;
  stages::ShadeStageParameters shade;
  runtime::StageParameters shade_row, track_row;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("color", self.color, "Colour tracking");
    visit.section("integrated", self.integrated, "The ball tracker");
    visit.section("shade", self.shade, "Shadow masks");
    visit.section("stage_shade", self.shade_row, "The stage shade in the schedule");
    visit.section("stage_track", self.track_row, "The stage track in the schedule");
  }
};

struct Shade {
  stages::ShadeStageParameters shade;
  runtime::StageParameters row;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("shade", self.shade, "Shadow masks");
    visit.section("stage_shade", self.row, "The stage shade in the schedule");
  }
};

Result<std::string> robot_hash(const Setting& setting, const std::string& name) {
  const auto robot = config::load_robot(robot_file(setting, name));
  if (!robot) return tl::unexpected(robot.error());
  return config::hash(*robot);
}

}  // namespace

std::string robot_file(const Setting& setting, const std::string& name) {
  return setting.config_file.empty() ? source_path("config/robots/" + name + ".toml") : setting.config_file;
}

Result<config::Robot> lamp_robot(const Setting& setting) {
  return config::load_robot(robot_file(setting, "sim-home-lamp"));
}

Result<std::string> color_hash(const Setting& setting) {
  return config::hash(setting.configuration);
}

Result<std::string> localization_hash(const Setting&) {
  const auto floor = shipped_localization("floor");
  if (!floor) return tl::unexpected(floor.error());
  const auto free = shipped_localization("free");
  if (!free) return tl::unexpected(free.error());
  return config::hash(BothLocalizations{*floor, *free});
}

Result<std::string> lamp_hash(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  return config::hash(ProbesAndLamp{robot->probes, robot->lamp});
}

Result<std::string> shade_hash(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  return config::hash(Shade{robot->shade, row_of<stages::ShadeStage>(*robot)});
}

Result<std::string> ball_hash(const Setting& setting) {
  const auto robot = lamp_robot(setting);
  if (!robot) return tl::unexpected(robot.error());
  return config::hash(Ball{setting.configuration, robot->integrated, robot->shade, row_of<stages::ShadeStage>(*robot),
                           row_of<stages::TrackStage>(*robot)});
}

Result<std::string> lamp_robot_hash(const Setting& setting) {
  return robot_hash(setting, "sim-home-lamp");
}

Result<std::string> home_robot_hash(const Setting& setting) {
  return robot_hash(setting, "sim-home");
}

Result<std::string> people_robot_hash(const Setting& setting) {
  return robot_hash(setting, "sim-people");
}

Result<std::string> people_line_robot_hash(const Setting& setting) {
  return robot_hash(setting, "sim-people-line");
}

Result<std::string> home_people_robot_hash(const Setting& setting) {
  return robot_hash(setting, "sim-home-people");
}

Result<std::string> everything_robot_hash(const Setting& setting) {
  return robot_hash(setting, "sim-home-everything");
}

Result<std::string> people_finals_robot_hash(const Setting& setting) {
  return robot_hash(setting, "sim-people-finals");
}

Result<std::string> round_robot_hash(const Setting& setting) {
  return robot_hash(setting, "sim-home-round");
}

}  // namespace cgsr::lab
