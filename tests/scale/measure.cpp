// SPDX-License-Identifier: MIT
#include "tests/scale/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "sweeps/cluster/packet.h"
#include "sweeps/lists/hand_lists.h"
#include "sweeps/result/mark.h"
#include "tests/scale/simulated_backend.h"

namespace wholehand::scale {
namespace {

constexpr std::size_t LIST = 16'384;  // grips that a pass keeps
constexpr int TIMES = 7;

// The least of some, since other work only adds to a time.
double least_seconds(const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < TIMES; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return least;
}

std::vector<Candidate> random_grips(std::size_t count, double low, double high, std::uint64_t first) {
  std::mt19937_64 random(first);
  std::uniform_real_distribution<double> score(low, high);
  std::vector<Candidate> grips;
  for (std::size_t k = 0; k < count; ++k) grips.push_back({score(random), first + k});
  return grips;
}

double report_seconds(const sweeps::Plan& plan, const sweeps::HandLists& list, const std::vector<Candidate>& grips) {
  sweeps::PacketWriter writer;
  writer.put(grips);
  sweeps::HandLists own = list;
  double taken = std::numeric_limits<double>::infinity();
  for (int k = 0; k < TIMES; ++k) {
    own.~HandLists();
    new (&own) sweeps::HandLists(plan, LIST, list.all());
    const auto start = std::chrono::steady_clock::now();
    sweeps::PacketReader reader(writer.bytes());
    own.offer(reader.take_all<Candidate>());
    taken = std::min(taken, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return taken / static_cast<double>(grips.size());
}

}  // namespace

void measure() {
  const Scene scene = simulated_scene(100'000'000, 100);
  const sweeps::Plan plan(scene, false);
  sweeps::HandLists list(plan, LIST, {});
  list.offer(random_grips(LIST, 0.5, 1, 0));
  fmt::print("an entry of a report that rank 0 refuses: {:.3g} s\n",
             report_seconds(plan, list, random_grips(LIST, 0, 0.5, 1 << 20)));
  fmt::print("an entry of a report that it takes: {:.3g} s\n", report_seconds(plan, list, random_grips(LIST, 1, 2, 1 << 20)));
  const std::string path = (std::filesystem::temp_directory_path() / "wholehand-scale.mark").string();
  const auto mark_of = [&](std::size_t stretches) {
    sweeps::SweepMark mark;
    sweeps::VesselProgress& vessel = mark.vessels.emplace_back();
    vessel.best = list.all();
    vessel.heat_map.assign(LIST, 0.123456789);
    for (std::size_t k = 0; k < stretches; ++k)
      vessel.stretches.push_back({k * 1'000'000, (k + 1) * 1'000'000, std::string(32, 'a')});
    return mark;
  };
  const sweeps::SweepMark small = mark_of(0), large = mark_of(100'000);
  const double without = least_seconds([&] { sweeps::save_mark(path, small); }),
               with = least_seconds([&] { sweeps::save_mark(path, large); });
  const double bytes = static_cast<double>(std::filesystem::file_size(path));
  fmt::print("a mark of two lists of {}: {:.3g} s; a line of a mark: {:.3g} s, {:.0f} bytes\n", LIST, without,
             (with - without) / 1e5, bytes / (1e5 + 2 * LIST));
  std::filesystem::remove(path);
}

}  // namespace wholehand::scale
