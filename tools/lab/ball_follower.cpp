#include "tools/lab/ball_follower.h"

#include <array>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/color/learn/learn.h"
#include "platform/count_marks.h"
#include "tools/lab/configurations.h"
#include "tools/lab/film.h"

namespace cgsr::lab {

Result<color::IntegratedTracker> learned_ball(const Image& image, const Box& box, const config::Color& configuration,
                                              const color::IntegratedParameters& parameters, double focal_px) {
  color::LearnParameters learn = configuration.learn;
  learn.widen = false;
  learn.min_distinctiveness = 0.0;
  const std::array samples{color::Sample{image.view(), box}};
  const auto learned = color::learn(samples, learn);
  if (!learned) return tl::unexpected(learned.error());
  return color::IntegratedTracker::create(learned->model, parameters, image.bgr.cols, image.bgr.rows, focal_px);
}

Result<int> follow_ball(const std::string& folder, bool with_mask, double focal_px,
                        const config::Color& configuration) {
  const auto film = open_film(folder);
  if (!film) return tl::unexpected(film.error());
  const cv::Mat cells = with_mask ? cv::imread(folder + "/mask.png", cv::IMREAD_GRAYSCALE) : cv::Mat{};
  if (with_mask && cells.empty()) return fail(folder + "/mask.png: no image that can be read");
  const color::ShadeMaskView mask{cells.data, cells.cols, cells.rows, static_cast<std::ptrdiff_t>(cells.step)};
  auto first = film->image(0);
  if (!first) return tl::unexpected(first.error());
  const auto robot = lamp_robot({});
  if (!robot) return tl::unexpected(robot.error());
  auto tracker = learned_ball(*first, film->truth.front().value_or(Box{}), configuration, robot->integrated, focal_px);
  if (!tracker) return tl::unexpected(tracker.error());
  UnlimitedBudget budget;
  int found = 0;
  for (int i = 0; i < film->size(); ++i) {
    const auto image = film->image(i);
    if (!image) return tl::unexpected(image.error());
    count_stage_begin();
    const color::BallSighting seen = tracker->track(image->view(), with_mask ? mask : color::ShadeMaskView{}, budget);
    count_stage_end("ball");
    count_image_end();
    if (seen.found) ++found;
  }
  return found;
}

}  // namespace cgsr::lab
