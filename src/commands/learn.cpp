#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "pipeline/color/learn/model_file.h"
#include "platform/config/canonical.h"
#include "src/commands/command.h"
#include "src/commands/files.h"
#include "src/commands/option_checks.h"
#include "src/config/load.h"
#include "src/input/image_input.h"
#include "src/output/learn_preview.h"
#include "src/output/picture.h"

namespace cgsr::app {
namespace {

struct LearnOptions {
  std::string input;
  std::vector<std::string> regions;
  std::vector<int> at;
  std::string output;
  std::string preview;
  std::string config;
  bool force = false;

  [[nodiscard]] std::string preview_file() const { return preview.empty() ? output + ".png" : preview; }
};

/// The images that are learned from, kept with the inputs that lend them.
struct Views {
  std::vector<ImageInput> inputs;
  std::vector<ImageLease> leases;
  std::vector<color::Sample> samples;
};

Result<Views> open_views(const LearnOptions& options) {
  if (options.at.size() > 1 && options.regions.size() != options.at.size()) {
    return fail(fmt::format("{} regions and {} image numbers: each view needs one --region and one --at",
                            options.regions.size(), options.at.size()));
  }
  Views views;
  for (std::size_t i = 0; i < options.regions.size(); ++i) {
    const auto box = parse_box(options.regions[i]);
    if (!box) return tl::unexpected(box.error());
    const int number = options.at.empty() ? 0 : options.at[std::min(i, options.at.size() - 1)];
    auto input = ImageInput::open({options.input, number, 1, 0, 0});
    if (!input) return tl::unexpected(input.error());
    auto next = input->next();
    if (!next.image) return fail(fmt::format("{}: no image {}: {}", options.input, number, next.problem));
    views.samples.push_back({next.image.view(), *box});
    views.leases.push_back(std::move(next.image));
    views.inputs.push_back(std::move(*input));
  }
  return views;
}

Result<void> claim_outputs(const LearnOptions& options) {
  OutputClaims files(options.force);
  files.reads(options.input, "--input");
  reads_configuration(files, options.config, "--config");
  files.writes(options.output, "--output", color_model());
  files.writes(options.preview_file(), "--preview", picture_file());
  return files.claim();
}

int run_learn(const LearnOptions& options) {
  if (const auto claimed = claim_outputs(options); !claimed) return report(claimed.error());
  const auto config = config::load_color(options.config);
  if (!config) return report(config.error());
  const auto views = open_views(options);
  if (!views) return report(views.error());

  const auto learned = color::learn(views->samples, config->learn);
  if (!learned) return report(learned.error());
  if (const auto saved = color::save_model(learned->model, options.output); !saved) return report(saved.error());

  const std::string preview = options.preview_file();
  if (const auto written = write_picture(preview, draw_preview(views->samples, *learned)); !written) {
    return report(written.error());
  }
  fmt::print("{}\nmodel    {}\npreview  {}\nconfiguration {}\n", learned->message, options.output, preview,
             config::hash(*config));
  return kSuccess;
}

}  // namespace

void add_learn_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<LearnOptions>();
  auto* command = app.add_subcommand("learn", "learn an object's colours from one or several views (Alg. 3.1)");
  command->add_option("--input", options->input, "video, image folder or image")->required();
  command->add_option("--region", options->regions, "X,Y,W,H of the object in pixels; once per view")->required();
  command->add_option("--at", options->at, "number of the image of each view, 0 is the first")->check(whole_number());
  command->add_option("--output", options->output, "model file to write")->required();
  command->add_option("--preview", options->preview, "picture of what was learned; default: OUTPUT.png");
  command->add_option("--config", options->config, "a robot's file, or one with just the section [color]");
  add_force_option(*command, options->force);
  command->callback([options, &exit_code] { exit_code = run_learn(*options); });
}

}  // namespace cgsr::app
