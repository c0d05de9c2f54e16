#include "pipeline/color/ball/integrated_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/color/ball/ball_circle.h"
#include "pipeline/color/ball/ball_likeness.h"
#include "pipeline/color/ball/ball_model.h"
#include "pipeline/color/ball/ball_search.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {
namespace {

constexpr double kSizeLimit = 5.0;  // of the learned diameter, where nothing else is known
constexpr double kGrowth = 1.33;    // of a followed circle from one image to the next
constexpr double kCatch = 1.6;      // radii about the expected place in which a followed ball's colours are looked for
constexpr double kStillOwn = 0.8;   // of what the colours inside must be at first sight
constexpr double kMoreAround = 0.15;  // of them may be around a followed one
constexpr double kBetter = 0.12;      // in worth, that a ball elsewhere must be
constexpr int kRest = 5;              // images between two such searches, where a ball is followed
constexpr double kSurelyLike = 0.5;   // of the divergence that is found: above, another one is looked for as well
constexpr double kInertia = 0.7;      // of the motion from image to image
constexpr int kLeastImage_px = 16;    // of a side
constexpr int kUnitsOfEdges = 200;    // of these where there is a circle to look for edges at
constexpr int kLookUnits = 300;       // a closer look at a window costs so many groups of windows
constexpr double kClose = 2.5;        // widths of a window, between the middles of two that may lie on one thing
constexpr double kPlain = 0.75;       // a score at which no other kinds of colours are tried

Box box_of(const Circle& circle) {
  const double side = 2.0 * circle.radius_px;
  return {circle.x_px - circle.radius_px, circle.y_px - circle.radius_px, side, side};
}

std::pair<double, double> middle_of(const Box& box) {
  return {box.x + 0.5 * box.width, box.y + 0.5 * box.height};
}

/// Between the middles.
double distance(const Box& a, const Box& b) {
  const auto [ax, ay] = middle_of(a);
  const auto [bx, by] = middle_of(b);
  return std::hypot(ax - bx, ay - by);
}

bool covers(const Circle& circle, double x, double y) {
  const double dx = x - circle.x_px;
  const double dy = y - circle.y_px;
  return dx * dx + dy * dy < circle.radius_px * circle.radius_px;
}

/// Mean of the channels.
double gain_of(const Light& light) {
  return (light.r + light.g + light.b) / 3.0;
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
        likeness(ball, search, p.search.divergence, p.ball.diameter_m, max_width, max_height),
        max_width_px(max_width),
        max_height_px(max_height) {}

  struct Answer {
    CircleFit fit;
    Likeness likeness;
  };
  /// Of shape and colours together, 0..1; 0: unlike what may be found first.
  [[nodiscard]] double worth(const Answer& answer) const {
    return answer.fit.score() * std::max(0.0, 1.0 - answer.likeness.divergence / parameters.max_found_divergence);
  }
  /// Whether what was found elsewhere is the ball rather than what is followed: its colours alone do not tell, all that is dark enough is alike.
  [[nodiscard]] bool replaces(const Answer& elsewhere, const Answer& followed) const {
    return worth(elsewhere) > worth(followed) + kBetter && elsewhere.fit.score() > followed.fit.score() - kBetter;
  }

  BallSighting look(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget);
  /// \param followed  what needs no second look; null: nothing is followed.
  [[nodiscard]] Answer find(const BallPixels& pixels, const Circle* followed, WorkBudget& budget,
                            const SizeRange& sizes, BallSighting& seen);
  void restart_search();
  void choose_windows();
  [[nodiscard]] SearchRequest request_for(const SizeRange& sizes) const;
  [[nodiscard]] CircleFit follow(BallPixels pixels, const SizeRange& sizes, WorkBudget& budget);
  /// Sets of kinds of colours, from few to all.
  using KindsInTurn = std::array<std::uint8_t, 2>;
  [[nodiscard]] KindsInTurn kinds_in(bool dark, int of_light) const;
  [[nodiscard]] Answer best_of_windows(BallPixels pixels, const Circle* followed, WorkBudget& budget,
                                       const SizeRange& sizes);
  [[nodiscard]] const std::uint8_t* colors_under(std::size_t of_light) const { return ball.of_code[of_light].data(); }
  [[nodiscard]] bool is_found(const CircleFit& fit) const;
  [[nodiscard]] bool is_kept(const CircleFit& fit) const;
  void remember(const Answer& answer);
  void describe(const Answer& answer, const BallPixels& pixels, BallSighting& seen) const;
  [[nodiscard]] Likeness likeness_of(const BallPixels& pixels, const Circle& of) {
    return likeness.of(pixels, of, factor, places);
  }
  /// For the shade that is known here. Where neither mask nor places are, none is.
  [[nodiscard]] bool is_too_dark(const BallPixels& pixels, const Likeness& of) const {
    const bool knows_shade = !pixels.mask.empty() || places != nullptr;
    return knows_shade && !light_in_shade.is_plausible(gain_of(light_of(of)));
  }
  [[nodiscard]] const Light& light_of(const Likeness& of) const {
    return (of.dark ? ball.dark : ball.bright).lights[static_cast<std::size_t>(of.light)];
  }

  IntegratedParameters parameters;
  BallModel ball;
  BallSearch search;
  BallLikeness likeness;
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
  std::size_t light = 0;                 // of the grid, under which it was seen last
  std::uint8_t kinds = BallModel::kAny;  // of colours in which it was
  double motion_x_px = 0.0;
  double motion_y_px = 0.0;
  LightInShade light_in_shade;
  int images_without = 0;
  int images_since_look = 0;  // around, to the end of a search
  Installments next_look;
  // Of the search that is at its end, in the order in which they are looked at.
  struct Window {
    Match match;
    bool dark = false;
  };
  std::array<Window, 2 * kMaxMatches> found_windows;
  int windows = 0;
  int next_window = 0;
  std::size_t next_kinds = 0;  // of colours at that window
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
  request.candidates = kMaxMatches;  // of which some are chosen
  return request;
}

void IntegratedTracker::State::restart_search() {
  search.abandon();
  next_window = 0;
  next_kinds = 0;
}

/// Goes on with the search; when it is at its end, the windows are looked at closely in this image.
IntegratedTracker::State::Answer IntegratedTracker::State::find(const BallPixels& pixels, const Circle* followed,
                                                                WorkBudget& budget, const SizeRange& sizes,
                                                                BallSighting& seen) {
  const auto progress = search.advance(pixels.image, pixels.mask, request_for(sizes), sizes.min_px, budget);
  seen.bright_windows = search.bright().windows;
  seen.bright_examined = search.bright().examined;
  seen.dark_windows = search.dark().windows;
  seen.dark_examined = search.dark().examined;
  seen.exact = progress == BallSearch::Progress::kAtEnd;
  if (!seen.exact) return {};
  if (next_window == 0 && next_kinds == 0) choose_windows();
  const Answer best = best_of_windows(pixels, followed, budget, sizes);
  seen.exact = next_window == windows;
  if (seen.exact || best.fit.agreement > 0.0) restart_search();
  return best;
}

/// What a ball may show whose colours were found under this light: those alone, in which a ball on a brown floor does not run into it, and
/// all that there are, as of one that is half lit.
IntegratedTracker::State::KindsInTurn IntegratedTracker::State::kinds_in(bool dark, int of_light) const {
  return {dark ? ball.kind_of_dark(static_cast<std::size_t>(of_light)) : BallModel::kBright, BallModel::kAny};
}

/// Near where it was last, moving on as it moved.
/// The colours that it had there come first; others, at the price of a look each, where those do not make a plain ball.
CircleFit IntegratedTracker::State::follow(BallPixels pixels, const SizeRange& sizes, WorkBudget& budget) {
  pixels.of_code = colors_under(light);
  const double diameter = 2.0 * circle.radius_px;
  const SizeRange near{std::max(sizes.min_px, diameter / kGrowth), std::min(sizes.most_px, diameter * kGrowth)};
  if (near.min_px > near.most_px) return {};
  const Circle expected{circle.x_px + motion_x_px, circle.y_px + motion_y_px, kCatch * circle.radius_px};
  const auto fit_to = [&](std::uint8_t some) {
    pixels.kinds = some;
    const Circle middle = middle_of_members(pixels, expected);
    return fit_circle(pixels, middle.x_px, middle.y_px, near);
  };
  CircleFit best = fit_to(kinds);
  for (const std::uint8_t others : {BallModel::kAny, BallModel::kBright}) {
    if (is_found(best) && best.score() > kPlain) break;
    if (others == kinds || !next_look.pay(kLookUnits, budget)) continue;
    const CircleFit fit = fit_to(others);
    if (fit.score() > best.score()) best = fit;
  }
  return best;
}

/// Of either search the best, then those close to a better one: something large of such colours has many windows, the ball one.
void IntegratedTracker::State::choose_windows() {
  windows = 0;
  for (const bool dark : {false, true}) {
    const SearchResult& result = dark ? search.dark() : search.bright();
    const auto matches = std::span(result.matches).first(static_cast<std::size_t>(result.count));
    const int most = windows + parameters.candidates;
    std::array<bool, kMaxMatches> is_close{};
    for (std::size_t i = 0; i < matches.size(); ++i) {
      is_close[i] = std::ranges::any_of(matches.first(i), [&](const Match& better) {
        return distance(better.box, matches[i].box) < kClose * matches[i].box.width;
      });
    }
    for (const bool close : {false, true}) {
      for (std::size_t i = 0; i < matches.size() && windows < most; ++i) {
        if (is_close[i] == close) found_windows[static_cast<std::size_t>(windows++)] = {matches[i], dark};
      }
    }
  }
}

/// The best circle at those windows of both searches that have not been looked at yet.
IntegratedTracker::State::Answer IntegratedTracker::State::best_of_windows(BallPixels pixels, const Circle* followed,
                                                                           WorkBudget& budget, const SizeRange& sizes) {
  Answer best;
  for (; next_window < windows; ++next_window, next_kinds = 0) {
    const auto [match, dark] = found_windows[static_cast<std::size_t>(next_window)];
    const auto [x, y] = middle_of(match.box);
    if (followed != nullptr && covers(*followed, x, y)) continue;
    if (best.fit.agreement > 0.0 && covers(best.fit.circle, x, y)) continue;
    pixels.of_code = colors_under(static_cast<std::size_t>(match.light) % ball.of_code.size());
    const KindsInTurn in_turn = kinds_in(dark, match.light);
    for (; next_kinds < in_turn.size(); ++next_kinds) {
      pixels.kinds = in_turn[next_kinds];
      if (!next_look.pay(kLookUnits, budget)) return best;
      const CircleFit fit = fit_circle(pixels, x, y, sizes);
      if (fit.agreement <= 0.0) {
        next_look.give_back(kUnitsOfEdges);
        break;  // with more colours there seldom is one
      }
      if (const Answer answer{fit, is_found(fit) ? likeness_of(pixels, fit.circle) : Likeness{}};
          worth(answer) > worth(best) && !is_too_dark(pixels, answer.likeness)) {
        best = answer;
      }
      if (is_found(fit) || fit.around > parameters.ball.max_around) break;  // more colours would be more around it
    }
  }
  return best;
}

void IntegratedTracker::State::remember(const Answer& answer) {
  const Circle& now = answer.fit.circle;
  const bool is_followed = located && images_without == 0;
  if (is_followed && is_found(answer.fit) && places != nullptr && places->is_shaded(now, parameters.ball.diameter_m)) {
    light_in_shade.add(gain_of(light_of(answer.likeness)));
  }
  if (is_followed) {
    motion_x_px = kInertia * (now.x_px - circle.x_px);
    motion_y_px = kInertia * (now.y_px - circle.y_px);
  } else {
    motion_x_px = 0.0;
    motion_y_px = 0.0;
  }
  circle = now;
  light = static_cast<std::size_t>(answer.likeness.light) % ball.of_code.size();
  kinds = answer.fit.kinds;
  located = true;
  images_without = 0;
}

BallSighting IntegratedTracker::State::look(const ImageView& image, const ShadeMaskView& mask, WorkBudget& budget) {
  BallSighting seen;
  seen.mask_used = can_be_used(mask, image);
  if (!can_be_searched(image, max_width_px, max_height_px)) return seen;
  const BallPixels pixels{image, colors_under(light), seen.mask_used ? mask : ShadeMaskView{}};
  const SizeRange& sizes = usual_sizes;
  light_in_shade.fade();
  factor = imaging::reduction_for(image.width_px, image.height_px, sizes.min_px);
  Answer answer;
  if (located) {
    answer.fit = follow(pixels, sizes, budget);
    if (is_kept(answer.fit)) answer.likeness = likeness_of(pixels, answer.fit.circle);
  }
  bool is_there = answer.likeness.divergence <= parameters.max_kept_divergence;
  const bool is_plain = is_there && is_found(answer.fit);
  const bool is_sure = is_plain && answer.likeness.divergence <= kSurelyLike * parameters.max_found_divergence;
  if (is_sure || (is_plain && ++images_since_look < kRest)) {
    restart_search();
  } else {
    const Answer elsewhere = find(pixels, is_there ? &answer.fit.circle : nullptr, budget, sizes, seen);
    if (seen.exact) images_since_look = 0;
    const bool is_better = is_there ? replaces(elsewhere, answer) : worth(elsewhere) > 0.0;
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
  seen.light = light_of(answer.likeness);
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
