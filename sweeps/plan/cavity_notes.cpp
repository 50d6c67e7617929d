// SPDX-License-Identifier: MIT
#include "sweeps/plan/cavity_notes.h"

#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "base/system/output.h"
#include "core/capacity.h"

namespace wholehand::sweeps {
namespace {

constexpr double NARROW = 10e-3;  // m of radius

}  // namespace

std::vector<std::string> cavity_notes(const Scene& scene) {
  std::vector<std::string> notes;
  for (const VesselData& vessel : scene.vessels) {
    const std::optional<Narrow> narrow = narrow_place(vessel, NARROW);
    if (!narrow) continue;
    notes.push_back(
        fmt::format("note: vessel '{}': its cavity narrows to a radius of {:.3g} mm at a height of {:.4g} mm and widens again "
                    "below it; {:.3g} of its {:.4g} mL lie below; if no liquid belongs there, {}",
                    vessel.name, narrow->radius * 1e3, narrow->height * 1e3, narrow->beneath * 1e6, capacity_of(vessel) * 1e6,
                    vessel.inner.empty() ? "give 'floor_mm' or 'inner_outline'" : "let 'inner_outline' begin above this height"));
  }
  return notes;
}

void print_cavity_notes(const Scene& scene) {
  for (const std::string& line : cavity_notes(scene)) print_note(line);
}

}  // namespace wholehand::sweeps
