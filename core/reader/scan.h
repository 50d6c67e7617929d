// SPDX-License-Identifier: MIT
// Scans a scene file's text before the TOML parser reads it, for input that toml++ 3.3 wrongly accepts or crashes on.
#pragma once

#include <string_view>

#include "core/reader/table.h"

namespace wholehand {

// Throws Error (usage) for
// * a key of more than LARGEST_KEY_DEPTH parts: dotted keys nest tables without a limit, and the parsed tables are freed by recursion;
// * a table header that does not begin with a key ("[= "), and brackets that do not match: the parser takes those for impossible;
// * a character beyond ASCII where the parser asks whether it is a space, which is undefined for most of them: outside strings and
//   comments, where TOML has none, and behind a backslash in a string of several lines, where it would be allowed after a line's end;
// * a text whose closing quote, opening quote or both are missing, which the parser does not name;
// * what makes the parser see a string elsewhere than this scan: one right behind something else, a second = of one value.
// Where a text has several faults, it may name a later one than the parser would.
void scan_scene(const SceneFile& file, std::string_view text);

}  // namespace wholehand
