// SPDX-License-Identifier: MIT
#include "core/reader/fills.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/error.h"
#include "core/capacity.h"
#include "core/reader/parts.h"

namespace wholehand {
namespace {

constexpr double ROUNDED_VOLUME = 1e-9;  // of the capacity: as much may a volume be above it

}  // namespace

double fraction_of_capacity(const VesselData& vessel, double capacity, double volume, const std::string& asked) {
  if (volume > capacity * (1 + ROUNDED_VOLUME)) {
    // rounded down, so that what the message allows is allowed
    throw usage_error(fmt::format("{}: vessel '{}' holds {:.13g} mL; allowed: 0 to this volume", asked, vessel.name,
                                  std::floor(capacity * 1e9) / 1e3));
  }
  return capacity > 0 ? std::min(1.0, volume / capacity) : 0;
}

void read_own_liquid(const SceneTable& vessel_table, VesselData& vessel) {
  const auto liquid = vessel_table.table("liquid", {"name", "fill", "fill_ml"});
  if (!liquid) return;
  const SceneFile& file = vessel_table.file();
  liquid->need("name", "a name for the liquid");
  liquid->read_name("name", vessel.liquid_name);
  if (!liquid->has("fill_ml")) {
    liquid->need("fill", ranges::FRACTION, vessel.liquid_fill);
    return;
  }
  if (liquid->has("fill")) file.refuse(liquid->place("fill_ml"), "both fill_ml and fill are given", "allowed: one of the two");
  double volume = 0;
  liquid->need("fill_ml", ranges::FILL_VOLUME, volume);
  if (!vessel.has_cavity()) return;  // refused when all vessels are known
  const std::string asked = fmt::format("{}: fill_ml {}", file.text_of(liquid->place("fill_ml")), found(*liquid->find("fill_ml")));
  vessel.liquid_fill = fraction_of_capacity(vessel, capacity_of(vessel), volume, asked);
}

void set_vessel_fills(const SceneTable& root, Scene& scene) {
  if (!scene.liquid || scene.liquid->volumes.empty()) return;
  const toml::array& given = *root.bare_table("liquid", "a table")->get_as<toml::array>("fills_ml");
  for (VesselData& vessel : scene.vessels) {
    const double capacity = capacity_of(vessel);
    for (std::size_t f = 0; f < scene.liquid->volumes.size(); ++f) {
      // a mesh that holds nothing stays empty, as with fractions
      const double volume = vessel.has_cavity() ? scene.liquid->volumes[f] : 0;
      const std::string asked = fmt::format("{}: fills_ml: {}", root.file().text_of(place_of(given[f])), found(given[f]).substr(2));
      vessel.fills.push_back(fraction_of_capacity(vessel, capacity, volume, asked));
    }
  }
}

}  // namespace wholehand
