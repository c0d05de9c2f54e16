#pragma once

#include <vector>

#include "hal/sim/scene/figure.h"
#include "hal/sim/scene/mesh.h"

namespace cgsr::sim {

/// What covers a part of the body.
enum class Cover { kShirt, kSleeve, kTrousers, kSkin, kShoe };

struct BodyPart {
  const char* name;
  int joint;
  Cover cover;
  Mesh mesh;  ///< in the joint's frame.
};

/// Indices of the joints that others hang on.
inline constexpr int kTorsoJoint = 2;
inline constexpr int kHeadJoint = 4;

/// The joints of somebody so tall, walking as JointDrive says: legs and arms swing against each other, knees bend in the forward swing.
std::vector<Joint> body_joints(double height_m);

/// Everything but head and clothes' colours. Texture coordinates of clothes are (height, girth) in metres: stripes run around.
std::vector<BodyPart> body_parts(double height_m);

}  // namespace cgsr::sim
