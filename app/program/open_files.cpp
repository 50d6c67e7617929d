// SPDX-License-Identifier: MIT
#include "app/program/open_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <vector>

#include "base/text/error.h"

namespace wholehand {

void check_open_files(std::size_t needed) {
  std::vector<int> opened;
  opened.reserve(needed);
  while (opened.size() < needed) {
    const int file = opened.empty() ? open("/", O_PATH | O_CLOEXEC) : fcntl(opened.front(), F_DUPFD_CLOEXEC, 0);
    if (file < 0) break;
    opened.push_back(file);
  }
  for (const int file : opened) close(file);
  if (opened.size() == needed) return;
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  throw failure_error(fmt::format(
      "only {} of the {} files that the program may need can be open at once: the limit is {}; raise this limit (ulimit -n)",
      opened.size(), needed, static_cast<unsigned long long>(limit.rlim_cur)));
}

}  // namespace wholehand
