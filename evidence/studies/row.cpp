// SPDX-License-Identifier: MIT
#include "evidence/studies/row.h"

namespace wholehand {

InsideCount count_inside(std::span<const StudyRow> rows) {
  InsideCount count;
  for (const StudyRow& row : rows) {
    const std::optional<bool> inside = row.inside();
    count.of += inside ? 1 : 0;
    count.inside += inside.value_or(false) ? 1 : 0;
  }
  return count;
}

double inside_share(std::span<const StudyRow> rows) {
  const InsideCount count = count_inside(rows);
  return count.of == 0 ? std::numeric_limits<double>::quiet_NaN()
                       : static_cast<double>(count.inside) / static_cast<double>(count.of);
}

}  // namespace wholehand
