// SPDX-License-Identifier: MIT
// Finds a better grip from the hand's present place: a backend evaluates a cloud of grips about it, and the core rates the best of them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"
#include "device/advice/advice.h"

namespace wholehand::device {

// The question: how a hand stands to a vessel, and what the vessel contains.
struct AdviceQuestion {
  int vessel = 0;
  bool is_held = false;
  GripInput grip;     // in the world of the scene
  double volume = 0;  // m3 of the scene's liquid
  // For a simulated user, who can follow nothing else: the line of the tips keeps its azimuth and passes through the axis.
  bool keeps_line = false;
};

constexpr std::size_t LEAST_CLOUD = 128, STEP_CLOUD = 512, MOST_CLOUD = 4096;  // grips of an update
// Two grips count as equally good if the efforts differ by no more than this share and this much; that is no reason to move.
constexpr double LIKE_SHARE = 0.05, LIKE_EFFORT = 5e-3;
// Liquid that has changed by less than this share of the vessel's capacity counts as unchanged since the last update.
constexpr double SAME_FILL = 2e-3;

// The scene in which grips are rated. Each vessel has one fill, its content at the start of a session. Tilts are the scene's own, or tens of degrees
// up to 150, up to where 95 % of a fill has poured. A table lies TABLE_LOWERED lower, because a session has none; the adviser applies the true table
// to what it advises. Throws Error (usage) if [strength] says efforts = false.
Scene advice_scene(const Scene& scene);
constexpr double TABLE_LOWERED = 2;  // m at a hand's scale of 1: further than a hand reaches from its grip

// Only one thread may ask. On one device, the same questions in the same order give the same answers to the bit.
class Adviser {
 public:
  // Opens the device with the pipelines of all vessels, which may take seconds. `on` and `threads` as for open_backend; devices compute in float.
  // Throws Error as advice_scene and open_backend do.
  Adviser(const Scene& scene, const std::string& on, int threads);
  // With a custom backend, for the scene and the fields that it gets.
  using BackendOpener = std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)>;
  Adviser(const Scene& scene, const BackendOpener& open);

  const BackendInfo& info() const { return backend_->info(); }
  // The core that rates an answer's grips, with the last answer's liquid.
  const Evaluator& core() const { return *core_; }
  // What it computes on now, for people: "vulkan, llvmpipe (LLVM 15.0.6, 256 bits)", or "core, 2 threads".
  std::string place() const;

  // The core rates the answer's grips. It rates the present grip as a session holds it: it may pass through the table, the vessel and itself. Such
  // grips are never advised, but a held vessel has left the table. At most `grips` are evaluated. `stop`, from another thread, ends early with what
  // is done. A device that cannot change the liquid is replaced by the core for good. Throws Error (failure) if neither device nor core can compute
  // it.
  Advice advise(const AdviceQuestion& question, std::size_t grips, const std::atomic<bool>* stop = nullptr);

  // Messages of the device since the last call ("device lost: .."); each line once.
  std::vector<std::string> notes();

 private:
  struct Found {
    double effort = 0;
    std::size_t grip = 0;  // of the cloud
  };
  void warm_up();
  void take_volume(int vessel, double volume);
  void go_on_with_core(const std::string& why);
  bool is_allowed(std::uint32_t status, double table_depth) const;
  std::vector<Found> ask(int vessel, const std::vector<GripInput>& cloud, const std::atomic<bool>* stop);
  RatedGrip rate(const Evaluator& core, int vessel, const GripInput& grip, bool is_advised) const;
  RatedGrip rate_advised(const GripInput& grip) const { return rate(*core_, vessel_, grip, true); }
  RatedGrip rate_present(const GripInput& grip);
  std::vector<RatedGrip> rate_best(const GripInput& present, const std::vector<GripInput>& cloud, std::vector<Found> found) const;
  void choose(const std::vector<RatedGrip>& rated, Advice& advice) const;
  void settle(bool has_moved);

  Scene scene_;
  FieldSet fields_, rated_;
  std::unique_ptr<Backend> backend_;
  std::unique_ptr<Evaluator> core_;
  std::unique_ptr<Evaluator> session_;  // every feasible grip is plausible to it; made when needed
  std::vector<double> volumes_;         // with which the backend computes, m3
  std::vector<double> capacities_;
  std::uint64_t turn_ = 0;
  double lowered_ = 0;             // m, how much lower the table lies than the scene's
  int vessel_ = -1;                // of the question
  bool stands_ = true;             // that vessel, on the table
  std::optional<GripInput> last_;  // its best grip
  double share_ = 1;               // share of the reach in which the next update searches about it
  std::vector<std::string> notes_, noted_;
};

}  // namespace wholehand::device
