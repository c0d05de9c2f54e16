#pragma once

#include <cstdint>

#include "platform/parameters.h"

namespace cgsr::localization {

enum class Method : std::uint8_t {
  kGlCorrect,  ///< visible edges only, Gaussian prior, gate, several starts where the prior is wide.
  kStronger,   ///< Alg. 4.1: every edge projected, no occlusion, no gate, one start.
  kPaper,  ///< 4.2's expectation with the dissertation's solver: lambda = 1, units proportional to the variance, full step, no gate.
};

inline constexpr Named<Method> kMethodNames[] = {
    {"glcorrect", Method::kGlCorrect}, {"stronger", Method::kStronger}, {"paper", Method::kPaper}};

/// What draws the edges that should be visible (4.2.2).
enum class ExpectationKind : std::uint8_t {
  kRaster,  ///< render::DepthRaster: the budget path.
  kOsmesa,  ///< render::OsmesaExpectation: OpenGL, as the dissertation has it; whoever makes a Localizer hands it over.
};

inline constexpr Named<ExpectationKind> kExpectationKindNames[] = {{"raster", ExpectationKind::kRaster},
                                                                   {"osmesa", ExpectationKind::kOsmesa}};

/// How a camera's pose is corrected. Pixels are those of the grey image worked on: 320x240 for a 640x480 camera.
struct LocalizerParameters {
  Method method = Method::kGlCorrect;
  ExpectationKind expectation = ExpectationKind::kRaster;
  bool search = true;
  bool gate = true;
  int max_iterations = 6;
  double min_step_px = 0.1;
  double max_view_shift_px = 6.0;
  double system_sigma_px = 0.9;
  double map_sigma_m = 0.005;
  double max_match_angle_deg = 12.0;
  double max_match_radius_px = 24.0;
  double min_match_radius_px = 4.0;
  double max_tracking_sigma_px = 7.0;
  double hypothesis_spacing_px = 12.0;
  double hypotheses_per_cell = 32.0;
  int max_hypotheses = 500;
  int hypotheses_per_image = 8;
  int finalists = 8;
  int neighbours = 40;
  int walks = 4;
  int min_matches = 3;
  double min_tracking_matched_ratio = 0.3;
  double min_evidence = 0.48;
  double max_prior_chi2 =
      22.0;  // chi square of six numbers exceeds it once in 800; the mount was told a little wrong besides
  double max_sigma_m = 0.1;
  double max_sigma_deg = 3.5;
  double max_rms_px = 1.35;
  int max_pieces = 1200;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("method", self.method, kMethodNames, "how a pose is corrected");
    visit.choice(
        "expectation", self.expectation, kExpectationKindNames,
        "what draws the edges that should be visible: our own depth buffer, or OpenGL through OSMesa, which costs "
        "ten times as much");
    visit.flag("search", self.search, "several starts where the prior is wide; off: from the prior alone");
    visit.flag("gate", self.gate, "a pose is corrected only where the evidence is enough");
    visit.number("max_iterations", self.max_iterations, {1, 50}, "",
                 "expectation and maximisation alternate at most so often");
    visit.number("min_step_px", self.min_step_px, {0.001, 10.0}, "px", "a step that moves the image less ends them");
    visit.number("max_view_shift_px", self.max_view_shift_px, {0.0, 100.0}, "px",
                 "a pose that moved the image further looks again at what is visible");
    visit.number("system_sigma_px", self.system_sigma_px, {0.05, 20.0}, "px",
                 "error of camera and map in the image, beside the segment's own");
    visit.number("map_sigma_m", self.map_sigma_m, {0.0, 0.5}, "m",
                 "error of the map's places: of each match, and of every pose");
    visit.number("max_match_angle_deg", self.max_match_angle_deg, {1.0, 45.0}, "deg",
                 "largest difference of direction");
    visit.number("max_match_radius_px", self.max_match_radius_px, {2.0, 200.0}, "px", "largest effective distance");
    visit.number("min_match_radius_px", self.min_match_radius_px, {1.0, 50.0}, "px",
                 "what it shrinks to as the pose settles");
    visit.number("max_tracking_sigma_px", self.max_tracking_sigma_px, {0.0, 200.0}, "px",
                 "a prior whose sigma moves the image less is followed from one start");
    visit.number("hypothesis_spacing_px", self.hypothesis_spacing_px, {2.0, 100.0}, "px",
                 "motion of the image that makes a cell of the prior");
    visit.number("hypotheses_per_cell", self.hypotheses_per_cell, {1.0, 100.0}, "", "of the prior");
    visit.number("max_hypotheses", self.max_hypotheses, {1, 2000}, "", "however wide the prior is");
    visit.number("hypotheses_per_image", self.hypotheses_per_image, {0, 2000}, "", "0: as many as the budget grants");
    visit.number("finalists", self.finalists, {1, 64}, "", "starts that are refined");
    visit.number("neighbours", self.neighbours, {0, 500}, "", "poses about the best one that are tried against it");
    visit.number("walks", self.walks, {0, 20}, "", "how often a better neighbour starts this again");
    visit.number("min_matches", self.min_matches, {2, 1000}, "", "gate; two where a narrow prior is followed");
    visit.number("min_tracking_matched_ratio", self.min_tracking_matched_ratio, {0.0, 1.0}, "",
                 "gate where a narrow prior is followed: share of the expected length found; what hides much of the "
                 "map moves no pose");
    visit.number("min_evidence", self.min_evidence, {-10.0, 2.0}, "",
                 "gate where several poses were tried: agreement of image and map, in the worst parts of the image "
                 "too, and lead, less distance and "
                 "width of the prior");
    visit.number("max_prior_chi2", self.max_prior_chi2, {1.0, 1000.0}, "", "gate: squared sigmas from the prior");
    visit.number(
        "max_sigma_m", self.max_sigma_m, {0.001, 10.0}, "m",
        "gate where several poses were tried: of the position's worst direction; after a search times 0.3 to 1.2, "
        "by how much speaks for the pose");
    visit.number("max_sigma_deg", self.max_sigma_deg, {0.01, 90.0}, "deg", "likewise of the worst axis of turning");
    visit.number("max_rms_px", self.max_rms_px, {0.1, 50.0}, "px", "gate: of the distances of the matches");
    visit.number("max_pieces", self.max_pieces, {16, 20000}, "",
                 "visible pieces of edges worked with, nearest and longest first");
  }
};

}  // namespace cgsr::localization
