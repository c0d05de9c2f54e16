#include "src/commands/track_session.h"

#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "pipeline/color/learn/learn.h"
#include "pipeline/color/learn/model_file.h"
#include "src/commands/files.h"
#include "src/config/load.h"

namespace cgsr::app {
namespace {

constexpr std::string_view kColumns = "frame,found,x,y,width,height,divergence,light_r,light_g,light_b,confidence";

Result<void> claim_outputs(const TrackOptions& options) {
  OutputClaims files(options.force);
  files.reads(options.input, "--input");
  files.reads(options.model, "--model");
  files.reads(options.truth, "--truth");
  reads_configuration(files, options.config, "--config");
  files.writes(options.csv, "--csv", csv_file(kColumns));
  files.writes(options.video, "--video", video_file());
  files.writes(options.json, "--json", json_object());
  return files.claim();
}

Result<config::Color> configuration_of(const TrackOptions& options) {
  auto config = config::load_color(options.config);
  if (config && options.mode == "plain") config->track.mode = color::TrackMode::kPlain;
  if (config && options.mode == "full") config->track.mode = color::TrackMode::kFull;
  return config;
}

Result<ImageInput> open_input(const TrackOptions& options) {
  InputOptions input{options.input, options.model.empty() ? options.learn_frame : 0, 0, 0, 0};
  if (!options.scale_to.empty()) {
    const auto size = parse_size(options.scale_to);
    if (!size) return tl::unexpected(size.error());
    std::tie(input.width_px, input.height_px) = *size;
  }
  return ImageInput::open(input);
}

Result<void> open_csv(const std::string& path, Session& session) {
  auto csv = TextFile::create(path);
  if (!csv) return tl::unexpected(csv.error());
  session.csv.emplace(std::move(*csv));
  return session.csv->add_line(kColumns);
}

Result<void> open_video(const std::string& path, Session& session) {
  const auto& mode = session.input->mode();
  session.overlay.emplace(mode.width_px, mode.height_px);
  auto video = VideoWriter::create(path, session.overlay->picture_size(), 1.0 / to_seconds(mode.frame_period));
  if (!video) return tl::unexpected(video.error());
  session.video.emplace(std::move(*video));
  return {};
}

}  // namespace

Result<Session> open_session(const TrackOptions& options) {
  Session session;
  if (auto claimed = claim_outputs(options); !claimed) return tl::unexpected(claimed.error());
  auto config = configuration_of(options);
  if (!config) return tl::unexpected(config.error());
  session.config = *config;
  auto input = open_input(options);
  if (!input) return tl::unexpected(input.error());
  session.input.emplace(std::move(*input));
  if (!options.truth.empty()) {
    auto truth = read_truth(options.truth);
    if (!truth) return tl::unexpected(truth.error());
    session.truth = std::move(*truth);
  }
  if (!options.csv.empty()) {
    if (auto opened = open_csv(options.csv, session); !opened) return tl::unexpected(opened.error());
  }
  if (!options.video.empty()) {
    if (auto opened = open_video(options.video, session); !opened) return tl::unexpected(opened.error());
  }
  return session;
}

Result<Begun> learn_or_load(const TrackOptions& options, Session& session) {
  if (!options.model.empty()) {
    auto model = color::load_model(options.model);
    if (!model) return tl::unexpected(model.error());
    return Begun{std::move(*model), std::nullopt, {}, fmt::format("model {}", options.model)};
  }
  const auto asked = parse_box(options.learn);
  if (!asked) return tl::unexpected(asked.error());
  auto next = session.input->next();
  if (!next.image) return fail(fmt::format("{}: no image {}: {}", options.input, options.learn_frame, next.problem));
  const ImageView image = next.image.view();
  const color::Sample sample{image, *asked};
  auto learned = color::learn({&sample, 1}, session.config.learn);
  if (!learned) return tl::unexpected(learned.error());
  const Box box =
      intersection(*asked, {0.0, 0.0, static_cast<double>(image.width_px), static_cast<double>(image.height_px)});
  std::string message = learned->message;
  if (box != *asked) {
    message +=
        fmt::format("\nnote: the box {} reaches beyond the image of {}x{} pixels; {:g},{:g},{:g},{:g} of it is tracked",
                    options.learn, image.width_px, image.height_px, box.x, box.y, box.width, box.height);
  }
  return Begun{std::move(learned->model), std::move(next.image), box, std::move(message)};
}

}  // namespace cgsr::app
