// sanitizers: address
#include "host/cache_folder.h"

#include <gtest/gtest.h>

#include "tests/support/environment.h"

namespace wholehand::host {
namespace {

TEST(HostCacheFolder, IsWhereTheUserKeepsSuchThings) {
  const ScopedVariable home("HOME", "/home/someone");
  {
    const ScopedVariable cache("XDG_CACHE_HOME", "/var/cache/someone");
    EXPECT_EQ(cache_folder(), "/var/cache/someone/wholehand");
  }
  for (const char* no_path : {static_cast<const char*>(nullptr), "", "relative/path"}) {
    const ScopedVariable cache("XDG_CACHE_HOME", no_path);
    EXPECT_EQ(cache_folder(), "/home/someone/.cache/wholehand");
  }
}

TEST(HostCacheFolder, IsNowhereWithoutAHome) {
  const ScopedVariable cache("XDG_CACHE_HOME", nullptr);
  for (const char* no_path : {static_cast<const char*>(nullptr), "", "here"}) {
    const ScopedVariable home("HOME", no_path);
    EXPECT_EQ(cache_folder(), "");
  }
}

}  // namespace
}  // namespace wholehand::host
