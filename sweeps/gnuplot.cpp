#include "sweeps/gnuplot.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <string_view>

#include <sys/wait.h>
#include <unistd.h>

namespace wholehand {
namespace {

std::string temporary_name(const std::string& file) { return file + ".partial"; }

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

// A broken pipe is an exit status here, not a signal.
class IgnorePipeSignal {
 public:
  IgnorePipeSignal() {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &ignore, &before_);
  }
  ~IgnorePipeSignal() { sigaction(SIGPIPE, &before_, nullptr); }

 private:
  struct sigaction before_ {};
};

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
      "set terminal svg size {},{} fixed noenhanced background '#ffffff' font 'DejaVu Sans,Arial,sans-serif' fontscale 1\n"
      "set border linecolor '#202020'\nset tics textcolor '#202020' out nomirror\nset key textcolor '#202020'\n",
      width, height);
}

std::string draw_with_gnuplot(const std::string& script, const std::vector<std::string>& files) {
  if (files.empty()) return {};
  const IgnorePipeSignal ignore;
  // flush first: the child must not inherit what the parent has still to print
  std::fflush(nullptr);
  FILE* pipe = popen("exec gnuplot >/dev/null 2>&1", "w");
  if (!pipe) return "no pictures: cannot start gnuplot";
  std::fwrite(script.data(), 1, script.size(), pipe);
  const int status = pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) return "no pictures: gnuplot is not installed (package gnuplot-nox)";
  bool drawn = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  for (const std::string& file : files) {
    const std::string temporary = temporary_name(file);
    drawn = drawn && is_whole(temporary);
    if (!drawn || std::rename(temporary.c_str(), file.c_str()) != 0) {
      drawn = false;
      unlink(temporary.c_str());
    }
  }
  return drawn ? "" : "no pictures: gnuplot failed to write " + files.front();
}

}  // namespace wholehand
