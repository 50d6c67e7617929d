// SPDX-License-Identifier: MIT
#include "app/c/status.h"

#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "base/system/version.h"
#include "base/text/printable.h"

namespace wholehand {
namespace {

// Has a fixed length, so that it can report a lack of memory.
thread_local char message[2048] = "";

// Remedies in the words of the C interface: arguments where the program names options.
const char* remedy_words(Remedy remedy) noexcept {
  switch (remedy) {
    case Remedy::core:
      return "; use \"core\"";
    case Remedy::or_core:
      return ", or use \"core\"";
    case Remedy::double_precision:
      return "; compute in double";
    case Remedy::float_precision:
      return "; compute in float";
    case Remedy::or_float_precision:
      return ", or compute in float";
    case Remedy::name_library:
    case Remedy::none:
      break;
  }
  return "";
}

}  // namespace

wh_status fail(wh_status status, const char* format, ...) noexcept {
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(message, sizeof message, format, values);
  va_end(values);
  for (char* at = message; *at != 0;) {  // of a caller's own names; in place, without memory
    const Utf8Character character = first_character(at);
    if (!character.is_whole || is_steering(character.code)) std::memset(at, '?', character.length);
    at += character.length;
  }
  return status;
}

wh_status fail(wh_status status, const std::string& line) noexcept { return fail(status, "%s", line.c_str()); }

wh_status fail(const Error& error) noexcept {
  return fail(error.code == ExitCode::usage ? WH_INPUT : WH_SYSTEM, "%s%s", error.what(), remedy_words(error.remedy));
}

wh_status check_size(std::size_t size, std::size_t first, std::size_t own, const char* place) noexcept {
  if (size > own)
    return fail(WH_ARGUMENT, "%s has %zu bytes, and this library (%s) knows %zu of them; it is of a later header", place, size,
                version(), own);
  if (size < first || size % alignof(double) != 0)
    return fail(WH_ARGUMENT, "%s is null, or its size is not set; WH_INIT sets it", place);
  return WH_OK;
}

}  // namespace wholehand

const char* wh_message(void) { return wholehand::message; }
const char* wh_version(void) { return wholehand::version(); }
int wh_abi(void) { return WH_ABI; }

void wh_init(void* structure, size_t size) {
  if (!structure || size < sizeof(size_t)) return;
  std::memset(structure, 0, size);
  std::memcpy(structure, &size, sizeof size);
}
