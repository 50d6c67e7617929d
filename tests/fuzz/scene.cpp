// SPDX-License-Identifier: MIT
// Whatever the text, a scene is read or refused: Error, with one line, is all that may come out.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/text/error.h"
#include "core/reader/reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    wholehand::parse_scene({reinterpret_cast<const char*>(data), size}, "fuzz.toml");
  } catch (const wholehand::Error& error) {
    const std::string_view line = error.what();
    const bool is_one_line = line.substr(0, 10) == "fuzz.toml:" && line.find('\n') == std::string_view::npos && line.size() < 2000;
    if (!is_one_line || error.code != wholehand::ExitCode::usage) std::abort();
  }
  return 0;
}
