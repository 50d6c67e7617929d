// SPDX-License-Identifier: MIT
// Pictures by gnuplot: one process for all of them, each whole or not there.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace wholehand {

// For a plain single-quoted string of gnuplot; line breaks become spaces.
std::string gnuplot_quoted(const std::string& text);

// The command that sends the next plot to the temporary file that becomes `file`.
std::string gnuplot_output(const std::string& file);

// The terminal and the colours of frame, tics and legend: an SVG of that size with a white ground, which is read the same in print and on
// a dark page.
std::string gnuplot_style(int width, int height);

constexpr std::chrono::seconds GNUPLOT_TIME{30};  // a hundred times what all pictures of a sweep take

// Runs the script, which has sent a plot to gnuplot_output of each of `files` and ends each with `set output`; then each gets its name.
// Returns an empty string, or why they are not all there: a sentence for the user (gnuplot is not installed, failed, or had not ended after
// `limit` and was stopped); no result depends on its pictures.
std::string draw_with_gnuplot(const std::string& script, const std::vector<std::string>& files,
                              std::chrono::milliseconds limit = GNUPLOT_TIME);

}  // namespace wholehand
