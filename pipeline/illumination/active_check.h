#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pipeline/illumination/switch_check.h"
#include "platform/parameters.h"

namespace cgsr::illumination {

/// Section [switches.probe_lamp] of a robot's file.
struct ProbeLampParameters {
  std::array<double, 3> position_m{0.3, -0.62, 1.75};
  double sigma_m = 0.01;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("position_m", self.position_m, {-5.0, 5.0}, "m",
                  "The position of the lamp that illuminates the board, in the robot's frame.");
    visit.number("sigma_m", self.sigma_m, {0.0001, 1.0}, "m",
                 "The standard deviation of each coordinate of that position.");
  }
};

/// Whose light is compared with the light without it.
enum class CheckedLamp : std::uint8_t {
  kProbeLamp,  ///< the board's own: are board and probes still as calibrated?
  kRoomLamp,   ///< the one that was located: are the shadows its shadows?
};
std::string_view to_string(CheckedLamp lamp);

/// How far a check is, or how it ended.
enum class CheckState : std::uint8_t {
  kNotThere,  ///< no line switches that lamp.
  kOpen,      ///< nobody asked for it yet.
  kRunning,
  kPassed,
  kFailed,  ///< shadows fall elsewhere, or there are none, or no two images could be compared.
  kFault,   ///< the line does not answer, or answers and the lamp does not switch.
};
std::string_view to_string(CheckState state);

/// The line of a lamp as it is known when an image comes.
struct LineState {
  bool there = false;
  bool on = false;       ///< as last acknowledged.
  bool settled = false;  ///< nothing is under way, and this image shows it: 'after'.
  bool silent = false;   ///< it did not answer.
};

/// What a check came to.
struct CheckReport {
  CheckState state = CheckState::kNotThere;
  SwitchVerdict verdict = SwitchVerdict::kNoImage;  ///< read only when it passed, failed or is at fault.
  int tries = 0;                                    ///< pairs of images that were compared.
};

/// A lamp switched and switched back, and the image before compared with the one after: what that lamp alone does.
/// Ours: the dissertation (5.1) takes the board and the probes as they were set up.
///
/// open -> running: an image is kept, the other level is wanted; 'after', both are judged and the first level is wanted again; when that is
/// settled it is over. A pair that says nothing (moved, not to be seen) is tried again. It knows no line, clock or thread: whoever runs it does as
/// wants_on() says, and says what became of it.
///
/// Allocates when constructed, not when it looks. Threads: one.
class ActiveCheck {
 public:
  /// \param there  a line switches the lamp; without one nothing is allocated and nothing happens.
  /// \param lamp_height_m  above the board, roughly.
  ActiveCheck(bool there, const Board& board, const ProbesParameters& parameters, double lamp_height_m);

  /// Begins, unless it runs or there is no line. \param p_RL, sigma_m  where the lamp is, robot frame, and how well that is known.
  void begin(const Eigen::Vector3d& p_RL, double sigma_m);
  /// The next image.
  void look(const ImageView& image, const LineState& line);
  /// What it found does not hold any more: it may be asked again.
  void reopen();

  [[nodiscard]] bool running() const { return report_.state == CheckState::kRunning; }
  /// The level that the lamp's line should have.
  [[nodiscard]] bool wants_on() const { return wants_on_; }
  [[nodiscard]] const CheckReport& report() const { return report_; }

 private:
  static constexpr int kMostTries = 3;
  enum class Phase : std::uint8_t { kBefore, kSwitched, kBack };

  void keep(const ImageView& image);
  void judge(const ImageView& image);
  void end();
  [[nodiscard]] double brightness(const ImageView& grey) const;

  Board board_;
  std::vector<SwitchChecker> checker_;  // one, or none without a line
  std::vector<std::uint8_t> before_;    // brightness of the image that was kept
  std::vector<std::uint8_t> after_;
  Eigen::Vector3d p_RL_ = Eigen::Vector3d::Zero();
  double sigma_m_ = 0.0;
  Phase phase_ = Phase::kBefore;
  bool wants_on_ = false;
  bool sized_ = false;  // the image that was kept has the camera's size
  CheckReport report_;
};

}  // namespace cgsr::illumination
