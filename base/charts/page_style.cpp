// SPDX-License-Identifier: MIT
#include "base/charts/page_style.h"

namespace wholehand {

// Contains no '<' or '&', because it stands in the page unescaped.
const char* const REPORT_STYLE = R"css(
:root {
  color-scheme: light dark;
  --ink: #1b1f24; --soft: #57606a; --page: #ffffff; --panel: #f5f7f9; --rule: #d0d7de; --link: #0b5394;
  --none: #e3e6ea; --hollow: #a9afb7; --good: #1a6b3c; --bad: #a40e26;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ink: #e4e8ec; --soft: #9aa4ae; --page: #15181c; --panel: #1d2126; --rule: #3a424b; --link: #83b9f0;
    --none: #2a2f36; --hollow: #676e77; --good: #7fd6a2; --bad: #ff9a9f;
  }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; text-size-adjust: 100%; }
body {
  margin: 0 auto; padding: 1rem clamp(0.8rem, 3vw, 2rem) 3rem; max-width: 78rem; background: var(--page); color: var(--ink);
  font: 1rem/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; overflow-wrap: break-word;
}
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0.6rem 0 0.2rem; }
h2 { font-size: 1.35rem; line-height: 1.25; margin: 2.4rem 0 0.6rem; padding-top: 0.6rem; border-top: 2px solid var(--rule); }
h3 { font-size: 1.08rem; margin: 1.8rem 0 0.4rem; }
p, li, dl { max-width: 46rem; }
p { margin: 0.4rem 0 0.8rem; }
a { color: var(--link); }
.lead, .note, figcaption { color: var(--soft); }
.note, figcaption { font-size: 0.88rem; }
.good::before { content: "\2713\00a0"; color: var(--good); font-weight: bold; }
.bad { color: var(--bad); font-weight: bold; }
nav ul { list-style: none; padding: 0; margin: 0.8rem 0 0; display: flex; flex-wrap: wrap; gap: 0.3rem 1.2rem; max-width: none; }
dl { margin: 0.4rem 0 1rem; }
dl div { display: grid; grid-template-columns: 10.5rem 1fr; gap: 0 1rem; padding: 0.25rem 0; border-bottom: 1px solid var(--rule); }
dt { color: var(--soft); }
dd { margin: 0; min-width: 0; }
@media (max-width: 34rem) { dl div { grid-template-columns: 1fr; } }
figure { margin: 0.8rem 0 1.2rem; }
figcaption { margin-top: 0.4rem; max-width: 52rem; }
.charts, .drawings { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 18rem), 1fr)); gap: 1rem 1.6rem; align-items: start; }
.chart { max-width: 32rem; min-width: 0; }
.chart h4 { margin: 0; font-size: 0.95rem; }
.drawing { min-width: 0; max-width: 32rem; }
.drawing img { display: block; width: 100%; height: auto; background: #fff; border: 1px solid var(--rule); border-radius: 4px; }
.drawing p { font-size: 0.88rem; margin: 0.3rem 0 0; }
svg { display: block; width: 100%; height: auto; overflow: visible; }
@media (prefers-color-scheme: dark) {
  .drawing img { filter: invert(0.9) hue-rotate(180deg); }
}
.wide { overflow-x: auto; margin: 0.6rem 0 1rem; }
table { border-collapse: collapse; font-size: 0.9rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding: 0.2rem 0; }
th, td { padding: 0.22rem 0.7rem; text-align: right; vertical-align: bottom; border-bottom: 1px solid var(--rule); }
thead th { border-bottom: 2px solid var(--rule); font-weight: 600; min-width: 4.2rem; }
th:first-child { text-align: left; padding-left: 0; }
tbody th { font-weight: 400; white-space: nowrap; }
tbody td { white-space: nowrap; }
th.word, td.word { text-align: left; }
details { margin: 0.6rem 0 1rem; }
summary { cursor: pointer; color: var(--link); }
pre { background: var(--panel); border: 1px solid var(--rule); border-radius: 4px; padding: 0.7rem; overflow-x: auto; font-size: 0.82rem; line-height: 1.4; }
footer { margin-top: 3rem; border-top: 1px solid var(--rule); padding-top: 0.6rem; color: var(--soft); font-size: 0.88rem; }
@media print {
  :root { --ink: #000; --soft: #444; --page: #fff; --panel: #fff; --rule: #bbb; --link: #000; --none: #e3e6ea; --hollow: #a9afb7; --good: #000; --bad: #a40e26; }
  html { font-size: 10pt; }
  body { padding: 0; max-width: none; }
  h2 { break-before: page; border-top: 0; }
  h2#asked, h2#ran { break-before: auto; }
  h3 { break-after: avoid; }
  figure, .chart, .drawing, tr, dl div { break-inside: avoid; }
  nav { display: none; }
  .wide { overflow: visible; }
  table { font-size: 8pt; }
  th, td { padding: 1pt 4pt; }
  .charts, .drawings { grid-template-columns: repeat(3, 1fr); gap: 0.6rem; }
  svg * , .drawing img { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
}
)css";

}  // namespace wholehand
