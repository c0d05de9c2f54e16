// cgsr-lab: what `cgsr reproduce` starts. With names (or none) it reproduces tables; `follow` and `scenes` are what it is made of.

#include <algorithm>
#include <cstdio>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>

#include "src/commands/option_checks.h"
#include "src/commands/parse_error.h"
#include "src/config/load.h"
#include "src/output/text_file.h"
#include "tools/lab/ball_follower.h"
#include "tools/lab/reproduce.h"
#include "tools/lab/searched_poses.h"
#include "tools/lab/shaded_views.h"
#include "tools/lab/trackers.h"

namespace cgsr::lab {
namespace {

int complain(const Error& error) {
  fmt::print(stderr, "error: {}\n", error.message);
  return 1;
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
  const auto written = cgsr::app::write_file(options.csv, text);
  return written ? 0 : complain(written.error());
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

void add_film_options(CLI::App& command, FilmOptions& options) {
  command.add_option("--config", options.config, "a robot's file, for its section [color]; none: what ships");
  command.add_option("--scene", options.scene, "seed of a generated film");
  command.add_option("--images", options.images, "how many, the one learned from included")
      ->check(cgsr::app::in_range(1, 1000000));
  command.add_flag("--absent", options.absent, "generated film: the object is in the first image alone");
}

/// What main() offers beside the tables, for tools/count and for looking at single films.
struct Commands {
  explicit Commands(CLI::App& app);
  /// \return the exit code of the command that was given; nothing: none was.
  std::optional<int> run() const;

  FilmOptions film;
  BallOptions ball;
  std::uint64_t shade_seed = 1;
  int shade_views = 10;
  std::uint64_t search_seed = 1;
  int search_poses = 5;
  CLI::App* follow;
  CLI::App* scenes;
  CLI::App* follow_ball;
  CLI::App* shade;
  CLI::App* search;
};

Commands::Commands(CLI::App& app)
    : follow(app.add_subcommand("follow", "run one tracker over one film and score it")),
      scenes(app.add_subcommand("scenes", "write a generated film as images and truth")),
      follow_ball(app.add_subcommand("follow-ball", "chapter 5's tracker over a folder with a mask of shade")),
      shade(app.add_subcommand("shade", "look for shaded regions in the home, for tools/count")),
      search(app.add_subcommand("search-pose", "search for poses on the field, for tools/count")) {
  std::vector<std::string> names;
  for (const NamedTracker& tracker : trackers()) names.emplace_back(tracker.name);
  follow->add_option("--tracker", film.tracker)->check(CLI::IsMember(names));
  follow->add_option("--input", film.input, "folder with img/ and groundtruth.txt");
  follow->add_option("--learn-from", film.learn_from, "another such folder: its object is sought in --input");
  follow->add_option("--size", film.size, "WxH: scale every image of --input");
  follow->add_option("--csv", film.csv, "frame,found,x,y,width,height");
  add_film_options(*follow, film);
  scenes->add_option("--output", film.output)->required();
  add_film_options(*scenes, film);
  follow_ball->add_option("--input", ball.input, "folder with img/, groundtruth.txt and mask.png")->required();
  follow_ball->add_option("--focal", ball.focal_px, "of the camera, in pixels")->capture_default_str();
  follow_ball->add_flag("--without-mask", ball.without_mask, "search dark histograms everywhere");
  follow_ball->add_option("--config", ball.config, "a robot's file, for its section [color]");
  shade->add_option("--seed", shade_seed)->check(cgsr::app::whole_number());
  shade->add_option("--views", shade_views)->check(cgsr::app::in_range(1, 10000));
  search->add_option("--seed", search_seed)->check(cgsr::app::whole_number());
  search->add_option("--poses", search_poses)->check(cgsr::app::in_range(1, 10000));
}

std::optional<int> Commands::run() const {
  const auto code_of = [](const auto& done) { return done ? 0 : complain(done.error()); };
  if (*follow) return follow_film(film);
  if (*follow_ball) return follow_ball_film(ball);
  if (*scenes) return save_scenes(film);
  if (*search) return code_of(search_for_poses(search_seed, search_poses));
  if (*shade) return code_of(look_at_shade(shade_seed, shade_views));
  return std::nullopt;
}

}  // namespace
}  // namespace cgsr::lab

int main(int argc, char** argv) {
  using namespace cgsr::lab;
  cv::setNumThreads(1);
  CLI::App app{"The dissertation's tables and figures, ours beside its own.", "cgsr reproduce"};
  ReproduceOptions options;
  add_reproduce(app, options);
  const Commands commands(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& wrong) {
    return cgsr::app::report_parse_error(app, wrong, argc, argv);
  }

  try {
    if (const auto code = commands.run()) return *code;
    const auto reproduced = reproduce(options);
    return reproduced ? *reproduced : complain(reproduced.error());
  } catch (const std::exception& error) {  // OpenCV's, of a defective picture
    return complain({error.what()});
  }
}
