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
      Experiment{"table-4.1", "A camera's pose corrected on the field (Table 4.1)", true, table_4_1},
      Experiment{"table-4.2", "What a correction costs by the edges in the map (Table 4.2)", true, table_4_2},
      Experiment{"section-4.3.3", "The same with cloth walls in between, and without them (4.3.3)", true,
                 section_4_3_3},
      Experiment{"false-corrections", "How often 'corrected' is claimed and wrong", true, false_corrections},
      Experiment{"home-round", "Three minutes through the simulated home on wheels that slip", true, home_round},
      Experiment{"section-5.4.3", "Algorithm 5.2 in the simulated home, a ball tracked with masks (5.4.3)", true,
                 section_5_4_3},
      Experiment{"table-5.1", "Where the lamp is, out of the probes' shadows (Table 5.1)", true, table_5_1},
      Experiment{"shaded-ball", "A ball in light and shade, with the mask of shade and without (5.4.3)", true,
                 shaded_ball},
      Experiment{"lamp-cases", "Lamps off, two, behind, flickering, moving; strengths and angles (5.4.1)", true,
                 lamp_cases},
      Experiment{"lamp-drives", "A lamp's place and height while the robot drives", true, lamp_drives},
      Experiment{"section-5.4.2", "Shaded regions beside the ray tracer's, and their cost (5.4.2)", true,
                 section_5_4_2},
      Experiment{"real-localization", "Chapter 4 on a cube, a desk and ViSP's castle", true, real_localization},
      Experiment{"search-cost", "What labels and search cost per image (3.3.2)", true, search_cost},
  };
  return kExperiments;
}

}  // namespace cgsr::lab
