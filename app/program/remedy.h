// SPDX-License-Identifier: MIT
// How the user asks for what would help: here a Remedy becomes words about options.
#pragma once

#include <string>
#include <vector>

#include "base/text/error.h"
#include "core/backend.h"
#include "core/scene.h"

namespace wholehand {

// What follows the line: "; use --on core". Empty for none.
const char* remedy_words(Remedy remedy);

// The whole line for the user, without anything that steers a terminal.
std::string error_line(const Error& error);

// Prints to stderr and returns what exceeds float's domain in the scene (domain_warnings), a line each, with the remedy.
// Throws as domain_warnings does.
std::vector<std::string> print_float_warnings(const Scene& scene, Precision precision);

}  // namespace wholehand
