#include "pipeline/color/ball/integrated_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/color/ball/ball_circle.h"
#include "pipeline/color/ball/ball_model.h"
#include "pipeline/color/ball/ball_search.h"
#include "pipeline/color/ball/image_part.h"
#include "pipeline/color/search/box_divergence.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {
namespace {

constexpr double kCoreSide = 0.62;  // of the diameter: a square that lies inside the circle
constexpr double kSizeLimit = 5.0;  // of the learned diameter, where nothing else is known
constexpr double kGrowth = 1.33;    // of a followed circle from one image to the next
constexpr double kCatch = 1.6;      // radii about the expected place in which a followed ball's colours are looked for
constexpr double kStillOwn = 0.8;   // of what the colours inside must be at first sight
constexpr double kMoreAround = 0.15;  // of them may be around a followed one
constexpr double kBetter = 0.12;      // in score, that a ball elsewhere must be
constexpr double kInertia = 0.7;      // of the motion from image to image
constexpr double kUnlike = 1.0;       // a divergence above all that can be
constexpr double kMostShaded = 0.75;  // of a circle in the mask: the rest is too little to say how it is lit
constexpr int kLeastImage_px = 16;    // of a side
constexpr int kLookUnits = 300;       // a closer look at a window costs so many groups of windows

Box core_of(const Circle& circle) {
  const double side = kCoreSide * 2.0 * circle.radius_px;
  return {circle.x_px - 0.5 * side, circle.y_px - 0.5 * side, side, side};
}

Box box_of(const Circle& circle) {
  const double side = 2.0 * circle.radius_px;
  return {circle.x_px - circle.radius_px, circle.y_px - circle.radius_px, side, side};
}

bool covers(const Circle& circle, double x, double y) {
  const double dx = x - circle.x_px;
  const double dy = y - circle.y_px;
  return dx * dx + dy * dy < circle.radius_px * circle.radius_px;
}

bool can_be_searched(const ImageView& image, int max_width_px, int max_height_px) {
  return image.format == PixelFormat::kYuyv && image.width_px >= kLeastImage_px && image.height_px >= kLeastImage_px &&
         image.width_px % 2 == 0 && image.width_px <= max_width_px && image.height_px <= max_height_px;
}

}  // namespace

SizeRange projected_size(const BallParameters& ball, double focal_px) {
  return {ball.diameter_m * focal_px / ball.max_distance_m, ball.diameter_m * focal_px / ball.min_distance_m};
}

struct IntegratedTracker::State {
  State(BallModel&& ball_model, const IntegratedParameters& p, BallSearch&& both, int max_width, int max_height)
      : parameters(p),
        ball(std::move(ball_model)),
        search(std::move(both)),
        bright_divergence(ball.bright, p.search.divergence),
        dark_divergence(ball.dark, p.search.divergence),
        labels(max_width, max_height),
        max_width_px(max_width),
        max_height_px(max_height) {}

  struct Likeness {
    double divergence = kUnlike;
    int light = 0;  ///< of the bright or dark model.
    bool dark = false;
  };
  struct Answer {
    CircleFit fit;
    Likeness likeness;
  };
  /// Which pixels of a box count.
  enum class Where : std::uint8_t { kEverywhere, kShaded, kLit };

  BallSighting look(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget);
  [[nodiscard]] Answer find(const BallPixels& pixels, WorkBudget& budget, const SizeRange& sizes, BallSighting& seen);
  void restart_search();
  [[nodiscard]] SearchRequest request_for(const SizeRange& sizes) const;
  [[nodiscard]] CircleFit follow(BallPixels pixels, const SizeRange& sizes) const;
  [[nodiscard]] Answer best_of_windows(BallPixels pixels, WorkBudget& budget, const SizeRange& sizes);
  [[nodiscard]] const std::uint8_t* colors_under(std::size_t of_light) const { return ball.of_code[of_light].data(); }
  [[nodiscard]] bool is_found(const CircleFit& fit) const;
  [[nodiscard]] bool is_kept(const CircleFit& fit) const;
  void remember(const Answer& answer);
  void describe(const Answer& answer, const BallPixels& pixels, BallSighting& seen) const;
  [[nodiscard]] Likeness likeness_of(const BallPixels& pixels, const Circle& of);
  [[nodiscard]] Likeness likeness_in_the_light(const BallPixels& pixels, const Circle& of);
  [[nodiscard]] bool looks_shaded_in_the_light(const BallPixels& pixels, const Circle& of);
  [[nodiscard]] BoxDivergence::Answer bright_of(const BallPixels& pixels, const Box& box, Where where);
  [[nodiscard]] BoxDivergence::Answer dark_of(const BallPixels& pixels, const Box& box, Where where);
  [[nodiscard]] BoxDivergence::Answer divergence_of(const BallPixels& pixels, Box box, Where where,
                                                    const imaging::LabelTable& table, BoxDivergence& divergence);

  IntegratedParameters parameters;
  BallModel ball;
  BallSearch search;
  BoxDivergence bright_divergence;
  BoxDivergence dark_divergence;
  imaging::ReducedImage labels;  // about a circle
  SizeRange usual_sizes;
  double size_step = 1.0;
  int max_width_px;
  int max_height_px;

  // Of the image under way.
  int factor = 2;  // of the reduced image
  const ShadeAtPlace* places = nullptr;

  // From image to image.
  bool located = false;
  Circle circle;
  std::size_t light = 0;  // of the grid, under which it was seen last
  double motion_x_px = 0.0;
  double motion_y_px = 0.0;
  int images_without = 0;
  Installments next_look;
  int next_window = 0;  // of the search that is at its end, to be looked at
};

bool IntegratedTracker::State::is_found(const CircleFit& fit) const {
  const BallParameters& p = parameters.ball;
  return fit.agreement >= p.min_found_agreement && fit.inside >= p.min_inside && fit.around <= p.max_around;
}

bool IntegratedTracker::State::is_kept(const CircleFit& fit) const {
  const BallParameters& p = parameters.ball;
  return fit.agreement >= p.min_kept_agreement && fit.inside >= kStillOwn * p.min_inside &&
         fit.around <= p.max_around + kMoreAround;
}

SearchRequest IntegratedTracker::State::request_for(const SizeRange& sizes) const {
  // The smallest window fits into the smallest ball, the others are larger by one step each.
  SearchRequest request;
  request.width_px = std::max(4.0, kCoreSide * sizes.min_px * std::pow(size_step, (parameters.search.sizes - 1) / 2));
  request.height_px = request.width_px;
  request.max_divergence = parameters.max_divergence;
  request.candidates = parameters.candidates;
  return request;
}

void IntegratedTracker::State::restart_search() {
  search.abandon();
  next_window = 0;
}

/// Goes on with the search; when it is at its end, the windows are looked at closely in this image.
IntegratedTracker::State::Answer IntegratedTracker::State::find(const BallPixels& pixels, WorkBudget& budget,
                                                                const SizeRange& sizes, BallSighting& seen) {
  const auto progress = search.advance(pixels.image, pixels.mask, request_for(sizes), sizes.min_px, budget);
  seen.bright_windows = search.bright().windows;
  seen.bright_examined = search.bright().examined;
  seen.dark_windows = search.dark().windows;
  seen.dark_examined = search.dark().examined;
  seen.exact = progress == BallSearch::Progress::kAtEnd;
  if (!seen.exact) return {};
  const Answer best = best_of_windows(pixels, budget, sizes);
  seen.exact = next_window == search.bright().count + search.dark().count;
  if (seen.exact || best.fit.agreement > 0.0) restart_search();
  return best;
}

/// Near where it was last, moving on as it moved.
CircleFit IntegratedTracker::State::follow(BallPixels pixels, const SizeRange& sizes) const {
  pixels.of_code = colors_under(light);
  const double diameter = 2.0 * circle.radius_px;
  const SizeRange near{std::max(sizes.min_px, diameter / kGrowth), std::min(sizes.most_px, diameter * kGrowth)};
  if (near.min_px > near.most_px) return {};
  const Circle expected{circle.x_px + motion_x_px, circle.y_px + motion_y_px, kCatch * circle.radius_px};
  const Circle middle = middle_of_members(pixels, expected);
  return fit_circle(pixels, middle.x_px, middle.y_px, near);
}

/// The best circle at those windows of both searches that have not been looked at yet.
IntegratedTracker::State::Answer IntegratedTracker::State::best_of_windows(BallPixels pixels, WorkBudget& budget,
                                                                           const SizeRange& sizes) {
  Answer best;
  const SearchResult& bright = search.bright();
  const SearchResult& dark = search.dark();
  for (; next_window < bright.count + dark.count; ++next_window) {
    const Match& match = next_window < bright.count
                             ? bright.matches[static_cast<std::size_t>(next_window)]
                             : dark.matches[static_cast<std::size_t>(next_window - bright.count)];
    const double x = match.box.x + 0.5 * match.box.width;
    const double y = match.box.y + 0.5 * match.box.height;
    if (best.fit.agreement > 0.0 && covers(best.fit.circle, x, y)) continue;
    if (!next_look.pay(kLookUnits, budget)) return best;
    pixels.of_code = colors_under(static_cast<std::size_t>(match.light) % ball.of_code.size());
    const CircleFit fit = fit_circle(pixels, x, y, sizes);
    if (!is_found(fit) || fit.score() <= best.fit.score()) continue;
    const Likeness likeness = likeness_of(pixels, fit.circle);
    if (likeness.divergence <= parameters.max_found_divergence) best = {fit, likeness};
  }
  return best;
}

void IntegratedTracker::State::remember(const Answer& answer) {
  const Circle& now = answer.fit.circle;
  if (located && images_without == 0) {
    motion_x_px = kInertia * (now.x_px - circle.x_px);
    motion_y_px = kInertia * (now.y_px - circle.y_px);
  } else {
    motion_x_px = 0.0;
    motion_y_px = 0.0;
  }
  circle = now;
  light = static_cast<std::size_t>(answer.likeness.light) % ball.of_code.size();
  located = true;
  images_without = 0;
}

/// Which histogram fits best what is inside a circle.
IntegratedTracker::State::Likeness IntegratedTracker::State::likeness_of(const BallPixels& pixels, const Circle& of) {
  if (places != nullptr && !places->may_be_shaded(of, parameters.ball.diameter_m)) {
    return likeness_in_the_light(pixels, of);
  }
  if (looks_shaded_in_the_light(pixels, of)) return {};
  const Box core = core_of(of);
  const auto bright = bright_of(pixels, core, Where::kEverywhere);
  const auto dark = dark_of(pixels, core, Where::kShaded);
  if (dark.divergence < bright.divergence) return {dark.divergence, dark.light, true};
  return {bright.divergence, bright.light, false};
}

/// Of what stands in the light whatever its ray passes through: nearer to a dark histogram than to every bright one it is something darker than the
/// ball.
IntegratedTracker::State::Likeness IntegratedTracker::State::likeness_in_the_light(const BallPixels& pixels,
                                                                                   const Circle& of) {
  const Box core = core_of(of);
  const auto bright = bright_of(pixels, core, Where::kEverywhere);
  if (dark_of(pixels, core, Where::kEverywhere).divergence < bright.divergence) return {};
  return {bright.divergence, bright.light, false};
}

/// Is what lies outside the mask nearer to a dark histogram than to every bright one? Then it is something darker than the ball, however near
/// to a bright one it comes.
bool IntegratedTracker::State::looks_shaded_in_the_light(const BallPixels& pixels, const Circle& of) {
  if (pixels.mask.empty() || shade_share(pixels, of) > kMostShaded) return false;
  const Box core = core_of(of);
  return dark_of(pixels, core, Where::kLit).divergence < bright_of(pixels, core, Where::kLit).divergence;
}

BoxDivergence::Answer IntegratedTracker::State::bright_of(const BallPixels& pixels, const Box& box, Where where) {
  return divergence_of(pixels, box, where, search.bright_table(), bright_divergence);
}

BoxDivergence::Answer IntegratedTracker::State::dark_of(const BallPixels& pixels, const Box& box, Where where) {
  return divergence_of(pixels, box, where, search.dark_table(), dark_divergence);
}

/// Of those pixels of a box that count; without a mask all do.
BoxDivergence::Answer IntegratedTracker::State::divergence_of(const BallPixels& pixels, Box box, Where where,
                                                              const imaging::LabelTable& table,
                                                              BoxDivergence& divergence) {
  if (where == Where::kShaded && !pixels.mask.empty()) {
    // What lies beside the rectangle of all shade is left out; what is lit in it speaks against the ball.
    const ImagePart shaded = shaded_part(pixels.mask, pixels.image);
    box = intersection(box, {1.0 * shaded.left, 1.0 * shaded.top, 1.0 * shaded.width, 1.0 * shaded.height});
    if (box.area() <= 0.0) return {kUnlike, 0};
  }
  const ImagePart part = part_around(box, pixels.image);
  if (!imaging::reduce(cut(pixels.image, part), factor, table, labels)) return {kUnlike, 0};
  if (where != Where::kEverywhere && !pixels.mask.empty()) {
    keep_only(where == Where::kLit ? Kept::kLit : Kept::kShaded, pixels.mask, pixels.image, part, labels);
  }
  box.x -= part.left;
  box.y -= part.top;
  return divergence.of(labels, box);
}

BallSighting IntegratedTracker::State::look(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget) {
  BallSighting seen;
  seen.mask_used = can_be_used(mask, image);
  if (!can_be_searched(image, max_width_px, max_height_px)) return seen;
  const BallPixels pixels{image, colors_under(light), seen.mask_used ? mask : ShadeMaskView{}};
  const SizeRange& sizes = usual_sizes;
  factor = imaging::reduction_for(image.width_px, image.height_px, sizes.min_px);
  Answer answer;
  if (located) {
    answer.fit = follow(pixels, sizes);
    if (is_kept(answer.fit)) answer.likeness = likeness_of(pixels, answer.fit.circle);
  }
  bool is_there = answer.likeness.divergence <= parameters.max_kept_divergence;
  if (is_there && is_found(answer.fit)) {
    restart_search();
  } else {
    const Answer elsewhere = find(pixels, budget, sizes, seen);
    const bool is_better = elsewhere.fit.score() > (is_there ? answer.fit.score() + kBetter : 0.0);
    if (is_better) {
      if (!covers(circle, elsewhere.fit.circle.x_px, elsewhere.fit.circle.y_px)) images_without = 1;  // no motion
      answer = elsewhere;
      is_there = true;
    }
  }
  if (!is_there) {
    if (++images_without > parameters.max_missed_images) located = false;
    return seen;
  }
  remember(answer);
  describe(answer, pixels, seen);
  return seen;
}

void IntegratedTracker::State::describe(const Answer& answer, const BallPixels& pixels, BallSighting& seen) const {
  const Box whole_image{0.0, 0.0, static_cast<double>(pixels.image.width_px),
                        static_cast<double>(pixels.image.height_px)};
  seen.found = true;
  seen.circle = circle;
  seen.box = intersection(box_of(circle), whole_image);
  seen.agreement = answer.fit.agreement;
  seen.divergence = answer.likeness.divergence;
  seen.dark = answer.likeness.dark;
  const ColorModel& model = seen.dark ? ball.dark : ball.bright;
  seen.light = model.lights[static_cast<std::size_t>(answer.likeness.light)];
  seen.shade_share = shade_share(pixels, circle);
}

Result<IntegratedTracker> IntegratedTracker::create(const ColorModel& model, const IntegratedParameters& parameters,
                                                    int max_width_px, int max_height_px, double focal_px) {
  auto ball = make_ball_model(model, parameters.dark_factors);
  if (!ball) return tl::unexpected(ball.error());
  if (!(parameters.ball.min_distance_m < parameters.ball.max_distance_m)) {
    return fail("the ball's min_distance_m is not below its max_distance_m");
  }
  const double learned_px = ball->diameter_px;
  const SizeRange usual_sizes = focal_px > 0.0 ? projected_size(parameters.ball, focal_px)
                                               : SizeRange{learned_px / kSizeLimit, learned_px * kSizeLimit};
  SearchParameters search = parameters.search;
  search.size_step = std::clamp(
      std::pow(usual_sizes.most_px / usual_sizes.min_px, 1.0 / std::max(1, parameters.search.sizes - 1)), 1.01, 2.0);
  auto both = BallSearch::create(*ball, search, max_width_px, max_height_px);
  if (!both) return tl::unexpected(both.error());
  auto state = std::make_unique<State>(std::move(*ball), parameters, std::move(*both), max_width_px, max_height_px);
  state->usual_sizes = usual_sizes;
  state->size_step = search.size_step;
  return IntegratedTracker(std::move(state));
}

IntegratedTracker::IntegratedTracker(std::unique_ptr<State> state) : state_(std::move(state)) {}
IntegratedTracker::IntegratedTracker(IntegratedTracker&&) noexcept = default;
IntegratedTracker& IntegratedTracker::operator=(IntegratedTracker&&) noexcept = default;
IntegratedTracker::~IntegratedTracker() = default;

BallSighting IntegratedTracker::track(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget,
                                      const ShadeAtPlace* places) {
  state_->places = places;
  const BallSighting seen = state_->look(image, mask, budget);
  state_->places = nullptr;  // the caller's, for this image
  return seen;
}

void IntegratedTracker::forget() {
  state_->located = false;
  state_->images_without = 0;
  state_->restart_search();
}

}  // namespace cgsr::color
