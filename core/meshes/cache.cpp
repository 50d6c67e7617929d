// SPDX-License-Identifier: MIT
#include "core/meshes/cache.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>
#include <xxhash.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <vector>

#include "base/files/cache_folder.h"
#include "core/meshes/distance.h"

namespace wholehand {
namespace {

namespace fs = std::filesystem;

// Increase it when samples, error or choice of a lattice, or the file format, change: older files are then made again.
constexpr std::uint32_t LATTICE_FORMAT = 2;
constexpr const char* LATTICE_SUFFIX = ".grid";
constexpr const char* PARTIAL_SUFFIX = ".partial";

using Digest = std::array<std::uint64_t, 2>;  // XXH3 of 128 bits

class Hash {
 public:
  Hash() {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_.get());
  }
  void add(const void* data, std::size_t size) { XXH3_128bits_update(state_.get(), data, size); }
  template <class T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, double>);  // no padding
    add(&value, sizeof value);
  }
  template <class T>
  void add_all(const std::vector<T>& values) {
    add(values.size());
    add(values.data(), values.size() * sizeof(T));
  }
  Digest digest() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return {hash.low64, hash.high64};
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_{XXH3_createState()};
};

std::string hex_of(const Digest& digest) { return fmt::format("{:016x}{:016x}", digest[1], digest[0]); }

Hash hash_of(const CheckedMesh& mesh) {
  Hash hash;
  hash.add(LATTICE_FORMAT);
  hash.add_all(mesh.mesh.vertices);
  hash.add_all(mesh.mesh.triangles);
  return hash;
}

Digest lattice_digest(const CheckedMesh& mesh, const PreparedLattice& lattice) {
  Hash hash = hash_of(mesh);
  for (const double x : lattice.origin) hash.add(x);
  hash.add(lattice.spacing);
  for (const int count : {lattice.nx, lattice.ny, lattice.nz, lattice.halves ? 16 : 32}) hash.add(count);
  return hash.digest();
}

// Digest of a lattice whose spacing is chosen. If the tolerance alone decides, the lattice is the same with any sufficient memory (`most_bytes` 0);
// otherwise the memory is part of the request.
Digest choice_digest(const CheckedMesh& mesh, const LatticeSpec& spec, int bits, std::uint64_t most_bytes) {
  Hash hash = hash_of(mesh);
  hash.add(spec.tolerance);
  hash.add(spec.margin);
  hash.add(bits);
  hash.add(most_bytes);
  return hash.digest();
}

// ---- files: this, the samples' words, and the hash of both ----

struct LatticeHeader {
  std::array<char, 8> magic{'w', 'h', 'g', 'r', 'i', 'd', '0', '1'};
  Digest key{};
  std::uint32_t format = LATTICE_FORMAT, bits = 0;
  std::int32_t nx = 0, ny = 0, nz = 0;
  std::uint32_t at_limit = 0;
  Triple origin{};
  double spacing = 0, error = 0;
};
static_assert(sizeof(LatticeHeader) == 88);

LatticeHeader header_of(const MeshLattice& made, const Digest& key) {
  LatticeHeader header;
  header.key = key;
  header.bits = made.lattice.halves ? 16 : 32;
  header.nx = made.lattice.nx;
  header.ny = made.lattice.ny;
  header.nz = made.lattice.nz;
  header.at_limit = made.at_limit ? 1 : 0;
  header.origin = made.lattice.origin;
  header.spacing = made.lattice.spacing;
  header.error = made.error;
  return header;
}

// Without samples.
MeshLattice lattice_of(const LatticeHeader& header) {
  MeshLattice found;
  found.lattice.origin = header.origin;
  found.lattice.spacing = header.spacing;
  found.lattice.nx = header.nx;
  found.lattice.ny = header.ny;
  found.lattice.nz = header.nz;
  found.lattice.halves = header.bits == 16;
  found.error = header.error;
  found.at_limit = header.at_limit != 0;
  return found;
}

Digest file_digest(const LatticeHeader& header, const std::vector<std::uint32_t>& words) {
  Hash hash;
  hash.add(&header, sizeof header);
  hash.add(words.data(), 4 * words.size());
  return hash.digest();
}

// How many words a file of this size holds after such a header; 0: it cannot be whole.
std::size_t words_in(const LatticeHeader& header, std::uintmax_t size) {
  const double samples = static_cast<double>(header.nx) * header.ny * header.nz;
  const double words = header.bits == 16 ? std::ceil(samples / 2) : samples;
  const bool is_whole =
      header.nx > 1 && header.ny > 1 && header.nz > 1 && static_cast<double>(size) == sizeof header + 4 * words + sizeof(Digest);
  return is_whole ? static_cast<std::size_t>(words) : 0;
}

template <class T>
bool read_value(std::istream& in, T& value) {
  return static_cast<bool>(in.read(reinterpret_cast<char*>(&value), sizeof value));
}

// The lattice in a file; none if it does not exist, is incomplete, is another one, or is not what `spec` asks for.
std::optional<MeshLattice> load_lattice_file(const fs::path& file, const Digest& key, const MeshFacts& facts,
                                             const LatticeSpec& spec) try {
  if (!fs::is_regular_file(file)) return {};  // a pipe would be waited for
  std::ifstream in(file, std::ios::binary);
  LatticeHeader header;
  if (!in || !read_value(in, header)) return {};
  if (header.magic != LatticeHeader().magic || header.format != LATTICE_FORMAT || header.key != key) return {};
  if (!(header.spacing > 0)) return {};
  const std::size_t count = words_in(header, fs::file_size(file));
  const std::optional<PreparedLattice> expected = lattice_at(facts, spec, header.spacing);
  if (count == 0 || !expected || expected->halves != (header.bits == 16)) return {};
  std::vector<std::uint32_t> words(count);
  Digest digest{};
  if (!in.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(4 * count)) || !read_value(in, digest))
    return {};
  if (digest != file_digest(header, words)) return {};
  touch_cached(file.string());
  MeshLattice found = lattice_of(header);
  found.lattice.words = std::make_shared<const std::vector<std::uint32_t>>(std::move(words));
  return found;
} catch (const std::exception&) {
  return {};
}

// Where lattices are kept, and the size limit.
struct LatticeCache {
  fs::path folder;           // empty: nowhere
  std::uintmax_t limit = 0;  // bytes; 0: nothing is kept
  fs::path lattices() const { return folder / "grids"; }
};

// A new file that no other process writes; empty if none can be made.
std::string new_partial(const fs::path& folder, const Digest& key) {
  std::string name = (folder / (hex_of(key) + ".XXXXXX" + PARTIAL_SUFFIX)).string();
  const int file = mkstemps(name.data(), static_cast<int>(std::strlen(PARTIAL_SUFFIX)));
  if (file < 0) return "";
  close(file);
  return name;
}

void save_lattice_file(const LatticeCache& cache, const Digest& key, const MeshLattice& made) try {
  const LatticeHeader header = header_of(made, key);
  const std::vector<std::uint32_t>& words = *made.lattice.words;
  const std::uintmax_t size = sizeof header + 4 * words.size() + sizeof(Digest);
  if (size > cache.limit) return;
  const fs::path folder = cache.lattices();
  fs::create_directories(folder);
  make_cache_room(cache.folder.string(), size, cache.limit);
  if (fs::space(folder).available < 2 * size) return;  // the disk is others' too
  const std::string partial = new_partial(folder, key);
  if (partial.empty()) return;
  std::ofstream out(partial, std::ios::binary);
  const Digest digest = file_digest(header, words);
  out.write(reinterpret_cast<const char*>(&header), sizeof header);
  out.write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(4 * words.size()));
  out.write(reinterpret_cast<const char*>(&digest), sizeof digest);
  out.close();
  std::error_code failed;
  if (out) fs::rename(partial, folder / (hex_of(key) + LATTICE_SUFFIX), failed);
  if (!out || failed) fs::remove(partial, failed);
  make_cache_room(cache.folder.string(), 0, cache.limit);  // others may have stored at the same time
} catch (const std::exception&) {
  // the next run makes it again
}

}  // namespace

MeshLattice cached_lattice(const CheckedMesh& mesh, const LatticeSpec& spec, const std::string& folder,
                           const LatticeProgress& progress, const LatticeForecast& forecast) {
  const auto make = [&] { return lattice_of_mesh(MeshDistance(mesh), mesh, spec, progress, forecast); };
  const LatticeCache cache{folder.empty() ? cache_folder() : folder, cache_limit()};
  if (cache.folder.empty() || cache.limit == 0) return make();
  const int bits = spec.bits.value_or(32);
  std::vector<Digest> keys;  // any file that holds the lattice has one of these
  if (!spec.spacing) {
    keys = {choice_digest(mesh, spec, bits, 0), choice_digest(mesh, spec, spec.bits.value_or(0), spec.most_bytes)};
  } else if (const std::optional<PreparedLattice> lattice = lattice_at(mesh.facts, spec, *spec.spacing)) {
    keys = {lattice_digest(mesh, *lattice)};
  }
  for (const Digest& key : keys) {
    if (auto found = load_lattice_file(cache.lattices() / (hex_of(key) + LATTICE_SUFFIX), key, mesh.facts, spec))
      return std::move(*found);
  }
  MeshLattice made = make();
  const bool by_tolerance = !made.at_limit && made.lattice.halves == (bits == 16);
  save_lattice_file(cache, spec.spacing || by_tolerance ? keys.front() : keys.back(), made);
  return made;
}

std::string mesh_key(const CheckedMesh& mesh, const PreparedLattice& lattice) { return hex_of(lattice_digest(mesh, lattice)); }

}  // namespace wholehand
