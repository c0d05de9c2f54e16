#include "pipeline/mapping/refine.h"

#include <array>

#include "pipeline/mapping/part_search.h"

namespace cgsr::mapping {
namespace {

constexpr std::size_t kSettled = 2;  // rounds, after which poses are good enough to tell what explains what

// Before each round: how far the poses are off then; 0: parts are not searched.
constexpr std::array<double, 9> kSharpness_px{0.0, 5.0, 4.0, 3.5, 3.0, 2.5, 2.5, 2.0, 0.0};

void shift_parts(const ElasticMap& map, const std::vector<Eigen::Vector3d>& shifts,
                 std::vector<Eigen::Vector3d>& corners) {
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] += shifts[map.part_of(static_cast<std::uint32_t>(i))];
}

}  // namespace

Refined refine(ElasticMap& map, std::span<View> views, const geometry::Camera& camera,
               const RefineParameters& parameters, const std::function<void(int, const Adjusted&)>& progress) {
  Refined refined;
  refined.corners = map.measured();
  const std::size_t rounds = parameters.radius_px.size();
  for (std::size_t round = 0; round < rounds; ++round) {
    map.move(refined.corners);
    if (round < kSharpness_px.size() && kSharpness_px.at(round) > 0.0 &&
        parameters.shape_sigma_m < parameters.map_sigma_m) {
      const auto owners =
          owners_of(map, round < kSettled ? Observed{} : observe(map, views, camera, parameters, kExplained_px));
      shift_parts(map, search_parts(map, views, camera, parameters, owners, kSharpness_px.at(round)), refined.corners);
      map.move(refined.corners);
    }
    const Observed observed = observe(map, views, camera, parameters, parameters.radius_px.at(round));
    const bool last = round + 1 == rounds;
    const Adjusted adjusted =
        adjust(map, refined.corners, views, observed.matches, observed.ends, camera, parameters, last);
    if (last) refined.sigma_m = adjusted.sigma_m;
    if (progress) progress(static_cast<int>(round), adjusted);
  }
  map.move(refined.corners);
  refined.observed = observe(map, views, camera, parameters, parameters.radius_px.back());
  refined.observations.resize(refined.corners.size(), 0);
  for (const LineMatch& match : refined.observed.matches) {
    for (const std::uint32_t corner : map.ends_of(match.edge)) ++refined.observations[corner];
  }
  return refined;
}

}  // namespace cgsr::mapping
