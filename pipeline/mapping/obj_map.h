#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "platform/error.h"

namespace cgsr::mapping {

/// A map file in Wavefront OBJ, line by line, so that it can be written again with moved corners and all else as it was: names, materials,
/// faces, comments. Metres, z up. Ours.
struct ObjMap {
  struct Face {
    std::vector<std::uint32_t> corners;  ///< indices into points, counter-clockwise seen from the front.
    std::uint32_t part = 0;              ///< index into parts.
  };

  std::vector<std::string> lines;
  std::vector<Eigen::Vector3d> points;  ///< of the `v` lines, W.
  std::vector<std::size_t> point_line;  ///< index into lines, of each point.
  std::vector<Face> faces;              ///< of the `f` lines.
  std::vector<std::string> parts;  ///< names of the `o` and `g` lines; what stands before the first is called "map".
};

/// Reads an OBJ file. \return what is wrong first, with file, line, value and what was expected: a corner that is not three finite numbers, a face
/// with fewer than three corners or with one that is not there, no face at all; a file that cannot be read or that is larger than 256 MB.
Result<ObjMap> read_obj(const std::filesystem::path& file);

/// The same from text. \param name  what messages call it.
Result<ObjMap> parse_obj(std::string_view text, std::string_view name);

/// \return the file's text with the points where `points` has them, to a hundredth of a millimetre and in no other line another letter.
/// \param points  as many as map.points.  \param folder_of_materials  how the new file gets to the folder of the old one: put before the names in
/// `mtllib`; empty: they lie in one folder.
std::string obj_text(const ObjMap& map, const std::vector<Eigen::Vector3d>& points,
                     const std::filesystem::path& folder_of_materials);

}  // namespace cgsr::mapping
