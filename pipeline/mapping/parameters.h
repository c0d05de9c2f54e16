#pragma once

#include <array>

namespace cgsr::mapping {

/// How a map is refined. Pixels are those of the grey image worked on: 320x240 for a 640x480 camera. Ours.
struct RefineParameters {
  double map_sigma_m = 0.05;     ///< how far a part is from where the map has it, along each axis.
  double shape_sigma_m = 0.003;  ///< how far two corners of one part are off against each other,
  double size_share = 0.005;     ///< besides, of their distance, along it: a part may be wrong in its size,
  double turn_sigma_rad = 0.02;  ///< and across it: it may be turned.
  double contact_sigma_m =
      0.002;  ///< what lies or stands on another part stays on it: its distance from that part's surface.
  double lies_on_m = 0.004;    ///< what is at most this far from a surface lies on it.
  double line_sigma_px = 0.6;  ///< of a perceived line against the map's, besides the line's own.
  double end_sigma_px = 2.0;   ///< of where a perceived line ends, against the corner at which its edge does,
  double end_robust = 1.0;     ///< and Cauchy's constant of that, in sigmas: lines end for other reasons too.
  double robust = 2.0;         ///< Cauchy's constant in sigmas: further out a distance counts less and less.
  std::array<float, 9> radius_px{24.0F, 24.0F, 16.0F, 12.0F, 10.0F,
                                 8.0F,  6.0F,  5.0F,  4.0F};  ///< of a match, round by round.
  double correlated_images =
      40.0;  ///< so many images share the error of their given poses, and together count once; it fades with half of that.
  double odometry_share = 0.03;       ///< of the way between two images, what odometry is off by ...
  double odometry_m = 0.002;          ///< ... and at least,
  double odometry_rad = 0.01;         ///< of a turn by nothing, and besides
  double odometry_turn_share = 0.05;  ///< of the turn.
  int max_steps = 12;                 ///< of the solver, a round.
  int max_pieces = 2000;              ///< of edges that an image is expected to show.
};

/// What is proposed as a new edge.
struct ProposeParameters {
  float min_length_px = 14.0F;     ///< shorter perceived edges propose nothing.
  float explained_px = 6.0F;       ///< nearer than this to an edge of the map that it runs along, an edge is that one,
  double explained_m = 0.03;       ///< or nearer than this in space, the edge of the map being where it is.
  float support_px = 1.6F;         ///< an image supports a line that runs no farther than this from what was perceived,
  float angle_rad = 0.1F;          ///< in this direction,
  float overlap = 0.5F;            ///< along this share of the perceived edge, and three tenths of the line.
  int min_support = 6;             ///< images that support a proposal, at least,
  double min_parallax_rad = 0.12;  ///< seen under angles that differ by this,
  double min_share = 0.35;         ///< and this share of the images in which both ends of the line would be.
  double min_length_m = 0.08;      ///< of the line.
  double same_m = 0.03;            ///< lines nearer than this that run along each other are one.
};

}  // namespace cgsr::mapping
