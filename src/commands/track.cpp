#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "platform/config/canonical.h"
#include "platform/stop.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/commands/track_run.h"
#include "src/commands/track_session.h"
#include "src/output/progress.h"
#include "src/output/text_file.h"

namespace cgsr::app {
namespace {

/// A list of images for a person, who needs no more than the first of many.
std::string listed(const std::vector<std::uint64_t>& images) {
  constexpr std::size_t kMostListed = 12;
  const auto shown = static_cast<std::ptrdiff_t>(std::min(images.size(), kMostListed));
  const std::string more = images.size() > kMostListed ? fmt::format(" and {} more", images.size() - kMostListed) : "";
  return fmt::format("{}{}", fmt::join(images.begin(), images.begin() + shown, ", "), more);
}

Result<void> write_json(const TrackOptions& options, const TrackRun& run, const std::optional<Score>& score) {
  if (options.json.empty()) return {};
  nlohmann::ordered_json json;
  json["images"] = run.images();
  json["found"] = run.found();
  json["losses"] = run.losses();
  json["reacquisitions"] = run.reacquisitions();
  json["config_sha256"] = config::hash(run.config());
  if (score) {
    json["truth"] = {{"images", score->images},
                     {"precision", score->precision},
                     {"recall", score->recall},
                     {"iou", score->iou},
                     {"success", score->success},
                     {"found", score->found},
                     {"found_when_absent", score->found_when_absent}};
  }
  return write_file(options.json, json.dump(1) + "\n");
}

void print_summary(const TrackOptions& options, const TrackRun& run, const std::optional<Score>& score, bool stopped) {
  fmt::print("{} images{}, object found in {}\n", run.images(), stopped ? " until it was stopped" : "", run.found());
  if (!run.losses().empty()) fmt::print("  lost at image {}\n", listed(run.losses()));
  if (!run.reacquisitions().empty()) fmt::print("  found again at image {}\n", listed(run.reacquisitions()));
  if (score) {
    fmt::print("against {} ({} images with the object after the learned one)\n", options.truth, score->images);
    fmt::print("  precision {:.3f}   recall {:.3f}   IoU {:.3f}   IoU > 0.5 in {:.3f}   found when absent {}\n",
               score->precision, score->recall, score->iou, score->success, score->found_when_absent);
  }
  if (!options.csv.empty()) fmt::print("boxes    {}\n", options.csv);
  if (!options.video.empty()) fmt::print("video    {}\n", options.video);
  fmt::print("configuration {}\n", config::hash(run.config()));
}

Result<bool> track_all(TrackRun& run, const StopRequest& stop) {
  Progress progress;
  while (!stop.requested()) {
    auto next = run.input().next();
    if (next.end) {
      if (!next.problem.empty()) fmt::print(stderr, "note: {}\n", next.problem);
      return false;
    }
    if (!next.image) fmt::print(stderr, "note: {}\n", next.problem);
    if (auto done = next.image ? run.track(next.image) : run.miss(); !done) return tl::unexpected(done.error());
    progress.show(fmt::format("image {}: found in {} of {}", run.frame(), run.found(), run.images()));
  }
  return true;
}

int run_track(const TrackOptions& options) {
  auto session = open_session(options);
  if (!session) return report(session.error());
  auto begun = learn_or_load(options, *session);
  if (!begun) return report(begun.error());
  for (const std::string& note : session->input->notes()) fmt::print(stderr, "note: {}\n", note);
  fmt::print(stderr, "{}\n", begun->message);

  const auto& mode = session->input->mode();
  auto loop = stages::ColorLoop::make(begun->model, session->config.track, mode.width_px, mode.height_px);
  if (!loop) return report(loop.error());

  StopRequest stop;
  const StopOnSignals signals(stop);
  const std::uint64_t first = begun->learned_from ? static_cast<std::uint64_t>(options.learn_frame) : 0;
  TrackRun run(std::move(*session), std::move(begun->model), std::move(*loop), first);
  if (begun->learned_from) {
    if (auto kept = run.begin_with(*begun->learned_from, begun->box); !kept) return report(kept.error());
    begun->learned_from.reset();
  }
  const auto stopped = track_all(run, stop);
  if (!stopped) return report(stopped.error());
  if (auto finished = run.finish(); !finished) return report(finished.error());
  if (auto checked = *stopped ? Result<void>{} : run.check_truth(options.truth); !checked)
    return report(checked.error());

  const auto score = run.score(begun->box.empty() ? 0 : first + 1);
  if (auto written = write_json(options, run, score); !written) return report(written.error());
  print_summary(options, run, score, *stopped);
  return *stopped ? kInterrupted : kSuccess;
}

}  // namespace

void add_track_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TrackOptions>();
  auto* command =
      app.add_subcommand("track", "track an object by its colours through a video or image folder (Alg. 3.2)");
  command->add_option("--input", options->input, "video, image folder or image")->required();
  auto* learn = command->add_option("--learn", options->learn, "X,Y,W,H: learn what lies there, then track it");
  command->add_option("--learn-frame", options->learn_frame, "number of the image to learn from; tracking starts there")
      ->check(whole_number())
      ->needs(learn);
  auto* model = command->add_option("--model", options->model, "track with a model that cgsr learn wrote");
  learn->excludes(model);
  command->add_option("--truth", options->truth, "true boxes, a line x,y,w,h per image: prints precision, recall, IoU");
  command->add_option("--csv", options->csv, "write a row per image");
  command->add_option("--video", options->video, "write a video with box, lights and divergence");
  command->add_option("--json", options->json, "write the summary for machines");
  add_force_option(*command, options->force);
  command->add_option("--config", options->config, "a robot's file, or one with just the section [color]");
  command
      ->add_option("--mode", options->mode,
                   "plain: the dissertation's Alg. 3.2; full: ours; default: the configuration's")
      ->check(CLI::IsMember({"plain", "full"}));
  command->add_option("--scale-to", options->scale_to,
                      "WIDTHxHEIGHT: scale images first; boxes are then in pixels of the scaled image");
  command->callback([command, options, &exit_code] {
    if (options->learn.empty() == options->model.empty()) {
      throw CLI::ValidationError(command->get_name(), "give either --learn or --model");
    }
    exit_code = run_track(*options);
  });
}

}  // namespace cgsr::app
