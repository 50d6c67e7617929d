// SPDX-License-Identifier: MIT
#include "core/reader/new_scene.h"

#include <algorithm>
#include <iterator>

#include "base/text/error.h"
#include "base/text/text.h"
#include "core/reader/reader.h"
#include "core/reader/text.h"

namespace wholehand {
namespace {

constexpr const char* DENSITY = "density_kg_m3";

constexpr NewSceneKey KEYS[] = {
    {"diameter_mm", ranges::DIAMETER, "outer, at the widest place", "Outer diameter, at the widest place"},
    {"neck_mm", ranges::DIAMETER, "outer diameter of the neck", "Outer diameter of a flask's or a conical vessel's neck"},
    {"upright_mm", ranges::UPRIGHT, "height of the upright wall under the cone", "Height of a conical vessel's upright wall"},
    {"shoulder_mm", ranges::HEIGHT, "height at which the neck begins", "Height at which a conical vessel's neck begins"},
    {"height_mm", ranges::HEIGHT, "from the base to the brim", "Height of a shape"},
    {"wall_mm", ranges::WALL, "thickness of the wall", "Thickness of the wall (default: 1.5)"},
    {"mass_kg", ranges::MASS, "empty", "Mass of an empty mesh"},
    {DENSITY, ranges::VESSEL_DENSITY, "of the wall: 2230 is glass, 1050 polystyrene, 7900 steel",
     "Density of the wall, or of the mesh (default: 2230, glass)"},
    {"mesh_scale", ranges::MESH_SCALE, "of the file's unit, in m", "Size of a mesh's unit in m (default: the likeliest)"},
};

const char* comment_of(const std::string& key) {
  return std::find_if(std::begin(KEYS), std::end(KEYS), [&](const NewSceneKey& one) { return key == one.name; })->comment;
}

void append_key(std::string& text, const std::string& key, const std::string& value, const std::string& comment) {
  const std::string line = key + " = " + value;
  constexpr std::size_t LONG = 24, LONGEST = 56;
  if (line.size() > LONGEST)
    append_formatted(text, "# {}: {}\n{}\n", key, comment, line);
  else
    append_formatted(text, "{:<{}} # {}\n", line, line.size() > LONG ? LONGEST : LONG, comment);
}

std::string vessel_table(const NewScene& wanted) {
  std::string text = "# ---- what is held ----\n\n[[vessel]]\n";
  append_formatted(text, "name = \"{}\"\n", wanted.name);
  if (wanted.mesh.empty()) {
    append_key(text, "shape", '"' + wanted.shape + '"', "\"cylinder\", \"flask\" or \"conical\"; `outline` draws any other");
  } else {
    std::string path;
    for (const char c : wanted.mesh) {
      const bool is_control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
      path += is_control              ? fmt::format("\\u{:04x}", static_cast<unsigned char>(c))
              : c == '"' || c == '\\' ? std::string{'\\', c}
                                      : std::string{c};
    }
    append_key(
        text, "mesh", '"' + path + '"',
        wanted.has_cavity() ? "holds liquid in its `inner_outline`" : "solid; `inner_outline` gives it a cavity for a liquid");
    for (const SceneKey& key : wanted.mesh_keys) append_key(text, key.key, key.value, key.comment);
  }
  std::vector<std::pair<std::string, double>> numbers = wanted.numbers;
  const auto has = [&](const char* key) {
    return std::any_of(numbers.begin(), numbers.end(), [&](const auto& number) { return number.first == key; });
  };
  if (wanted.mesh.empty() && !has("wall_mm")) numbers.emplace_back("wall_mm", 1.5);
  if (!has(DENSITY) && !has("mass_kg")) numbers.emplace_back(DENSITY, 2230);
  for (const auto& [key, value] : numbers) append_key(text, key, fmt::format("{}", value), comment_of(key));
  return text;
}

std::string liquid_table(const NewScene& wanted) {
  std::string text = "\n# ---- what is in it ----\n\n[liquid]\ndensity_kg_m3 = 1000     # water\n";
  if (wanted.fill) {
    append_key(text, "fills_ml", *wanted.fill == 0 ? "[0]" : fmt::format("[0, {}]", *wanted.fill),
               "each grip is judged at each fill");
  } else {
    append_key(text, "fills", "[0, 0.25, 0.5, 0.75, 1]", "of what it holds to the brim: each grip is judged at each fill");
  }
  append_key(text, "pour", "\"away\"", "from the palm, or \"towards\" it");
  return text;
}

constexpr const char* REST = R"(
# ---- what the hand can give, in N for each digit; docs/scene.md has the defaults ----

[strength]

# ---- how far it is tilted ----

[tilts]
deg = { from = 0, to = 120, count = 25 }

# ---- how exactly a person takes the grip that was meant: standard deviations ----

[robust]
height_mm = 3
offset_mm = 3
obliquity_deg = 5
roll_deg = 5

# ---- what is listed ----

[output]
best = 20
)";

}  // namespace

std::span<const NewSceneKey> new_scene_keys() { return KEYS; }

bool NewScene::has_cavity() const {
  return mesh.empty() ||
         std::any_of(mesh_keys.begin(), mesh_keys.end(), [](const SceneKey& key) { return key.key == "inner_outline"; });
}

std::string new_scene(const NewScene& wanted) {
  if (!is_plain_name(wanted.name))
    throw usage_error(fmt::format("name = {}; allowed: a letter, then letters, digits, '_', '-' or '.', at most {} in all",
                                  in_quotes(wanted.name), ranges::LARGEST_NAME));
  if (wanted.shape != "cylinder" && wanted.shape != "flask" && wanted.shape != "conical")
    throw usage_error(fmt::format("shape = {}; allowed: cylinder, flask or conical", in_quotes(wanted.shape)));
  if (wanted.fill && !wanted.has_cavity())
    throw usage_error("fill_ml: the mesh has no cavity; write the scene without it, and give its vessel an inner_outline");
  std::string text = fmt::format(
      "# One vessel. docs/scene.md describes every key, with its unit, default and range.\n\n[scene]\nname = \"{}\"\n\n",
      wanted.name);
  text += vessel_table(wanted);
  text += "\n# ---- where it stands: no finger may be under its base ----\n\n[table]\n";
  text += "\n# ---- whose hand it is: a person in front of it, whose wrist and forearm turn as far as people's do ----\n\n[arm]\n";
  if (wanted.has_cavity()) text += liquid_table(wanted);
  text += "\n# ---- how it is held: every combination, taken between thumb and index finger ----\n\n[grips]\n";
  const bool is_round = wanted.mesh.empty();
  append_key(text, "height_fraction", fmt::format("{{ from = 0.1, to = 0.95, count = {} }}", is_round ? 64 : 24),
             "of the line from thumb to index finger");
  if (!is_round) append_key(text, "azimuth_deg", "{ from = 0, to = 330, count = 12 }", "of that line about the axis");
  append_key(text, "obliquity_deg", fmt::format("{{ from = -20, to = 20, count = {} }}", is_round ? 9 : 3),
             "of that line to the horizontal");
  append_key(text, "roll_deg", fmt::format("{{ from = -90, to = 30, count = {} }}", is_round ? 16 : 9),
             "of the hand: 0 beside the vessel, -90 above");
  text += REST;
  const std::string label = "new";
  try {
    parse_scene(text, label);
  } catch (const Error& error) {  // nobody has seen the lines and columns of this text
    const std::string line = error.what();
    const std::size_t end = line.find(": ");
    throw usage_error(line.starts_with(label + ":") && end != std::string::npos ? line.substr(end + 2) : line);
  }
  return text;
}

}  // namespace wholehand
