// SPDX-License-Identifier: MIT
#include "evidence/studies/page.h"

#include <fmt/format.h>

#include "base/charts/page_style.h"
#include "base/charts/style.h"
#include "base/system/version.h"

namespace wholehand {
namespace {

// Charts stand side by side where there is room.
constexpr const char* STUDY_RULES = R"css(
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(20rem, 1fr)); gap: 1rem; }
.charts figure { margin: 0; max-width: 34rem; }
.answer svg { min-width: 44rem; max-width: 62rem; }
svg .head { font-weight: 600; }
svg .inside { fill: var(--good); stroke: var(--page); stroke-width: 0.8; }
svg .outside { fill: var(--bad); stroke: var(--page); stroke-width: 0.8; }
)css";

void write_study_head(MarkupWriter& html, const StudyPage& page) {
  html.open("head");
  html.empty("meta", {{"charset", "utf-8"}});
  // identifies the page by its first 64 KiB
  html.empty("meta", {{"name", "wholehand-study"}, {"content", fmt::format("seed {}", page.seed)}});
  html.empty("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.empty("meta", {{"name", "generator"}, {"content", "wholehand"}});
  html.empty("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.element("title", page.title);
  html.open("style").markup(REPORT_STYLE).markup(CHART_RULES).markup(BOX_RULES).markup(STUDY_RULES).close();
  html.close();
}

// The page is long: links to its sections.
void write_contents(MarkupWriter& html, const StudyPage& page) {
  html.open("nav", {{"aria-label", "sections"}}).open("ul");
  for (const StudySection& section : page.sections)
    html.open("li").element("a", section.title, {{"href", "#" + section.id}}).close();
  html.close().close();
}

void write_section(MarkupWriter& html, const StudySection& section) {
  html.open("section", {{"aria-labelledby", section.id}}).element("h2", section.title, {{"id", section.id}});
  for (const std::string& words : section.words) html.element("p", words);
  if (!section.rows.empty()) section.write(html, section.rows);
  if (!section.charts.empty()) {
    html.open("div", {{"class", "charts"}});
    for (const std::string& chart : section.charts) html.open("figure").markup(chart).close();
    html.close();
  }
  html.close();
}

}  // namespace

std::string study_title(const Scene& scene) {
  return scene.name.empty() ? "How do people grasp?" : fmt::format("How do people grasp {}?", scene.name);
}

std::string study_page(const StudyPage& page) {
  MarkupWriter html;
  html.markup("<!DOCTYPE html>\n").open("html", {{"lang", "en"}, {"xmlns", "http://www.w3.org/1999/xhtml"}});
  write_study_head(html, page);
  html.open("body");
  html.open("header").element("h1", page.title).element("p", page.lead, {{"class", "lead"}});
  html.close();
  html.open("main");
  write_contents(html, page);
  for (const StudySection& section : page.sections) write_section(html, section);
  html.close();
  html.element(
      "footer",
      fmt::format(
          "Written by wholehand {}. The numbers are in study.csv and study.nc beside this page, the single grasps in grasps.csv.",
          version()));
  html.close().close();
  return html.written();
}

}  // namespace wholehand
