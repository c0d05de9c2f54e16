#include "pipeline/global_localization/candidates.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>

namespace cgsr::global_localization {
namespace {

using geometry::Pose;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kCell = 2.0 * std::numbers::pi / Panorama::kAzimuths;
constexpr int kComparedAtOnce = 16;               // places with the panorama seen, for a unit
constexpr std::size_t kProposedPerCandidate = 3;  // one place of the home may be proposed by places on all its sides
constexpr double kNeighbours =
    1.5;                        // steps of the grid: places no farther apart, seen from one heading, are one candidate
constexpr double kAbout = 1.6;  // likewise: the neighbours along the axes and at the corners
constexpr int kNearCells = 3;   // of azimuth, about a candidate's heading
constexpr float kHardlyAlike = 0.2F;  // so much below a candidate's likeness

// The turn between two cells at which a parabola through a cell and its neighbours is highest.
double refined(const Panorama::Likeness& likeness, std::size_t best) {
  constexpr std::size_t kCount = Panorama::kAzimuths;
  const double before = static_cast<double>(likeness[(best + kCount - 1) % kCount]);
  const double after = static_cast<double>(likeness[(best + 1) % kCount]);
  const double curve = before - 2.0 * static_cast<double>(likeness[best]) + after;
  const double shift = curve < 0.0 ? 0.5 * (before - after) / curve : 0.0;
  return (static_cast<double>(best) + shift) * kCell;
}

// The cell of the greatest likeness near a heading.
std::size_t most_alike_about(const Panorama::Likeness& likeness, double heading_rad) {
  constexpr int kCount = Panorama::kAzimuths;
  const int middle = static_cast<int>(std::lround(heading_rad / kCell));
  const auto cell = [](int turn) { return static_cast<std::size_t>(((turn % kCount) + kCount) % kCount); };
  std::size_t most = cell(middle);
  for (int turn = middle - kNearCells; turn <= middle + kNearCells; ++turn) {
    if (likeness[cell(turn)] > likeness[most]) most = cell(turn);
  }
  return most;
}

}  // namespace

bool are_near(const Pose& a, const Pose& b, double distance_m, double turn_rad) {
  return (a.translation() - b.translation()).head<2>().norm() <= distance_m &&
         std::abs(std::remainder(geometry::heading_of(b) - geometry::heading_of(a), 2.0 * std::numbers::pi)) <=
             turn_rad;
}

std::vector<Eigen::Vector2d> grid_of_places(const world::Map& map, double spacing_m,
                                            const std::function<bool(double, double)>& may_stand) {
  std::vector<Eigen::Vector2d> places;
  if (map.vertices.empty()) return places;
  Eigen::Vector3f least = map.vertices.front();
  Eigen::Vector3f most = least;
  for (const Eigen::Vector3f& vertex : map.vertices) {
    least = least.cwiseMin(vertex);
    most = most.cwiseMax(vertex);
  }
  const auto count = [&](float from, float to) { return static_cast<int>(std::ceil((to - from) / spacing_m)); };
  for (int column = 0; column < count(least.x(), most.x()); ++column) {
    for (int row = 0; row < count(least.y(), most.y()); ++row) {
      const Eigen::Vector2d place =
          least.head<2>().cast<double>() + spacing_m * Eigen::Vector2d(column + 0.5, row + 0.5);
      if (may_stand(place.x(), place.y())) places.push_back(place);
    }
  }
  return places;
}

CandidateSearch::CandidateSearch(PlaceIndex& index, const GlobalLocalizerParameters& parameters)
    : index_(&index),
      parameters_(parameters),
      most_proposed_(kProposedPerCandidate * static_cast<std::size_t>(parameters.max_candidates)) {
  candidates_.reserve(most_proposed_ + 1);
}

void CandidateSearch::restart() {
  candidates_.clear();
  next_place_ = 0;
  compared_ = 0;
  sharpened_ = 0;
  about_ = std::nullopt;
}

bool CandidateSearch::go_on(const Panorama& seen, WorkBudget& budget) {
  for (; next_place_ < index_->size(); ++next_place_) {
    // In a large home the turn ends before every place is in the index.
    if (next_place_ >= index_->apart() && !index_->holds(next_place_)) continue;
    const auto likeness = compare(next_place_, seen, budget);
    if (!likeness) return false;
    propose(next_place_, *likeness);
  }
  while (sharpened_ < std::min(candidates_.size(), static_cast<std::size_t>(parameters_.max_candidates))) {
    if (!sharpen(candidates_[sharpened_], seen, budget)) return false;
    if (!leave_out_double()) ++sharpened_;
  }
  candidates_.resize(sharpened_);
  std::ranges::sort(candidates_, std::greater<>(), &Candidate::likeness);
  return true;
}

std::optional<Panorama::Likeness> CandidateSearch::compare(std::size_t place, const Panorama& seen,
                                                           WorkBudget& budget) {
  if (!index_->build(place, budget)) return std::nullopt;
  if (compared_ == 0 && !budget.grant()) return std::nullopt;
  compared_ = (compared_ + 1) % kComparedAtOnce;
  return index_->panorama(place).compare(seen);
}

void CandidateSearch::propose(std::size_t place, const Panorama::Likeness& likeness) {
  const auto worse = [](const Candidate& a, const Candidate& b) { return a.likeness > b.likeness; };
  for (std::size_t i = 0; i < likeness.size(); ++i) {
    const float here = likeness[i];
    const bool full = candidates_.size() >= most_proposed_;
    if (here <= 0.0F || (full && here <= candidates_.back().likeness)) continue;
    if (here < likeness[(i + 1) % likeness.size()] || here <= likeness[(i + likeness.size() - 1) % likeness.size()])
      continue;
    Candidate candidate;
    candidate.X_WR =
        geometry::pose_on_floor(index_->place_m(place).x(), index_->place_m(place).y(), refined(likeness, i));
    candidate.likeness = here;
    // Neighbours on the grid are one candidate.
    const double near_m = kNeighbours * parameters_.spacing_m;
    const auto is_same = [&](const Candidate& other) {
      return are_near(other.X_WR, candidate.X_WR, near_m, parameters_.same_deg * kDegree);
    };
    if (std::ranges::any_of(candidates_, [&](const Candidate& c) { return is_same(c) && c.likeness >= here; }))
      continue;
    std::erase_if(candidates_, is_same);
    candidates_.insert(std::upper_bound(candidates_.begin(), candidates_.end(), candidate, worse), candidate);
    if (candidates_.size() > most_proposed_) candidates_.pop_back();
  }
}

// The place between those of the grid: the middle of those about the most alike one, each by how much more alike it is than what is hardly so. Where not
// every place was compared, that one may be beside the one proposed.
bool CandidateSearch::sharpen(Candidate& candidate, const Panorama& seen, WorkBudget& budget) {
  if (!about_) about_ = About(candidate.X_WR, candidate.likeness);
  if (!look_about(seen, budget)) return false;
  if (about_->X_WR_alike.translation() != about_->X_WR.translation() && !about_->moved) {
    about_ = About(about_->X_WR_alike, about_->most_alike);
    about_->moved = true;
    if (!look_about(seen, budget)) return false;
  }
  const Eigen::Vector3d shift = about_->sum / about_->weights;
  const Eigen::Vector3d& middle = about_->X_WR.translation();
  candidate.X_WR = geometry::pose_on_floor(middle.x() + shift.x(), middle.y() + shift.y(),
                                           geometry::heading_of(about_->X_WR) + shift.z());
  candidate.X_WR_alike = about_->X_WR_alike;
  candidate.likeness = about_->most_alike;
  about_ = std::nullopt;
  return true;
}

bool CandidateSearch::look_about(const Panorama& seen, WorkBudget& budget) {
  const Eigen::Vector2d middle = about_->X_WR.translation().head<2>();
  const double heading = geometry::heading_of(about_->X_WR);
  for (; about_->next < index_->size(); ++about_->next) {
    const Eigen::Vector2d& place = index_->place_m(about_->next);
    const Eigen::Vector2d off = place - middle;
    if (off.cwiseAbs().maxCoeff() > kAbout * parameters_.spacing_m) continue;
    const auto likeness = compare(about_->next, seen, budget);
    if (!likeness) return false;
    const std::size_t most = most_alike_about(*likeness, heading);
    const double above = std::max(0.0F, (*likeness)[most] - about_->likeness + kHardlyAlike);
    const double turn = std::remainder(refined(*likeness, most) - heading, 2.0 * std::numbers::pi);
    about_->weights += above * above;
    about_->sum += above * above * Eigen::Vector3d(off.x(), off.y(), turn);
    if ((*likeness)[most] <= about_->most_alike) continue;
    about_->most_alike = (*likeness)[most];
    about_->X_WR_alike = geometry::pose_on_floor(place.x(), place.y(), heading + turn);
  }
  return true;
}

// One whose most alike place is that of another one, or next to it. \return whether it was.
bool CandidateSearch::leave_out_double() {
  const auto last = candidates_.begin() + static_cast<std::ptrdiff_t>(sharpened_);
  const auto same = std::find_if(candidates_.begin(), last, [&](const Candidate& other) {
    return are_near(other.X_WR_alike, last->X_WR_alike, kNeighbours * parameters_.spacing_m,
                    parameters_.same_deg * kDegree);
  });
  if (same == last) return false;
  if (last->likeness > same->likeness) *same = *last;
  candidates_.erase(last);
  return true;
}

}  // namespace cgsr::global_localization
