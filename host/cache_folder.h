// Where the program keeps what it can make again.
#pragma once

#include <string>

namespace wholehand::host {

// $XDG_CACHE_HOME/wholehand, else ~/.cache/wholehand; empty where neither variable holds an absolute path. It need not exist.
std::string cache_folder();

}  // namespace wholehand::host
