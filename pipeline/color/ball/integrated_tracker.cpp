#include "pipeline/color/ball/integrated_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/color/ball/ball_circle.h"
#include "pipeline/color/ball/ball_model.h"
#include "pipeline/color/search/box_divergence.h"
#include "pipeline/color/search/window_search.h"
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
constexpr int kLeastSide_px = 32;     // of what is searched for dark histograms

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

/// The first pixel of a mask's column or row.
int first_pixel(int cell, int cells, int pixels) {
  return (cell * pixels + cells - 1) / cells;
}

bool can_be_used(const ShadeMaskView& mask, const ImageView& image) {
  return !mask.empty() && mask.stride >= mask.width && mask.width <= image.width_px && mask.height <= image.height_px;
}

/// A rectangle of whole pixels.
struct Part {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// \return the first of [from, to) and the length, at least kLeastSide_px where there is so much.
std::pair<int, int> span_of(int from, int to, int limit) {
  const int length = std::min(limit, std::max(kLeastSide_px, to - from));
  return {std::clamp(from, 0, limit - length), length};
}

/// Of even columns.
Part part_of(int left, int right, int top, int bottom, const ImageView& image) {
  const auto [x, width] = span_of(left / 2 * 2, std::min(image.width_px, (right + 1) / 2 * 2), image.width_px);
  const auto [y, height] = span_of(top, bottom, image.height_px);
  return {x, y, width, height};
}

Part part_around(const Box& box, const ImageView& image) {
  const auto pixel = [](double edge, int limit) { return std::clamp(static_cast<int>(std::lround(edge)), 0, limit); };
  return part_of(pixel(box.x, image.width_px), pixel(box.x + box.width, image.width_px), pixel(box.y, image.height_px),
                 pixel(box.y + box.height, image.height_px), image);
}

/// The part of the image that may lie in shade, of even columns; width 0: nothing does.
Part shaded_part(const ShadeMaskView& mask, const ImageView& image) {
  int left = mask.width;
  int right = 0;
  int top = mask.height;
  int bottom = 0;
  for (int y = 0; y < mask.height; ++y) {
    const std::uint8_t* row = mask.cells + y * mask.stride;
    const std::uint8_t* end = row + mask.width;
    const auto* first = std::find_if(row, end, [](std::uint8_t cell) { return cell != 0; });
    if (first == end) continue;
    top = std::min(top, y);
    bottom = y + 1;
    left = std::min(left, static_cast<int>(first - row));
    const std::uint8_t* last = end - 1;
    while (*last == 0) --last;
    right = std::max(right, static_cast<int>(last - row) + 1);
  }
  if (top >= bottom) return {};
  return part_of(first_pixel(left, mask.width, image.width_px), first_pixel(right, mask.width, image.width_px),
                 first_pixel(top, mask.height, image.height_px), first_pixel(bottom, mask.height, image.height_px),
                 image);
}

enum class Kept : std::uint8_t { kShaded, kLit };

/// Takes the labels away from what is not kept.
void keep_only(Kept kept, const ShadeMaskView& mask, const ImageView& image, const Part& part,
               imaging::ReducedImage& labels) {
  const int factor = labels.factor;
  const auto reduced = [factor](int pixel, int start, int limit) {
    return std::clamp((pixel - start + factor - 1) / factor, 0, limit);
  };
  for (int y = 0; y < labels.height_px; ++y) {
    const int cell_y = std::min((part.top + y * factor) * mask.height / image.height_px, mask.height - 1);
    const std::uint8_t* cells = mask.cells + cell_y * mask.stride;
    std::uint16_t* row = labels.labels.data() + static_cast<std::ptrdiff_t>(y) * labels.width_px;
    int cell = part.left * mask.width / image.width_px;
    int from = 0;
    while (from < labels.width_px && cell < mask.width) {
      const bool shaded = cells[cell] != 0;
      do ++cell;
      while (cell < mask.width && (cells[cell] != 0) == shaded);
      const int to = cell == mask.width
                         ? labels.width_px
                         : reduced(first_pixel(cell, mask.width, image.width_px), part.left, labels.width_px);
      if (shaded != (kept == Kept::kShaded) && to > from) std::fill(row + from, row + to, std::uint16_t{0});
      from = std::max(from, to);
    }
  }
}

ImageView cut(const ImageView& image, const Part& part) {
  return {image.row(part.top) + std::ptrdiff_t{2} * part.left, part.width, part.height, image.stride_bytes,
          image.format};
}

}  // namespace

SizeRange projected_size(const BallParameters& ball, double focal_px) {
  return {ball.diameter_m * focal_px / ball.max_distance_m, ball.diameter_m * focal_px / ball.min_distance_m};
}

struct IntegratedTracker::State {
  State(BallModel&& ball_model, const IntegratedParameters& p, WindowSearch&& bright, WindowSearch&& dark,
        int max_width, int max_height)
      : parameters(p),
        ball(std::move(ball_model)),
        bright_search(std::move(bright)),
        dark_search(std::move(dark)),
        bright_divergence(ball.bright, p.search.divergence),
        dark_divergence(ball.dark, p.search.divergence),
        bright_labels(max_width, max_height),
        dark_labels(max_width, max_height),
        lit_labels(max_width, max_height) {}

  struct Likeness {
    double divergence = kUnlike;
    int light = 0;  ///< of the bright or dark model.
    bool dark = false;
  };
  struct Answer {
    CircleFit fit;
    Likeness likeness;
  };

  BallSighting look(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget, const SizeRange& sizes);
  bool search(const BallPixels& pixels, WorkBudget& budget, const SizeRange& sizes, BallSighting& seen);
  void search_dark(const BallPixels& pixels, SearchRequest request, BallSighting& seen);
  [[nodiscard]] CircleFit follow(BallPixels pixels, const SizeRange& sizes) const;
  [[nodiscard]] Answer find(BallPixels pixels, WorkBudget& budget, const SizeRange& sizes);
  [[nodiscard]] const std::uint8_t* colors_under(std::size_t of_light) const { return ball.of_code[of_light].data(); }
  [[nodiscard]] bool is_found(const CircleFit& fit) const;
  [[nodiscard]] bool is_kept(const CircleFit& fit) const;
  void remember(const Answer& answer);
  [[nodiscard]] Likeness likeness_of(const BallPixels& pixels, const Circle& of);
  [[nodiscard]] bool looks_shaded_in_the_light(const BallPixels& pixels, const Circle& of);
  [[nodiscard]] double lit_divergence(const BallPixels& pixels, Box box, const WindowSearch& search,
                                      BoxDivergence& divergence);

  IntegratedParameters parameters;
  BallModel ball;
  WindowSearch bright_search;
  WindowSearch dark_search;
  BoxDivergence bright_divergence;
  BoxDivergence dark_divergence;
  imaging::ReducedImage bright_labels;
  imaging::ReducedImage dark_labels;  // of dark_part
  imaging::ReducedImage lit_labels;   // of what is surely lit about a circle
  SizeRange usual_sizes;
  double size_step = 1.0;

  // Of the image under way.
  Part dark_part;
  SearchResult bright_matches;
  SearchResult dark_matches;

  // From image to image.
  bool located = false;
  Circle circle;
  std::size_t light = 0;  // of the grid, under which it was seen last
  double motion_x_px = 0.0;
  double motion_y_px = 0.0;
  int images_without = 0;
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

/// \return whether the image is one that can be searched.
bool IntegratedTracker::State::search(const BallPixels& pixels, WorkBudget& budget, const SizeRange& sizes,
                                      BallSighting& seen) {
  bright_matches = {};
  dark_matches = {};
  // The smallest window fits into the smallest ball, the others are larger by one step each.
  SearchRequest request;
  request.width_px = std::max(4.0, kCoreSide * sizes.min_px * std::pow(size_step, (parameters.search.sizes - 1) / 2));
  request.height_px = request.width_px;
  request.max_divergence = parameters.max_divergence;
  request.candidates = parameters.candidates;
  request.budget = &budget;
  const ImageView& image = pixels.image;
  const int factor = imaging::reduction_for(image.width_px, image.height_px, sizes.min_px);
  if (!imaging::reduce(image, factor, bright_search.labels(), bright_labels)) return false;
  bright_matches = bright_search.search(bright_labels, request).value_or(SearchResult{});
  seen.bright_windows = bright_matches.windows;
  seen.bright_examined = bright_matches.examined;
  seen.exact = bright_matches.exact;
  search_dark(pixels, request, seen);
  return true;
}

void IntegratedTracker::State::search_dark(const BallPixels& pixels, SearchRequest request, BallSighting& seen) {
  const ImageView& image = pixels.image;
  dark_part = {0, 0, image.width_px, image.height_px};
  if (seen.mask_used) dark_part = shaded_part(pixels.mask, image);
  if (dark_part.width == 0) return;
  if (!imaging::reduce(cut(image, dark_part), bright_labels.factor, dark_search.labels(), dark_labels)) {
    dark_part = {};
    return;
  }
  if (seen.mask_used) keep_only(Kept::kShaded, pixels.mask, image, dark_part, dark_labels);
  dark_matches = dark_search.search(dark_labels, request).value_or(SearchResult{});
  for (int i = 0; i < dark_matches.count; ++i) {
    Box& box = dark_matches.matches[static_cast<std::size_t>(i)].box;
    box.x += dark_part.left;
    box.y += dark_part.top;
  }
  seen.dark_windows = dark_matches.windows;
  seen.dark_examined = dark_matches.examined;
  seen.exact = seen.exact && dark_matches.exact;
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

/// The best circle at one of the windows of both searches.
IntegratedTracker::State::Answer IntegratedTracker::State::find(BallPixels pixels, WorkBudget& budget,
                                                                const SizeRange& sizes) {
  Answer best;
  for (const SearchResult* matches : {&bright_matches, &dark_matches}) {
    for (int i = 0; i < matches->count; ++i) {
      const Match& match = matches->matches[static_cast<std::size_t>(i)];
      const Box& box = match.box;
      const double x = box.x + 0.5 * box.width;
      const double y = box.y + 0.5 * box.height;
      if (best.fit.agreement > 0.0 && covers(best.fit.circle, x, y)) continue;
      if (!budget.grant()) return best;
      pixels.of_code = colors_under(static_cast<std::size_t>(match.light) % ball.of_code.size());
      const CircleFit fit = fit_circle(pixels, x, y, sizes);
      if (!is_found(fit) || fit.score() <= best.fit.score()) continue;
      const Likeness likeness = likeness_of(pixels, fit.circle);
      if (likeness.divergence <= parameters.max_found_divergence) best = {fit, likeness};
    }
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
  if (looks_shaded_in_the_light(pixels, of)) return {};
  Box core = core_of(of);
  const auto bright = bright_divergence.of(bright_labels, core);
  Likeness likeness{bright.divergence, bright.light, false};
  if (dark_part.width == 0) return likeness;
  core.x -= dark_part.left;
  core.y -= dark_part.top;
  const auto dark = dark_divergence.of(dark_labels, core);
  if (dark.divergence < likeness.divergence) likeness = {dark.divergence, dark.light, true};
  return likeness;
}

/// Is what lies outside the mask nearer to a dark histogram than to every bright one? Then it is something darker than the ball, however near
/// to a bright one it comes.
bool IntegratedTracker::State::looks_shaded_in_the_light(const BallPixels& pixels, const Circle& of) {
  if (pixels.mask.empty() || shade_share(pixels, of) > kMostShaded) return false;
  const Box core = core_of(of);
  return lit_divergence(pixels, core, dark_search, dark_divergence) <
         lit_divergence(pixels, core, bright_search, bright_divergence);
}

/// Of a box without what may lie in shade.
double IntegratedTracker::State::lit_divergence(const BallPixels& pixels, Box box, const WindowSearch& search,
                                                BoxDivergence& divergence) {
  const Part part = part_around(box, pixels.image);
  if (!imaging::reduce(cut(pixels.image, part), bright_labels.factor, search.labels(), lit_labels)) return kUnlike;
  keep_only(Kept::kLit, pixels.mask, pixels.image, part, lit_labels);
  box.x -= part.left;
  box.y -= part.top;
  return divergence.of(lit_labels, box).divergence;
}

BallSighting IntegratedTracker::State::look(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget,
                                            const SizeRange& sizes) {
  BallSighting seen;
  seen.mask_used = can_be_used(mask, image);
  const BallPixels pixels{image, colors_under(light), seen.mask_used ? mask : ShadeMaskView{}};
  if (!search(pixels, budget, sizes, seen)) return seen;
  Answer answer;
  if (located) {
    answer.fit = follow(pixels, sizes);
    if (is_kept(answer.fit)) answer.likeness = likeness_of(pixels, answer.fit.circle);
  }
  bool is_there = answer.likeness.divergence <= parameters.max_kept_divergence;
  if (!is_there || !is_found(answer.fit)) {
    const Answer elsewhere = find(pixels, budget, sizes);
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
  const Box whole_image{0.0, 0.0, static_cast<double>(image.width_px), static_cast<double>(image.height_px)};
  seen.found = true;
  seen.circle = circle;
  seen.box = intersection(box_of(circle), whole_image);
  seen.agreement = answer.fit.agreement;
  seen.divergence = answer.likeness.divergence;
  seen.dark = answer.likeness.dark;
  const ColorModel& model = seen.dark ? ball.dark : ball.bright;
  seen.light = model.lights[static_cast<std::size_t>(answer.likeness.light)];
  seen.shade_share = shade_share(pixels, circle);
  return seen;
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
  auto bright = WindowSearch::create(ball->bright, search, max_width_px, max_height_px);
  if (!bright) return tl::unexpected(bright.error());
  auto dark = WindowSearch::create(ball->dark, search, max_width_px, max_height_px);
  if (!dark) return tl::unexpected(dark.error());
  auto state = std::make_unique<State>(std::move(*ball), parameters, std::move(*bright), std::move(*dark), max_width_px,
                                       max_height_px);
  state->usual_sizes = usual_sizes;
  state->size_step = search.size_step;
  return IntegratedTracker(std::move(state));
}

IntegratedTracker::IntegratedTracker(std::unique_ptr<State> state) : state_(std::move(state)) {}
IntegratedTracker::IntegratedTracker(IntegratedTracker&&) noexcept = default;
IntegratedTracker& IntegratedTracker::operator=(IntegratedTracker&&) noexcept = default;
IntegratedTracker::~IntegratedTracker() = default;

BallSighting IntegratedTracker::track(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget,
                                      std::optional<SizeRange> size) {
  return state_->look(image, mask, budget, size.value_or(state_->usual_sizes));
}

void IntegratedTracker::forget() {
  state_->located = false;
  state_->images_without = 0;
}

}  // namespace cgsr::color
