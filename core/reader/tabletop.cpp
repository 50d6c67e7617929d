// SPDX-License-Identifier: MIT
// [table]: what the vessels stand on before they are lifted.
#include <fmt/format.h>

#include "core/reader/parts.h"

namespace wholehand {

void read_tabletop(const SceneTable& root, const std::vector<VesselData>& vessels, std::optional<TableData>& tabletop) {
  const auto table = root.table("table", {"clearance_mm"});
  if (!table) return;
  tabletop.emplace();
  table->read("clearance_mm", ranges::TABLE_CLEARANCE, tabletop->clearance);
  const Place place = table->place("clearance_mm");
  for (const VesselData& vessel : vessels) {
    if (vessel.mesh || tabletop->clearance < vessel.height - vessel.base) continue;  // a mesh's height is known once it is read
    root.file().refuse(
        place, fmt::format("clearance_mm = {:.6g} reaches the mouth of vessel '{}'", tabletop->clearance * 1e3, vessel.name),
        fmt::format("allowed: less than the vessel's height, {:.6g} mm", (vessel.height - vessel.base) * 1e3));
  }
}

}  // namespace wholehand
