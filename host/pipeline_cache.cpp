// SPDX-License-Identifier: MIT
#include "host/pipeline_cache.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/files/cache_folder.h"

namespace wholehand::host {
namespace {

// The file: this line, the bytes' number and hash, the bytes. A driver may trust its input, so it never gets damaged data.
struct FileHeader {
  char magic[8] = {'w', 'h', 'p', 'i', 'p', 'e', '0', '1'};
  std::uint64_t size = 0, hash = 0;
};

std::uint64_t fnv1a(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint8_t byte : bytes) {
    hash = (hash ^ byte) * 0x100000001b3u;
  }
  return hash;
}

std::vector<std::uint8_t> load(const std::string& file) {
  std::error_code absent;
  if (!std::filesystem::is_regular_file(file, absent)) return {};  // a pipe would be waited for
  std::ifstream in(file, std::ios::binary);
  FileHeader header;
  const FileHeader expected;
  if (!in.read(reinterpret_cast<char*>(&header), sizeof header) ||
      std::memcmp(header.magic, expected.magic, sizeof header.magic) != 0) {
    return {};
  }
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return bytes.size() == header.size && fnv1a(bytes) == header.hash ? bytes : std::vector<std::uint8_t>();
}

}  // namespace

void open_pipeline_cache(DeviceState& device, const std::string& folder) {
  std::vector<std::uint8_t> bytes;
  const std::string where = !folder.empty() ? folder : device.info.kind == DeviceKind::cpu ? "" : cache_folder();
  if (!where.empty() && cache_limit() > 0) {
    const std::uint32_t driver = device.physical->getProperties().driverVersion;
    device.cache_file = where + "/" + device.info.uuid + "-" + std::to_string(driver) + ".pipelines";
    bytes = load(device.cache_file);
    if (!bytes.empty()) touch_cached(device.cache_file);
  }
  device.cache.emplace(*device.device, vk::PipelineCacheCreateInfo({}, bytes.size(), bytes.data()));
  device.cache_size = bytes.size();
}

void save_pipeline_cache(DeviceState& device) noexcept {
  if (device.cache_file.empty() || !device.cache) {
    return;
  }
  try {
    const std::vector<std::uint8_t> bytes = device.cache->getData();
    if (bytes.size() == device.cache_size) {
      return;
    }
    FileHeader header;
    header.size = bytes.size();
    header.hash = fnv1a(bytes);
    const std::filesystem::path file(device.cache_file);
    std::filesystem::create_directories(file.parent_path());
    const std::uintmax_t size = sizeof header + bytes.size(), limit = cache_limit();
    if (size > limit) {
      return;
    }
    make_cache_room(file.parent_path().string(), size, limit);
    const std::string partial = device.cache_file + "." + std::to_string(getpid());  // two runs at once: each its own
    std::ofstream out(partial, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    out.close();
    if (out) {
      std::filesystem::rename(partial, file);
    } else {
      std::filesystem::remove(partial);
    }
  } catch (const std::exception&) {
    // an unwritable folder, a full disk or a lost device: the next run compiles again
  }
}

}  // namespace wholehand::host
