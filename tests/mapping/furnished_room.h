#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/mapping/elastic_map.h"
#include "pipeline/mapping/obj_map.h"
#include "pipeline/mapping/view.h"

namespace cgsr::mapping::testing {

/// A room of 5 x 4 m with four boxes in it and two sheets on its walls, as OBJ.
std::string room_as_obj();

/// The same with each box and sheet moved by N(0, sigma_m) along the surface that it stands or hangs on.
std::string moved_room_as_obj(double sigma_m, std::uint32_t seed);

/// A box that is in no map.
std::string chair_as_obj();

/// Loads a text as a map of the robot's and makes it elastic.
ElasticMap elastic(const ObjMap& file, const std::string& text, const RefineParameters& parameters = {});

geometry::Camera small_camera();

/// Views along a ring in the room, with the edges of `text` as exact segments, noise of `noise_px` across; given poses off by `pose_error` times
/// 5 cm and a degree, odometry exact.
std::vector<View> views_of(const std::string& text, double noise_px, double pose_error, int count, std::uint32_t seed,
                           std::vector<geometry::Pose>* true_poses = nullptr);

}  // namespace cgsr::mapping::testing
