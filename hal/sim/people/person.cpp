#include "hal/sim/people/person.h"

#include <cstddef>
#include <numbers>

#include <fmt/format.h>

#include "hal/sim/people/body.h"
#include "hal/sim/people/head.h"
#include "hal/sim/people/identity.h"
#include "hal/sim/people/marker.h"
#include "hal/sim/scene/shapes.h"

namespace cgsr::sim {
namespace {

class Tailor {
 public:
  Tailor(Scene& scene, int figure, std::string who) : scene_(scene), figure_(figure), who_(std::move(who)) {}

  int cloth(const char* what, const Rgb& color) {
    Material material;
    material.name = who_ + "/" + what;
    material.albedo = color;
    return scene_.add_material(std::move(material));
  }

  int shirt(const Outfit& outfit, bool sleeve) {
    const int index = cloth("shirt", outfit.color);
    Material& material = scene_.materials[static_cast<std::size_t>(index)];
    material.second_albedo = outfit.second;
    if (outfit.shirt == ShirtKind::kStriped) {
      material.pattern = PatternKind::kStripes;
      material.size_m = 0.09F;
    } else if (outfit.shirt == ShirtKind::kTwoColoured && !sleeve) {
      material.pattern = PatternKind::kStripes;  // one period over the whole shirt
      material.size_m = 1.2F;
      material.width = 0.27F / 1.2F;
    }
    return index;
  }

  void add(const std::string& name, Mesh mesh, int joint, int material, int outfit) {
    Part part;
    part.name = who_ + "/" + name;
    part.mesh = std::move(mesh);
    part.material = material;
    part.figure = figure_;
    part.joint = joint;
    part.outfit = outfit;
    part.in_map = false;
    scene_.parts.push_back(std::move(part));
  }

 private:
  Scene& scene_;
  int figure_;
  std::string who_;
};

/// A marker on a sheet of paper, 0.17 m with its margin.
void pin(Tailor& tailor, int id, const std::string& name, const Pose& on_torso, int outfit) {
  Mesh sheet = marker_mesh(id, 0.17);
  sheet.transform(on_torso);
  const std::string white = name + " white", black = name + " black";
  tailor.add(white, sheet_of(sheet, false), kTorsoJoint, tailor.cloth(white.c_str(), Rgb::Constant(0.85F)), outfit);
  tailor.add(black, sheet_of(sheet, true), kTorsoJoint, tailor.cloth(black.c_str(), Rgb::Constant(0.02F)), outfit);
}

void dress(Tailor& tailor, const std::vector<BodyPart>& body, const Outfit& outfit, int index, double height_m) {
  const int shirt = tailor.shirt(outfit, false);
  const int sleeve = tailor.shirt(outfit, true);
  const int trousers = tailor.cloth("trousers", outfit.trousers);
  for (const BodyPart& part : body) {
    if (part.cover == Cover::kShirt) tailor.add(part.name, part.mesh, part.joint, shirt, index);
    if (part.cover == Cover::kSleeve) tailor.add(part.name, part.mesh, part.joint, sleeve, index);
    if (part.cover == Cover::kTrousers) tailor.add(part.name, part.mesh, part.joint, trousers, index);
  }
  const double k = height_m / 1.72;
  if (outfit.marker >= 0) pin(tailor, outfit.marker, "marker", pose_at({0.135 * k, 0, 0.28 * k}), index);
  if (outfit.back_marker >= 0)
    pin(tailor, outfit.back_marker, "back marker", pose_at({-0.135 * k, 0, 0.28 * k}, std::numbers::pi), index);
}

}  // namespace

Outfit usual_outfit(int index) {
  return identity(index).outfit;
}

int add_person(Scene& scene, const Person& person) {
  const Identity id = identity(person.identity);
  Figure figure;
  figure.name = person.name;
  figure.kind = FigureKind::kPerson;
  figure.joints = body_joints(person.height_m);
  figure.stride_m = 1.3 * person.height_m / 1.72;
  scene.figures.push_back(figure);
  const int index = static_cast<int>(scene.figures.size()) - 1;

  Tailor tailor(scene, index, person.name);
  const std::vector<BodyPart> body = body_parts(person.height_m);
  const int skin = tailor.cloth("skin", id.skin);
  const int shoe = tailor.cloth("shoe", Rgb::Constant(0.03F));
  for (const BodyPart& part : body) {
    if (part.cover == Cover::kSkin) tailor.add(part.name, part.mesh, part.joint, skin, -1);
    if (part.cover == Cover::kShoe) tailor.add(part.name, part.mesh, part.joint, shoe, -1);
  }
  const std::vector<Outfit> outfits = person.outfits.empty() ? std::vector<Outfit>{id.outfit} : person.outfits;
  for (std::size_t i = 0; i < outfits.size(); ++i)
    dress(tailor, body, outfits[i], static_cast<int>(i), person.height_m);

  const int face = tailor.cloth("face", id.skin);
  scene.textures.push_back(face_texture(id));
  scene.materials[static_cast<std::size_t>(face)].texture = static_cast<int>(scene.textures.size()) - 1;
  tailor.add("head", head_mesh(id), kHeadJoint, face, -1);
  return index;
}

}  // namespace cgsr::sim
