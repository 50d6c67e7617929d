// SPDX-License-Identifier: MIT
// Puts a Remedy into words about options.
#pragma once

#include <string>
#include <vector>

#include "base/text/error.h"
#include "core/backend.h"
#include "core/scene.h"

namespace wholehand {

// The text after the line: "; use --on core". Empty for none.
const char* remedy_words(Remedy remedy);

// The whole line for the user, without characters that control a terminal.
std::string error_line(const Error& error);

// Prints to stderr and returns how the scene exceeds float's domain (domain_warnings), one line each, with the remedy. Throws as domain_warnings
// does.
std::vector<std::string> print_float_warnings(const Scene& scene, Precision precision);

}  // namespace wholehand
