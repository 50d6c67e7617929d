// SPDX-License-Identifier: MIT
// Notes on likely mistakes in a scene's cavities.
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"

namespace wholehand::sweeps {

// A line for each vessel whose cavity narrows below 10 mm of radius and widens again beneath, with the volume there. Throws Error (usage) for vessels
// that cannot be prepared.
std::vector<std::string> cavity_notes(const Scene& scene);

// The same on stderr, a line each.
void print_cavity_notes(const Scene& scene);

}  // namespace wholehand::sweeps
