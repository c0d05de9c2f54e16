#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace cgsr::person {

/// The number of a class: of a person, here.
using Label = std::int32_t;

/// What a classifier answers: a class, and how likely it is that this is right.
struct Classification {
  Label label = 0;
  double confidence = 0.0;  ///< in [0, 1].
};

/// Which part of the image a classifier stands on: what disturbs one kind may leave another alone (8.3).
enum class Cue : std::uint8_t {
  kColor,  ///< hue and saturation: suffers in the dark, under saturation and when the light's colour changes.
  kGrey,   ///< contrast and texture: suffers from blur and where the image is cut off at black or white.
};

std::string_view to_string(Cue cue);

/// One of the classifiers that teach each other: extracts a characteristic of its own from the input and names its class (Extract…Char and
/// Classify…Char of Alg. 6.1). It knows nothing of the others.
///
/// \tparam Input  what all classifiers look at: one element of the input sequence.
template <class Input>
class Classifier {
 public:
  Classifier() = default;
  Classifier(const Classifier&) = delete;
  Classifier& operator=(const Classifier&) = delete;
  virtual ~Classifier() = default;

  /// Extracts the characteristic, keeps it for train(), and classifies it.
  /// \return nothing: the characteristic is not there, or belongs to no class that is known.
  virtual std::optional<Classification> classify(const Input& input) = 0;

  /// Trains with the characteristic that classify() extracted last (Train…Char of Alg. 6.1). Called only after a classify() of the same input.
  /// \param label  the class that it is of.  \param mistaken_for  the class that classify() named, when that was another: a negative sample of it.
  virtual void train(Label label, std::optional<Label> mistaken_for) = 0;
};

}  // namespace cgsr::person
