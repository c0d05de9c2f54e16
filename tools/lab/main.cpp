// cgsr-lab: what `cgsr reproduce` starts. With names (or none) it reproduces tables; `follow` and `scenes` are what it is made of.

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>

#include "src/commands/option_checks.h"
#include "src/commands/parse_error.h"
#include "src/config/load.h"
#include "tools/lab/ball_follower.h"
#include "tools/lab/experiment.h"
#include "tools/lab/shaded_views.h"
#include "tools/lab/trackers.h"

namespace cgsr::lab {
namespace {

int complain(const Error& error) {
  fmt::print(stderr, "error: {}\n", error.message);
  return 1;
}

bool write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  return static_cast<bool>(file.flush());
}

struct ReproduceOptions {
  std::vector<std::string> names;
  std::uint64_t seed = 1;
  int trials = 0;
  std::string data, json, html, config, videos;
  bool list = false;
  bool no_count = false;
};

Result<std::vector<const Experiment*>> chosen(const std::vector<std::string>& names) {
  std::vector<const Experiment*> all;
  for (const Experiment& experiment : experiments()) {
    if (names.empty() && !experiment.by_name_only) all.push_back(&experiment);
  }
  for (const std::string& name : names) {
    const auto found = std::ranges::find(experiments(), name, &Experiment::name);
    if (found == experiments().end())
      return fail(fmt::format("there is no table '{}'; --list names what there is", name));
    all.push_back(&*found);
  }
  return all;
}

int list_experiments() {
  for (const Experiment& experiment : experiments()) {
    fmt::print("{:14} {}{}\n", experiment.name, experiment.title, experiment.by_name_only ? " (by name only)" : "");
  }
  return 0;
}

Result<Setting> setting_of(const ReproduceOptions& options) {
  const auto configuration = config::load_color(options.config);
  if (!configuration) return tl::unexpected(configuration.error());
  Setting setting;
  setting.configuration = *configuration;
  setting.config_file = options.config;
  setting.seed = options.seed;
  setting.count = !options.no_count;
  if (options.trials > 0) setting.trials = options.trials;
  if (!options.data.empty()) setting.data = options.data;
  if (!options.videos.empty()) setting.videos = options.videos;
  if (isatty(STDERR_FILENO) != 0) {
    setting.progress = [](const std::string& words) { fmt::print(stderr, "\r\033[K{}", words); };
  }
  return setting;
}

int reproduce(const ReproduceOptions& options) {
  if (options.list) return list_experiments();
  const auto wanted = chosen(options.names);
  if (!wanted) return complain(wanted.error());
  const auto setting = setting_of(options);
  if (!setting) return complain(setting.error());
  std::vector<Report> reports;
  for (const Experiment* experiment : *wanted) {
    auto report = experiment->run(*setting);
    setting->progress("");
    if (!report) return complain(report.error());
    fmt::print("{}\n", to_text(*report));
    reports.push_back(std::move(*report));
  }
  for (const auto& [path, text] :
       {std::pair(options.json, to_json(reports).dump(1) + "\n"), std::pair(options.html, to_html(reports))}) {
    if (!path.empty() && !write_file(path, text)) return complain({fmt::format("cannot write {}", path)});
  }
  return 0;
}

constexpr int kGeneratedImages = 150;

struct FilmOptions {
  std::string config, tracker = "ours", input, learn_from, csv, output;
  std::string size;
  std::uint64_t scene = 0;
  int images = 0;  // all; of a generated film kGeneratedImages
  bool absent = false;
};

Result<Film> film_of(const FilmOptions& options, const std::string& folder) {
  std::optional<cv::Size> size;
  cv::Size wanted;
  if (std::sscanf(options.size.c_str(), "%dx%d", &wanted.width, &wanted.height) == 2) size = wanted;
  if (!folder.empty()) return open_film(folder, size);
  return generated_film(options.scene, options.images > 0 ? options.images : kGeneratedImages, options.absent);
}

int follow_film(const FilmOptions& options) {
  const auto film = film_of(options, options.input);
  if (!film) return complain(film.error());
  const auto learn_from = options.learn_from.empty() ? film : film_of(options, options.learn_from);
  if (!learn_from) return complain(learn_from.error());
  const auto configuration = config::load_color(options.config);
  if (!configuration) return complain(configuration.error());
  const auto named = std::ranges::find(trackers(), options.tracker, &NamedTracker::name);
  const auto boxes =
      follow(*named->make(*configuration), *film, options.images > 0 ? options.images : film->size(), *learn_from);
  if (!boxes) return complain(boxes.error());
  Boxes truth = film->truth;
  truth.resize(boxes->size());
  const Score result = score(*boxes, truth);
  fmt::print(
      "{} / {}: precision {:.3f} recall {:.3f} IoU {:.3f} success {:.3f} found {:.3f} images {} found when absent {}\n",
      film->name, named->name, result.precision, result.recall, result.iou, result.success, result.found, result.images,
      result.found_when_absent);
  if (options.csv.empty()) return 0;
  std::string text = "frame,found,x,y,width,height\n";
  for (std::size_t i = 0; i < boxes->size(); ++i) {
    const Box box = (*boxes)[i].value_or(Box{});
    text +=
        fmt::format("{},{},{:.2f},{:.2f},{:.2f},{:.2f}\n", i, (*boxes)[i] ? 1 : 0, box.x, box.y, box.width, box.height);
  }
  return write_file(options.csv, text) ? 0 : complain({fmt::format("cannot write {}", options.csv)});
}

struct BallOptions {
  std::string config, input;
  double focal_px = 600.0;
  bool without_mask = false;
};

int follow_ball_film(const BallOptions& options) {
  const auto configuration = config::load_color(options.config);
  if (!configuration) return complain(configuration.error());
  const auto found = follow_ball(options.input, !options.without_mask, options.focal_px, *configuration);
  if (!found) return complain(found.error());
  fmt::print("found in {} images\n", *found);
  return 0;
}

int save_scenes(const FilmOptions& options) {
  const auto saved = film_of(options, "").and_then([&](const Film& film) { return save_film(film, options.output); });
  return saved ? 0 : complain(saved.error());
}

void add_reproduce(CLI::App& app, ReproduceOptions& options) {
  app.add_option("name", options.names, "tables to reproduce; none: all that are not by name only");
  app.add_flag("--list", options.list, "name what there is");
  app.add_option("--seed", options.seed, "of everything that is drawn at random")
      ->check(cgsr::app::whole_number())
      ->capture_default_str();
  app.add_option("--trials", options.trials, "instead of each table's own number")
      ->check(cgsr::app::in_range(1, 1000000));
  app.add_option("--config", options.config, "a robot's file, for its section [color]; none: what ships");
  app.add_option("--data", options.data, "folder of recorded sequences")->envname("CGSR_DATA");
  app.add_option("--videos", options.videos,
                 "folder for the films of tables that film; none: cgsr-videos in the temporary folder");
  app.add_flag("--no-count", options.no_count, "leave out the instructions, which are slow to count");
  app.add_option("--json", options.json, "write the rows for machines");
  app.add_option("--html", options.html, "write a page with tables and plots");
}

void add_film_options(CLI::App& command, FilmOptions& options) {
  command.add_option("--config", options.config, "a robot's file, for its section [color]; none: what ships");
  command.add_option("--scene", options.scene, "seed of a generated film");
  command.add_option("--images", options.images, "how many, the one learned from included")
      ->check(cgsr::app::in_range(1, 1000000));
  command.add_flag("--absent", options.absent, "generated film: the object is in the first image alone");
}

}  // namespace
}  // namespace cgsr::lab

int main(int argc, char** argv) {
  using namespace cgsr::lab;
  cv::setNumThreads(1);
  CLI::App app{"The dissertation's tables and figures, ours beside its own.", "cgsr reproduce"};
  ReproduceOptions reproduce_options;
  add_reproduce(app, reproduce_options);

  FilmOptions film_options;
  CLI::App* follow_command = app.add_subcommand("follow", "run one tracker over one film and score it");
  std::vector<std::string> names;
  for (const NamedTracker& tracker : trackers()) names.emplace_back(tracker.name);
  follow_command->add_option("--tracker", film_options.tracker)->check(CLI::IsMember(names));
  follow_command->add_option("--input", film_options.input, "folder with img/ and groundtruth.txt");
  follow_command->add_option("--learn-from", film_options.learn_from,
                             "another such folder: its object is sought in --input");
  follow_command->add_option("--size", film_options.size, "WxH: scale every image of --input");
  follow_command->add_option("--csv", film_options.csv, "frame,found,x,y,width,height");
  add_film_options(*follow_command, film_options);
  CLI::App* scenes_command = app.add_subcommand("scenes", "write a generated film as images and truth");
  scenes_command->add_option("--output", film_options.output)->required();
  add_film_options(*scenes_command, film_options);
  BallOptions ball_options;
  CLI::App* ball_command = app.add_subcommand("follow-ball", "chapter 5's tracker over a folder with a mask of shade");
  ball_command->add_option("--input", ball_options.input, "folder with img/, groundtruth.txt and mask.png")->required();
  ball_command->add_option("--focal", ball_options.focal_px, "of the camera, in pixels")->capture_default_str();
  ball_command->add_flag("--without-mask", ball_options.without_mask, "search dark histograms everywhere");
  ball_command->add_option("--config", ball_options.config, "a robot's file, for its section [color]");
  std::uint64_t shade_seed = 1;
  int shade_views = 10;
  CLI::App* shade_command = app.add_subcommand("shade", "look for shaded regions in the home, for tools/count");
  shade_command->add_option("--seed", shade_seed)->check(cgsr::app::whole_number());
  shade_command->add_option("--views", shade_views)->check(cgsr::app::in_range(1, 10000));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    return cgsr::app::report_parse_error(app, wrong, argc, argv);
  }

  try {
    if (*follow_command) return follow_film(film_options);
    if (*ball_command) return follow_ball_film(ball_options);
    if (*scenes_command) return save_scenes(film_options);
    if (*shade_command) {
      const auto looked = look_at_shade(shade_seed, shade_views);
      return looked ? 0 : complain(looked.error());
    }
    return reproduce(reproduce_options);
  } catch (const std::exception& error) {  // OpenCV's, of a defective picture
    return complain({error.what()});
  }
}
