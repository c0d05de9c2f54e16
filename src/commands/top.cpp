// `cgsr top`: the profile of a robot that runs, out of the file that its housekeeping rewrites every second.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/core.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "platform/clock.h"
#include "platform/stop.h"
#include "src/commands/command.h"
#include "src/sinks/profile.h"

namespace cgsr::app {
namespace {

struct Options {
  std::string file = "/run/cgsr/status.json";
  bool once = false;
};

/// \return the text of the screen, or why there is none.
Result<std::string> screen(const std::string& file) {
  std::ifstream in(file);
  if (!in)
    return fail(
        fmt::format("{}: cannot be read: no robot runs with --status {}, or it is not yours to read", file, file));
  const auto profile = nlohmann::ordered_json::parse(in, nullptr, false);
  if (!profile.is_object()) return fail(fmt::format("{}: is no status of a robot", file));
  std::error_code error;
  const auto written = std::filesystem::last_write_time(file, error);
  const auto age = std::chrono::duration<double>(std::filesystem::file_time_type::clock::now() - written).count();
  const bool old = !error && age > 3.0;
  return fmt::format("{}, {:.0f} s old{}\n\n{}", file, error ? 0.0 : age,
                     old ? ": the robot does not run, or hangs" : "", sinks::profile_text(profile));
}

int run_top(const Options& options) {
  StopRequest stop;
  const StopOnSignals signals(stop);
  RealClock clock;
  const bool redraw = isatty(STDOUT_FILENO) != 0 && !options.once;
  for (;;) {
    const auto text = screen(options.file);
    if (!text) return report(text.error());
    fmt::print("{}{}", redraw ? "\x1b[H\x1b[2J" : "", *text);
    std::fflush(stdout);
    if (options.once || stop.wait_until(clock.now() + seconds(1.0))) return kSuccess;
  }
}

}  // namespace

void add_top_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("top", "show the time of each stage of the running service");
  command->add_option("FILE", options->file, "the file that cgsr run --status writes")->capture_default_str();
  command->add_flag("--once", options->once, "print it once and end");
  command->callback([options, &exit_code] { exit_code = run_top(*options); });
}

}  // namespace cgsr::app
