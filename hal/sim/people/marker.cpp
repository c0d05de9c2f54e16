#include "hal/sim/people/marker.h"

#include <cstddef>

#include <opencv2/aruco.hpp>

namespace cgsr::sim {
namespace {

constexpr int kCells = 8;  // 4 x 4 bits, the black border and a white margin

}  // namespace

Mesh marker_mesh(int id, double side_m) {
  cv::Mat image;
  cv::aruco::drawMarker(cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), id, 6, image, 1);
  const auto cell = static_cast<float>(side_m / kCells);
  Mesh mesh;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const bool margin = row == 0 || column == 0 || row == kCells - 1 || column == kCells - 1;
      const bool black = !margin && image.at<std::uint8_t>(row - 1, column - 1) == 0;
      // Seen from the front, columns run to the right, which is to the left (+y) of who wears it.
      const float y = cell * (static_cast<float>(column) + 1.0F - static_cast<float>(kCells) / 2);
      const float z = cell * (static_cast<float>(kCells) / 2 - static_cast<float>(row));
      const Eigen::Vector2f uv(black ? 1.0F : 0.0F, 0.0F);
      mesh.add_polygon({{0, y, z - cell}, {0, y - cell, z - cell}, {0, y - cell, z}, {0, y, z}}, {uv, uv, uv, uv});
      for (std::size_t i = mesh.normal.size() - 4; i < mesh.normal.size(); ++i)
        mesh.normal[i] = Eigen::Vector3f::UnitX();
    }
  }
  return mesh;
}

Mesh sheet_of(const Mesh& marker, bool black) {
  Mesh sheet;
  for (const auto& outline : marker.polygons) {
    if ((marker.uv[outline[0]].x() > 0.5F) != black) continue;
    std::vector<Eigen::Vector3f> corners;
    std::vector<Eigen::Vector2f> uv;
    for (const std::uint32_t corner : outline) {
      corners.push_back(marker.position_m[corner]);
      uv.push_back(marker.uv[corner]);
    }
    sheet.add_polygon(corners, uv);
  }
  return sheet;
}

}  // namespace cgsr::sim
