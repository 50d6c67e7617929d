// SPDX-License-Identifier: MIT
// Whatever a file holds, it is read as a recording and reported on, or refused: Error, with one line, is all that may come out.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/text/error.h"
#include "device/recordings/recording.h"
#include "device/recordings/session_report.h"
#include "tests/support/renewed_recording.h"

namespace {

// A file in memory with these bytes, by the name under which it can be opened.
std::string file_of(const std::string& bytes) {
  static const int file = memfd_create("recording", 0);
  if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    std::abort();
  return "/proc/self/fd/" + std::to_string(file);
}

void try_recording(const std::string& bytes) {
  const std::string path = file_of(bytes);
  try {
    const wholehand::device::SessionReport report = wholehand::device::report_session(wholehand::device::read_recording(path));
    const std::size_t length =
        session_table(report).size() + session_json(report).size() + grasps_csv(report).size() + states_csv(report).size();
    if (length == 0) std::abort();
  } catch (const wholehand::Error& error) {
    const std::string_view line = error.what();
    const bool is_one_line = line.starts_with(path + ": ") && line.size() < 2000;
    if (!is_one_line || error.code != wholehand::ExitCode::usage) std::abort();
  }
}

}  // namespace

// As they are, and with checksums that fit: damage that no checksum finds goes on to what is behind them.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string bytes(reinterpret_cast<const char*>(data), size);
  try_recording(bytes);
  wholehand::renew_checksums(bytes);
  try_recording(bytes);
  return 0;
}
