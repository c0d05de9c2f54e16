#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/color/learn/light.h"
#include "pipeline/imaging/reduce.h"
#include "pipeline/person/classifier.h"
#include "pipeline/person/colors/color_histogram.h"
#include "platform/parameters.h"

namespace cgsr::person {

/// Where colours are sampled around a face (Fig. 6.3): a shirt as large as the face's box, half a box below it; the background half a box to its left and right.
struct SamplingRegions {
  Box shirt;
  std::array<Box, 2> background;
};
SamplingRegions sampling_regions(const Box& face);

struct PersonColorParameters {
  int max_people = 8;
  double min_share = 0.004;
  double min_ratio = 2.0;
  color::LightParameters light{};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_people", self.max_people, Range{1, 32}, "",
                 "The number of people whose colours are kept, those of the latest interest; 1 MB each.");
    visit.number("min_share", self.min_share, Range{0.0, 1.0}, "",
                 "The share of a person's samples that a colour and its neighbours must have to be that person's.");
    visit.number("min_ratio", self.min_ratio, Range{1.0, 100.0}, "",
                 "How much larger that share must be than the share among the negative samples.");
    visit.section("light", self.light, "The lights under which a shirt is looked for (Alg. 3.1)");
  }
};

/// The colours of a characteristic (a shirt, or skin and hair) of several people, and the map from colours to people (6.2.2): positive and negative
/// histograms of 64 x 64 x 64 RGB for each, kept as colours without the light that was assumed at learning (Alg. 3.1, lines 9 to 11), so that the
/// map can be made for another light. A colour that several people have belongs to the one of the latest interest.
///
/// Threads: one. Bounded by max_people.
class PersonColors {
 public:
  explicit PersonColors(const PersonColorParameters& parameters = {}) : parameters_(parameters) {}

  /// Learns from scratch; takes the place of the person of the oldest interest when there is no room. No samples: nothing happens.
  void learn(Label person, std::span<const imaging::Rgb> positive, std::span<const imaging::Rgb> negative);
  /// Adds to what is known of a person who is there; else the same as learn(). \param light  under which they were recorded; nothing: as at learning.
  void add(Label person, std::span<const imaging::Rgb> positive, std::span<const imaging::Rgb> negative,
           const std::optional<color::Light>& light = std::nullopt);
  /// What looks like the person and is not: negative samples, recorded under a light. Nothing happens where the person is not known.
  void doubt(Label person, std::span<const imaging::Rgb> negative, const color::Light& light);
  void forget(Label person);
  /// Equal colours go to this person from now on.
  void prefer(Label person);

  [[nodiscard]] bool knows(Label person) const;
  [[nodiscard]] std::size_t people() const { return people_.size(); }
  [[nodiscard]] double share(Label person, const imaging::Rgb& recorded, const color::Light& light) const;
  /// The light that was assumed when the person was learned; the map of that light finds the colours as they were.
  [[nodiscard]] std::optional<color::Light> learned_light(Label person) const;

  /// The RGB-to-person map, over the colour codes of an image: 0 is nobody, i + 1 is the person at place i of order().
  /// \param lights  the light of each person now, in the order of order(); missing ones: as it was at learning.
  /// Cost: every code near a sample is compared with 3^3 bins under the light of learning, with 7^3 to 11^3 under another one, for each person who was learned since the last one, or whose light is neither that of the last one nor that of the one before.
  void make_map(std::span<const color::Light> lights, imaging::LabelTable& map);
  /// The people by place.
  [[nodiscard]] std::vector<Label> order() const;

 private:
  /// The colour codes that are a person's under a light; without one they are to be looked for again.
  struct Codes {
    std::optional<color::Light> light{};
    std::vector<std::uint16_t> all;
  };
  struct Person {
    Label label = 0;
    std::uint64_t interest = 0;  // larger: later
    color::Light light{1.0, 1.0, 1.0};
    ColorHistogram positive, negative;
    std::array<Codes, 2> codes;  // under the light of the last map first, and that of a map before it
  };
  Person* find(Label person);
  [[nodiscard]] const Person* find(Label person) const;
  Person& room_for(Label person);
  [[nodiscard]] const std::vector<std::uint16_t>& codes_under(const color::Light& light, Person& person) const;
  void find_codes(const Person& person, const color::Light& light, std::vector<std::uint16_t>& codes) const;
  static void put(Person& person, std::span<const imaging::Rgb> positive, std::span<const imaging::Rgb> negative,
                  const color::Light& light);

  PersonColorParameters parameters_;
  std::vector<Person> people_;
  std::uint64_t interest_ = 0;
};

}  // namespace cgsr::person
