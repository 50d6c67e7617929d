// SPDX-License-Identifier: MIT
#include "base/charts/style.h"

#include <string_view>
#include <utility>

namespace wholehand {
namespace {

// Like a report's page in print.
constexpr std::pair<std::string_view, std::string_view> PICTURE_COLORS[] = {
    {"var(--ink)", "#202020"},  {"var(--soft)", "#57606a"}, {"var(--page)", "#ffffff"},
    {"var(--rule)", "#d0d7de"}, {"var(--none)", "#e3e6ea"}, {"var(--hollow)", "#a9afb7"}};

}  // namespace

// Contain no '<' or '&', because they stand in the page unescaped.
const char* const CHART_RULES = R"css(
svg text { font-size: 11px; fill: var(--ink); }
svg .mid { text-anchor: middle; }
svg .end { text-anchor: end; }
svg .frame { stroke: var(--soft); stroke-width: 1; fill: none; }
svg .grid { stroke: var(--rule); stroke-width: 0.7; fill: none; }
svg .ground { fill: var(--none); }
svg .hollow { fill: var(--hollow); }
svg .cell { shape-rendering: crispEdges; }
svg .halo-text { paint-order: stroke; stroke: var(--page); stroke-width: 3px; stroke-linejoin: round; }
svg .mark { fill: #fff; stroke: #000; stroke-width: 0.8; }
svg .halo { fill: none; stroke: #fff; stroke-width: 3.4; }
svg .ring { fill: none; stroke: #000; stroke-width: 1.4; }
)css";

const char* const LINE_RULES = R"css(
svg .limit { stroke: var(--bad); stroke-width: 1.2; stroke-dasharray: 5 3; fill: none; }
svg .line { stroke: var(--day); stroke-width: 2; fill: none; stroke-linejoin: round; }
svg .key { stroke: var(--day); stroke-width: 2.5; }
svg .dot { fill: var(--day); stroke: var(--page); stroke-width: 1; }
@media (prefers-color-scheme: dark) {
  svg .line, svg .key { stroke: var(--night); }
  svg .dot { fill: var(--night); }
}
)css";

const char* const BOX_RULES = R"css(
svg .box { fill: var(--none); stroke: var(--ink); stroke-width: 1; }
svg .median { stroke: var(--ink); stroke-width: 2.4; }
svg .whisker { stroke: var(--ink); stroke-width: 1; }
svg .outlier { fill: none; stroke: var(--soft); stroke-width: 1; }
svg .box-mark { fill: var(--bad); stroke: var(--bad); stroke-width: 1.4; }
)css";

std::string picture_rules() {
  std::string rules = CHART_RULES;
  for (const auto& [variable, color] : PICTURE_COLORS)
    for (std::size_t at = 0; (at = rules.find(variable, at)) != std::string::npos;) rules.replace(at, variable.size(), color);
  return rules +
         "svg text { font-family: \"DejaVu Sans\", Verdana, Arial, sans-serif; }\n"
         "svg .title { font-size: 13px; font-weight: bold; }\nsvg .head { font-weight: bold; }\n";
}

}  // namespace wholehand
