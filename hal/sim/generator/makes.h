#pragma once

#include <string>
#include <vector>

#include "hal/sim/generator/draw.h"
#include "hal/sim/generator/palette.h"
#include "hal/sim/worlds/shape_spec.h"

namespace cgsr::sim {

/// A piece of furniture in a frame of its own: it stands on the origin and faces +x. Several makes of each kind: those that world files
/// know, and others put together of boxes and cylinders. Ours.
struct Make {
  std::string name;
  Triple size_m{0.0, 0.0, 0.0};   ///< the box around it: depth, width, height.
  std::vector<ShapeSpec> shapes;  ///< named by their part; empty: the thing itself.
  bool in_map = true;
  bool flat_top = false;  ///< small things can stand on it.
};

Make make_dining_table(Palette& palette, Draw& draw);
Make make_low_table(Palette& palette, Draw& draw);
Make make_desk(Palette& palette, Draw& draw);
Make make_chair(Palette& palette, Draw& draw);
Make make_stool(Palette& palette, Draw& draw);
Make make_shelf(Palette& palette, Draw& draw);
Make make_sideboard(Palette& palette, Draw& draw);
Make make_wardrobe(Palette& palette, Draw& draw);
Make make_drawers(Palette& palette, Draw& draw);
Make make_sofa(Palette& palette, Draw& draw);
Make make_armchair(Palette& palette, Draw& draw);
Make make_bench(Palette& palette, Draw& draw);
Make make_ottoman(Palette& palette, Draw& draw);
Make make_bed(Palette& palette, Draw& draw);
Make make_night_table(Palette& palette, Draw& draw);
Make make_television(Palette& palette, Draw& draw);
Make make_kitchen_row(Palette& palette, Draw& draw, double width_m);
Make make_fridge(Palette& palette, Draw& draw);
Make make_tub(Palette& palette, Draw& draw);
Make make_washstand(Palette& palette, Draw& draw);
Make make_plant(Palette& palette, Draw& draw);

/// What lies about and no map knows: boxes, bins, balls, bags, baskets.
Make make_clutter(Palette& palette, Draw& draw);
/// Something small to stand on furniture: no map knows it either.
Make make_small_thing(Palette& palette, Draw& draw);

}  // namespace cgsr::sim
