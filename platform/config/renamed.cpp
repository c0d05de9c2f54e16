#include "platform/config/renamed.h"

#include <algorithm>
#include <array>

namespace cgsr::config {
namespace {

struct Renaming {
  std::string_view before;
  std::string_view now;
  std::string_view remark = {};
};

// Sorted by the earlier name. One name may have become two, each in its own section.
constexpr std::array kRenamings{
    Renaming{"acceleration_limit_mps2", "max_acceleration_mps2"},
    Renaming{"again_agreement", "min_reacquire_agreement"},
    Renaming{"agree_within_m", "max_disagreement_m"},
    Renaming{"answer_within_s", "answer_timeout_s"},
    Renaming{"back_off_aside_deg", "max_back_off_turn_deg"},
    Renaming{"backward_limit_mps", "max_backward_mps"},
    Renaming{"clearance_m", "min_clearance_m"},
    Renaming{"deceleration_limit_mps2", "max_deceleration_mps2"},
    Renaming{"drive", "base.kinematic"},
    Renaming{"edges_most", "max_edges"},
    Renaming{"evidence_least", "min_evidence"},
    Renaming{"explained_tracking", "min_tracking_matched_ratio"},
    Renaming{"explore_places", "max_explore_places"},
    Renaming{"farthest_m", "max_distance_m"},
    Renaming{"foreign_agreement", "min_agreement"},
    Renaming{"foreign_images", "max_foreign_images"},
    Renaming{"forward_limit_mps", "max_forward_mps"},
    Renaming{"found_agreement", "min_found_agreement"},
    Renaming{"found_divergence", "max_found_divergence"},
    Renaming{"found_score", "min_found_score"},
    Renaming{"found_sharpness", "min_found_sharpness"},
    Renaming{"gone_after", "max_missing_images"},
    Renaming{"good_angle_deg", "max_locate_angle_deg"},
    Renaming{"good_sigma_m", "max_located_sigma_m"},
    Renaming{"highest", "max_level"},
    Renaming{"iterations", "max_iterations"},
    Renaming{"kept_agreement", "min_kept_agreement"},
    Renaming{"kept_divergence", "max_kept_divergence"},
    Renaming{"lamp_kept_m", "max_lamp_shift_m"},
    Renaming{"lamp_sigma_most_m", "max_lamp_sigma_m"},
    Renaming{"largest_angle_deg", "max_angle_deg"},
    Renaming{"least_contrast", "min_contrast"},
    Renaming{"least_inside", "min_inside"},
    Renaming{"least_points", "min_points"},
    Renaming{"least_share", "min_contrast_ratio"},
    Renaming{"least_support", "min_support"},
    Renaming{"light_step", "min_light_step"},
    Renaming{"locate_least_s", "min_locate_s"},
    Renaming{"locate_most_s", "max_locate_s"},
    Renaming{"longest_hold_s", "max_hold_s"},
    Renaming{"look_again_px", "max_view_shift_px"},
    Renaming{"lost_after", "max_missed_corrections"},
    Renaming{"lost_deg", "max_sigma_deg"},
    Renaming{"lost_m", "max_sigma_m"},
    Renaming{"lowest", "min_level"},
    Renaming{"lowest_m", "min_obstacle_height_m"},
    Renaming{"match_angle_deg", "max_match_angle_deg"},
    Renaming{"match_radius_least_px", "min_match_radius_px"},
    Renaming{"match_radius_px", "max_match_radius_px"},
    Renaming{"matches_least", "min_matches"},
    Renaming{"most_around", "max_around"},
    Renaming{"nearest_m", "min_distance_m"},
    Renaming{"pieces_most", "max_pieces"},
    Renaming{"plausible_mps", "max_plausible_mps"},
    Renaming{"plausible_radps", "max_plausible_radps"},
    Renaming{"pose_lost_s", "max_pose_loss_s"},
    Renaming{"pose_sigma_deg", "min_pose_sigma_deg"},
    Renaming{"pose_sigma_m", "min_pose_sigma_m"},
    Renaming{"prior_chi2_most", "max_prior_chi2"},
    Renaming{"probes_lost_s", "max_probes_loss_s"},
    Renaming{"refusals_to_give_up", "max_refusals"},
    Renaming{"rmp", "base.rmp"},
    Renaming{"rms_most_px", "max_rms_px"},
    Renaming{"search_for_s", "max_search_s"},
    Renaming{"sets_to_be_ready", "min_ready_sets"},
    Renaming{"settled_px", "min_step_px"},
    Renaming{"shade_most_s", "max_shade_wait_s"},
    Renaming{"sigma_most_deg", "max_sigma_deg"},
    Renaming{"sigma_most_m", "max_sigma_m"},
    Renaming{"size_limit", "max_size_ratio"},
    Renaming{"source", "kind", "base.kind, base.can and switches.kind choose the other devices, each by itself"},
    Renaming{"stale_after_s", "max_box_age_s"},
    Renaming{"start_spacing_px", "hypothesis_spacing_px"},
    Renaming{"starts_most", "max_hypotheses"},
    Renaming{"starts_per_cell", "hypotheses_per_cell"},
    Renaming{"starts_per_image", "hypotheses_per_image"},
    Renaming{"steady_after", "min_steady_images"},
    Renaming{"stride_share", "min_steps_per_side"},
    Renaming{"surfaces_most", "max_surfaces"},
    Renaming{"tallest_m", "max_obstacle_height_m"},
    Renaming{"track_px", "max_tracking_sigma_px"},
    Renaming{"turn_acceleration_limit_radps2", "max_turn_acceleration_radps2"},
    Renaming{"turn_first_rad", "max_driving_bearing_rad"},
    Renaming{"turn_limit_radps", "max_turn_radps"},
    Renaming{"weak_score", "min_sure_score"},
    Renaming{"wide_deg", "max_lost_sigma_deg"},
    Renaming{"wide_m", "max_lost_sigma_m"},
    Renaming{"widest_cells", "max_widening_cells"},
    Renaming{"x_max_m", "max_x_m"},
    Renaming{"x_min_m", "min_x_m"},
    Renaming{"y_max_m", "max_y_m"},
    Renaming{"y_min_m", "min_y_m"},
};

constexpr std::string_view kOneSetOfLimits = "one set of limits holds for every task";
constexpr std::string_view kOneEvidence = "the evidence is weighed as a whole, no measure has a threshold of its own";

// Keys of sections that have moved or become others. These names are no longer keys of any section that is read with them.
constexpr std::array kMoved{
    Renaming{"max_acceleration_mps2", "motion.max_acceleration_mps2", kOneSetOfLimits},
    Renaming{"max_backward_mps", "motion.max_backward_mps", kOneSetOfLimits},
    Renaming{"max_deceleration_mps2", "motion.max_deceleration_mps2", kOneSetOfLimits},
    Renaming{"max_divergence_rise", "color.track.presence.divergence_weight", kOneEvidence},
    Renaming{"max_doubtful_images", "color.track.presence.memory", kOneEvidence},
    Renaming{"max_forward_mps", "motion.max_forward_mps", kOneSetOfLimits},
    Renaming{"max_turn_acceleration_radps2", "motion.max_turn_acceleration_radps2", kOneSetOfLimits},
    Renaming{"max_turn_radps", "motion.max_turn_radps", kOneSetOfLimits},
    Renaming{"min_reacquire_score", "color.track.doubt.min_reacquire_log_odds", kOneEvidence},
    Renaming{"min_sharp_score", "color.track.presence.score_weight", kOneEvidence},
    Renaming{"min_stay_score", "color.track.presence.score_weight", kOneEvidence},
    Renaming{"min_stay_sharpness", "color.track.presence.sharpness_weight", kOneEvidence},
    Renaming{"min_sure_sharpness", "color.track.presence.sharpness_weight", kOneEvidence},
};

/// \return whether a section with the keys `known` has the key, which may lie in one of its sections.
bool is_known(std::string_view key, const std::vector<std::string_view>& known) {
  return std::find(known.begin(), known.end(), key.substr(0, key.find('.'))) != known.end();
}

}  // namespace

std::optional<NewName> renamed(std::string_view key, const std::vector<std::string_view>& known) {
  for (const Renaming& renaming : kRenamings) {
    if (renaming.before == key && is_known(renaming.now, known)) return NewName{renaming.now, renaming.remark};
  }
  for (const Renaming& moved : kMoved) {
    if (moved.before == key) return NewName{moved.now, moved.remark};
  }
  return std::nullopt;
}

}  // namespace cgsr::config
