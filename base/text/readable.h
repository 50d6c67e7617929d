// SPDX-License-Identifier: MIT
// Numbers as people read them: whole parts from 1,000 on have commas. What is typed back (options, keys and values of a scene) and what a
// program reads (CSV, JSON, NetCDF) has none and is not made here.
#pragma once

#include <cstdint>
#include <string>

namespace wholehand {

// "1.5 GB", decimal.
std::string readable_bytes(double bytes);
// "27,648"; "1.0e+12" from 1e12 on.
std::string readable_count(double count);
std::string readable_number(std::uint64_t count);
// "1 row", "27,648 rows"; `things`: where they have a name of their own, as people.
std::string counted(std::uint64_t count, const char* thing, const char* things = nullptr);

// As many digits behind the point; "-" for a number that does not exist, "inf", and no sign before zero.
std::string fixed_text(double value, int digits);
// As many digits as it has, at most `digits`; likewise.
std::string plain_text(double value, int digits = 6);
// The same, with "+" where the value is the end of the range that was searched and the true one may lie beyond it: "150+".
std::string range_text(double value, bool is_end);
// How many digits behind the point are known of what is known to `error`, at most `digits`: 1 of 0.2, 0 of 3; all of 0 (exact) and NaN.
int known_digits(double error, int digits);

// "54 s", "3 min 20 s", "2 h 5 min": rounded up.
std::string readable_duration(double seconds);

}  // namespace wholehand
