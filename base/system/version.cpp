// SPDX-License-Identifier: MIT
#include "base/system/version.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/text/error.h"

#ifndef WHOLEHAND_VERSION
#define WHOLEHAND_VERSION "unknown"
#endif

namespace wholehand {

const char* version() { return WHOLEHAND_VERSION; }

void check_version(const std::string& subject, const std::string& written_by, const char* remedy) {
  int minor = 0, patch = 0;
  if (std::sscanf(written_by.c_str(), "0.%d.%d", &minor, &patch) == 2 && minor < 4)
    throw usage_error(
        fmt::format("{}written by version 0.{}.{}; this version reads files from 0.4.0 on: {}", subject, minor, patch, remedy));
}

}  // namespace wholehand
