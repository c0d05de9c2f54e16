#include "tools/lab/experiment.h"

#include <array>

#include "platform/config/canonical.h"

namespace cgsr::lab {

std::string Setting::config_sha256() const {
  return config::hash(configuration);
}

std::span<const Experiment> experiments() {
  static constexpr std::array kExperiments{
      Experiment{"light-sweep", "Chapter 3 on generated scenes while the light changes (3.1.1, 3.2.1)", false,
                 light_sweep},
      Experiment{"real-video", "Chapter 3 beside CAM-Shift, KCF and CSRT on real video", true, real_video},
      Experiment{"figure-3.3", "A shirt followed from a corridor into daylight (Figure 3.3)", true, figure_3_3},
      Experiment{"closed-loop", "The simulated home's robot follows a cart through changing light", true, closed_loop},
      Experiment{"search-cost", "What labels and search cost per image (3.3.2)", true, search_cost},
  };
  return kExperiments;
}

}  // namespace cgsr::lab
