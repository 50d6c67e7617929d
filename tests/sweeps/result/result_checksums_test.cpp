// SPDX-License-Identifier: MIT
// One bit of a result flipped anywhere: whoever reads it refuses it and names what is damaged, or finds what the sweep wrote.
// sanitizers: none
#include "sweeps/result/result_checksums.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "base/text/error.h"
#include "sweeps/result/sweep_result.h"
#include "tests/support/program.h"
#include "tests/support/refusal.h"
#include "tests/support/result_reader.h"
#include "tests/support/sweep_file.h"
#include "tests/support/sweep_results.h"

namespace wholehand::sweeps {
namespace {

// All that readers take from a result, as text.
std::string all_of(const std::string& path, const SweptScene& swept) {
  SweepResult result(path);
  result.use(swept.scene, *swept.plan);
  const SweepOrigin& origin = result.origin();
  std::string text = fmt::format("{} {} {} {} {} {} {}", origin.scene, origin.version, origin.backend, origin.device, origin.driver,
                                 origin.wall_seconds, origin.kernel_seconds);
  const auto add = [&text](const std::vector<double>& values) {
    for (const double value : values) text += fmt::format(" {}", value);
  };
  std::vector<double> values(swept.plan->stored_grips());
  for (std::size_t v = 0; v < swept.scene.vessels.size(); ++v) {
    for (const Variable* variable : result.variables())
      for (std::size_t plane = 0; plane < variable_planes(*variable, swept.scene); ++plane) {
        result.read(*variable, v, plane, 0, values.size(), values.data());
        add(values);
      }
    for (const Candidate& candidate : result.best(v)) text += fmt::format(" {} {}", candidate.index, candidate.score);
    result.refined(v);
    add(result.pouring_tilts(v));
  }
  add(result.vessel_heights());
  add(result.vessel_bases());
  return text;
}

class FlippedResult : public testing::Test {
 protected:
  FlippedResult() : whole_(file_text(swept_.path)), path_(swept_.folder / "flipped.nc"), parts_(checksum_parts(swept_.path)) {}

  // The line with which the file is refused; empty: all that was read is as it was.
  std::string line_of(std::uint64_t at) {
    std::string bytes = whole_;
    bytes[at] = static_cast<char>(bytes[at] ^ 1 << random_() % 8);
    std::ofstream(path_, std::ios::binary) << bytes;
    std::string found;
    const std::string line = refusal_line([&] { found = all_of(path_, swept_); });
    if (line.empty()) {
      EXPECT_EQ(found, expected_) << "other values without a word, byte " << at;
    }
    return line;
  }
  std::uint64_t any_of(const FileRange& range) { return range.offset + random_() % range.size; }

  std::mt19937 random_{11};
  SweptScene swept_{edited(RESULT_SCENE, "best = 5", "best = 5\nalso = [\"hold_force\"]")};
  std::string whole_, path_, expected_ = all_of(swept_.path, swept_);
  ChecksumParts parts_;
};

TEST_F(FlippedResult, ABitOfAnyVariableOfAnyVesselIsRefusedByItsName) {
  std::size_t grips = 0;
  for (const ChecksumPart& part : parts_.parts) {
    const std::string line = line_of(any_of(part.range));
    if (line.empty()) {  // what no reader takes from the file: the scene's own text says it
      EXPECT_EQ(swept_.result->find(part.variable), nullptr) << part.variable;
      const std::string all = refusal_line([&] { SweepResult(path_).check_all(); });
      EXPECT_NE(all.find(": is damaged: the values of " + part.variable), std::string::npos) << all;
      continue;
    }
    const std::string whose = part.vessel ? fmt::format(" of vessel {}", *part.vessel + 1) : "";
    EXPECT_EQ(line, path_ + ": is damaged: the values of " + part.variable + whose +
                        " are not those that the sweep wrote; sweep again, or use a copy that is not damaged");
    grips += swept_.result->find(part.variable) != nullptr;
  }
  EXPECT_EQ(grips, 2 * swept_.result->variables().size());
}

TEST_F(FlippedResult, ABitOfTheChecksumsIsRefused) {
  const std::size_t start = whole_.find("wholehand checksums 1 "), body = whole_.find('\n', start) + 1;
  ASSERT_EQ(start, parts_.room.offset);
  const std::uint64_t length = std::strtoull(whole_.c_str() + start + 22, nullptr, 10);
  ASSERT_LT(length, parts_.room.size);
  for (int k = 0; k < 40; ++k) EXPECT_NE(line_of(any_of({start, body + length - start})), "");
  for (int k = 0; k < 5; ++k) EXPECT_EQ(line_of(any_of({body + length, parts_.room.size - (body - start) - length})), "");
}

TEST_F(FlippedResult, ABitOfTheAttributesOrTheStructureIsRefused) {
  const auto is_of_a_part = [this](std::uint64_t at) {
    if (at - parts_.room.offset < parts_.room.size) return true;
    return std::any_of(parts_.parts.begin(), parts_.parts.end(),
                       [at](const ChecksumPart& part) { return at - part.range.offset < part.range.size; });
  };
  std::vector<std::uint64_t> places{whole_.find("1.2.3"), whole_.find("height_mm = 95"), whole_.find("score_weights"),
                                    whole_.size() - 1};
  while (places.size() < 100)
    if (const std::uint64_t at = random_() % whole_.size(); !is_of_a_part(at)) places.push_back(at);
  for (const std::uint64_t at : places) EXPECT_NE(line_of(at).find("is "), std::string::npos) << at;
}

TEST_F(FlippedResult, OnlyWhatIsReadIsCompared) {
  line_of(any_of(parts_.parts.front().range));
  const auto gap =
      std::find_if(parts_.parts.begin(), parts_.parts.end(), [](const ChecksumPart& p) { return p.variable == "gap"; });
  ASSERT_NE(line_of(any_of(gap->range)), "");
  SweepResult result(path_);
  result.use(swept_.scene, *swept_.plan);
  std::vector<double> values(swept_.plan->stored_grips());
  EXPECT_EQ(refusal_line([&] { result.read(*result.find("gap"), 1, 0, 0, values.size(), values.data()); }), "")
      << "the other vessel";
  EXPECT_NE(refusal_line([&] { result.read(*result.find("gap"), 0, 0, 7, 1, values.data()); }), "");
}

TEST_F(FlippedResult, AResultWithoutChecksumsIsRefused) {
  std::string bytes = whole_;
  std::ofstream(path_, std::ios::binary) << bytes.replace(parts_.room.offset, parts_.room.size, parts_.room.size, '\0');
  EXPECT_NE(refusal_line([&] { SweepResult result(path_); }).find("was not finished; finish it with wholehand sweep --resume"),
            std::string::npos);
  std::filesystem::copy_file(swept_.path, path_, std::filesystem::copy_options::overwrite_existing);
  int file = -1, id = -1;
  ASSERT_EQ(nc_open(path_.c_str(), NC_WRITE, &file), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(file, CHECKSUMS, &id), NC_NOERR);
  EXPECT_EQ(nc_rename_var(file, id, "other"), NC_NOERR);
  EXPECT_EQ(nc_close(file), NC_NOERR);
  EXPECT_EQ(refusal_line([&] { SweepResult result(path_); }), path_ + ": has no checksums of its values; sweep again");
}

// Parts of more than one block, and blocks that only a part of a request lies in.
TEST(ResultChecksums, LongVariablesHaveBlocks) {
  const TemporaryFolder folder;
  const std::string path = folder / "long.nc";
  Scene scene = fake_scene();
  scene.grips.sampling = Sampling::sobol;
  scene.grips.count = 300'000;
  scene.output.keep = {{"score"}};
  SweepFile setup(scene, path, Precision::full, 65'536);
  ResultFile file = setup.open();
  setup.write_all(file);
  file.finish();
  const ChecksumParts parts = checksum_parts(path);
  const auto score =
      std::find_if(parts.parts.begin(), parts.parts.end(), [](const ChecksumPart& p) { return p.variable == "score"; });
  ASSERT_EQ(score->block_count(), 3u);
  std::fstream bytes(path, std::ios::in | std::ios::out | std::ios::binary);
  bytes.seekp(static_cast<std::streamoff>(score->range.offset + 8 * 140'000)).put('x').flush();
  std::string text(parts.room.size, ' ');
  bytes.seekg(static_cast<std::streamoff>(parts.room.offset)).read(text.data(), static_cast<std::streamsize>(text.size()));
  ResultChecksums checksums(path, text);
  const std::uint64_t all = 300'000 * scene.vessels.size();
  EXPECT_EQ(refusal_line([&] { checksums.check("score", 0, 131'072, all); }), "") << "the first block";
  EXPECT_EQ(refusal_line([&] { checksums.check("score", 262'144, 600'000, all); }), "") << "the last one, and another vessel";
  EXPECT_NE(refusal_line([&] { checksums.check("score", 131'071, 131'073, all); }), "");
  EXPECT_NE(refusal_line([&] { checksums.check_all(); }), "");
}

#ifdef WHOLEHAND_PROGRAM

// The case that was found: one bit makes a score of 1.5e308.
TEST_F(FlippedResult, EveryCommandRefusesAScoreThatIsDamaged) {
  const auto score =
      std::find_if(parts_.parts.begin(), parts_.parts.end(), [](const ChecksumPart& p) { return p.variable == "score"; });
  std::string bytes = whole_;
  bytes[score->range.offset + 8 * 50 + 7] ^= 0x40;
  std::ofstream(path_, std::ios::binary) << bytes;
  const std::string scene = swept_.folder / "scene.toml";
  std::ofstream(scene) << swept_.scene.text;
  for (const std::string& command : {"rank " + path_, "report " + path_, "sweep " + scene + " --on core --resume -o " + path_})
    expect_error(command, 2, "flipped.nc: is damaged: the values of score of vessel 1 are not those that the sweep wrote");
}

// A page says that the file's numbers agree, so it is about all of them.
TEST_F(FlippedResult, ReportRefusesADamagedVariableThatItDoesNotShow) {
  const auto depth = std::find_if(parts_.parts.begin(), parts_.parts.end(),
                                  [](const ChecksumPart& p) { return p.variable == "palm_depth" && p.vessel == 1u; });
  ASSERT_NE(depth, parts_.parts.end());
  std::string bytes = whole_;
  bytes[depth->range.offset] ^= 1;
  std::ofstream(path_, std::ios::binary) << bytes;
  expect_error("report " + path_, 2, "flipped.nc: is damaged: the values of palm_depth of vessel 2 are not");
}

#endif

}  // namespace
}  // namespace wholehand::sweeps
