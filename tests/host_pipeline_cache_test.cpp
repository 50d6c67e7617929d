// sanitizers: address
#include "host/pipeline_cache.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

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
  const auto written = fs::last_write_time(files()[0]);
  use(folder);  // nothing to add: not written again
  ASSERT_EQ(files().size(), 1u);
  EXPECT_EQ(fs::last_write_time(files()[0]), written);
  EXPECT_NE(files()[0].filename().string().find(Device().info().uuid), std::string::npos);
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

TEST_F(HostPipelineCache, UnwritableFolderCostsNothing) {
  use("/proc/nonexistent");
  std::ofstream(folder / "file") << "not a folder";
  use(folder / "file" / "below");
}

TEST_F(HostPipelineCache, CpuDriverKeepsNone) {
  const Device device;
  EXPECT_EQ(device.impl().cache_file.empty(), device.info().kind == DeviceKind::cpu);
}

}  // namespace
}  // namespace wholehand::host
