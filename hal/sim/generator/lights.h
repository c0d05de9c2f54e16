#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hal/sim/generator/site.h"
#include "platform/error.h"

namespace cgsr::sim {

/// Where a lamp is, and which entries of site.standing() it brought: what carries it is not in its way.
struct LampPlace {
  std::size_t room = 0;
  std::size_t own_from = 0;
  std::size_t own_to = 0;
};

/// The light of a home.
struct Lights {
  std::vector<LampPlace> lamps;  ///< that somebody can switch, one to three: the first ones of the world.
  bool day = false;              ///< daylight comes through the windows.
  double ambient_share =
      0.0;  ///< of the light on the floor of the brightest room: what comes from everywhere, bounced light too.
};

/// Draws lamps (under the ceiling, on a stand, on a wall), daylight through windows, ambient light, and the exposure that suits them.
/// \return an error when a lamp has no place, or is seen from nowhere even before the furniture is there.
Result<Lights> add_lights(Site& site, Draw& draw);

/// Is there a place on the floor, reached by the robot, from where both probes of the shipped board throw their whole shadow of this lamp on the
/// board, with nothing between lamp and apex? By the generator's own geometry:
///   S = A + (A - L) h / (L.z - A.z)   the shadow of apex A on the board, h below it (Eq. 5.1, 5.2 turned round)
bool probes_see(const Site& site, const LampSpec& lamp, const LampPlace& place);

/// Are all lamps seen, now that everything stands? Fails with the first that is not.
Result<void> lamps_are_seen(Site& site, const Lights& lights);

}  // namespace cgsr::sim
