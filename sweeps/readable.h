// Numbers as people read them.
#pragma once

#include <string>

namespace wholehand {

// "1.5 GB", decimal.
std::string readable_bytes(double bytes);
// "27,648"; "1.0e+12" from 1e12 on.
std::string readable_count(double count);

}  // namespace wholehand
