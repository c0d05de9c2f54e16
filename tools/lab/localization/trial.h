#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/stages/localize_stage.h"
#include "src/config/load.h"
#include "tools/lab/localization/standpoints.h"
#include "tools/lab/report.h"

namespace cgsr::lab {

/// One way to correct a pose, as a table compares them.
struct Contender {
  std::string name;
  config::Localization configuration;
  bool perfect_copy = false;
};

/// A shipped configuration: `floor` or `free`.
Result<config::Localization> shipped_localization(const std::string& name);

/// The same with another way to correct.
Contender contender(std::string name, const config::Localization& shipped, localization::Method method);
/// Plain alternation of expectation and maximisation from the prior: one start, no gate.
Contender plain_em(std::string name, const config::Localization& shipped);

/// How far a pose is from the true one.
struct PoseError {
  double position_m = 0.0;
  double direction_rad = 0.0;  ///< of the whole rotation.
};
PoseError error_of(const geometry::Pose& X, const geometry::Pose& X_true);

/// What came of one trial.
struct Outcome {
  localization::Correction answer;
  int images = 0;  ///< handed over until there was an answer.
  PoseError error;
  PoseError robot;  ///< of X_WR, with the mount that was told.
  PoseError prior;

  /// 'Corrected' was claimed, and it is worse than the prior by a measure that matters.
  [[nodiscard]] bool false_correction() const;
};

/// The robot's own stage with what was measured of camera, mount and map. A method without a gate (the paper's, Stronger's) is one of its
/// parameters.
std::unique_ptr<stages::LocalizeStage> localize_stage(const Survey& measured,
                                                      const config::Localization& configuration);

/// Hands over `image` until there is an answer: the camera stands still. The work of a call has no limit but the search's own.
Outcome correct_once(stages::LocalizeStage& stage, const ImageView& image, const localization::Prior& prior,
                     const Standpoint& truth, const geometry::Pose& X_RC_told);

/// What many trials of one contender gave.
struct Tally {
  int trials = 0;
  int corrected = 0;
  int wrong = 0;
  std::vector<double> position_cm, direction_deg, robot_cm, robot_deg, images;  // where corrected
  std::map<std::string, int> refused;                                           // why, how often

  void add(const Outcome& outcome);

  /// \return "NAME was not corrected in 12: 7 ambiguous, 5 residual."
  [[nodiscard]] std::string refusals(const std::string& name) const;
};

/// The rows of a tally: corrected, errors, images needed, false corrections.
/// \param theirs  the dissertation's position [cm] and direction [deg] error, where it has them.
void add_rows(const std::string& row, const Tally& tally, std::uint64_t seed, Report& report,
              std::optional<std::pair<double, double>> theirs = {});

}  // namespace cgsr::lab
