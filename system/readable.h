// SPDX-License-Identifier: MIT
// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>

namespace wholehand {

// "1.5 GB", decimal.
std::string readable_bytes(double bytes);
// "27,648"; "1.0e+12" from 1e12 on.
std::string readable_count(double count);
std::string readable_number(std::uint64_t count);
// "1 grip", "27,648 grips".
std::string counted(std::uint64_t count, const char* thing);

// "54 s", "3 min 20 s", "2 h 5 min": rounded up.
std::string readable_duration(double seconds);

}  // namespace wholehand
