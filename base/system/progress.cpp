// SPDX-License-Identifier: MIT
#include "base/system/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "base/system/output.h"
#include "base/text/printable.h"
#include "base/text/readable.h"

namespace wholehand {
namespace {

constexpr double LOG_PERIOD = 10;       // s
constexpr double LONG_UNANNOUNCED = 5;  // s

std::string rate_text(double rate, const char* noun) {
  if (rate >= 1e6) return fmt::format("{:.2f} million {}/s", rate * 1e-6, noun);
  if (rate >= 1e3) return fmt::format("{:.1f} thousand {}/s", rate * 1e-3, noun);
  if (rate < 10) return fmt::format("{:.1f} {}/s", rate, noun);
  return fmt::format("{:.0f} {}/s", rate, noun);
}

std::string time_text(double seconds) {
  const auto whole = static_cast<long long>(std::ceil(seconds));
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

void announce_time(const std::string& what, double seconds) {
  if (seconds >= LONG_UNANNOUNCED) print_note(what + " takes about " + readable_duration(seconds));
}

ProgressSink progress_sink(ProgressSink otherwise) { return isatty(STDERR_FILENO) == 1 ? ProgressSink::terminal : otherwise; }

Progress::Progress(std::uint64_t total, std::uint64_t done, const char* noun, ProgressSink sink, double (*clock)())
    : total_(total),
      before_(done),
      noun_(noun),
      sink_(sink),
      clock_(clock),
      start_(clock()),
      next_(start_ + (sink == ProgressSink::terminal ? 0.5 : 1)) {}

std::string Progress::line(const std::string& what, const char* noun, std::uint64_t total, std::uint64_t before, std::uint64_t done,
                           double seconds) {
  const double share = total > 0 ? static_cast<double>(done) / static_cast<double>(total) : 1;
  const double rate = seconds > 0 ? static_cast<double>(done - before) / seconds : 0;
  std::string line = fmt::format("{}  {:.0f} %", one_line(what), std::floor(100 * share));
  if (rate > 0) line += fmt::format("  {}  {} left", rate_text(rate, noun), time_text(static_cast<double>(total - done) / rate));
  return line;
}

bool Progress::is_due() const { return sink_ != ProgressSink::none && clock_() >= next_; }

void Progress::update(const std::string& what, std::uint64_t done) {
  if (!is_due()) return;
  const double now = clock_(), seconds = now - start_;
  const std::string text = line(what, noun_, total_, before_, done, seconds);
  if (sink_ == ProgressSink::terminal) {
    next_ = now + 0.1;
    drawn_ = true;
    fmt::print(stderr, "\r{}\033[K", text);
  } else {
    // done / seconds is the rate, so that (total - done) / rate is what is left
    const bool is_long = static_cast<double>(total_ - done) * seconds >= LOG_PERIOD * static_cast<double>(done - before_);
    if (!logged_ && seconds < LOG_PERIOD && (done == before_ || !is_long)) return;
    logged_ = true;
    next_ = now + LOG_PERIOD;
    fmt::print(stderr, "{}\n", text);
  }
  std::fflush(stderr);
}

void Progress::clear() {
  if (!drawn_) return;
  drawn_ = false;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

void show_status(const std::string& line) {
  if (isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "\r\x1b[K%s", one_line(line).c_str());
}

}  // namespace wholehand
