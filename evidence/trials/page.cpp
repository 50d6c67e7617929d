// SPDX-License-Identifier: MIT
#include "evidence/trials/page.h"

#include <fmt/format.h>

#include "base/charts/html.h"
#include "base/charts/page_style.h"
#include "base/charts/style.h"
#include "base/system/version.h"
#include "base/text/readable.h"
#include "evidence/trials/page_parts.h"

namespace wholehand {
namespace {

constexpr std::pair<const char*, const char*> CONTENTS[] = {{"bars", "The bars"},
                                                            {"tried", "What was tried"},
                                                            {"success", "How many held"},
                                                            {"scatter", "Where a person's hand may be"},
                                                            {"predictors", "What predicts success"},
                                                            {"efforts", "Is effort right?"},
                                                            {"weights", "Weights of the score"},
                                                            {"disagreements", "Where effort and engine disagree"},
                                                            {"words", "The words"}};

// In a narrow window, and on paper, words and intervals wrap, so that a bar's outcome stays in sight. What is wider still scrolls
// in its own box.
constexpr const char* TRIALS_RULES = R"css(
@media (max-width: 60rem), print {
  tbody th, tbody td { white-space: normal; }
  th, td { padding: 0.22rem 0.35rem; vertical-align: top; }
  tbody th { min-width: 6rem; }
  td.word { min-width: 5rem; }
  td.word:last-child { min-width: 12rem; }
}
)css";

std::string title_of_trials(const Scene& scene) {
  return scene.name.empty() ? "Do the grips hold?" : fmt::format("Do the grips of {} hold?", scene.name);
}

void write_trials_head(MarkupWriter& html, const TrialPageSource& source) {
  html.open("head");
  html.empty("meta", {{"charset", "utf-8"}});
  // identifies the page by its first 64 KiB, so name and identity come before everything else
  html.empty("meta", {{"name", "wholehand-trials"}, {"content", source.identity}});
  html.empty("meta", {{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}});
  html.empty("meta", {{"name", "generator"}, {"content", "wholehand"}});
  html.empty("meta", {{"name", "color-scheme"}, {"content", "light dark"}});
  html.element("title", title_of_trials(source.scene));
  html.open("style").markup(REPORT_STYLE).markup(CHART_RULES).markup(LINE_RULES).markup(TRIALS_RULES).close();
  html.close();
}

void write_trials_header(MarkupWriter& html, const TrialPageSource& source) {
  std::size_t trials = 0;
  for (std::size_t g = 0; g < source.tried.grips.size(); ++g) trials += source.tried.cases_of(g).size();
  html.open("header").element("h1", title_of_trials(source.scene));
  html.element("p",
               fmt::format("{} in {}, held by {}, which knows nothing of wholehand's formulas.",
                           counted(source.tried.grips.size(), "grip"), counted(trials, "trial"), source.engine),
               {{"class", "lead"}});
  html.open("nav", {{"aria-label", "Contents"}}).open("ul");
  for (const auto& [id, text] : CONTENTS)
    if (source.analysis.scatter || std::string_view(id) != "scatter")
      html.open("li").element("a", text, {{"href", fmt::format("#{}", id)}}).close();
  html.close().close().close();
}

}  // namespace

std::string share_text(const Share& share) {
  if (share.of == 0) return "\u2013";
  return fmt::format("{} of {}: {:.0f} % ({:.0f} to {:.0f})", readable_number(share.yes), readable_number(share.of),
                     100 * share.share, 100 * share.interval.low, 100 * share.interval.high);
}

void open_trial_section(MarkupWriter& html, const char* id, const char* heading) {
  html.open("section", {{"aria-labelledby", id}}).element("h2", heading, {{"id", id}});
}

std::string trials_page(const TrialPageSource& source) {
  MarkupWriter html;
  html.markup("<!DOCTYPE html>\n").open("html", {{"lang", "en"}, {"xmlns", "http://www.w3.org/1999/xhtml"}});
  write_trials_head(html, source);
  html.open("body");
  write_trials_header(html, source);
  html.open("main");
  write_trial_bars(html, source);
  write_trial_setup(html, source);
  write_trial_successes(html, source);
  write_trial_scatter(html, source);
  write_trial_predictors(html, source);
  write_trial_efforts(html, source);
  write_trial_weights(html, source);
  write_trial_disagreements(html, source);
  write_trial_words(html);
  html.close();
  html.element("footer",
               fmt::format("Written by wholehand {} with {}. The numbers are in trials.csv and trials.nc beside this page.",
                           version(), source.engine));
  html.close().close();
  return html.written();
}

}  // namespace wholehand
