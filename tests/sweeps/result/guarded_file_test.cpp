// SPDX-License-Identifier: MIT
// Damaged files, and names that look like addresses: whatever a file says, reading it costs at most one line.
// sanitizers: address
#include "sweeps/result/guarded_file.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>

#include "base/text/error.h"
#include "sweeps/result/sweep_result.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/refusal.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_results.h"

namespace wholehand::sweeps {
namespace {

// Small, and with all that a result has but most of its numbers.
const std::string& small_result() {
  static const std::string bytes = [] {
    const SweptScene swept(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"score\"]"));
    return file_text(swept.path);
  }();
  return bytes;
}

TEST(GuardedFile, GivesWhatTheLibraryGives) {
  const SweptScene swept(RESULT_SCENE);
  const GuardedFile file(swept.path);
  EXPECT_EQ(file.text("scene"), RESULT_SCENE);
  EXPECT_EQ(file.text("wall_time_s"), std::nullopt);
  EXPECT_EQ(file.number("wall_time_s"), 12.5);
  EXPECT_EQ(file.find("nothing"), nullptr);
  const GuardedFile::Stored* gap = file.find("gap");
  ASSERT_TRUE(gap);
  EXPECT_EQ(gap->shape, (std::vector<std::size_t>{2, 3, 2, 3, 1, 1, 12}));
  EXPECT_EQ(gap->type, NC_DOUBLE);
  const std::vector<double> all = read_values(swept.path, "gap");
  std::vector<double> block(2 * 3);
  file.read(*gap, std::vector<std::size_t>{1, 2, 0, 1, 0, 0, 4}, std::vector<std::size_t>{1, 1, 2, 1, 1, 1, 3}, block.data());
  for (std::size_t k = 0; k < block.size(); ++k) {
    const double expected = all[(((1 * 3 + 2) * 2 + k / 3) * 3 + 1) * 12 + 4 + k % 3];
    EXPECT_TRUE(block[k] == expected || (std::isnan(block[k]) && std::isnan(expected))) << k;
  }
  EXPECT_NE(refusal_line([&] {
              file.read(*gap, std::vector<std::size_t>{2, 0, 0, 0, 0, 0, 0}, std::vector<std::size_t>(7, 1), block.data());
            }).find("gap cannot be read"),
            std::string::npos)
      << "a place that is not there";
}

// The library's strings and references lie in its global heap; it trusts lengths there, and crashes or never ends. Writes a huge one
// `at` bytes into it.
void write_damaged_heap(const std::string& path, std::size_t at) {
  std::string damaged = small_result();
  const std::size_t heap = damaged.find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  damaged.replace(heap + at, 8, "\x7f\xff\xff\xff\xff\xff\xff\xff", 8);
  std::ofstream(path, std::ios::binary) << damaged;
}

TEST(GuardedFile, ADamagedHeapCostsOneLine) {
  const TemporaryFolder folder;
  const std::string path = folder / "damaged.nc";
  for (const std::size_t at : {8, 24, 27, 35, 40, 64, 91}) {
    write_damaged_heap(path, at);
    EXPECT_NE(refusal_line([&] { SweepResult result(path); }).find("is damaged"), std::string::npos) << at;
  }
}

#ifdef WHOLEHAND_PROGRAM

TEST(GuardedFile, EveryCommandThatReadsAResultRefusesADamagedOne) {
  const TemporaryFolder folder;
  const std::string path = folder / "damaged.nc";
  write_damaged_heap(path, 8);
  std::vector<std::string> commands{"rank " + path, "grip " + path + " --vessel cup --rank 1",
                                    "sweep small --on core --resume -o " + path};
#ifdef HAS_VIEWER
  commands.push_back("view " + path);
#endif
#ifdef HAS_EVIDENCE
  commands.push_back("report " + path);
#endif
  for (const std::string& arguments : commands) expect_error(arguments, 2, "damaged.nc: is damaged");
}

#endif

// What the reading process dies of may come with any value.
TEST(GuardedFile, AReaderThatDiesLaterCostsOneLine) {
  const SweptScene swept(RESULT_SCENE);
  const std::unique_ptr<GuardedFile> file = std::make_unique<GuardedFile>(swept.path);
  const GuardedFile::Stored* gap = file->find("gap");
  ASSERT_TRUE(gap);
  std::vector<pid_t> children;
  std::ifstream list("/proc/thread-self/children");
  for (pid_t child = 0; list >> child;) children.push_back(child);
  ASSERT_FALSE(children.empty());
  kill(children.back(), SIGSEGV);
  double value = 0;
  const std::vector<std::size_t> place(7, 0), one(7, 1);
  EXPECT_EQ(refusal_line([&] { file->read(*gap, place, one, &value); }),
            swept.path + ": is damaged, or is not a NetCDF-4 file: it cannot be read");
  EXPECT_NE(refusal_line([&] { file->read(*gap, place, one, &value); }), "") << "and it stays so";
}

TEST(GuardedFile, WhatIsNoRegularFileIsRefused) {
  const TemporaryFolder folder;
  EXPECT_NE(refusal_line([&] { GuardedFile(folder.path()); }).find("is a directory"), std::string::npos);
  EXPECT_NE(refusal_line([] { GuardedFile("/dev/null"); }).find("is a device or pipe"), std::string::npos);
  EXPECT_NE(refusal_line([&] { GuardedFile(folder / "none"); }).find("No such file"), std::string::npos);
  std::ofstream(folder / "text") << "text";
  EXPECT_NE(refusal_line([&] { GuardedFile(folder / "text"); }).find("is damaged, or is not a NetCDF-4 file"), std::string::npos);
}

// The process that reads holds nothing of the one that asks: what that closes is closed.
TEST(GuardedFile, TheReaderInheritsNothing) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.nc", std::ios::binary) << small_result();
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const GuardedFile file(folder / "a.nc");
  close(ends[1]);
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 0) << "nobody else has the pipe's other end";
  close(ends[0]);
}

// A listening port on this machine that knows whether anybody came.
class Listener {
 public:
  Listener() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(socket_, 4), 0);
    socklen_t size = sizeof address;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  ~Listener() { close(socket_); }
  bool has_guest() const { return accept(socket_, nullptr, nullptr) >= 0 || errno != EAGAIN; }

  int port = 0;

 private:
  int socket_;
};

TEST(GuardedFile, ANameInTheFormOfAnAddressIsAFileAllTheSame) {
  const TemporaryFolder folder;
  const Listener listener;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const std::string host = "http:/127.0.0.1:" + std::to_string(listener.port);
  std::filesystem::create_directories(host);
  std::ofstream(host + "/x.nc", std::ios::binary) << small_result();
  EXPECT_EQ(SweepResult(host + "/x.nc").vessel_heights().size(), 2u);
  EXPECT_NE(refusal_line([&] { SweepResult(host + "/missing.nc"); }).find("No such file"), std::string::npos);
#ifdef WHOLEHAND_PROGRAM
  expect_error("rank " + host + "/missing.nc", 2, "missing.nc");
  const Outcome swept = run("PROGRAM sweep small --on core --resume -o " + host + "/new.nc 2>&1");
  EXPECT_EQ(swept.code, 0) << swept.output;
  EXPECT_EQ(run("PROGRAM sweep small --on core --resume -o " + host + "/new.nc 2>&1").code, 0) << "which is complete";
#endif
  EXPECT_FALSE(listener.has_guest());
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace wholehand::sweeps
