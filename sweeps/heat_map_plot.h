// SPDX-License-Identifier: MIT
// Heat maps as pictures, drawn by gnuplot.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"
#include "sweeps/heat_map.h"
#include "system/files.h"

namespace wholehand {

// One picture to draw.
struct HeatMapPicture {
  std::string file;   // SVG
  std::string title;  // the vessel, as the reader knows it
  const HeatMap* map = nullptr;
  double height_unit = 1;  // m per unit of the map's height axis
  double height_zero = 0;  // m: the height where that axis is 0
};

// Draws all pictures in one gnuplot process, with one colour scale for all. Each is written under a temporary name and renamed, so
// none is ever half there. Returns an empty string, or why there are none: a sentence for the user (gnuplot is not installed, or
// failed); a sweep's results do not depend on its pictures.
std::string draw_heat_maps(const std::vector<HeatMapPicture>& pictures);

// The script that gnuplot gets, with the data inline.
std::string heat_map_script(const std::vector<HeatMapPicture>& pictures);

// The pictures of a sweep, one per vessel, with titles that say what each cell is the largest of. Vessels whose names make the same
// file name are told apart by a number.
std::vector<HeatMapPicture> sweep_pictures(const Scene& scene, const Plan& plan, const std::vector<HeatMap>& maps,
                                           const OutputNames& names);

// "a b/c" -> "a_b_c": a vessel's name as part of a file name.
std::string file_name_part(const std::string& name);

// Of all vessels; those that are alike are told apart by a number.
std::vector<std::string> file_name_parts(const Scene& scene);

}  // namespace wholehand
