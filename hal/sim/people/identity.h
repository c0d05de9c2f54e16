#pragma once

#include <cstdint>

#include "hal/sim/people/person.h"

namespace cgsr::sim {

/// What makes a head somebody's. Lengths in metres, in the face's plane: y to the face's left, z up from the line of the eyes.
struct Identity {
  std::uint32_t seed = 0;  ///< of skin pattern and moles.
  Rgb skin;                ///< albedo, linear.
  Rgb hair;
  float skin_contrast = 0.5F;  ///< of the pattern, 0.35 .. 0.7.
  float width = 1.0F;          ///< of the head, relative.
  float height = 1.0F;
  float jaw = 0.25F;             ///< taper of the jaw.
  float eye_apart_m = 0.032F;    ///< from the middle of the face.
  float nose_length_m = 0.036F;  ///< from the eyes down.
  float nose_width = 1.0F;
  float mouth_width_m = 0.024F;
  float mouth_down_m = 0.062F;
  float lip_red = 0.5F;  ///< 0: lips of the skin's colour.
  float brow_up_m = 0.021F;
  float brow_thick_m = 0.004F;
  float hairline_m = 0.066F;
  float hair_back_m = -0.055F;  ///< how far down the hair goes at the sides and behind.
  float beard = 0.0F;           ///< 0 .. 1.
  bool glasses = false;
  Outfit outfit{};  ///< the usual one.
};

/// \param index  0 .. kLastIdentity. The first kIdentities are made by hand, skin going from light to dark with them; every other is drawn by its number.
Identity identity(int index);

}  // namespace cgsr::sim
