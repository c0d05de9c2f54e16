#include "src/commands/files.h"

#include "src/config/load.h"

namespace cgsr::app {
namespace {

void reads_layers(OutputClaims& files, const config::Robot& robot) {
  for (const auto& [key, origin] : robot.provenance.origins) files.reads(origin.file, "the configuration");
}

}  // namespace

void reads_configuration(OutputClaims& files, const std::string& file, const std::string& option) {
  files.reads(file, option);
  if (file.empty()) return;
  if (const auto robot = config::load_sections(file))
    reads_layers(files, *robot);  // what is wrong is reported by its reader
}

void reads_robot(OutputClaims& files, const config::Robot& robot) {
  reads_layers(files, robot);
  for (const auto& [file, written] : robot.provenance.written_paths) files.reads(file, "named by the configuration");
  files.reads(robot.camera.replay.path, "--input");
  files.reads(robot.run.model, "--model");
}

}  // namespace cgsr::app
