// SPDX-License-Identifier: MIT
// sanitizers: address
#include "host/pipeline_cache.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "base/files/cache_folder.h"
#include "tests/support/environment.h"
#include "tests/support/vulkan_kernels.h"

namespace wholehand::host {
namespace {

namespace fs = std::filesystem;

class HostPipelineCache : public testing::Test {
 protected:
  HostPipelineCache() {
    std::string name = (fs::temp_directory_path() / "wholehand-XXXXXX").string();
    folder = mkdtemp(name.data());
  }
  ~HostPipelineCache() override { fs::remove_all(folder); }

  // Opens a device, compiles on it, closes it.
  void use(const fs::path& where) {
    Device device("vulkan", {.cache_folder = where.string()});
    const Kernel kernel(device, test_shader("host_count"), {}, "host_count");
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> result;
    for (const auto& entry : fs::directory_iterator(folder)) {
      result.push_back(entry.path());
    }
    return result;
  }

  fs::path folder;
};

TEST_F(HostPipelineCache, IsOneFileADevice) {
  use(folder);
  ASSERT_EQ(files().size(), 1u);
  const auto used = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(files()[0], used);
  struct stat written {
  }, now{};
  ASSERT_EQ(stat(files()[0].c_str(), &written), 0);
  use(folder);  // nothing to add: not written again, and used
  ASSERT_EQ(files().size(), 1u);
  ASSERT_EQ(stat(files()[0].c_str(), &now), 0);
  EXPECT_EQ(now.st_ino, written.st_ino);
  EXPECT_GT(fs::last_write_time(files()[0]), used);
  EXPECT_NE(files()[0].filename().string().find(Device().info().uuid), std::string::npos);
}

TEST_F(HostPipelineCache, CountsTowardsTheBoundOfTheCache) {
  const fs::path lattice = folder / "grids" / (std::string(32, 'a') + ".grid");
  fs::create_directories(lattice.parent_path());
  std::ofstream(lattice) << "";
  fs::resize_file(lattice, MEBIBYTE);
  const ScopedVariable one("WHOLEHAND_CACHE_MIB", "1");
  use(folder);
  EXPECT_FALSE(fs::exists(lattice));
  EXPECT_EQ(files().size(), 2u) << "the folder of lattices, and the pipelines";
  fs::remove_all(folder);
  const ScopedVariable none("WHOLEHAND_CACHE_MIB", "0");
  use(folder);
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(HostPipelineCache, DamageIsFoundAndMended) {
  use(folder);
  const fs::path file = files().at(0);
  const auto size = fs::file_size(file);
  for (const std::string damaged : {"", "short", "whpipe01 and then something else that is long enough for a header"}) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << damaged;
    use(folder);
    EXPECT_EQ(fs::file_size(file), size);
  }
  std::fstream flip(file, std::ios::binary | std::ios::in | std::ios::out);
  flip.seekp(-1, std::ios::end);
  flip.put('\x55');
  flip.close();
  use(folder);
  EXPECT_EQ(fs::file_size(file), size);
}

TEST_F(HostPipelineCache, DoesNotWaitForAPipe) {
  use(folder);
  const fs::path file = files().at(0);
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  use(folder);
  EXPECT_TRUE(fs::is_regular_file(file));
}

TEST_F(HostPipelineCache, UnwritableFolderCostsNothing) {
  use("/proc/nonexistent");
  std::ofstream(folder / "file") << "not a folder";
  use(folder / "file" / "below");
}

TEST_F(HostPipelineCache, CpuDriverKeepsNone) {
  const Device device;
  EXPECT_EQ(device.state().cache_file.empty(), device.info().kind == DeviceKind::cpu);
}

}  // namespace
}  // namespace wholehand::host
