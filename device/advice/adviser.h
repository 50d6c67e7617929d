// SPDX-License-Identifier: MIT
// Which grip would be better from here? Asks a backend for a cloud of grips about where the hand is, and the core for the best of
// them.
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

namespace wholehand {

// What is asked: how a hand stands to a vessel, and what is in it.
struct AdviceQuestion {
  int vessel = 0;
  bool is_held = false;
  GripInput grip;     // in the world of the scene
  double volume = 0;  // m3 of the scene's liquid
  // For a simulated user, who can follow no more: the line of the tips keeps its azimuth and goes through the axis.
  bool keeps_line = false;
};

constexpr std::size_t LEAST_CLOUD = 128, STEP_CLOUD = 512, MOST_CLOUD = 4096;  // grips of an update
// A grip counts as good as another whose effort is larger by no more than this share and this much: less is no reason to move.
constexpr double LIKE_SHARE = 0.05, LIKE_EFFORT = 5e-3;
// Liquid that has changed by less of the vessel's capacity is still the liquid of the last update.
constexpr double SAME_FILL = 2e-3;

// The scene that grips are rated in: one fill for each vessel, what it holds at the start of a session; the scene's own tilts or,
// without any, tens of degrees up to 150; those up to where 95 % of a fill has poured. A table lies TABLE_LOWERED lower, as a
// session has none: the adviser applies it to what it advises. Throws Error (usage): [strength] says efforts = false.
Scene advice_scene(const Scene& scene);
constexpr double TABLE_LOWERED = 2;  // m at a hand's scale of 1: further than a hand reaches from its grip

// One thread asks. The answers to the same questions in the same order are the same, to the bit, on the same device.
class Adviser {
 public:
  // Opens the device with the pipelines of all vessels, which may take seconds. `on` and `threads` as for open_backend, in float
  // where it is a device. Throws Error as advice_scene and open_backend do.
  Adviser(const Scene& scene, const std::string& on, int threads);
  // With a backend of one's own, for the scene and the fields that it is given.
  using BackendOpener = std::function<std::unique_ptr<Backend>(const Scene&, const FieldSet&)>;
  Adviser(const Scene& scene, const BackendOpener& open);

  const BackendInfo& info() const { return backend_->info(); }
  // By which the grips of an answer are rated, with the liquid of the last one.
  const Evaluator& core() const { return *core_; }
  // What it computes on now, in words: "vulkan, llvmpipe (LLVM 15.0.6, 256 bits)", or "core, 2 threads".
  std::string place() const;

  // The grips of the answer are rated by the core, the present one as a session holds it: it may go through the table, into the vessel
  // and into itself. No such grip is advised, but a held vessel has left the table. No more than `grips` are asked for. `stop`, from
  // another thread: the answer is then of what is done. A device that cannot take other liquid gives way to the core for good.
  // Throws Error (failure) where neither the device nor the core can compute it.
  Advice advise(const AdviceQuestion& question, std::size_t grips, const std::atomic<bool>* stop = nullptr);

  // What the device had to say since the last call ("device lost: .."); each line once.
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
  std::unique_ptr<Evaluator> session_;  // to which every feasible grip is plausible; made when it is needed
  std::vector<double> volumes_;         // with which the backend computes, m3
  std::vector<double> capacities_;
  std::uint64_t turn_ = 0;
  double lowered_ = 0;             // m, by which the table lies lower than the scene's
  int vessel_ = -1;                // of the question
  bool stands_ = true;             // that vessel, on the table
  std::optional<GripInput> last_;  // its best grip
  double share_ = 1;               // of the reach in which the next update looks about it
  std::vector<std::string> notes_, noted_;
};

}  // namespace wholehand
