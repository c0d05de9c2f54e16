#pragma once

#include <nlohmann/json.hpp>

#include "platform/ring.h"
#include "src/tasks/links.h"

namespace cgsr::tasks {

/// Calls visit(name, statistics) for each ring.
template <class Visitor>
void visit_rings(const Links& links, Visitor visit) {
  visit("images", links.images.statistics());
  visit("goals", links.goals.statistics());
  visit("odometry", links.odometry.statistics());
  visit("arm_requests", links.arm_requests.statistics());
  visit("switch_requests", links.switch_requests.statistics());
  visit("switch_answers", links.switch_answers.statistics());
  visit("switchings", links.switchings.statistics());
  visit("reports", links.reports.statistics());
  visit("pictures", links.pictures.statistics());
  visit("motions", links.motions.statistics());
}

/// \return an object with the statistics of each ring under its name.
inline nlohmann::ordered_json rings_json(const Links& links) {
  auto rings = nlohmann::ordered_json::object();
  visit_rings(links, [&rings](const char* name, const RingStatistics& ring) {
    rings[name] = {{"capacity", ring.capacity},
                   {"high_water", ring.high_water},
                   {"pushed", ring.pushed},
                   {"dropped", ring.dropped},
                   {"skipped", ring.skipped}};
  });
  return rings;
}

}  // namespace cgsr::tasks
