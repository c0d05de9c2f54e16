#pragma once

#include "platform/parameters.h"

namespace cgsr::color {

/// What the local tracker measures at a place, against what it measured while the object was surely seen.
struct PresenceMeasures {
  double score_ratio = 0.0;      ///< of the score to its running mean.
  double sharpness = 0.0;        ///< peak to sidelobe ratio of the shape's response.
  double divergence_rise = 0.0;  ///< [nat] of the divergence above its running mean.
  double separation = 0.0;       ///< mean likelihood of the pixels inside the box less that around it.
};

/// The weights of Presence, and its memory.
struct PresenceParameters {
  double offset = -10.67;
  double score_weight = 2.52;
  double sharpness_weight = 4.57;
  double divergence_weight = -1.66;
  double separation_weight = 3.6;
  double memory = 0.8;
  double max_log_odds = 3.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("offset", self.offset, {-100.0, 100.0}, "",
                 "The log-odds of the object's presence when all measures are zero.");
    visit.number("score_weight", self.score_weight, {-100.0, 100.0}, "",
                 "The weight of the logarithm of the score's ratio to its running mean.");
    visit.number("sharpness_weight", self.sharpness_weight, {-100.0, 100.0}, "",
                 "The weight of the logarithm of the peak's sharpness.");
    visit.number("divergence_weight", self.divergence_weight, {-100.0, 100.0}, "",
                 "The weight of the divergence's rise above its running mean, in nat.");
    visit.number("separation_weight", self.separation_weight, {-100.0, 100.0}, "",
                 "The weight of the difference of the pixel likelihoods inside and around the box.");
    visit.number("memory", self.memory, {0.0, 0.99}, "",
                 "The share of the log-odds of the image before that counts in the present one.");
    visit.number("max_log_odds", self.max_log_odds, {0.1, 100.0}, "",
                 "The largest magnitude that the log-odds of presence reach over several images.");
  }
};

/// Whether the object is where it is followed: the log-odds of each image by a logistic regression (Cox 1958), summed with a memory of a few
/// images. A single weak image does not end a long sight; one without any sign of the object does. The weights were fitted to images
/// of recorded sequences in which the object is followed, and to the same ones with the object painted over. Ours: the dissertation
/// (3.2.2) has the threshold on the divergence alone, which parts of the surroundings pass.
class Presence {
 public:
  explicit Presence(const PresenceParameters& parameters) : parameters_(parameters) {}

  /// \return what one image says alone, as log-odds.
  [[nodiscard]] double log_odds(const PresenceMeasures& measures) const;

  /// Counts an image. \param log_odds  of the object's presence by this image alone.
  void add(double log_odds);

  /// The object is surely here.
  void confirm() { log_odds_ = parameters_.max_log_odds; }
  /// It surely is not.
  void deny() { log_odds_ = -parameters_.max_log_odds; }

  /// \return whether all images together speak for it.
  [[nodiscard]] bool believed() const { return log_odds_ > 0.0; }

 private:
  PresenceParameters parameters_;
  double log_odds_ = 0.0;
};

}  // namespace cgsr::color
