#pragma once

#include <string>
#include <vector>

#include "hal/sim/generator/draw.h"
#include "hal/sim/worlds/world_spec.h"

namespace cgsr::sim {

/// The materials of one home, drawn as they are needed. Each function adds one and returns its name.
class Palette {
 public:
  Palette(std::vector<MaterialSpec>& materials, Draw draw) : materials_(&materials), draw_(draw) {}

  std::string wood();    ///< one of the home's two or three woods, or painted.
  std::string cloth();   ///< woven, in any colour.
  std::string paint();   ///< a strong colour.
  std::string metal();   ///< steel or black.
  std::string white();   ///< the home's white paint.
  std::string books();   ///< stripes of backs.
  std::string screen();  ///< of a television.
  std::string leaf();
  std::string pot();
  std::string artwork();  ///< what a frame holds: print, blotches, stripes, one colour.
  std::string floor(bool tiled);
  std::string wall();  ///< mostly the home's own, sometimes another colour or wallpaper.
  std::string skirting();
  std::string ceiling();
  std::string curtain();
  std::string rug();
  std::string sky();  ///< what is seen through windows; how it glows is set with the other lights.

 private:
  std::string add(MaterialSpec material);
  Triple tinted(const Triple& srgb, double spread);
  std::string once(std::string& kept, MaterialSpec material);

  std::vector<MaterialSpec>* materials_;
  Draw draw_;
  std::vector<std::string> woods_;
  std::string white_, leaf_, screen_, ceiling_, skirting_, wall_;
};

}  // namespace cgsr::sim
