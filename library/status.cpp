// SPDX-License-Identifier: MIT
#include "library/status.h"

#include <cstring>

#include "system/version.h"

namespace wholehand {
namespace {

// Of a fixed length, so that telling of a failure needs no memory.
thread_local char message[2048] = "";

}  // namespace

wh_status fail(wh_status status, const char* line) noexcept {
  std::strncpy(message, line, sizeof message - 1);
  return status;
}

wh_status fail(const Error& error) noexcept { return fail(error.code == ExitCode::usage ? WH_INPUT : WH_SYSTEM, error.what()); }

}  // namespace wholehand

const char* wh_message(void) { return wholehand::message; }
const char* wh_version(void) {
  static const std::string text = wholehand::version();
  return text.c_str();
}
int wh_abi(void) { return WH_ABI; }

void wh_init(void* structure, size_t size) {
  if (!structure || size < sizeof(size_t)) return;
  std::memset(structure, 0, size);
  std::memcpy(structure, &size, sizeof size);
}
