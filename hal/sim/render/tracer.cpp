#include "hal/sim/render/tracer.h"

#include <cstddef>
#include <cstring>

#include <fmt/format.h>

namespace cgsr::sim {
namespace {

constexpr std::size_t kStill = 2;  // instances that never move

}  // namespace

Result<std::unique_ptr<Tracer>> Tracer::make(const Scene& scene) {
  if (scene.figures.size() > kMostFigures) {
    return fail(fmt::format("the scene '{}' has {} moving figures, more than {}", scene.name, scene.figures.size(),
                            kMostFigures));
  }
  std::unique_ptr<Tracer> tracer(new Tracer(scene));
  if (auto built = tracer->build(); !built) return tl::unexpected(built.error());
  return tracer;
}

Tracer::Tracer(const Scene& scene) : scene_(&scene), placements_(scene.parts.size()) {}

Tracer::~Tracer() {
  for (RTCGeometry instance : instances_) rtcReleaseGeometry(instance);
  for (RTCScene object : objects_) rtcReleaseScene(object);
  if (top_ != nullptr) rtcReleaseScene(top_);
  if (device_ != nullptr) rtcReleaseDevice(device_);
}

RTCGeometry Tracer::geometry_of(const Part& part) {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  const Mesh& mesh = part.mesh;
  void* corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                          mesh.position_m.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                          mesh.triangles.size());
  if (corners != nullptr && indices != nullptr) {
    auto* to = static_cast<float*>(corners);
    for (const Eigen::Vector3f& p : mesh.position_m) {
      std::memcpy(to, p.data(), 3 * sizeof(float));
      to += 3;
    }
    auto* index = static_cast<unsigned*>(indices);
    for (const Mesh::Triangle& triangle : mesh.triangles) {
      std::memcpy(index, triangle.corner.data(), 3 * sizeof(unsigned));
      index += 3;
    }
  }
  const bool map = part.figure < 0 && part.in_map;
  rtcSetGeometryMask(geometry, kSightRays | (part.casts_shadow ? kShadowRays : 0U) | (map ? kMapRays : 0U) |
                                   (part.figure >= 0 ? figure_rays(part.figure) : 0U));
  rtcCommitGeometry(geometry);
  return geometry;
}

Result<void> Tracer::build() {
  device_ = rtcNewDevice("isa=sse2,threads=1,user_threads=0,verbose=0");
  if (device_ == nullptr) return fail(fmt::format("Embree does not open: error {}", rtcGetDeviceError(nullptr)));

  const auto new_object = [this](RTCBuildQuality quality) {
    RTCScene object = rtcNewScene(device_);
    rtcSetSceneFlags(object, RTC_SCENE_FLAG_ROBUST);  // no light through the seam of two triangles
    rtcSetSceneBuildQuality(object, quality);
    return object;
  };
  // What stands still: instance 0 casts shadows, instance 1 does not, and shadow rays pass it by as a whole. (A glass globe around a lamp
  // is where all of them end: asking its triangles one by one costs more than the rest of the room.)
  std::vector<unsigned> masks;
  for (const unsigned mask : {kSightRays | kShadowRays | kMapRays, kSightRays | kMapRays}) {
    objects_.push_back(new_object(RTC_BUILD_QUALITY_HIGH));
    part_of_.emplace_back();
    masks.push_back(mask);
  }
  for (std::size_t i = 0; i < scene_->parts.size(); ++i) {
    const Part& part = scene_->parts[i];
    std::size_t object = part.casts_shadow ? 0 : 1;
    if (part.figure >= 0) {
      object = objects_.size();
      masks.push_back(kSightRays | (part.casts_shadow ? kShadowRays : 0U) | figure_rays(part.figure));
      objects_.push_back(new_object(RTC_BUILD_QUALITY_HIGH));
      part_of_.emplace_back();
    }
    RTCGeometry geometry = geometry_of(part);
    rtcAttachGeometryByID(objects_[object], geometry, static_cast<unsigned>(part_of_[object].size()));
    rtcReleaseGeometry(geometry);
    part_of_[object].push_back(static_cast<int>(i));
  }
  for (RTCScene object : objects_) rtcCommitScene(object);

  top_ = rtcNewScene(device_);
  rtcSetSceneFlags(top_, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(top_, RTC_BUILD_QUALITY_LOW);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, objects_[i]);
    rtcSetGeometryMask(instance, masks[i]);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(top_, instance, static_cast<unsigned>(i));
    instances_.push_back(instance);
  }
  rtcCommitScene(top_);
  if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE) {
    return fail(fmt::format("Embree cannot hold the scene '{}': error {}", scene_->name, static_cast<int>(error)));
  }
  return {};
}

void Tracer::update(const SceneState& state) {
  for (std::size_t i = kStill; i < instances_.size(); ++i) {
    const int index = part_of_[i].front();
    const Part& part = scene_->parts[static_cast<std::size_t>(index)];
    if (!is_present(part, state)) {
      rtcDisableGeometry(instances_[i]);
      continue;
    }
    rtcEnableGeometry(instances_[i]);
    const Pose& X_WJ = state.X_WJ[static_cast<std::size_t>(part.figure)][static_cast<std::size_t>(part.joint)];
    Placement& placement = placements_[static_cast<std::size_t>(index)];
    placement.R = X_WJ.linear().cast<float>();
    placement.p = X_WJ.translation().cast<float>();
    std::array<float, 12> columns{};
    Eigen::Map<Eigen::Matrix<float, 3, 4>> map(columns.data());
    map << placement.R, placement.p;
    rtcSetGeometryTransform(instances_[i], 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(instances_[i]);
  }
  rtcCommitScene(top_);
}

void Tracer::nearest(const int* valid, RTCRayHit8& rays, bool coherent) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcIntersect8(valid, top_, &context, &rays);
  for (int lane = 0; lane < kPacket; ++lane) {
    if (valid[lane] != 0 && rays.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) measure(rays, lane);
  }
}

// Möller and Trumbore's intersection ("Fast, Minimum Storage Ray/Triangle Intersection", 1997), in double.
void Tracer::measure(RTCRayHit8& rays, int lane) const {
  const Met hit = met(rays, lane);
  const Part& part = scene_->parts[static_cast<std::size_t>(hit.part)];
  const Mesh::Triangle& triangle = part.mesh.triangles[hit.triangle];
  const Placement& X = placement(hit.part);
  std::array<Eigen::Vector3d, 3> corner;
  for (std::size_t i = 0; i < 3; ++i) corner[i] = part.mesh.position_m[triangle.corner[i]].cast<double>();
  if (part.figure >= 0) {
    const Eigen::Matrix3d R = X.R.cast<double>();
    for (Eigen::Vector3d& p : corner) p = R * p;
  }
  const Eigen::Vector3d p_W = X.p.cast<double>();
  const Eigen::Vector3d a = corner[0] + p_W;
  const Eigen::Vector3d ab = corner[1] + p_W - a;
  const Eigen::Vector3d ac = corner[2] + p_W - a;
  const Eigen::Vector3d direction(rays.ray.dir_x[lane], rays.ray.dir_y[lane], rays.ray.dir_z[lane]);
  const Eigen::Vector3d from_a = Eigen::Vector3d(rays.ray.org_x[lane], rays.ray.org_y[lane], rays.ray.org_z[lane]) - a;
  const Eigen::Vector3d across = direction.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0.0) return;  // seen exactly edge on: Embree says where
  const Eigen::Vector3d q = from_a.cross(ab);
  rays.hit.u[lane] = static_cast<float>(from_a.dot(across) / determinant);
  rays.hit.v[lane] = static_cast<float>(direction.dot(q) / determinant);
  rays.ray.tfar[lane] = static_cast<float>(ac.dot(q) / determinant);
}

void Tracer::blocked(const int* valid, RTCRay8& rays, bool coherent) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcOccluded8(valid, top_, &context, &rays);
}

Met Tracer::met(const RTCRayHit8& rays, int lane) const {
  if (rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return {};
  const unsigned instance = rays.hit.instID[0][lane];
  const int part = part_of_[instance][rays.hit.geomID[lane]];
  return {part, rays.hit.primID[lane], rays.hit.u[lane], rays.hit.v[lane]};
}

}  // namespace cgsr::sim
