#include "hal/sim/people/person.h"

namespace cgsr::sim {
int add_person(Scene& scene, const Person& person) {
  Figure figure;
  figure.name = person.name;
  figure.kind = FigureKind::kPerson;
  scene.figures.push_back(figure);
  return static_cast<int>(scene.figures.size()) - 1;
}
}  // namespace cgsr::sim
