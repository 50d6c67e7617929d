// SPDX-License-Identifier: MIT
#include "base/charts/colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wholehand {
namespace {

constexpr std::array<Rgb, 10> VIRIDIS{{{0x44, 0x01, 0x54},
                                       {0x48, 0x28, 0x78},
                                       {0x3e, 0x4a, 0x89},
                                       {0x31, 0x68, 0x8e},
                                       {0x26, 0x82, 0x8e},
                                       {0x1f, 0x9e, 0x89},
                                       {0x35, 0xb7, 0x79},
                                       {0x6e, 0xce, 0x58},
                                       {0xb5, 0xde, 0x2b},
                                       {0xfd, 0xe7, 0x25}}};

// The way from one color to another, to whole numbers.
Rgb between(const Rgb& from, const Rgb& to, double share) {
  Rgb color{};
  for (std::size_t k = 0; k < color.size(); ++k) color[k] = static_cast<int>(std::lround(from[k] + share * (to[k] - from[k])));
  return color;
}

}  // namespace

std::string color_text(const Rgb& color) { return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]); }

std::string tint(const Rgb& color, double share) { return color_text(between({255, 255, 255}, color, share)); }

std::string sequential_color(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * (VIRIDIS.size() - 1);
  const std::size_t i = std::min(VIRIDIS.size() - 2, static_cast<std::size_t>(place));
  return color_text(between(VIRIDIS[i], VIRIDIS[i + 1], place - static_cast<double>(i)));
}

}  // namespace wholehand
