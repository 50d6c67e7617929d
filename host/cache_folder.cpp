#include "host/cache_folder.h"

#include <cstdlib>

namespace wholehand::host {

std::string cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache == '/') return std::string(cache) + "/wholehand";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? std::string(home) + "/.cache/wholehand" : "";
}

}  // namespace wholehand::host
