// SPDX-License-Identifier: MIT
#include "core/meshes/sampling.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/numbers/half.h"
#include "base/numbers/parallel.h"
#include "base/system/clock.h"
#include "core/lattice.h"

namespace wholehand {
namespace {

constexpr double TIMED_SECONDS = 0.2;  // of a lattice's work, before its time is estimated
constexpr int BLOCK = 8;               // cells along a side of a block, for which the winding number's slope is bounded at once

// Halves of two rows may share a word, and rows are taken by different threads.
void store_row(const std::vector<float>& row, std::size_t first, bool halves, std::vector<std::uint32_t>& words) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::size_t at = first + i;
    std::atomic_ref<std::uint32_t> word(words[word_index(at, halves)]);
    word.fetch_or(sample_bits(row[i], at, halves), std::memory_order_relaxed);
  }
}

}  // namespace

double forecast_seconds(std::size_t done, std::size_t all, double seconds) {
  return done > 0 ? seconds * static_cast<double>(all) / static_cast<double>(done) : 0;
}

LatticeSampler::LatticeSampler(const MeshDistance& distance, const PreparedLattice& lattice, int threads)
    : distance_(distance), lattice_(lattice), threads_(threads) {
  if (distance.sign() != MeshSign::winding) return;
  const auto blocks = [](int samples) { return static_cast<std::size_t>((samples + BLOCK - 1) / BLOCK); };
  blocks_x_ = blocks(lattice.nx);
  blocks_y_ = blocks(lattice.ny);
  const std::size_t layer = blocks_x_ * blocks_y_, layers = blocks(lattice.nz);
  slopes_.resize(layer * layers);
  const double half = lattice.spacing * BLOCK / 2, radius = half * std::sqrt(3.0);
  in_parallel(layers, threads, [&](std::size_t z) {
    for (std::size_t i = 0; i < layer; ++i) {
      const Triple low = lattice_place(lattice, static_cast<int>(i % blocks_x_) * BLOCK, static_cast<int>(i / blocks_x_) * BLOCK,
                                       static_cast<int>(z) * BLOCK);
      slopes_[z * layer + i] = distance.winding_slope({low[0] + half, low[1] + half, low[2] + half}, radius);
    }
  });
}

// In the cells from sample i to the next one.
double LatticeSampler::slope_at(int i, int j, int k) const {
  if (slopes_.empty()) return 0;
  const auto block = [](int sample) { return static_cast<std::size_t>(sample / BLOCK); };
  return slopes_[(block(k) * blocks_y_ + block(j)) * blocks_x_ + block(i)];
}

// Whether the side of a sample, which is `from`, is that of the next one along an axis. If so, sets `side`, with the room that is left.
bool LatticeSampler::keeps_side(const SidedSample& from, int i, int j, int k, MeshSide& side) const {
  const double room = from.side.room - lattice_.spacing * slope_at(i, j, k);
  if (!(from.away > lattice_.spacing * (1 + 1e-6)) || !(room > 0)) return false;
  side = {from.side.is_inside, room};
  return true;
}

// The triangle nearest to one sample is near to the next.
void LatticeSampler::take_row(int j, int k, bool has_row_before, std::vector<SidedSample>& line) const {
  std::uint32_t nearest = 0;
  for (int i = 0; i < lattice_.nx; ++i) {
    const Triple p = lattice_place(lattice_, i, j, k);
    SidedSample& sample = line[static_cast<std::size_t>(i)];
    const bool is_known = (i > 0 && keeps_side(*(&sample - 1), i - 1, j, k, sample.side)) ||
                          (has_row_before && keeps_side(sample, i, j - 1, k, sample.side));
    if (!is_known) sample.side = distance_.side(p);
    sample.away = distance_.distance(p, nearest);
  }
}

std::vector<std::uint32_t> LatticeSampler::take_all(const LatticeProgress& progress) const {
  const auto nx = static_cast<std::size_t>(lattice_.nx), planes = static_cast<std::size_t>(lattice_.nz),
             all = nx * lattice_.ny * planes;
  std::vector<std::uint32_t> words(lattice_words(all, lattice_.halves));
  const auto sample_plane = [&](std::size_t k) {
    std::vector<SidedSample> line(nx);
    std::vector<float> row(nx);
    for (int j = 0; j < lattice_.ny; ++j) {
      take_row(j, static_cast<int>(k), j > 0, line);
      std::transform(line.begin(), line.end(), row.begin(), [](const SidedSample& sample) {
        return static_cast<float>(sample.side.is_inside ? -sample.away : sample.away);
      });
      store_row(row, (k * lattice_.ny + j) * nx, lattice_.halves, words);
    }
  };
  std::function<void(std::size_t)> report_planes;
  if (progress) report_planes = [&](std::size_t done) { progress(static_cast<double>(done) / static_cast<double>(planes)); };
  in_parallel(planes, threads_, sample_plane, report_planes);
  return words;
}

double LatticeSampler::forecast(const std::function<double()>& clock) const {
  const auto now = [&] { return clock ? clock() : monotonic_now(); };
  const std::size_t all = static_cast<std::size_t>(lattice_.ny) * lattice_.nz,
                    step = static_cast<std::size_t>(0.618 * static_cast<double>(all)) | 1u;
  const auto sample_one = [&](std::size_t number) {
    std::vector<SidedSample> line(lattice_.nx);
    const std::size_t place = number * step % all;
    take_row(static_cast<int>(place % lattice_.ny), static_cast<int>(place / lattice_.ny), false, line);
  };
  const double start = now();
  double seconds = 0;
  std::size_t done = 0;
  for (std::size_t more = thread_count(threads_); done < all; more = std::min(2 * more, all - done)) {
    more = std::min(more, all - done);
    in_parallel(more, threads_, [&](std::size_t i) { sample_one(done + i); });
    done += more;
    seconds = now() - start;
    if (seconds >= TIMED_SECONDS || 32 * done >= all) break;
  }
  return forecast_seconds(done, all, seconds);
}

}  // namespace wholehand
