#include "pipeline/illumination/active_check.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace cgsr::illumination {
namespace {

constexpr int kAcross = 24;  // places of the board at which brightness is read
constexpr int kAlong = 12;

/// A grey image's level for each of YUYV's, whose black is 16 and white 235 (BT.601).
constexpr std::array<std::uint8_t, 256> grey_of_yuyv() {
  std::array<std::uint8_t, 256> grey{};
  for (int level = 0; level < 256; ++level) {
    const int stretched = ((level - 16) * 255 + 109) / 219;
    grey[static_cast<std::size_t>(level)] = static_cast<std::uint8_t>(std::clamp(stretched, 0, 255));
  }
  return grey;
}

/// \return whether the image has the camera's size; then its brightness is in `grey`, from black at 0 to white at 255.
bool take_brightness(const ImageView& image, const geometry::Camera& camera, std::vector<std::uint8_t>& grey) {
  if (image.empty() || image.format == PixelFormat::kBgr24) return false;
  if (image.width_px != camera.width_px || image.height_px != camera.height_px) return false;
  static constexpr auto kGreyOfYuyv = grey_of_yuyv();
  const bool is_yuyv = image.format == PixelFormat::kYuyv;
  const int step = bytes_per_pixel(image.format);
  std::uint8_t* out = grey.data();
  for (int y = 0; y < image.height_px; ++y) {
    const std::uint8_t* row = image.row(y);
    for (int x = 0; x < image.width_px; ++x) *out++ = is_yuyv ? kGreyOfYuyv[row[step * x]] : row[x];
  }
  return true;
}

bool says_nothing(SwitchVerdict verdict) {
  return verdict == SwitchVerdict::kMoved || verdict == SwitchVerdict::kNoImage ||
         verdict == SwitchVerdict::kNotRegistered;
}

}  // namespace

std::string_view to_string(CheckedLamp lamp) {
  return lamp == CheckedLamp::kProbeLamp ? "probe lamp" : "room lamp";
}

std::string_view to_string(CheckState state) {
  switch (state) {
    case CheckState::kNotThere:
      return "no line";
    case CheckState::kOpen:
      return "not checked";
    case CheckState::kRunning:
      return "running";
    case CheckState::kPassed:
      return "passed";
    case CheckState::kFailed:
      return "failed";
    case CheckState::kFault:
      return "fault";
  }
  return "unknown";
}

ActiveCheck::ActiveCheck(bool there, const Board& board, const ProbesParameters& parameters, double lamp_height_m)
    : board_(board) {
  if (!there) return;
  const auto pixels =
      static_cast<std::size_t>(board.camera.width_px) * static_cast<std::size_t>(board.camera.height_px);
  checker_.emplace_back(board, parameters, lamp_height_m);
  before_.resize(pixels);
  after_.resize(pixels);
  report_.state = CheckState::kOpen;
}

void ActiveCheck::begin(const Eigen::Vector3d& p_RL, double sigma_m) {
  if (report_.state == CheckState::kNotThere || running()) return;
  p_RL_ = p_RL;
  sigma_m_ = sigma_m;
  phase_ = Phase::kBefore;
  report_ = {CheckState::kRunning, SwitchVerdict::kNoImage, 0};
}

void ActiveCheck::reopen() {
  if (report_.state == CheckState::kPassed || report_.state == CheckState::kFailed) report_.state = CheckState::kOpen;
}

void ActiveCheck::look(const ImageView& image, const LineState& line) {
  if (!running()) return;
  if (line.silent) {
    wants_on_ = false;
    report_.verdict = SwitchVerdict::kNoAnswer;
    report_.state = CheckState::kFault;
    return;
  }
  if (!line.settled) return;
  switch (phase_) {
    case Phase::kBefore:
      keep(image);
      wants_on_ = !line.on;
      phase_ = Phase::kSwitched;
      return;
    case Phase::kSwitched:
      judge(image);
      wants_on_ = !line.on;
      phase_ = Phase::kBack;
      return;
    case Phase::kBack:
      end();
      return;
  }
}

void ActiveCheck::keep(const ImageView& image) {
  sized_ = take_brightness(image, board_.camera, before_);
}

void ActiveCheck::judge(const ImageView& image) {
  ++report_.tries;
  report_.verdict = SwitchVerdict::kNoImage;
  if (!sized_ || !take_brightness(image, board_.camera, after_)) return;
  const int width = board_.camera.width_px;
  const int height = board_.camera.height_px;
  const ImageView before{before_.data(), width, height, width, PixelFormat::kGrey8};
  const ImageView after{after_.data(), width, height, width, PixelFormat::kGrey8};
  // A room's lamp may have a switch in the wall as well: the line says that it changed, the images whither.
  const bool went_on = brightness(after) > brightness(before);
  report_.verdict = checker_.front().check(went_on ? after : before, went_on ? before : after, p_RL_, sigma_m_).verdict;
}

void ActiveCheck::end() {
  if (says_nothing(report_.verdict) && report_.tries < kMostTries) {
    phase_ = Phase::kBefore;
    return;
  }
  report_.state = report_.verdict == SwitchVerdict::kAgrees         ? CheckState::kPassed
                  : report_.verdict == SwitchVerdict::kNoDifference ? CheckState::kFault
                                                                    : CheckState::kFailed;
}

double ActiveCheck::brightness(const ImageView& grey) const {
  const LumaView luma(grey);
  const BoardView view(board_.camera, board_.X_BC);
  double sum = 0.0;
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAcross; ++k) {
      const Eigen::Vector3d p_B(((i + 0.5) / kAlong - 0.5) * board_.depth_m,
                                ((k + 0.5) / kAcross - 0.5) * board_.width_m, 0.0);
      const auto pixel = view.pixel(p_B);
      if (pixel.in_front && luma.holds(pixel.at.x(), pixel.at.y())) sum += luma.at(pixel.at.x(), pixel.at.y());
    }
  }
  return sum;
}

}  // namespace cgsr::illumination
