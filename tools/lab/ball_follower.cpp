#include "tools/lab/ball_follower.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/color/learn/learn.h"
#include "platform/count_marks.h"
#include "tools/lab/configurations.h"
#include "tools/lab/film.h"

namespace cgsr::lab {

Result<BallTracker> learned_ball(const Image& image, const Box& box, const config::Color& configuration,
                                 const color::IntegratedParameters& parameters, const runtime::StageParameters& row,
                                 double focal_px) {
  color::LearnParameters learn = configuration.learn;
  learn.widen = false;
  learn.min_distinctiveness = 0.0;
  const std::array samples{color::Sample{image.view(), box}};
  const auto learned = color::learn(samples, learn);
  if (!learned) return tl::unexpected(learned.error());
  auto tracker = color::IntegratedTracker::create(learned->model, parameters, image.bgr.cols, image.bgr.rows, focal_px);
  if (!tracker) return tl::unexpected(tracker.error());
  return BallTracker(std::move(*tracker), row);
}

stages::ShadowMasks all_lit(const shade::ShadeMasks& masks) {
  const std::vector<std::uint8_t> nothing(masks.possibly_shaded.size(), 0);
  return given_masks({masks.width, masks.height, nothing, nothing});
}

namespace {

/// \return the masks of a folder's mask.png.
Result<stages::ShadowMasks> read_masks(const std::string& file) {
  const cv::Mat cells = cv::imread(file, cv::IMREAD_GRAYSCALE);
  if (cells.empty()) return fail(file + ": no image that can be read");
  shade::ShadeMasks masks{cells.cols, cells.rows, {}, {}};
  masks.possibly_shaded.assign(cells.begin<std::uint8_t>(), cells.end<std::uint8_t>());
  masks.surface_shaded = masks.possibly_shaded;
  return given_masks(std::move(masks));
}

}  // namespace

Result<int> follow_ball(const std::string& folder, bool with_mask, double focal_px,
                        const config::Color& configuration) {
  const auto film = open_film(folder);
  if (!film) return tl::unexpected(film.error());
  const auto masks = with_mask ? read_masks(folder + "/mask.png") : stages::ShadowMasks{};
  if (!masks) return tl::unexpected(masks.error());
  auto first = film->image(0);
  if (!first) return tl::unexpected(first.error());
  const auto robot = lamp_robot({});
  if (!robot) return tl::unexpected(robot.error());
  auto tracker = learned_ball(*first, film->truth.front().value_or(Box{}), configuration, robot->integrated,
                              row_of<stages::TrackStage>(*robot), focal_px);
  if (!tracker) return tl::unexpected(tracker.error());
  int found = 0;
  for (int i = 0; i < film->size(); ++i) {
    const auto image = film->image(i);
    if (!image) return tl::unexpected(image.error());
    count_stage_begin();
    const color::BallSighting seen = tracker->track(image->view(), *masks);
    count_stage_end("ball");
    count_image_end();
    if (seen.found) ++found;
  }
  return found;
}

}  // namespace cgsr::lab
