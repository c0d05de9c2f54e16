#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "pipeline/color/light_history.h"
#include "pipeline/color/model_file.h"
#include "platform/config/canonical.h"
#include "platform/count_marks.h"
#include "platform/stop.h"
#include "src/command.h"
#include "src/config/load.h"
#include "src/input/image_input.h"
#include "src/output/overlay.h"
#include "src/output/progress.h"
#include "src/output/text_file.h"
#include "src/output/video_writer.h"
#include "src/scoring.h"

namespace cgsr::app {
namespace {

struct TrackOptions {
  std::string input;
  std::string learn;
  int learn_frame = 0;
  std::string model;
  std::string truth;
  std::string csv;
  std::string video;
  std::string json;
  std::string config;
  std::string mode;
  std::string scale_to;
};

/// Everything that is opened before the first image is looked at, so that what cannot be written or read is said at once.
struct Session {
  config::Color config;
  std::optional<ImageInput> input;
  std::optional<Boxes> truth;
  std::optional<TextFile> csv;
  std::optional<VideoWriter> video;
  std::optional<Overlay> overlay;
};

Result<Session> open_session(const TrackOptions& options) {
  Session session;
  auto config = config::load_color(options.config);
  if (!config) return tl::unexpected(config.error());
  session.config = *config;
  if (options.mode == "plain") session.config.track.mode = color::TrackMode::kPlain;
  if (options.mode == "full") session.config.track.mode = color::TrackMode::kFull;

  InputOptions input{options.input, options.model.empty() ? options.learn_frame : 0, 0, 0, 0};
  if (!options.scale_to.empty()) {
    const auto size = parse_size(options.scale_to);
    if (!size) return tl::unexpected(size.error());
    std::tie(input.width_px, input.height_px) = *size;
  }
  auto opened = ImageInput::open(input);
  if (!opened) return tl::unexpected(opened.error());
  session.input.emplace(std::move(*opened));

  if (!options.truth.empty()) {
    auto truth = read_truth(options.truth);
    if (!truth) return tl::unexpected(truth.error());
    session.truth = std::move(*truth);
  }
  if (!options.csv.empty()) {
    auto csv = TextFile::create(options.csv);
    if (!csv) return tl::unexpected(csv.error());
    session.csv.emplace(std::move(*csv));
    if (auto head = session.csv->add_line("frame,found,x,y,width,height,divergence,light_r,light_g,light_b"); !head) {
      return tl::unexpected(head.error());
    }
  }
  if (!options.video.empty()) {
    const auto& mode = session.input->mode();
    session.overlay.emplace(mode.width_px, mode.height_px);
    auto video =
        VideoWriter::create(options.video, session.overlay->picture_size(), 1.0 / to_seconds(mode.frame_period));
    if (!video) return tl::unexpected(video.error());
    session.video.emplace(std::move(*video));
  }
  return session;
}

std::string csv_row(std::uint64_t frame, const color::TrackedObject& object) {
  if (!object.found) return fmt::format("{},0,,,,,,,,", frame);
  return fmt::format("{},1,{:.2f},{:.2f},{:.2f},{:.2f},{:.5f},{:.3f},{:.3f},{:.3f}", frame, object.box.x, object.box.y,
                     object.box.width, object.box.height, object.divergence, object.light.r, object.light.g,
                     object.light.b);
}

/// Tracks through a session's images and keeps what was found.
class TrackRun {
 public:
  TrackRun(Session session, color::ColorModel model, color::Tracker tracker, std::uint64_t first_frame)
      : session_(std::move(session)),
        model_(std::move(model)),
        tracker_(std::move(tracker)),
        reduced_(session_.input->mode().width_px, session_.input->mode().height_px),

        frame_(first_frame) {}

  /// The image that was learned from: its box is known. Counts as image number one of the output, but never as an answer.
  Result<void> begin_with(const ImageLease& image, const Box& box) {
    const auto& view = image.view();
    const int factor = tracker_.reduction(view.width_px, view.height_px);
    if (imaging::reduce(view, factor, tracker_.labels(), reduced_)) tracker_.place(view, reduced_, box);
    color::TrackedObject known{true, box, 0.0, {}, {}};
    if (!model_.samples.empty()) known.light = model_.samples.front().light;
    return keep(image, known);
  }

  Result<void> track(const ImageLease& image) {
    count_stage_begin();
    const auto& view = image.view();
    const auto outcome =
        imaging::reduce(view, tracker_.reduction(view.width_px, view.height_px), tracker_.labels(), reduced_);
    count_stage_end("decode");
    color::TrackedObject object;
    if (outcome) {
      UnlimitedBudget unlimited;
      count_stage_begin();
      const color::SearchResult matches = tracker_.search(reduced_, unlimited);
      count_stage_end("search");
      count_stage_begin();
      object = tracker_.track(view, reduced_, matches, unlimited);
      count_stage_end("track");
    }
    count_image_end();
    ++asked_;
    found_ += object.found ? 1 : 0;
    return keep(image, object);
  }

  /// An image that could not be read: nothing is found in it, and the numbering goes on.
  Result<void> miss() {
    ++asked_;
    return write_row({});
  }

  [[nodiscard]] int images() const { return asked_; }
  [[nodiscard]] int found() const { return found_; }
  [[nodiscard]] std::uint64_t frame() const { return frame_; }
  [[nodiscard]] const config::Color& config() const { return session_.config; }
  [[nodiscard]] ImageInput& input() { return *session_.input; }

  /// Over the images after the learned one.
  [[nodiscard]] std::optional<Score> score(std::uint64_t first_answer) const {
    if (!session_.truth) return std::nullopt;
    const std::size_t seen = std::min(session_.truth->size(), boxes_.size());
    return app::score(boxes_,
                      Boxes(session_.truth->begin(), session_.truth->begin() + static_cast<std::ptrdiff_t>(seen)),
                      static_cast<int>(first_answer));
  }

 private:
  Result<void> keep(const ImageLease& image, const color::TrackedObject& object) {
    const auto light = object.found ? std::optional(object.light) : std::nullopt;
    const auto plurality = history_.add(image.stamp(), light);
    if (session_.video) {
      OverlayFacts facts;
      facts.image_number = frame_;
      if (object.found) facts.box = object.box;
      facts.light = plurality;
      facts.divergence = object.divergence;
      if (session_.truth && frame_ < session_.truth->size()) facts.truth = (*session_.truth)[frame_];
      if (auto added = session_.video->add(session_.overlay->draw(image.view(), facts)); !added) return added;
    }
    return write_row(object);
  }

  Result<void> write_row(const color::TrackedObject& object) {
    boxes_.resize(frame_ + 1);
    if (object.found) boxes_[frame_] = object.box;
    if (session_.csv) {
      if (auto added = session_.csv->add_line(csv_row(frame_, object)); !added) return added;
    }
    ++frame_;
    return {};
  }

  Session session_;
  color::ColorModel model_;
  color::Tracker tracker_;
  imaging::ReducedImage reduced_;
  color::LightHistory history_;
  Boxes boxes_;
  std::uint64_t frame_;
  int asked_ = 0;
  int found_ = 0;
};

struct Begun {
  color::ColorModel model;
  std::optional<ImageLease> learned_from;
  Box box;
  std::string words;
};

Result<Begun> learn_or_load(const TrackOptions& options, Session& session) {
  if (!options.model.empty()) {
    auto model = color::load_model(options.model);
    if (!model) return tl::unexpected(model.error());
    return Begun{std::move(*model), std::nullopt, {}, fmt::format("model {}", options.model)};
  }
  const auto box = parse_box(options.learn);
  if (!box) return tl::unexpected(box.error());
  auto next = session.input->next();
  if (!next.image) return fail(fmt::format("{}: no image {}: {}", options.input, options.learn_frame, next.problem));
  const color::Sample sample{next.image.view(), *box};
  auto learned = color::learn({&sample, 1}, session.config.learn);
  if (!learned) return tl::unexpected(learned.error());
  return Begun{std::move(learned->model), std::move(next.image), *box, learned->words};
}

Result<void> write_json(const TrackOptions& options, const TrackRun& run, const std::optional<Score>& score) {
  if (options.json.empty()) return {};
  nlohmann::ordered_json json;
  json["images"] = run.images();
  json["found"] = run.found();
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
  fmt::print(stderr, "{}\n", begun->words);

  const auto& mode = session->input->mode();
  auto tracker = color::Tracker::create(begun->model, session->config.track, mode.width_px, mode.height_px);
  if (!tracker) return report(tracker.error());

  StopRequest stop;
  const StopOnSignals signals(stop);
  const std::uint64_t first = begun->learned_from ? static_cast<std::uint64_t>(options.learn_frame) : 0;
  TrackRun run(std::move(*session), std::move(begun->model), std::move(*tracker), first);
  if (begun->learned_from) {
    if (auto kept = run.begin_with(*begun->learned_from, begun->box); !kept) return report(kept.error());
    begun->learned_from.reset();
  }
  const auto stopped = track_all(run, stop);
  if (!stopped) return report(stopped.error());

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
      ->check(CLI::NonNegativeNumber)
      ->needs(learn);
  auto* model = command->add_option("--model", options->model, "track with a model that cgsr learn wrote");
  learn->excludes(model);
  command->add_option("--truth", options->truth, "true boxes, a line x,y,w,h per image: prints precision, recall, IoU");
  command->add_option("--csv", options->csv, "write a row per image");
  command->add_option("--video", options->video, "write a video with box, lights and divergence");
  command->add_option("--json", options->json, "write the summary for machines");
  command->add_option("--config", options->config, "a robot's file, for its section [color]");
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
