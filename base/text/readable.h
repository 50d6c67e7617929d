// SPDX-License-Identifier: MIT
// Numbers for people: whole parts from 1,000 on have commas. Do not use it for what users type back (options, scene keys and values) or what programs
// read (CSV, JSON, NetCDF).
#pragma once

#include <cstdint>
#include <string>

namespace wholehand {

// "1.5 GB", decimal.
std::string readable_bytes(double bytes);
// "27,648"; "1.0e+12" from 1e12 on.
std::string readable_count(double count);
std::string readable_number(std::uint64_t count);
// "1 row", "27,648 rows"; `things`: an irregular plural, such as people.
std::string counted(std::uint64_t count, const char* thing, const char* things = nullptr);

// With that many decimals; "-" for NaN, "inf", and no sign before zero.
std::string fixed_text(double value, int digits);
// With as many decimals as the value has, at most `digits`; otherwise the same.
std::string plain_text(double value, int digits = 6);
// The same, with "+" if the value is the end of the searched range and the true one may lie beyond it: "150+".
std::string range_text(double value, bool is_end);
// The number of meaningful decimals of a value known to `error`, at most `digits`: 1 for 0.2, 0 for 3; all for 0 (exact) and NaN.
int known_digits(double error, int digits);

// "54 s", "3 min 20 s", "2 h 5 min": rounded up.
std::string readable_duration(double seconds);

}  // namespace wholehand
