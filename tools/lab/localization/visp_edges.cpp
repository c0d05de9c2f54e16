// C++17: ViSP's headers are not C++20.
#include "tools/lab/localization/visp_edges.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include <fmt/format.h>

#ifdef CGSR_VISP
#include <visp3/mbt/vpMbGenericTracker.h>
#endif

namespace cgsr::lab {

#ifdef CGSR_VISP
namespace {

// What ViSP says on the standard output is not part of a table.
class Silence {
 public:
  Silence() : output_(std::cout.rdbuf(nullptr)) {}
  ~Silence() {
    std::cout.rdbuf(output_);
    std::cout.clear();
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::streambuf* output_;
};

vpHomogeneousMatrix visp_of(const geometry::Pose& X) {
  vpHomogeneousMatrix M;
  for (unsigned r = 0; r < 3; ++r) {
    for (unsigned c = 0; c < 4; ++c) M[r][c] = X.matrix()(r, c);
  }
  return M;
}

vpImage<unsigned char> visp_of(const cv::Mat& grey) {
  vpImage<unsigned char> image(static_cast<unsigned>(grey.rows), static_cast<unsigned>(grey.cols));
  for (int y = 0; y < grey.rows; ++y)
    std::copy(grey.ptr<std::uint8_t>(y), grey.ptr<std::uint8_t>(y) + grey.cols, image[static_cast<unsigned>(y)]);
  return image;
}

}  // namespace

struct VispEdges::State {
  vpMbGenericTracker tracker{1, vpMbGenericTracker::EDGE_TRACKER};
  int calls = 1;
};

bool VispEdges::built() {
  return true;
}

Result<VispEdges> VispEdges::create(const std::vector<VispModel>& models, const geometry::Camera& camera,
                                    const VispSettings& settings) {
  auto state = std::make_unique<State>();
  vpMbGenericTracker& tracker = state->tracker;
  state->calls = settings.calls;
  constexpr double kRad = M_PI / 180.0;
  vpMe edges;
  edges.setMaskSize(5);
  edges.setMaskNumber(180);
  edges.setRange(settings.range_px);
  edges.setSampleStep(settings.sample_step_px);
  edges.setThreshold(10000);
  edges.setMu1(0.5);
  edges.setMu2(0.5);
  try {
    tracker.setMovingEdge(edges);
    tracker.setCameraParameters({camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px});
    tracker.setAngleAppear(settings.appear_deg * kRad);
    tracker.setAngleDisappear(settings.disappear_deg * kRad);
    tracker.setNearClippingDistance(settings.near_m);
    tracker.setFarClippingDistance(settings.far_m);
    tracker.setClipping(tracker.getClipping() | vpPolygon3D::FOV_CLIPPING);
    tracker.setScanLineVisibilityTest(true);  // without it hidden edges are sought as well
    const Silence silence;                    // it lists what it reads
    for (const VispModel& model : models) tracker.loadModel(model.path.string(), false, visp_of(model.X_WM));
  } catch (const vpException& error) {
    return fail(fmt::format("ViSP: {}", error.getMessage()));
  }
  return VispEdges(std::move(state));
}

bool VispEdges::begin(const cv::Mat& grey, const geometry::Pose& X_WC) {
  try {
    state_->tracker.initFromPose(visp_of(grey), visp_of(X_WC.inverse()));
  } catch (const vpException&) {
    return false;
  }
  return true;
}

std::optional<geometry::Pose> VispEdges::track(const cv::Mat& grey) {
  const auto image = visp_of(grey);
  try {
    for (int i = 0; i < state_->calls; ++i) state_->tracker.track(image);
  } catch (const vpException&) {
    return std::nullopt;
  }
  vpHomogeneousMatrix M;
  state_->tracker.getPose(M);
  geometry::Pose X_CW = geometry::Pose::Identity();
  for (unsigned r = 0; r < 3; ++r) {
    for (unsigned c = 0; c < 4; ++c) X_CW.matrix()(r, c) = M[r][c];
  }
  if (!X_CW.matrix().allFinite()) return std::nullopt;
  return geometry::normalized(X_CW.inverse());
}
#else
struct VispEdges::State {};
bool VispEdges::built() {
  return false;
}
Result<VispEdges> VispEdges::create(const std::vector<VispModel>& /*models*/, const geometry::Camera& /*camera*/,
                                    const VispSettings& /*settings*/) {
  return fail("built without ViSP: libvisp-mbt-dev was not installed");
}
bool VispEdges::begin(const cv::Mat& /*grey*/, const geometry::Pose& /*X_WC*/) {
  return false;
}
std::optional<geometry::Pose> VispEdges::track(const cv::Mat& /*grey*/) {
  return std::nullopt;
}
#endif

VispEdges::VispEdges(std::unique_ptr<State> state) : state_(std::move(state)) {}
VispEdges::VispEdges(VispEdges&&) noexcept = default;
VispEdges& VispEdges::operator=(VispEdges&&) noexcept = default;
VispEdges::~VispEdges() = default;

}  // namespace cgsr::lab
