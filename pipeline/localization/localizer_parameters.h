#pragma once

#include <cstdint>
#include <string_view>

#include "platform/parameters.h"

namespace cgsr::localization {

/// By which method a pose is corrected.
enum class Method : std::uint8_t {
  kGlCorrect,  ///< visible edges only, Gaussian prior, gate, several starts where the prior is wide.
  kStronger,   ///< Alg. 4.1: every edge projected, no occlusion, no gate, one start.
  kPaper,  ///< 4.2's expectation with the dissertation's solver: lambda = 1, units proportional to the variance, full step, no gate.
};

inline constexpr Named<Method> kMethodNames[] = {
    {"glcorrect", Method::kGlCorrect}, {"stronger", Method::kStronger}, {"paper", Method::kPaper}};
constexpr std::string_view to_string(Method method) {
  return word_in(kMethodNames, method);
}

/// What draws the edges that should be visible (4.2).
enum class ExpectationKind : std::uint8_t {
  kRaster,  ///< render::DepthRaster: the budget path.
  kOsmesa,  ///< render::OsmesaExpectation: OpenGL, as the dissertation has it; whoever makes a Localizer hands it over.
};

inline constexpr Named<ExpectationKind> kExpectationKindNames[] = {{"raster", ExpectationKind::kRaster},
                                                                   {"osmesa", ExpectationKind::kOsmesa}};
constexpr std::string_view to_string(ExpectationKind kind) {
  return word_in(kExpectationKindNames, kind);
}

/// What the gate decides by: for a searched pose the log-odds of its error, for one of the few poses that a narrow prior holds evidence, in units
/// of agreement: 1 where all of the map that should be visible is in the image.
struct GateParameters {
  double max_lead = 0.3;
  double chance_agreement = 0.2;
  double worst_part_weight = 0.5;
  double prior_weight = 0.02;
  double error_log_odds = 8.0;
  double error_per_lead = -8.9;
  double error_per_ln_cell = 0.24;
  double error_per_agreement = -5.2;
  double error_per_ln_m = 1.15;
  double error_per_px = 6.8;
  double error_per_ln_match = -2.15;
  double error_per_cost = 0.127;
  double max_error_log_odds = -2.5;
  double same_m = 0.05;
  double same_deg = 1.5;
  int min_expected = 3;
  int min_tracking_expected = 2;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_lead", self.max_lead, {0.0, 2.0}, "",
                 "The lead over the next hypothesis counts up to this, as evidence and in the log-odds of an error.");
    visit.number("chance_agreement", self.chance_agreement, {0.0, 1.0}, "",
                 "The agreement of the next hypothesis where the search found none: some pose always has as much.");
    visit.number("worst_part_weight", self.worst_part_weight, {0.0, 5.0}, "",
                 "The weight of the agreement in the worst parts of the image.");
    visit.number("prior_weight", self.prior_weight, {0.0, 1.0}, "",
                 "The evidence that each unit of squared Mahalanobis distance to the prior costs.");
    describe_error(self, visit);
    visit.number("same_m", self.same_m, {0.0, 1.0}, "m",
                 "Two poses are the same answer when they are at most this far apart and turned by at most same_deg.");
    visit.number("same_deg", self.same_deg, {0.0, 45.0}, "deg",
                 "The largest rotation between two poses that are the same answer.");
    visit.number("min_expected", self.min_expected, {0, 1000}, "",
                 "The gate requires at least this many expected edges after a search.");
    visit.number("min_tracking_expected", self.min_tracking_expected, {0, 1000}, "",
                 "The gate requires at least this many expected edges and matches when tracking from a narrow prior; "
                 "that holds what they leave open.");
  }

 private:
  template <class Self, class Visitor>
  static void describe_error(Self& self, Visitor& visit) {
    visit.number(
        "error_log_odds", self.error_log_odds, {-1000.0, 1000.0}, "",
        "The natural log-odds that a searched pose is more than 5 cm or 1.5 degrees off, where all that follows "
        "is 0 or, of a logarithm, 1.");
    visit.number("error_per_lead", self.error_per_lead, {-1000.0, 0.0}, "",
                 "The growth of these log-odds per unit of lead over the next hypothesis, up to max_lead.");
    visit.number("error_per_ln_cell", self.error_per_ln_cell, {0.0, 1000.0}, "",
                 "The growth of these log-odds per natural logarithm of the number of distinct poses in the prior.");
    visit.number("error_per_agreement", self.error_per_agreement, {-1000.0, 0.0}, "",
                 "The growth of these log-odds per unit of agreement.");
    visit.number("error_per_ln_m", self.error_per_ln_m, {0.0, 1000.0}, "",
                 "The growth of these log-odds per natural logarithm of the standard deviation of the position in "
                 "metres.");
    visit.number("error_per_px", self.error_per_px, {0.0, 1000.0}, "1/px",
                 "The growth of these log-odds per pixel of the matches' root mean square.");
    visit.number("error_per_ln_match", self.error_per_ln_match, {-1000.0, 0.0}, "",
                 "The growth of these log-odds per natural logarithm of the number of matches.");
    visit.number("error_per_cost", self.error_per_cost, {0.0, 1000.0}, "",
                 "The growth of these log-odds per unit of the solver's cost: the robust sum of the squared distances "
                 "in standard deviations and of the prior's.");
    visit.number("max_error_log_odds", self.max_error_log_odds, {-100.0, 100.0}, "",
                 "The gate accepts at most these log-odds of an error after a search.");
  }
};

/// When another pose beside a tracked one takes its place. Leads are in units of agreement.
struct AlternativeParameters {
  double min_offset_px = 2.0;
  double max_offset_px = 5.0;
  double prior_widening = 6.0;
  int rounds = 3;
  double match_radius_px = 4.0;
  double same_px = 1.0;
  int min_matches = 6;
  double prior_weight = 0.001;
  double max_lead_per_image = 0.04;
  double lead_kept = 0.8;
  double min_lead = 0.12;
  int min_images = 5;
  double max_deficit = 0.03;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("min_offset_px", self.min_offset_px, {0.0, 100.0}, "px",
                 "An alternative starts at least this far from the tracked pose, as motion of the image.");
    visit.number("max_offset_px", self.max_offset_px, {0.0, 100.0}, "px", "An alternative starts at most this far.");
    visit.number("prior_widening", self.prior_widening, {1.0, 100.0}, "",
                 "The factor by which the prior's standard deviations are larger for the alternative.");
    visit.number("rounds", self.rounds, {1, 50}, "",
                 "The number of iterations by which an image refines the alternative.");
    visit.number("match_radius_px", self.match_radius_px, {1.0, 50.0}, "px",
                 "The largest effective distance of its matches.");
    visit.number("same_px", self.same_px, {0.0, 100.0}, "px",
                 "An alternative that comes nearer than this to the tracked pose is dropped.");
    visit.number("min_matches", self.min_matches, {1, 1000}, "",
                 "There is no alternative to a tracked pose with fewer matches: they would fit any pose.");
    visit.number("prior_weight", self.prior_weight, {0.0, 1.0}, "",
                 "The lead that each unit of squared Mahalanobis distance to the tracked pose costs.");
    visit.number("max_lead_per_image", self.max_lead_per_image, {0.0, 2.0}, "",
                 "An image adds at most this to the lead, so that one that is blurred or half hidden does not decide.");
    visit.number("lead_kept", self.lead_kept, {0.0, 1.0}, "",
                 "The share of the lead that is kept from image to image.");
    visit.number("min_lead", self.min_lead, {0.0, 10.0}, "",
                 "The alternative takes the tracked pose's place when its lead is at least this.");
    visit.number("min_images", self.min_images, {1, 1000}, "", "The lead must have been gained in this many images.");
    visit.number("max_deficit", self.max_deficit, {0.0, 2.0}, "",
                 "An alternative is dropped when one image agrees with it by more than this less.");
  }
};

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
  double rival_share = 0.5;
  double max_match_angle_deg = 12.0;
  double max_match_radius_px = 24.0;
  double min_match_radius_px = 4.0;
  double settle_radius_px = 2.5;
  double max_tracking_sigma_px = 7.0;
  double hypothesis_spacing_px = 12.0;
  double hypotheses_per_cell = 32.0;
  int max_hypotheses = 500;
  int hypotheses_per_image = 8;
  int finalists = 8;
  int neighbours = 40;
  int walks = 4;
  double misfit_weight = 0.2;
  int min_matches = 3;
  double min_tracking_matched_ratio = 0.3;
  double min_evidence = 0.48;
  double max_prior_chi2 =
      22.0;  // chi square of six numbers exceeds it once in 800; the mount was told a little wrong besides
  double max_sigma_m = 0.1;
  double max_sigma_deg = 3.5;
  double max_rms_px = 1.35;
  int max_pieces = 1200;
  GateParameters decision;
  AlternativeParameters alternative;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    describe_method(self, visit);
    describe_matches(self, visit);
    describe_search(self, visit);
    describe_gate(self, visit);
    visit.number("max_pieces", self.max_pieces, {16, 20000}, "",
                 "The largest number of visible edge pieces; the nearest and longest ones are kept.");
    visit.section("decision", self.decision, "The gate's decision on a pose: evidence and the log-odds of an error");
    visit.section("alternative", self.alternative, "Another pose beside a tracked one");
  }

 private:
  template <class Self, class Visitor>
  static void describe_method(Self& self, Visitor& visit) {
    visit.choice("method", self.method, kMethodNames, "The method that corrects a pose.");
    visit.choice("expectation", self.expectation, kExpectationKindNames,
                 "The renderer that determines the visible edges: raster is the project's own depth buffer; osmesa is "
                 "OpenGL and costs ten times as much.");
    visit.flag("search", self.search,
               "Several hypotheses are examined where the prior is wide; otherwise only the prior's mean is.");
    visit.flag("gate", self.gate, "A correction is accepted only when it passes the gate.");
    visit.number("max_iterations", self.max_iterations, {1, 50}, "",
                 "The largest number of iterations of expectation and maximisation.");
    visit.number("min_step_px", self.min_step_px, {0.001, 10.0}, "px",
                 "The iterations end when a step moves the image less than this.");
    visit.number("max_view_shift_px", self.max_view_shift_px, {0.0, 100.0}, "px",
                 "The visible edges are computed again when the pose has moved the image further than this.");
  }

  template <class Self, class Visitor>
  static void describe_matches(Self& self, Visitor& visit) {
    visit.number(
        "system_sigma_px", self.system_sigma_px, {0.05, 20.0}, "px",
        "The standard deviation of the error of camera and map in the image, in addition to that of the segment.");
    visit.number("rival_share", self.rival_share, {0.0, 10.0}, "",
                 "The standard deviation of a match that may be the wrong one of two parallel lines, as a share of the "
                 "distance between them.");
    visit.number(
        "map_sigma_m", self.map_sigma_m, {0.0, 0.5}, "m",
        "The standard deviation of positions in the map, for every match and for every pose; of a small map at most "
        "a thousandth of its diagonal.");
    visit.number("max_match_angle_deg", self.max_match_angle_deg, {1.0, 45.0}, "deg",
                 "The largest angle between an expected and a perceived edge that match.");
    visit.number("max_match_radius_px", self.max_match_radius_px, {2.0, 200.0}, "px",
                 "The largest effective distance between an expected and a perceived edge that match.");
    visit.number("min_match_radius_px", self.min_match_radius_px, {1.0, 50.0}, "px",
                 "The distance to which that radius shrinks while the pose converges.");
    visit.number("settle_radius_px", self.settle_radius_px, {0.5, 50.0}, "px",
                 "The distance to which it shrinks further in a search, where two parallel lines may lie closer than "
                 "min_match_radius_px; a larger value counts as that.");
  }

  template <class Self, class Visitor>
  static void describe_search(Self& self, Visitor& visit) {
    visit.number("max_tracking_sigma_px", self.max_tracking_sigma_px, {0.0, 200.0}, "px",
                 "A prior whose standard deviation moves the image by at most this is tracked from one hypothesis.");
    visit.number("hypothesis_spacing_px", self.hypothesis_spacing_px, {2.0, 100.0}, "px",
                 "The motion of the image that separates two cells of the prior.");
    visit.number("hypotheses_per_cell", self.hypotheses_per_cell, {1.0, 100.0}, "",
                 "The number of hypotheses per cell of the prior.");
    visit.number("max_hypotheses", self.max_hypotheses, {1, 2000}, "",
                 "The largest number of hypotheses, however wide the prior is.");
    visit.number("hypotheses_per_image", self.hypotheses_per_image, {0, 2000}, "",
                 "The number of hypotheses examined per image; 0 examines as many as the budget grants.");
    visit.number("finalists", self.finalists, {1, 64}, "", "The number of best hypotheses that are refined.");
    visit.number("neighbours", self.neighbours, {0, 500}, "",
                 "The number of poses around the best one that are compared with it.");
    visit.number("walks", self.walks, {0, 20}, "",
                 "The number of times that this comparison starts again from a better neighbour.");
    visit.number(
        "misfit_weight", self.misfit_weight, {0.0, 10.0}, "",
        "The agreement that each unit of the mean cost of a match takes from a pose when the poses of a search "
        "are compared.");
  }

  template <class Self, class Visitor>
  static void describe_gate(Self& self, Visitor& visit) {
    visit.number("min_matches", self.min_matches, {2, 1000}, "",
                 "The gate requires at least this many matches; when tracking from a narrow prior, "
                 "decision.min_tracking_expected are enough.");
    visit.number("min_tracking_matched_ratio", self.min_tracking_matched_ratio, {0.0, 1.0}, "",
                 "The gate requires at least this matched-length ratio when tracking from a narrow prior, so that a "
                 "hidden map moves no pose.");
    visit.number(
        "min_evidence", self.min_evidence, {-10.0, 2.0}, "",
        "The gate requires at least this evidence for one of the few poses that a narrow prior holds: the agreement of "
        "image and map, also in the worst parts of the image, and the lead over the next hypothesis, less the distance "
        "to the prior.");
    visit.number("max_prior_chi2", self.max_prior_chi2, {1.0, 1000.0}, "",
                 "The gate accepts at most this squared Mahalanobis distance to the prior.");
    visit.number("max_sigma_m", self.max_sigma_m, {0.001, 10.0}, "m",
                 "The gate accepts at most this standard deviation in the position's worst direction after a search.");
    visit.number("max_sigma_deg", self.max_sigma_deg, {0.01, 90.0}, "deg",
                 "The gate accepts at most this standard deviation about the worst axis of rotation after a search.");
    visit.number("max_rms_px", self.max_rms_px, {0.1, 50.0}, "px",
                 "The gate accepts at most this root mean square of the distances of the matches.");
  }
};

}  // namespace cgsr::localization
