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
constexpr int kComparedAtOnce = 16;  // places with the panorama seen, for a unit
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
    : index_(&index), parameters_(parameters) {
  candidates_.reserve(static_cast<std::size_t>(parameters.max_candidates) + 1);
}

void CandidateSearch::restart() {
  candidates_.clear();
  next_place_ = 0;
  compared_ = 0;
  sharpened_ = 0;
  about_ = About{};
}

bool CandidateSearch::go_on(const Panorama& seen, WorkBudget& budget) {
  for (; next_place_ < index_->size(); ++next_place_) {
    if (!compare_next(seen, budget)) return false;
  }
  return sharpen(seen, budget);
}

// In a large home the turn ends before every place is in the index.
bool CandidateSearch::compare_next(const Panorama& seen, WorkBudget& budget) {
  if (next_place_ < index_->apart() && !index_->build(next_place_, budget)) return false;
  if (!index_->holds(next_place_)) return true;
  if (compared_ == 0 && !budget.grant()) return false;
  compared_ = (compared_ + 1) % kComparedAtOnce;
  propose(next_place_, index_->panorama(next_place_).compare(seen));
  return true;
}

void CandidateSearch::propose(std::size_t place, const Panorama::Likeness& likeness) {
  const auto worse = [](const Candidate& a, const Candidate& b) { return a.likeness > b.likeness; };
  for (std::size_t i = 0; i < likeness.size(); ++i) {
    const float here = likeness[i];
    const bool full = candidates_.size() >= static_cast<std::size_t>(parameters_.max_candidates);
    if (here <= 0.0F || (full && here <= candidates_.back().likeness)) continue;
    if (here < likeness[(i + 1) % likeness.size()] || here <= likeness[(i + likeness.size() - 1) % likeness.size()])
      continue;
    Candidate candidate;
    candidate.X_WR =
        geometry::pose_on_floor(index_->place_m(place).x(), index_->place_m(place).y(), refined(likeness, i));
    candidate.likeness = here;
    candidate.X_WR_alike = candidate.X_WR;
    // Neighbours on the grid are one candidate.
    const double near_m = kNeighbours * parameters_.spacing_m;
    const auto is_same = [&](const Candidate& other) {
      return are_near(other.X_WR, candidate.X_WR, near_m, parameters_.same_deg * kDegree);
    };
    if (std::ranges::any_of(candidates_, [&](const Candidate& c) { return is_same(c) && c.likeness >= here; }))
      continue;
    std::erase_if(candidates_, is_same);
    candidates_.insert(std::upper_bound(candidates_.begin(), candidates_.end(), candidate, worse), candidate);
    if (candidates_.size() > static_cast<std::size_t>(parameters_.max_candidates)) candidates_.pop_back();
  }
}

// The place between those of the grid: the middle of those about the best one, each by how much more alike it is than what is hardly so.
bool CandidateSearch::sharpen(const Panorama& seen, WorkBudget& budget) {
  for (; sharpened_ < candidates_.size(); ++sharpened_, about_ = About{}) {
    Candidate& candidate = candidates_[sharpened_];
    const Eigen::Vector2d best = candidate.X_WR.translation().head<2>();
    const double heading = geometry::heading_of(candidate.X_WR);
    for (; about_.next < index_->size(); ++about_.next) {
      const Eigen::Vector2d off = index_->place_m(about_.next) - best;
      if (off.cwiseAbs().maxCoeff() > kAbout * parameters_.spacing_m) continue;
      if (!index_->build(about_.next, budget) || !budget.grant()) return false;
      const Panorama::Likeness likeness = index_->panorama(about_.next).compare(seen);
      const std::size_t most = most_alike_about(likeness, heading);
      const double above = std::max(0.0F, likeness[most] - candidate.likeness + kHardlyAlike);
      const double turn = std::remainder(refined(likeness, most) - heading, 2.0 * std::numbers::pi);
      about_.weights += above * above;
      if (likeness[most] > about_.likeness) {
        about_.likeness = likeness[most];
        about_.X_WR = geometry::pose_on_floor(index_->place_m(about_.next).x(), index_->place_m(about_.next).y(),
                                              heading + turn);
      }
      about_.sum += above * above * Eigen::Vector3d(off.x(), off.y(), turn);
    }
    const Eigen::Vector3d shift = about_.sum / about_.weights;
    candidate.likeness = about_.likeness;
    candidate.X_WR_alike = about_.X_WR;
    candidate.X_WR = geometry::pose_on_floor(best.x() + shift.x(), best.y() + shift.y(), heading + shift.z());
  }
  leave_out_doubles();
  return true;
}

// What is most alike about one of them is next to what is about a better one, or the same.
void CandidateSearch::leave_out_doubles() {
  const double near_m = kNeighbours * parameters_.spacing_m;
  std::ranges::sort(candidates_, std::greater<>(), &Candidate::likeness);
  for (std::size_t i = 1; i < candidates_.size();) {
    const bool is_double = std::any_of(
        candidates_.begin(), candidates_.begin() + static_cast<std::ptrdiff_t>(i), [&](const Candidate& better) {
          return are_near(better.X_WR_alike, candidates_[i].X_WR_alike, near_m, parameters_.same_deg * kDegree);
        });
    if (is_double) {
      candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
}

}  // namespace cgsr::global_localization
