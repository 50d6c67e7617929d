// SPDX-License-Identifier: MIT
#include "sweeps/run/closing.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>

#include "base/text/printable.h"
#include "base/text/readable.h"
#include "sweeps/grips/report.h"
#include "sweeps/plan/edge.h"
#include "sweeps/result/grip_lists.h"

namespace wholehand::sweeps {
namespace {

constexpr double SURE_SHARE = 0.95;  // of the deviations of a grip, from which on its holding is sure

// Less is not worth a word.
bool is_compiling_long(const SweepTimes& times) { return times.compiling >= 1; }

double seconds(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

// Three digits, without an exponent where that is readable.
std::string short_number(double value) {
  return value >= 100 ? fixed_text(value, 0) : value >= 0.1 ? fmt::format("{:#.3g}", value) : fmt::format("{:.3g}", value);
}

// Whether a grip of a list is ranked ahead of the next one by less than the tolerance of a score.
bool is_near(const BestGrip& grip, const BestGrip& next, const ListView& view) {
  const auto are_near = [&](double a, double b) { return std::abs(a - b) <= view.score_tolerance; };
  const RobustScore &a = grip.robust, &b = next.robust;
  if (view.by == RankBy::robust && !(std::isnan(a.low) && std::isnan(b.low)))
    return a.low == b.low ? are_near(a.mean, b.mean) : are_near(a.low, b.low);
  return (view.by == RankBy::score || view.by == RankBy::robust) && are_near(grip.score, next.score);
}

// "rank 4 is within 0.00028 of the next one", "2 ranks are within 0.00028 of the next one, the first is rank 4".
std::string near_text(const std::vector<BestGrip>& best, const ListView& view) {
  std::size_t near = 0, first = 0;
  for (std::size_t k = 0; k + 1 < best.size() && best[k + 1].score > 0; ++k) {
    if (!is_near(best[k], best[k + 1], view)) continue;
    if (near++ == 0) first = best[k].rank;
  }
  if (near == 0) return "";
  const std::string within = fmt::format("within {} of the next one", plain_text(view.score_tolerance, 2));
  return near == 1 ? fmt::format("rank {} is {}", first, within)
                   : fmt::format("{} ranks are {}, the first is rank {}", readable_number(near), within, first);
}

}  // namespace

std::string opening_lines(const Scene& scene, const Plan& plan, const BackendInfo& info) {
  std::string text = fmt::format("{}: {} of {}", scene.name.empty() ? "sweep" : scene.name,
                                 counted(plan.grips() * scene.vessels.size(), "grip"), counted(scene.vessels.size(), "vessel"));
  const std::size_t states = scene.tilts.size() * scene_fills(scene);
  if (states > 0) text += fmt::format(", {} each", counted(states, "state"));
  text +=
      fmt::format("\non {}{} ({}), {} precision\n", info.device, info.backend == "vulkan" && info.is_cpu ? ", a CPU driver" : "",
                  info.driver, info.precision == Precision::single ? "single" : "double");
  if (plan.copies() > 1) {
    text += fmt::format("one azimuth stands for all {}: the vessels are bodies of revolution\n",
                        readable_count(static_cast<double>(plan.copies())));
  }
  return text;
}

std::string vessel_lines(const Scene& scene, const std::vector<VesselFacts>& facts) {
  std::string text;
  for (std::size_t v = 0; v < facts.size(); ++v) {
    const std::string holds = scene.vessels[v].has_cavity() ? short_number(facts[v].capacity * 1e6) + " mL" : "nothing";
    text += fmt::format("{}: holds {}, {} kg empty\n", scene.vessels[v].name, holds, short_number(facts[v].empty_mass));
  }
  return text;
}

std::string verdict_text(const Scene& scene, const std::vector<BestGrip>& best) {
  if (best.empty()) return has_effort(scene) ? "no grip is feasible and plausible and holds" : "no grip is feasible and plausible";
  const BestGrip& first = best.front();
  if (!has_effort(scene)) {
    return fmt::format("whether it holds is not judged without {}; grip {} scores {}", scene.strength ? "[tilts]" : "efforts",
                       first.rank, fixed_text(first.score, 3));
  }
  const double effort = first.efforts.worst, share = first.robust.share;
  if (std::isinf(effort)) return fmt::format("no grip holds; no force of the hand holds it in grip {}", first.rank);
  const int digits =
      effort < 0.0995 || (effort != 1 && std::abs(effort - 1) < 5e-3) ? 1 : 0;  // else all of the strength would be held and not
  const std::string strength =
      fmt::format("{} % of the hand's strength (margin {})", fixed_text(100 * effort, digits), fixed_text(held_margin(effort), 2));
  if (!(effort <= 1)) return fmt::format("no grip holds; grip {} takes {}", first.rank, strength);
  return fmt::format("grip {} holds with {}{}", first.rank, strength,
                     !std::isnan(share) ? fmt::format("{} in {}{} % of its deviations", share < SURE_SHARE ? ", but" : " and",
                                                      share < SURE_SHARE ? "only " : "", held_percent(share))
                     : scene.robust     ? ""
                                        : "; not judged off its place");
}

std::string gate_text(std::uint64_t at_gate, double gate_tolerance) {
  if (at_gate == 0) return "";
  // 1 / (1 + effort) has the slope -1/4 there
  return fmt::format("{} within {:.2g} % of the gate, where another backend may decide otherwise",
                     counted(at_gate, "grip is", "grips are"), 400 * gate_tolerance);
}

std::string list_lines(const Scene& scene, const Plan& plan, std::size_t vessel, const std::vector<BestGrip>& best,
                       const std::string& file, const ListView& view) {
  if (best.empty()) return "";
  std::string text = best_table(scene, plan, best, view);
  if (best.size() > view.rows)
    text += fmt::format("  .. {} more{}\n", readable_number(best.size() - view.rows),
                        file.empty() ? "; -o FILE writes all of them" : " in " + one_line(file));
  if (const std::string near = near_text(best, view); !near.empty()) text += "  " + near + "\n";
  if (!view.results.empty()) return text;  // whose ends differ
  std::vector<Candidate> candidates;
  for (const BestGrip& grip : best) candidates.push_back(grip.candidate);
  const std::string edge = edge_line(edge_axes(scene, plan, vessel, candidates));
  return edge.empty() ? text : text + "  " + edge + "\n";
}

std::string best_lines(const Scene& scene, const Plan& plan, std::size_t vessel, const std::string& counts,
                       const std::vector<std::vector<BestGrip>>& lists, const std::vector<std::string>& failures,
                       const std::string& file, const ListView& view) {
  const std::size_t scales = plan.hand_scales();
  std::string text = scales == 1 ? "" : scene.vessels[vessel].name + ": " + counts + "\n";
  for (std::size_t list = vessel * scales; list < (vessel + 1) * scales; ++list) {
    text +=
        list_name(scene, plan, list) + ": " + (failures[list].empty() ? verdict_text(scene, lists[list]) : failures[list]) + "\n";
    if (scales == 1) text += "  " + counts + "\n";
    text += list_lines(scene, plan, vessel, lists[list], file, view);
  }
  return text;
}

std::string closing_lines(const std::vector<std::string>& files, const SweepTimes& times) {
  struct stat status {};
  const double size = stat(files.front().c_str(), &status) == 0 ? static_cast<double>(status.st_size) : 0;
  std::string text = fmt::format("wrote {} ({})", one_line(files.front()), readable_bytes(size));
  for (std::size_t i = 1; i < files.size(); ++i) text += ", " + one_line(files[i]);
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  const double rate = static_cast<double>(times.written_bytes) / std::max(times.writing, 1e-9);
  const double compiling = is_compiling_long(times) ? times.compiling : 0;
  text +=
      fmt::format("\n{} s: {}kernels {}, file writing {} ({} MB/s), everything else {}; CPU {} s; peak memory {}\n",
                  fixed_text(times.wall, 2), compiling > 0 ? fmt::format("compiling kernels {}, ", fixed_text(compiling, 2)) : "",
                  fixed_text(times.kernels, 2), fixed_text(times.writing, 3), fixed_text(rate * 1e-6, 0),
                  fixed_text(times.wall - compiling - times.kernels - times.writing, 2),
                  fixed_text(seconds(usage.ru_utime) + seconds(usage.ru_stime), 2),
                  readable_bytes(1024.0 * static_cast<double>(usage.ru_maxrss)));
  return text;
}

std::string backend_line(const BackendInfo& info, const SweepTimes& times, const std::string& alternative) {
  const std::string where = info.backend == "core" ? "the CPU core"
                            : info.is_cpu          ? fmt::format("Vulkan ({}, a CPU driver)", info.device)
                                                   : fmt::format("Vulkan ({})", info.device);
  return fmt::format("computed on {}, {}, in {} s{}{}\n", where, info.precision == Precision::single ? "float" : "double",
                     fixed_text(times.wall, 1),
                     is_compiling_long(times) ? fmt::format(", {} s of it to compile kernels", fixed_text(times.compiling, 1)) : "",
                     alternative);
}

}  // namespace wholehand::sweeps
