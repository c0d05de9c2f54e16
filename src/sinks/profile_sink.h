#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "src/sinks/profile.h"
#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// Keeps a Profile, and writes it once a second to a file for `cgsr top` where one is named. The file is replaced as a
/// whole. A disk that takes nothing is reported once and does not end the run: the robot needs no status file.
class ProfileSink final : public Sink {
 public:
  using Rings = std::function<nlohmann::ordered_json()>;

  /// \param file  of the status; empty: none. \param rings  what there is to say of the rings.
  ProfileSink(const runtime::Schedule& schedule, std::string file, Rings rings)
      : profile_(schedule), file_(std::move(file)), rings_(std::move(rings)) {}

  Result<void> on_image(const ImageReport& report) override;
  Result<void> on_missing_image(const runtime::FrameRecord& record) override;
  Result<void> on_control_cycle(const MotionStatus& status) override;
  Result<void> finish() override;
  /// Adds the key "profile".
  void summarize(Summary& summary) override;

 private:
  [[nodiscard]] nlohmann::ordered_json json() const;
  void write_if_due(MonoTime now);
  void write();

  Profile profile_;
  std::string file_;
  Rings rings_;
  std::optional<MonoTime> written_at_;
  bool failed_ = false;
};

}  // namespace cgsr::sinks
