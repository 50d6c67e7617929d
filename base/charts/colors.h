// SPDX-License-Identifier: MIT
// The colors of charts and drawings, in one place.
#pragma once

#include <array>
#include <string>

namespace wholehand {

using Rgb = std::array<int, 3>;  // sRGB, 0..255

// Okabe and Ito's colors: color-blind readers can distinguish them, and they differ in lightness too.
namespace okabe_ito {
inline constexpr Rgb BLACK{0x00, 0x00, 0x00}, ORANGE{0xe6, 0x9f, 0x00}, SKY_BLUE{0x56, 0xb4, 0xe9}, GREEN{0x00, 0x9e, 0x73},
    BLUE{0x00, 0x72, 0xb2}, VERMILION{0xd5, 0x5e, 0x00};
}  // namespace okabe_ito

// "#rrggbb".
std::string color_text(const Rgb& color);

// The color on white, at `share` in [0, 1]: 0 is white.
std::string tint(const Rgb& color, double share);

// Viridis at `share` in [0, 1] as "#rrggbb": equal steps look equal, for color-blind readers and in gray print too.
std::string sequential_color(double share);

}  // namespace wholehand
