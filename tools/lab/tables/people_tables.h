#pragma once

#include <string>

#include "tools/lab/experiment.h"

namespace cgsr::lab {

/// What identifying people costs (Fig. 6.7): instructions per image on the frame path, the recogniser's apart.
Result<Report> figure_6_7(const Setting& setting);

/// Who Is Who in a line (6.4.1.2): four people who are enrolled and a stranger.
Result<Report> who_is_who(const Setting& setting);

/// The same spread through the home: found by a search over the map's free floor (6.4.1.2).
Result<Report> who_is_who_home(const Setting& setting);

/// What everything at once costs in the home (Fig. 5.1 and chapter 6): instructions per image.
Result<Report> everything(const Setting& setting);

/// Where people are hard to tell (6.2.4, 6.3): exchanged shirts, a white shirt at a white wall, changing light, crossing people, a dark face.
Result<Report> people_cases(const Setting& setting);

/// The Finals (6.4.3): a person who changes shirts, and strangers in the same ones.
Result<Report> finals(const Setting& setting);

/// All of sim-people-finals, hashed.
Result<std::string> people_finals_robot_hash(const Setting& setting);

/// All of sim-home-people, hashed.
Result<std::string> home_people_robot_hash(const Setting& setting);

/// All of sim-home-everything, hashed.
Result<std::string> everything_robot_hash(const Setting& setting);

/// All of sim-people-line, hashed.
Result<std::string> people_line_robot_hash(const Setting& setting);

}  // namespace cgsr::lab
