#include <memory>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/config/listing.h"
#include "src/config/load.h"
#include "src/config/robot_docs.h"
#include "src/config/starter.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

int put(const std::string& text) {
  fmt::print("{}", text);
  return kSuccess;
}

/// Writes to a file, or to standard output where none is named.
int put(const std::string& text, const std::string& file, const FileKind& kind, bool force) {
  if (file.empty()) return put(text);
  OutputClaims files(force);
  files.writes(file, "--output", kind);
  if (const auto claimed = files.claim(); !claimed) return report(claimed.error());
  const auto written = write_file(file, text);
  return written ? kSuccess : report(written.error());
}

int run_show(const std::string& file) {
  const auto robot = config::load_sections(file);
  if (!robot) return report(robot.error());
  return put(config::show_text(*robot));
}

int run_diff(const std::string& file, const std::string& other_file) {
  const auto robot = config::load_sections(file);
  if (!robot) return report(robot.error());
  const auto other = other_file.empty() ? Result<config::Robot>(config::Robot{}) : config::load_sections(other_file);
  if (!other) return report(other.error());
  return put(config::diff_text(*robot, *other));
}

int run_keys(const std::string& pattern, const std::string& output, bool force) {
  if (!output.empty()) {
    const std::string page = config::robot_docs();
    return put(page, output, text_beginning(page.substr(0, page.find('\n'))), force);
  }
  const std::string text = config::keys_text(pattern);
  if (text.empty()) return report(Error{fmt::format("no key contains '{}'; cgsr config keys lists all", pattern)});
  return put(text);
}

void add_new(CLI::App& config, int& exit_code) {
  struct Options {
    bool webcam = false;
    bool recording = false;
    bool force = false;
    std::string output;
  };
  auto options = std::make_shared<Options>();
  auto* command = config.add_subcommand("new", "write a short commented robot's file to start from");
  auto* kind = command->add_option_group("kind", "where the images come from");
  kind->add_flag("--webcam", options->webcam, "a webcam of this computer");
  kind->add_flag("--recording", options->recording, "a recording, processed as fast as possible");
  kind->require_option(1);
  command->add_option("--output", options->output, "the file to write; without it the text is printed");
  add_force_option(*command, options->force);
  command->callback([options, &exit_code] {
    const auto text = options->webcam ? config::webcam_starter() : config::recording_starter();
    // One that was edited is no longer the same text: it is not lost.
    exit_code = put(std::string(text), options->output, same_text(std::string(text)), options->force);
  });
}

void add_show(CLI::App& config, int& exit_code) {
  auto file = std::make_shared<std::string>();
  auto* command =
      config.add_subcommand("show", "print every value that takes effect, with the file and line it is from");
  command->add_option("FILE", *file, "a robot's file, or one with some of its sections")->required();
  command->callback([file, &exit_code] { exit_code = run_show(*file); });
}

void add_diff(CLI::App& config, int& exit_code) {
  auto file = std::make_shared<std::string>();
  auto other = std::make_shared<std::string>();
  auto* command = config.add_subcommand("diff", "print the values that differ from the defaults or from another file");
  command->add_option("FILE", *file, "a robot's file, or one with some of its sections")->required();
  command->add_option("OTHER", *other, "the file to compare with; without it the defaults");
  command->callback([file, other, &exit_code] { exit_code = run_diff(*file, *other); });
}

void add_keys(CLI::App& config, int& exit_code) {
  auto pattern = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();
  auto force = std::make_shared<bool>(false);
  auto* command = config.add_subcommand("keys", "explain keys: default, unit, range and meaning");
  auto* some = command->add_option("PATTERN", *pattern, "only keys that contain this text, such as motion.max");
  command->add_option("--output", *output, "write the page of all keys (docs/config.md)")->excludes(some);
  add_force_option(*command, *force);
  command->callback([pattern, output, force, &exit_code] { exit_code = run_keys(*pattern, *output, *force); });
}

}  // namespace

void add_config_command(CLI::App& app, int& exit_code) {
  auto* config = app.add_subcommand("config", "write, show, compare and explain configuration files");
  config->require_subcommand(1);
  add_new(*config, exit_code);
  add_show(*config, exit_code);
  add_diff(*config, exit_code);
  add_keys(*config, exit_code);
}

}  // namespace cgsr::app
