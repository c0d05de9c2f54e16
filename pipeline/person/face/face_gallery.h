#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/person/classifier.h"
#include "pipeline/person/face/face_descriptor.h"
#include "platform/parameters.h"

namespace cgsr::person {

struct FaceMatchParameters {
  double min_margin = 0.019;
  double typical_stranger = 0.138;
  double nearest_stranger = 0.133;
  int min_views = 2;
  int max_views = 6;
  int max_learned_views = 2;
  double max_step = 0.082;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("min_margin", self.min_margin, Range{0.0, 0.5}, "",
                 "How much nearer a face must be to one person than to every other, else it is a stranger's.");
    visit.number("typical_stranger", self.typical_stranger, Range{0.01, 1.0}, "",
                 "How far a stranger's face is from an enrolled one, typically: stands in for the others where three "
                 "or four people are enrolled.");
    visit.number(
        "nearest_stranger", self.nearest_stranger, Range{0.01, 1.0}, "",
        "How far it is where it is most alike: stands in for them where one or two are, for there is nobody to "
        "compare with.");
    visit.number("min_views", self.min_views, Range{1, 20}, "",
                 "The number of views from which on a person can be named.");
    visit.number("max_views", self.max_views, Range{1, 50}, "",
                 "The number of views kept of a person; more replace the oldest but the first.");
    visit.number("max_learned_views", self.max_learned_views, Range{0, 20}, "",
                 "The number of views kept besides of a face that is followed, learned as it changes; more replace the "
                 "oldest. 0: none is learned.");
    visit.number(
        "max_step", self.max_step, Range{0.0, 0.5}, "",
        "A face that is followed and no longer surely named is learned where it is no farther than this from "
        "how it was when it was surely named: larger, and somebody else who comes before the face is learned.");
  }
};

/// The confidence from which on 'a stranger's' counts, and a name against another one that is known: below, the face lies at the threshold.
inline constexpr double kClearConfidence = 0.55;

/// Whose face it is.
struct FaceMatch {
  std::optional<Label> label;    ///< nothing: a stranger's.
  double confidence = 0.0;       ///< of this answer, 0.5 at the threshold, 1 far from it.
  std::optional<Label> nearest;  ///< the person whose face is most like it, named or not.
  double distance = 1.0;  ///< to that one: the mean of view_distances() over all points but the farthest twentieth.
  double margin = 0.0;    ///< how much farther every other person is.
  double rules_out =
      0.0;  ///< the confidence that it is nobody's who is enrolled but `nearest`'s: a stranger's who resembles one person is surely not another's; 0 where fewer than two are compared.
  FaceAlignment
      alignment{};  ///< how the face lies in its crop: against the nearest view of each person, in the mean over all.
};

/// Views of a person that were learned while his face was followed.
struct LearnedViews {
  Label person = 0;
  std::span<const FaceView> views;
};

/// The faces that are known, several views each, and the decision whose a face is (ClassifyPriChar of Alg. 6.1). The dissertation (6.2.1) counts
/// SIFT matches and names the person with most; here descriptors are compared place by place, and a face must be nearer to one person than to all
/// others by a margin: how far faces are from each other depends on the light, the difference of two such distances hardly.
///
/// Bounded: max_views per person. Threads: one at a time; enrolled in the background, read when it is handed over.
class FaceGallery {
 public:
  explicit FaceGallery(const FaceMatchParameters& parameters = {}) : parameters_(parameters) {}

  void enroll(Label person, const FaceView& view);
  /// \return whether there was such a person.
  bool forget(Label person) { return people_.erase(person) > 0; }
  [[nodiscard]] std::size_t people() const { return people_.size(); }
  /// \return nothing: there is no such person.
  [[nodiscard]] const std::vector<FaceView>* views_of(Label person) const;
  /// \return how far a face is from one view, as from a person who has no other.
  static double distance(const FaceDescriptor& face, const FaceView& view);
  [[nodiscard]] const FaceMatchParameters& parameters() const { return parameters_; }

  /// \param without  this person is left out, as if he had not been enrolled.  \param learned  more views of somebody, for this face alone.
  /// Cost: 0.5 million instructions per view of the 16 people who are roughly most alike (rough_likeness()); the others are left out.
  [[nodiscard]] FaceMatch identify(const FaceDescriptor& face, std::optional<Label> without = std::nullopt,
                                   const LearnedViews& learned = {}) const;

 private:
  using People = std::map<Label, std::vector<FaceView>>;
  [[nodiscard]] std::vector<People::const_iterator> candidates(const FaceDescriptor& face, std::optional<Label> without,
                                                               const LearnedViews& learned) const;

  FaceMatchParameters parameters_;
  People people_;
};

}  // namespace cgsr::person
