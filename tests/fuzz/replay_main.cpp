// SPDX-License-Identifier: MIT
// Gives every file of a folder to a fuzz target, once, and then as many random inputs: `replay FOLDER [RUNS]`. Fails where there is no file.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

void run(const Bytes& bytes) { LLVMFuzzerTestOneInput(bytes.data(), bytes.size()); }

// Half of them are a file with some other bytes, half are bytes by chance; the same in every run.
void run_random(const std::vector<Bytes>& files, long runs) {
  std::mt19937 random(1);  // a fixed seed, so that a failure repeats
  const auto below = [&](std::size_t count) { return random() % count; };
  for (long k = 0; k < runs; ++k) {
    Bytes bytes = files[below(files.size())];
    const bool is_new = k % 2 == 0;
    bytes.resize(bytes.size() / 2 + below(bytes.size() + 64));
    const std::size_t changes = is_new ? bytes.size() : 1 + below(8);
    for (std::size_t n = 0; n < changes && !bytes.empty(); ++n)
      bytes[is_new ? n : below(bytes.size())] = static_cast<std::uint8_t>(random());
    run(bytes);
  }
  std::printf("%ld random inputs\n", runs);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: %s FOLDER [RUNS]\n", argv[0]);
    return 2;
  }
  std::set<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1], error)) paths.insert(entry.path());
  std::vector<Bytes> files;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    const Bytes& bytes = files.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    std::printf("%s: %zu bytes\n", path.filename().c_str(), bytes.size());
    run(bytes);
  }
  if (files.empty())
    std::fprintf(stderr, "%s: no inputs\n", argv[1]);
  else if (argc == 3)
    run_random(files, std::atol(argv[2]));
  return files.empty();
}
