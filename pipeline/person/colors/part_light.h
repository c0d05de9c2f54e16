#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pipeline/color/learn/light.h"
#include "pipeline/person/classifier.h"
#include "platform/box.h"
#include "platform/image_view.h"
#include "platform/parameters.h"

namespace cgsr::person {

struct PartLightParameters {
  double min_change = 0.08;
  double agreement = 0.35;
  double max_gain = 2.2;
  double max_tint = 1.8;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("min_change", self.min_change, Range{0.005, 1.0}, "",
                 "The change of a channel, relative, from which on a shirt is looked for in another light.");
    visit.number(
        "agreement", self.agreement, Range{0.0, 2.0}, "",
        "By how much the change of a shirt's place may differ from that of what is beside it to be taken for a "
        "change of the light: a share of the change, of its logarithm.");
    visit.number("max_gain", self.max_gain, Range{1.0, 10.0}, "",
                 "The largest change of a channel, to both sides, between the light at learning and now.");
    visit.number("max_tint", self.max_tint, Range{1.0, 10.0}, "",
                 "The largest ratio between the changes of two channels since learning.");
  }
};

/// The mean colours of a shirt's middle and of what is beside it.
struct PartColors {
  imaging::Rgb part;
  imaging::Rgb beside;
};

/// The light under which somebody's shirt is looked for. Where its place and what is beside it have changed by the same factor, channel by
/// channel (the diagonal model of Eq. 3.1), the light has changed: what was learned under the lamp is found in daylight. A shirt that turns its back with
/// another print, or that is gone, changes alone. Ours.
///
/// Threads: one.
class PartLight {
 public:
  explicit PartLight(const PartLightParameters& parameters = {}) : parameters_(parameters) {}

  /// The part was learned under this light.
  void learn(Label person, const color::Light& assumed);
  void forget(Label person);
  /// Forgets everybody else.
  void keep(std::span<const Label> people);

  /// The part was found and looks like this. \return whether the light has changed and it is to be looked for under another one, which of() tells.
  bool found(Label person, const PartColors& colors);
  /// Under the light that found() said has come the part is lost, or less of it is seen: it is looked for under the one before again, and what it looks
  /// like now counts as how it looks under that.
  void undo(Label person);
  /// It is seen as well under the light that found() said has come: that one stays.
  void confirm(Label person);
  /// The part was lost, and its last place looks like this.
  /// \return whether it is to be looked for under another light, which of() tells; false where no light explains it, or the one that was supposed since it
  ///         was lost.
  bool suppose(Label person, const PartColors& now);
  /// What suppose() said was wrong.
  void take_back(Label person);
  /// The part has been gone for long: whether the light at its last place, or that of learning, is on it where it comes back is open.
  /// \return whether it is to be looked for under the other of the two, which of() tells; false where they are alike.
  bool turn(Label person);

  /// \return nothing: not known.
  [[nodiscard]] std::optional<color::Light> of(Label person) const;

 private:
  struct Part {
    Label person = 0;
    color::Light assumed{};                // at learning
    color::Light used{};                   // under which it is looked for
    std::optional<PartColors> colors{};    // under `used`
    std::optional<color::Light> before{};  // suppose(): what was used until then
    std::optional<color::Light> tried{};   // suppose(): since it was found last
    std::optional<color::Light> last{};    // found(): what was used until the light changed
    std::optional<color::Light> other{};   // turn(): what is not in use now
  };
  Part* find(Label person);
  [[nodiscard]] std::optional<color::Light> light_by(const Part& part, const PartColors& now) const;

  PartLightParameters parameters_;
  std::vector<Part> parts_;
};

/// The mean colour of a region's pixels, of one in 4 x 4, of those that are neither dark nor cut off at white. \return nothing: fewer than 12.
/// \param image  YUYV.  \param region  in its pixels.
std::optional<imaging::Rgb> mean_color(const ImageView& image, const Box& region);

}  // namespace cgsr::person
