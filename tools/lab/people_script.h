#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "tools/lab/scenes/random.h"

namespace cgsr::lab {

inline constexpr double kTraining_s = 3.0;  ///< before the script begins: the person alone, from the front.
inline constexpr double kToFace_s =
    1.0;  ///< in another's shirt only a face can tell, and it has to be found and compared.

/// Somebody at one place for some time, as the world's file has him.
struct Figure {
  int identity = 0;
  double height_m = 1.7;
  std::array<double, 3> shirt{};  // sRGB
  double x_m = 2.3, y_m = 0.0;
  double from_s = 0.0, to_s = 1000.0;                    // of the whole run
  double turns_s = 1000.0;                               // away, so long after the run's begin
  double faces_s = -1.0;                                 // shows the back until then; negative: as turns_s says
  double to_x_m = 0.0;                                   // where he walks to; 0: x_m
  double to_y_m = 0.0, walks_s = -1.0, speed_mps = 0.4;  // sideways, from then on; negative: he stands
};

/// The arena's robot stands here and looks along x.
inline constexpr double kRobotStart_m = 0.8;

/// From when on the script says that a person, or nobody, is visible. Ends with the next.
struct Phase {
  double from_s = 0.0;
  int number = 1;        // 0: nothing is asked of the robot
  double grace_s = 0.0;  // after which a wrong name is an error
};

/// A script with its people.
struct Case {
  std::string name;
  std::vector<int> identities;  // enrolled, the first is number 1
  std::vector<Figure> figures;
  std::vector<Phase> phases;
  double ends_s = 0.0;
  std::string lamp;  // more keys of the ceiling lamp
  bool white_wall = false;
  std::string ambient{};  // scripts of the ambient light
  std::string robot{};    // more keys of the robot
  double face_light_lm = 250.0;
};

/// How many kinds of cases there are (6.2.4, 6.3).
inline constexpr std::size_t kPeopleCases = 8;

/// \return a variation of a case: exchanged shirts, a white shirt before a white wall, light that changes, two people who cross, a dark face in dim light,
///     in a tenth of the light, and in the dark with and without a light on the face.
Case draw_people_case(std::size_t kind, Random& random);

/// \return a figure as the world's file has it.
std::string text_of(const Figure& figure, const std::string& name);

}  // namespace cgsr::lab
