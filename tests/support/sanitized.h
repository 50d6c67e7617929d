// SPDX-License-Identifier: MIT
// Whether a sanitizer watches: every access costs some twenty times as much, and a test may then look at less.
#pragma once

namespace wholehand {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool IS_SANITIZED = true;
#else
inline constexpr bool IS_SANITIZED = false;
#endif

}  // namespace wholehand
