// SPDX-License-Identifier: MIT
// [table]: what the vessels stand on before they are lifted.
#include "scene/parts.h"

namespace wholehand {

void read_tabletop(const SceneTable& root, std::optional<TableData>& tabletop) {
  const auto table = root.table("table", {"clearance_mm"});
  if (!table) return;
  tabletop.emplace();
  table->read("clearance_mm", ranges::TABLE_CLEARANCE, tabletop->clearance);
}

}  // namespace wholehand
