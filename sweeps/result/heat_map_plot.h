// SPDX-License-Identifier: MIT
// Heat maps as pictures.
#pragma once

#include <string>
#include <vector>

#include "base/charts/field.h"
#include "base/files/pictures.h"
#include "core/scene.h"
#include "sweeps/result/heat_map.h"
#include "sweeps/result/output_names.h"

namespace wholehand::sweeps {

// One picture to draw.
struct HeatMapPicture {
  std::string file;   // SVG
  std::string title;  // the vessel, as the reader knows it
  const HeatMap* map = nullptr;
  double height_unit = 1;                         // m per unit of the map's height axis
  double height_zero = 0;                         // m: the height where that axis is 0
  std::string hollow = "only implausible grips";  // value of a cell of feasible grips without a score
};

// The pictures drawn, with one color scale for all.
std::vector<PictureFile> heat_map_files(const std::vector<HeatMapPicture>& pictures);

// Colors of scores from `low` to `high`, widened to whole twentieths.
ColorScale score_scale(double low, double high);

// The pictures of a sweep, one per vessel, with titles that name the maximized quantity. Vessels whose names give the same file name get a number.
std::vector<HeatMapPicture> sweep_pictures(const Scene& scene, const Plan& plan, const std::vector<HeatMap>& maps,
                                           const OutputNames& names);

// "a b/c" -> "a_b_c": a vessel's name as part of a file name.
std::string file_name_part(const std::string& name);

// The file name parts for all vessels; equal ones get a number.
std::vector<std::string> file_name_parts(const Scene& scene);

}  // namespace wholehand::sweeps
