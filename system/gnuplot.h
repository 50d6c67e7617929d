// SPDX-License-Identifier: MIT
// Pictures by gnuplot: one process for all of them, each whole or not there.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace wholehand {

// Whether a picture is there that was drawn here. `is_beside_own`: beside a file of ours; there it may also be one of version 0.1, whose title
// is that of anybody who draws with gnuplot.
bool is_own_picture(const std::string& path, bool is_beside_own);
// Throws Error (usage) where something is there that is neither empty nor such a picture: it is not overwritten.
void check_overwrites_picture(const std::string& path, bool is_beside_own);

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
