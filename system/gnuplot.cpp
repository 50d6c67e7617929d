// SPDX-License-Identifier: MIT
#include "system/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <span>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

#include "system/child_process.h"
#include "system/files.h"

namespace wholehand {
namespace {

// Makes the temporary file, so that gnuplot follows no link and waits at no pipe that lies there. False: it cannot be made.
bool make_temporary(const std::string& temporary) {
  const int made = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (made >= 0) close(made);
  return made >= 0;
}

void remove_temporaries(std::span<const std::string> files) {
  for (const std::string& file : files) unlink(temporary_name(file).c_str());
}

// Gnuplot does not see that a disk is full.
bool is_whole(const std::string& svg) {
  constexpr std::string_view END = "</svg>";
  std::ifstream file(svg, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg();
  std::string tail(static_cast<std::size_t>(std::clamp<std::streamoff>(size, 0, 64)), '\0');
  file.seekg(size - static_cast<std::streamoff>(tail.size()));
  file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  return tail.find(END) != std::string::npos;
}

}  // namespace

// In gnuplot's single quotes a quote is doubled and nothing else is special; a line break would end the command.
std::string gnuplot_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + "'";
}

std::string gnuplot_output(const std::string& file) { return fmt::format("set output {}\n", gnuplot_quoted(temporary_name(file))); }

std::string gnuplot_style(int width, int height) {
  return fmt::format(
      "set encoding utf8\n"
      "set terminal svg size {},{} fixed noenhanced name 'wholehand' background '#ffffff' font 'DejaVu Sans,Arial,sans-serif' "
      "fontscale 1\n"
      "set border linecolor '#202020'\nset tics textcolor '#202020' out nomirror\nset key textcolor '#202020'\n",
      width, height);
}

std::string draw_with_gnuplot(const std::string& script, const std::vector<std::string>& files, std::chrono::milliseconds limit) {
  if (files.empty()) return {};
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (make_temporary(temporary_name(files[k]))) continue;
    const std::string reason = std::strerror(errno);
    remove_temporaries(std::span(files).first(k));  // what lies there already is another's
    return fmt::format("no pictures: cannot make {}: {}", temporary_name(files[k]), reason);
  }
  const ChildEnd end = run_child("gnuplot", script, limit);
  if (end == ChildEnd::missing || end == ChildEnd::no_start) remove_temporaries(files);
  if (end == ChildEnd::missing) return "no pictures: gnuplot is not installed (package gnuplot-nox)";
  if (end == ChildEnd::no_start) return "no pictures: cannot start gnuplot";
  bool drawn = end == ChildEnd::success;
  for (const std::string& file : files) {
    const std::string temporary = temporary_name(file);
    drawn = drawn && is_whole(temporary);
    if (!drawn || std::rename(temporary.c_str(), followed(file).c_str()) != 0) {
      drawn = false;
      unlink(temporary.c_str());
    }
  }
  if (end == ChildEnd::late)
    return fmt::format("no pictures: gnuplot had not ended after {:g} s and was stopped",
                       static_cast<double>(limit.count()) * 1e-3);
  return drawn ? "" : "no pictures: gnuplot failed to write " + files.front();
}

}  // namespace wholehand
