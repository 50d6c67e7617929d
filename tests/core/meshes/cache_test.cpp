// SPDX-License-Identifier: MIT
// sanitizers: address
// (Embree starts workers that the thread sanitizer cannot see into, and then reports what they were given.)
// Lattices of meshes on the disk: the same again to the bit, made anew where a file is not what it should be, and never in the way.
#include "core/meshes/cache.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "base/files/cache_folder.h"
#include "base/text/error.h"
#include "core/meshes/distance.h"
#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"

namespace wholehand {
namespace {

namespace fs = std::filesystem;

class MeshCache : public testing::Test {
 protected:
  MeshCache() {
    std::string name = (fs::temp_directory_path() / "wholehand-XXXXXX").string();
    root = mkdtemp(name.data());
    folder = root / "grids";
    fs::create_directories(folder);
    spec.spacing = 20e-3;
  }
  ~MeshCache() override {
    std::error_code ignored;
    fs::permissions(folder, fs::perms::owner_all, ignored);
    fs::remove_all(root);
  }

  // The cache's answer, and whether it had to be made.
  MeshLattice ask(const CheckedMesh& of, const LatticeSpec& with) {
    was_made = false;
    return cached_lattice(of, with, root.string(), [&](double) { was_made = true; });
  }
  MeshLattice ask() { return ask(mesh, spec); }
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder)) found.push_back(entry.path());
    return found;
  }
  static void write(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  }

  const CheckedMesh mesh = check_mesh(torus(0.05, 0.02, 20, 10), "torus");
  LatticeSpec spec;
  fs::path root, folder;  // of the cache, and of the lattices in it
  bool was_made = false;
};

void expect_same(const MeshLattice& a, const MeshLattice& b) {
  EXPECT_EQ(a.lattice.origin, b.lattice.origin);
  EXPECT_EQ(a.lattice.spacing, b.lattice.spacing);
  EXPECT_EQ((std::array{a.lattice.nx, a.lattice.ny, a.lattice.nz}), (std::array{b.lattice.nx, b.lattice.ny, b.lattice.nz}));
  EXPECT_EQ(a.lattice.halves, b.lattice.halves);
  EXPECT_EQ(*a.lattice.words, *b.lattice.words);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.at_limit, b.at_limit);
}

TEST_F(MeshCache, GivesTheSameToTheBitWithoutMakingIt) {
  std::vector<LatticeSpec> specs(5, spec);
  specs[1].bits = 16;
  specs[2].spacing.reset();
  specs[2].tolerance = 2e-3;
  specs[3] = specs[2];
  specs[3].most_bytes = 6'000;  // halves, and not fine enough
  specs[4].margin = 8e-3;
  for (const LatticeSpec& each : specs) {
    const MeshLattice plain = lattice_of_mesh(MeshDistance(mesh), mesh, each), made = ask(mesh, each);
    EXPECT_TRUE(was_made);
    expect_same(plain, made);
    const MeshLattice again = ask(mesh, each);
    EXPECT_FALSE(was_made);
    expect_same(made, again);
  }
  EXPECT_EQ(files().size(), specs.size());
  EXPECT_TRUE(ask(mesh, specs[3]).at_limit);
  EXPECT_TRUE(ask(mesh, specs[3]).lattice.halves);
}

TEST_F(MeshCache, EveryPartOfTheWishAndEveryVertexCounts) {
  const auto is_new = [&](const CheckedMesh& of, const LatticeSpec& with) {
    ask(of, with);
    return was_made;
  };
  EXPECT_TRUE(is_new(mesh, spec));
  LatticeSpec other = spec;
  other.spacing = 20.001e-3;
  EXPECT_TRUE(is_new(mesh, other));
  other = spec;
  other.margin = 1e-6;
  EXPECT_TRUE(is_new(mesh, other));
  other = spec;
  other.bits = 16;
  EXPECT_TRUE(is_new(mesh, other));
  other = spec;
  other.spacing.reset();
  other.tolerance = 3e-3;
  EXPECT_TRUE(is_new(mesh, other));
  other.tolerance = 3.001e-3;
  EXPECT_TRUE(is_new(mesh, other));
  other.margin = 1e-3;
  EXPECT_TRUE(is_new(mesh, other));
  other.bits = 16;
  EXPECT_TRUE(is_new(mesh, other));
  CheckedMesh moved = mesh;
  moved.mesh.vertices[77][1] += 1e-9;
  EXPECT_TRUE(is_new(moved, spec));
  CheckedMesh turned = mesh;
  std::swap(turned.mesh.triangles[5][0], turned.mesh.triangles[5][1]);
  EXPECT_TRUE(is_new(turned, spec));
  EXPECT_FALSE(is_new(mesh, spec));
}

TEST_F(MeshCache, WhatDoesNotChangeTheLatticeDoesNotCount) {
  const MeshLattice given = ask();
  spec.threads = 1;
  spec.tolerance = 1e-9;
  spec.most_bytes = 1u << 22;
  spec.bits = 32;
  expect_same(given, ask());
  EXPECT_FALSE(was_made);
  spec.spacing.reset();
  spec.tolerance = 2e-3;
  const MeshLattice chosen = ask();
  EXPECT_TRUE(was_made);
  EXPECT_FALSE(chosen.at_limit);
  const std::size_t words = chosen.lattice.words->size();
  for (const std::size_t most : {4 * words, 8 * words, std::size_t{1} << 30}) {  // any memory that holds it
    spec.most_bytes = most;
    spec.bits = most == 4 * words ? std::optional<int>(32) : std::nullopt;
    expect_same(chosen, ask());
    EXPECT_FALSE(was_made) << most;
  }
}

TEST_F(MeshCache, MemoryThatDecidesCounts) {
  spec.spacing.reset();
  spec.tolerance = 2e-3;
  const std::size_t words = ask().lattice.words->size();
  spec.most_bytes = 8 * words - 4;
  EXPECT_TRUE(ask().lattice.halves);
  EXPECT_TRUE(was_made);
  spec.most_bytes = words;
  EXPECT_TRUE(ask().at_limit);
  EXPECT_TRUE(was_made);
  spec.most_bytes = words - 400;
  EXPECT_LE(4 * ask().lattice.words->size(), words - 400);
  EXPECT_TRUE(was_made);
  spec.bits = 32;  // good enough, but coarser than what more memory begins with
  spec.most_bytes = 2 * words;
  EXPECT_TRUE(ask().at_limit);
  spec.most_bytes = 4 * words;
  EXPECT_EQ(ask().lattice.words->size(), words);
  EXPECT_FALSE(was_made);
  spec.most_bytes = 100;
  EXPECT_THROW(ask(), Error);
  spec.spacing = 1e-6;
  EXPECT_THROW(ask(), Error);
}

TEST_F(MeshCache, ADamagedFileIsMadeAgain) {
  const MeshLattice made = ask();
  ASSERT_EQ(files().size(), 1u);
  const fs::path file = files()[0];
  const std::string whole = file_text(file);
  ASSERT_EQ(whole.size(), 88 + 4 * made.lattice.words->size() + 16);
  // each byte of the header, samples at both ends and in between, each byte of the hash
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < 88; ++i) places.push_back(i);
  for (const std::size_t i : {std::size_t{88}, whole.size() / 2, whole.size() - 17}) places.push_back(i);
  for (std::size_t i = whole.size() - 16; i < whole.size(); ++i) places.push_back(i);
  for (const std::size_t at : places) {
    for (const int bit : {0, 7}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << bit));
      write(file, bytes);
      expect_same(made, ask());
      EXPECT_TRUE(was_made) << at;
      ASSERT_EQ(file_text(file), whole) << at;
    }
  }
}

TEST_F(MeshCache, ATruncatedOrForeignFileIsMadeAgain) {
  const MeshLattice made = ask();
  const fs::path file = files().at(0);
  const std::string whole = file_text(file);
  std::vector<std::string> wrong{"", "short", std::string(200, '\0'), std::string(200, '\xFF'), whole + "x", whole + whole};
  for (const std::size_t size : {8u, 87u, 88u, 89u, 103u, 104u}) wrong.push_back(whole.substr(0, size));
  wrong.push_back(whole.substr(0, whole.size() - 1));
  for (const std::string& bytes : wrong) {
    write(file, bytes);
    expect_same(made, ask());
    EXPECT_TRUE(was_made) << bytes.size();
    EXPECT_EQ(file_text(file), whole);
  }
  // another's lattice under this one's name
  spec.margin = 5e-3;
  ask();
  for (const fs::path& other : files()) {
    if (other != file) fs::rename(other, file);
  }
  spec.margin = 0;
  expect_same(made, ask());
  EXPECT_TRUE(was_made);
  // a folder under this one's name stays
  fs::remove(file);
  fs::create_directories(file / "below");
  expect_same(made, ask());
  EXPECT_TRUE(fs::is_directory(file / "below"));
  EXPECT_EQ(files().size(), 1u);  // nothing half written beside it
}

TEST_F(MeshCache, AFolderThatCannotBeWrittenCostsNothing) {
  const MeshLattice plain = lattice_of_mesh(MeshDistance(mesh), mesh, spec);
  expect_same(plain, cached_lattice(mesh, spec, "/proc/nonexistent"));
  write(folder / "file", "not a folder");
  expect_same(plain, cached_lattice(mesh, spec, (folder / "file").string()));
  expect_same(plain, cached_lattice(mesh, spec, (folder / "file" / "below").string()));
}

TEST_F(MeshCache, AFolderThatMayOnlyBeReadIsRead) {
  ask();
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  ask();
  EXPECT_FALSE(was_made);
}

TEST_F(MeshCache, IsKeptWhereTheUserKeepsSuchThings) {
  const ScopedVariable home("HOME", folder.c_str());
  {
    const ScopedVariable cache("XDG_CACHE_HOME", (folder / "xdg").c_str());
    cached_lattice(mesh, spec);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "xdg/wholehand/grids"), {}), 1);
  }
  const ScopedVariable cache("XDG_CACHE_HOME", nullptr);
  cached_lattice(mesh, spec);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / ".cache/wholehand/grids"), {}), 1);
  const ScopedVariable nowhere("HOME", nullptr);
  EXPECT_FALSE(cached_lattice(mesh, spec).lattice.words->empty());
}

// Files without contents, which take no room on the disk, fill the cache up.
TEST_F(MeshCache, WhatIsUnusedForLongestGoesFirst) {
  using std::chrono::hours;
  ask();
  const fs::path used = files().at(0);
  const auto size = fs::file_size(used);
  const auto now = fs::file_time_type::clock::now();
  const auto add = [&](char digit, const std::string& ending, std::uintmax_t bytes, hours age) {
    const fs::path file = folder / (std::string(32, digit) + ending);
    write(file, "");
    fs::resize_file(file, bytes);
    fs::last_write_time(file, now - age);
    return file;
  };
  fs::last_write_time(used, now - hours(5));
  const fs::path oldest = add('a', ".grid", DEFAULT_CACHE_BYTES / 2, hours(4)),
                 old = add('b', ".grid", DEFAULT_CACHE_BYTES / 2 - 2 * size - 11, hours(3)),
                 left_over = add('c', ".Ab3dEf.partial", 10, hours(2)), begun = add('d', ".Ab3dEf.partial", 10, hours(0)),
                 foreign = folder / "notes.grid";
  write(foreign, "keep me");
  fs::last_write_time(foreign, now - hours(100));
  ask();  // not read for longest until now
  EXPECT_FALSE(was_made);
  spec.margin = 1e-7;  // as large; both fit beside the others to within a byte
  ask();
  EXPECT_TRUE(fs::exists(oldest));
  EXPECT_FALSE(fs::exists(left_over));
  EXPECT_TRUE(fs::exists(begun));
  spec.margin = 2e-7;
  ask();
  EXPECT_FALSE(fs::exists(oldest));
  for (const fs::path& file : {used, old, begun, foreign}) EXPECT_TRUE(fs::exists(file)) << file;
  fs::resize_file(old, DEFAULT_CACHE_BYTES + 1);
  fs::last_write_time(old, now + hours(1));  // and a clock that was wrong
  spec.margin = 3e-7;
  ask();
  EXPECT_EQ(files().size(), 3u);  // all lattices but the new one have gone
  ask();
  EXPECT_FALSE(was_made);
}

TEST_F(MeshCache, TheBoundIsTheUsers) {
  const auto size = static_cast<std::uintmax_t>(4 * ask().lattice.words->size() + 104);
  ASSERT_EQ(fs::file_size(files().at(0)), size);
  ASSERT_LT(size, MEBIBYTE);
  const fs::path pipelines = root / (std::string(32, 'd') + "-7.pipelines");
  write(pipelines, "");
  fs::resize_file(pipelines, MEBIBYTE - size);
  fs::last_write_time(files().at(0), fs::file_time_type::clock::now() - std::chrono::hours(1));  // clocks of files are coarse
  spec.margin = 1e-7;                                                                            // as large
  {
    const ScopedVariable one("WHOLEHAND_CACHE_MIB", "1");
    ask();
    EXPECT_EQ(files().size(), 1u) << "the first lattice was unused for longest";
    EXPECT_TRUE(fs::exists(pipelines)) << "two files fill the bound to the byte";
    ask();
    EXPECT_FALSE(was_made);
  }
  {
    const ScopedVariable none("WHOLEHAND_CACHE_MIB", "0");
    ask();
    EXPECT_TRUE(was_made) << "what is there is not read";
    spec.margin = 2e-7;
    ask();
    EXPECT_EQ(files().size(), 1u) << "nothing is written, nothing removed";
  }
  const ScopedVariable wrong("WHOLEHAND_CACHE_MIB", "2 GB");
  EXPECT_THROW(ask(), Error);
}

TEST_F(MeshCache, ManyAtOnceDoNoHarm) {
  const MeshLattice plain = lattice_of_mesh(MeshDistance(mesh), mesh, spec);
  std::vector<std::jthread> others;
  for (int t = 0; t < 4; ++t) {
    others.emplace_back([&] {
      for (int i = 0; i < 10; ++i) {
        expect_same(plain, cached_lattice(mesh, spec, root.string()));
        std::error_code ignored;
        for (const fs::path& file : files()) {
          if (i % 3 == 0 && file.extension() == ".grid") fs::remove(file, ignored);
        }
      }
    });
  }
  others.clear();
  ask();
  EXPECT_EQ(files().size(), 1u);
}

TEST_F(MeshCache, TheKeyIsThatOfTrianglesAndLattice) {
  const PreparedLattice lattice = ask().lattice;
  std::set<std::string> keys{mesh_key(mesh, lattice)};
  EXPECT_EQ(keys.begin()->size(), 32u);
  EXPECT_EQ(keys.begin()->find_first_not_of("0123456789abcdef"), std::string::npos);
  const CheckedMesh same = check_mesh(torus(0.05, 0.02, 20, 10), "another name");
  keys.insert(mesh_key(same, lattice_of_mesh(MeshDistance(same), same, spec).lattice));
  EXPECT_EQ(keys.size(), 1u);
  for (int part = 0; part < 8; ++part) {
    PreparedLattice other = lattice;
    if (part < 3) other.origin[part] += 1e-12;
    if (part == 3) other.spacing += 1e-12;
    if (part == 4) ++other.nx;
    if (part == 5) ++other.ny;
    if (part == 6) ++other.nz;
    if (part == 7) other.halves = true;
    EXPECT_TRUE(keys.insert(mesh_key(mesh, other)).second) << part;
  }
  for (std::size_t i = 0; i < mesh.mesh.vertices.size(); i += 17) {
    CheckedMesh other = mesh;
    other.mesh.vertices[i][i % 3] += 1e-12;
    EXPECT_TRUE(keys.insert(mesh_key(other, lattice)).second) << i;
  }
  CheckedMesh other = mesh;
  std::swap(other.mesh.triangles[1][1], other.mesh.triangles[1][2]);
  EXPECT_TRUE(keys.insert(mesh_key(other, lattice)).second);
  other.mesh.triangles.pop_back();
  EXPECT_TRUE(keys.insert(mesh_key(other, lattice)).second);
}

// Reading a pipe in a file's place without a writer would wait without end.
TEST_F(MeshCache, DoesNotWaitForAPipe) {
  const MeshLattice made = ask();
  const fs::path file = files().at(0);
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  expect_same(ask(), made);
  EXPECT_TRUE(was_made);
  EXPECT_TRUE(fs::is_regular_file(file)) << "the lattice took its place";
}

}  // namespace
}  // namespace wholehand
