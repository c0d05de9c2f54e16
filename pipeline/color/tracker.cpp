#include "pipeline/color/tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pipeline/color/box_divergence.h"
#include "pipeline/color/color_agreement.h"
#include "pipeline/color/light_estimate.h"
#include "pipeline/color/window_search.h"

namespace cgsr::color {
namespace {

constexpr double kLargestGrowth = 1.25;  // from one image to the next
constexpr int kRefinements = 3;

Box centred_on(const Box& place, double width, double height) {
  return {place.x + 0.5 * (place.width - width), place.y + 0.5 * (place.height - height), width, height};
}

/// A box about its centre, grown by a factor that is held within reason.
Box grown(const Box& box, double factor, const ColorModel& model, double limit) {
  if (factor == 1.0) return box;
  const double asked = std::clamp(factor, 1.0 / kLargestGrowth, kLargestGrowth);
  const double width = std::clamp(box.width * asked, model.width_px / limit, model.width_px * limit);
  return centred_on(box, width, box.height * width / box.width);
}

Box with_centre_inside(Box box, int width_px, int height_px) {
  box.x = std::clamp(box.x, -0.5 * box.width, width_px - 0.5 * box.width);
  box.y = std::clamp(box.y, -0.5 * box.height, height_px - 0.5 * box.height);
  return box;
}

}  // namespace

/// A place for the object, with what is known in favour of it.
struct Place {
  LocalAnswer local;
  double divergence = 0.0;
};

/// The colours of a place, against the learned ones.
struct Tint {
  Light gain;              ///< of the light, from the learned image's.
  double agreement = 0.0;  ///< ColorAmounts::agreement with that light taken out.
};

struct Tracker::State {
  State(const ColorModel& m, const TrackParameters& p, WindowSearch s, int max_width_px, int max_height_px)
      : model(m),
        parameters(p),
        search(std::move(s)),
        divergence(m, p.search.divergence),
        pyramid(max_width_px, max_height_px),
        local(p.local) {
    learn_from_model();
  }

  void learn_from_model();
  void keep_colors(const ObjectView& view);
  SearchResult search_all(const imaging::ReducedImage& reduced, WorkBudget& budget);
  TrackedObject track_plain(const SearchResult& matches) const;
  TrackedObject track_full(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget);
  Place look(const imaging::ReducedImage& reduced, const Box& box);
  [[nodiscard]] Tint tint(const Box& at) const;
  /// Where it will come back, it may be nearer or farther: one size after the other, in different images.
  [[nodiscard]] double lost_scale() const {
    constexpr std::array kScales{1.0, 0.7, 1.4};
    return kScales[static_cast<std::size_t>(images_lost) % kScales.size()];
  }
  [[nodiscard]] bool lost() const { return weak_images >= parameters.doubt.lost_after_images; }
  void start_again();
  [[nodiscard]] bool is_weak(const Place& place) const;
  bool stayed(const imaging::ReducedImage& reduced, Place& place);
  bool recognise(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget, Place& place);
  bool find(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget, Place& place);
  [[nodiscard]] TrackedObject answer(const Light& gain, double divergence_of_box) const;

  ColorModel model;
  TrackParameters parameters;
  WindowSearch search;
  BoxDivergence divergence;
  imaging::Pyramid pyramid;
  LocalTracker local;
  ChannelQuantiles learned_quantiles;
  ColorAmounts learned_amounts;
  Light learned_light;

  bool located = false;  ///< `box` is where the object was in the last image.
  Box box;
  double mean_score = 0.0;
  double mean_divergence = 0.0;
  int images_since_sight = 0;
  int weak_images = 0;     ///< in a row.
  int images_lost = 0;     ///< in a row.
  int foreign_images = 0;  ///< in a row; whose colours are not the learned ones.
  double first_score = 0.0;
  double first_divergence = 0.0;
};

/// Until an image is there in which the object was learned, the patch that the model keeps of it has to do.
void Tracker::State::learn_from_model() {
  box = {0.0, 0.0, model.width_px, model.height_px};
  if (model.samples.empty()) return;
  const SamplePatch& sample = model.samples.front();
  imaging::Pyramid patch(sample.width_px, sample.height_px);
  patch.build(sample.view());
  local.begin(patch, sample.window);
  keep_colors(view_object(patch, sample.window));
  learned_light = sample.light;
  const LocalAnswer itself = local.look(patch, sample.window);
  first_score = itself.score;
  mean_score = first_score;
}

void Tracker::State::keep_colors(const ObjectView& view) {
  learned_quantiles = channel_quantiles(view);
  learned_amounts = ColorAmounts(view);
}

SearchResult Tracker::State::search_all(const imaging::ReducedImage& reduced, WorkBudget& budget) {
  SearchRequest request;
  const bool plain = parameters.mode == TrackMode::kPlain;
  if (!plain && !located) box = centred_on(box, model.width_px * lost_scale(), model.height_px * lost_scale());
  request.width_px = plain ? model.width_px : box.width;
  request.height_px = plain ? model.height_px : box.height;
  request.max_divergence = parameters.max_divergence;
  request.candidates = plain ? 1 : parameters.candidates;
  request.budget = &budget;
  return search.search(reduced, request).value_or(SearchResult{});
}

TrackedObject Tracker::State::track_plain(const SearchResult& matches) const {
  if (matches.count == 0) return {};
  const Match& best = matches.matches.front();
  const Light light = model.lights[static_cast<std::size_t>(best.light)];
  return {true, best.box, best.divergence, light, light};
}

/// The whole image is searched in any case. Where the object was, the local tracker says how it moved; what it says is doubted by three
/// measures together, and then the search's best windows are looked at as if for the first time: a prior, not a cage.
TrackedObject Tracker::State::track_full(const imaging::ReducedImage& reduced, const SearchResult& matches,
                                         WorkBudget& budget) {
  Place place;
  bool sure = false;
  if (located && !lost()) {
    local.follow_light(pyramid);
    place = look(reduced, box);
    sure = !is_weak(place) || recognise(reduced, matches, budget, place) || find(reduced, matches, budget, place);
    weak_images = sure ? 0 : weak_images + 1;
    if (lost()) return {};
  } else {
    sure = (located && (stayed(reduced, place) || recognise(reduced, matches, budget, place))) ||
           find(reduced, matches, budget, place);
    if (!sure) {
      ++images_lost;
      return {};
    }
    located = true;
    images_lost = 0;
    weak_images = 0;
    foreign_images = 0;
  }

  Box now = place.local.box;
  if (sure) now = grown(now, local.growth(pyramid, now), model, parameters.size_limit);
  box = with_centre_inside(now, pyramid.width_px(), pyramid.height_px());
  const Tint seen = tint(box);
  foreign_images = seen.agreement < parameters.doubt.foreign_agreement ? foreign_images + 1 : 0;
  if (foreign_images >= parameters.doubt.foreign_images) {
    start_again();
    return {};
  }
  if (sure) {
    local.learn(pyramid, box);
    const double rate = images_since_sight < parameters.doubt.warm_up_images ? 0.3 : parameters.doubt.mean_rate;
    mean_score += rate * (place.local.score - mean_score);
    mean_divergence += rate * (place.divergence - mean_divergence);
  }
  ++images_since_sight;
  local.remember(pyramid, box);
  return answer(seen.gain, place.divergence);
}

Tint Tracker::State::tint(const Box& at) const {
  const ObjectView view = view_object(pyramid, at);
  const Light gain = light_gain(learned_quantiles, channel_quantiles(view));
  const ColorAmounts seen(relit(view, without_light({1.0, 1.0, 1.0}, gain)));
  return {gain, learned_amounts.agreement(seen)};
}

Place Tracker::State::look(const imaging::ReducedImage& reduced, const Box& at) {
  const LocalAnswer local_answer = local.look(pyramid, at);
  return {local_answer, divergence.of(reduced, local_answer.box).divergence};
}

bool Tracker::State::is_weak(const Place& place) const {
  const DoubtParameters& doubt = parameters.doubt;
  const bool warm = images_since_sight >= doubt.warm_up_images;
  const double expected = warm ? doubt.weak_score * mean_score : doubt.found_score * first_score;
  return place.local.sharpness < doubt.weak_sharpness && place.local.score < expected &&
         place.divergence > mean_divergence + doubt.weak_divergence;
}

/// \return whether the object is where it was lost, as when something passed before it.
bool Tracker::State::stayed(const imaging::ReducedImage& reduced, Place& place) {
  const DoubtParameters& doubt = parameters.doubt;
  place = look(reduced, box);
  return place.local.sharpness >= doubt.stay_sharpness && place.local.score >= doubt.stay_score * mean_score &&
         place.divergence <= mean_divergence + doubt.weak_divergence &&
         tint(place.local.box).agreement >= doubt.foreign_agreement;
}

/// What the local tracker followed was not the object: it forgets what it learned from it.
void Tracker::State::start_again() {
  local.forget();
  located = false;
  box = centred_on(box, model.width_px, model.height_px);
  mean_score = first_score;
  mean_divergence = first_divergence;
}

/// Elsewhere, but as it looked last. A fast move blurs it, so that its shape says little; its colours must then be all there.
/// \return whether one of the search's windows is surely the object; else `place` stays as it is.
bool Tracker::State::recognise(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget,
                               Place& place) {
  const DoubtParameters& doubt = parameters.doubt;
  Place best;
  for (int i = 0; i < matches.count && budget.grant(); ++i) {
    const Box& window = matches.matches[static_cast<std::size_t>(i)].box;
    const Place other = look(reduced, centred_on(window, box.width, box.height));
    if (other.local.score > best.local.score) best = other;
  }
  if (best.local.score < doubt.again_score * mean_score) return false;
  if (best.divergence > mean_divergence + doubt.weak_divergence) return false;
  if (tint(best.local.box).agreement < doubt.again_agreement) return false;
  place = best;
  return true;
}

/// First sight, sight again after a loss, or elsewhere: each window of the search is looked at under its own light.
/// \return whether one of them is surely the object; else `place` stays as it is.
bool Tracker::State::find(const imaging::ReducedImage& reduced, const SearchResult& matches, WorkBudget& budget,
                          Place& place) {
  LocalAnswer best;
  Light gain;
  bool any = false;
  for (int i = 0; i < matches.count && budget.grant(); ++i) {
    const Box& window = matches.matches[static_cast<std::size_t>(i)].box;
    const Light its_gain = light_gain(learned_quantiles, channel_quantiles(view_object(pyramid, window)));
    const LocalAnswer seen = local.look_under(its_gain, pyramid, centred_on(window, box.width, box.height));
    if (any && seen.score <= best.score) continue;
    best = seen;
    gain = its_gain;
    any = true;
  }
  if (!any) return false;
  Tint seen{gain, 0.0};
  for (int round = 0; round < kRefinements && budget.grant(); ++round) {
    best = local.look_under(seen.gain, pyramid, best.box);
    best.box = grown(best.box, local.growth(pyramid, best.box), model, parameters.size_limit);
    seen = tint(best.box);
  }
  const DoubtParameters& doubt = parameters.doubt;
  const double its_divergence = divergence.of(reduced, best.box).divergence;
  if (best.sharpness < doubt.found_sharpness || best.score < doubt.found_score * first_score) return false;
  if (seen.agreement < doubt.found_agreement || its_divergence > parameters.max_divergence) return false;
  place = {best, its_divergence};
  local.believe_light(seen.gain);
  images_since_sight = 0;
  return true;
}

TrackedObject Tracker::State::answer(const Light& gain, double divergence_of_box) const {
  const Light exact = lit(learned_light, gain);
  const Box image{0.0, 0.0, static_cast<double>(pyramid.width_px()), static_cast<double>(pyramid.height_px())};
  return {true, intersection(box, image), divergence_of_box, nearest_of(model, exact), exact};
}

Result<Tracker> Tracker::create(const ColorModel& model, const TrackParameters& parameters, int max_width_px,
                                int max_height_px) {
  auto settings = parameters.search;
  if (parameters.mode == TrackMode::kPlain) {
    settings.weights = BinWeights::kPlain;
    settings.sizes = 1;
  } else if (model.samples.empty()) {
    return fail("the colour model keeps no picture of the object, which mode \"full\" needs: learn it again");
  }
  auto search = WindowSearch::create(model, settings, max_width_px, max_height_px);
  if (!search) return tl::unexpected(search.error());
  return Tracker(std::make_unique<State>(model, parameters, std::move(*search), max_width_px, max_height_px));
}

Tracker::Tracker(std::unique_ptr<State> state) : state_(std::move(state)) {}
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;
Tracker::~Tracker() = default;

const imaging::LabelTable& Tracker::labels() const {
  return state_->search.labels();
}

int Tracker::reduction(int width_px, int height_px) const {
  return imaging::reduction_for(width_px, height_px, std::min(state_->model.width_px, state_->model.height_px));
}

void Tracker::place(const ImageView& image, const imaging::ReducedImage& reduced, const Box& box) {
  State& s = *state_;
  s.pyramid.build(image);
  s.local.begin(s.pyramid, box);
  s.keep_colors(view_object(s.pyramid, box));
  const Place itself = s.look(reduced, box);
  s.first_score = itself.local.score;
  s.first_divergence = s.divergence.of(reduced, box).divergence;
  s.mean_score = s.first_score;
  s.mean_divergence = s.first_divergence;
  s.box = box;
  s.located = true;
  s.images_since_sight = 0;
  s.weak_images = 0;
  s.foreign_images = 0;
}

SearchResult Tracker::search(const imaging::ReducedImage& reduced, WorkBudget& budget) {
  return state_->search_all(reduced, budget);
}

TrackedObject Tracker::track(const ImageView& image, const imaging::ReducedImage& reduced, const SearchResult& matches,
                             WorkBudget& budget) {
  State& s = *state_;
  if (s.parameters.mode == TrackMode::kPlain) return s.track_plain(matches);
  s.pyramid.build(image);
  return s.track_full(reduced, matches, budget);
}

}  // namespace cgsr::color
