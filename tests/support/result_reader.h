// SPDX-License-Identifier: MIT
// Result files as tests read them back.
#pragma once

#include <string>
#include <vector>

namespace wholehand {

// All values of a variable in the file's order. Adds a test failure and returns nothing where it cannot be read.
std::vector<double> read_values(const std::string& file, const std::string& variable);
// The values of a variable of strings.
std::vector<std::string> read_strings(const std::string& file, const std::string& variable);
// The raw text of an attribute; `variable` empty: of the file.
std::string read_text(const std::string& file, const std::string& variable, const std::string& attribute);
std::vector<std::string> dimension_names(const std::string& file, const std::string& variable);
std::vector<std::string> variable_names(const std::string& file);

// Every variable of both files but the checksums holds the same bits.
void expect_same_values(const std::string& file, const std::string& other);

}  // namespace wholehand
