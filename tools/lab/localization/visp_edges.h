#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "platform/error.h"

namespace cgsr::lab {

/// A .cao model and where it stands.
struct VispModel {
  std::filesystem::path path;
  geometry::Pose X_WM = geometry::Pose::Identity();
};

struct VispSettings {
  unsigned range_px = 8;  ///< how far along an edge's normal it is sought.
  int calls = 1;          ///< of track(), on one image.
  double sample_step_px = 5.0;
  double appear_deg = 85.0;  ///< of a face against the line of sight.
  double disappear_deg = 89.0;
  double near_m = 0.01;
  double far_m = 2.0;
};

/// A peer: the moving-edge tracker of ViSP's model-based trackers (libvisp-mbt-dev), where it was there when this was built.
class VispEdges {
 public:
  static bool built();

  /// \return an error when ViSP is not built in or does not read a model.
  static Result<VispEdges> create(const std::vector<VispModel>& models, const geometry::Camera& camera,
                                  const VispSettings& settings);
  VispEdges(VispEdges&&) noexcept;
  VispEdges& operator=(VispEdges&&) noexcept;
  ~VispEdges();

  /// Begins anew at a pose. \param grey  8 bit, of the camera's size.  \return whether it could.
  bool begin(const cv::Mat& grey, const geometry::Pose& X_WC);

  /// \return the camera's pose, or nothing where it gave up.
  std::optional<geometry::Pose> track(const cv::Mat& grey);

 private:
  struct State;
  explicit VispEdges(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cgsr::lab
