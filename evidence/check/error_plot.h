// SPDX-License-Identifier: MIT
// The Pareto fronts of `wholehand error-time` as pictures.
#pragma once

#include <string>
#include <vector>

#include "base/files/pictures.h"
#include "evidence/check/error_table.h"

namespace wholehand {

struct FrontPicture {
  std::string file;
  std::string title;
  std::string error_axis;  // its label, with the unit
  double error_unit = 1;   // from ErrorRow's error to the axis's
  double (ErrorRow::*error)() const;
};

// error-time.svg by length and error-time-force.svg by force, in `folder`; the second only if some row has a force.
std::vector<FrontPicture> front_pictures(const std::string& folder, const std::vector<ErrorRow>& rows, const ErrorContext& context);

// Every picture that has a point: all variants, numbered on the front, with their names beside it.
std::vector<PictureFile> front_files(const std::vector<FrontPicture>& pictures, const std::vector<ErrorRow>& rows);

}  // namespace wholehand
