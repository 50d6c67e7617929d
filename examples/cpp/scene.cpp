// SPDX-License-Identifier: MIT
// core/scene.h: a scene as plain data in SI units. It comes from a text, from a file, or from the program that fills it itself.
#include <cmath>
#include <cstdio>

#include "base/text/error.h"
#include "core/reader/reader.h"
#include "core/scene.h"

int main() {
  using namespace wholehand;
  const Scene scene = parse_scene(R"(
[[vessel]]
name = "mug"
outline = [{ line = [40, 0] }, { line = [40, 90] }, { line = [0, 90] }]
wall_mm = 3
[grips]
height_mm = [30, 60]
[tilts]
deg = [0, 90]
)",
                                  "mug.toml");
  const VesselData& mug = scene.vessels.front();
  std::printf("%s: %.3f m high, %zu tilts, the last %.4f rad\n", mug.name.c_str(), mug.height, scene.tilts.size(),
              scene.tilts.back());
  try {
    parse_scene("[[vessel]]\nname = 7\n", "wrong.toml");
  } catch (const Error& error) {
    std::printf("%s\n", error.what());  // the line that the program prints
    return mug.height == 0.09 && scene.tilts.back() == PI / 2 ? 0 : 1;
  }
  return 1;
}
