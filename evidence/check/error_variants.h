// SPDX-License-Identifier: MIT
// The ways to evaluate a scene that `wholehand error-time` compares: each shortcut varied with the others at their defaults, and useful combinations.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/backend.h"
#include "core/evaluator.h"
#include "host/shaders.h"

namespace wholehand {

// Which of a variant's answers mean the same as the reference's. A variant that answers another question has some that do not.
struct Comparable {
  bool pose = true;      // separations, posed joints, proxies, touches
  bool states = true;    // the liquid, torque and forces
  bool outcomes = true;  // whether a grip is feasible
};

// The varied approximation, for the fit of its convergence; `step`: the error should be a power of it.
enum class SweptAxis { none, lattice, tolerance, gap_table, points, effort };

struct ErrorVariant {
  std::string name;
  bool on_core = true;
  Precision precision = Precision::full;
  int threads = 0;  // of the core
  OutlineSource outline = OUTLINE_COPIED;
  EvaluatorOptions options;
  std::string left_out;                // omitted parts of the scene or the pipelines; "+ ..": parts kept
  std::shared_ptr<const Scene> scene;  // null: the scene as it is
  Comparable comparable;
  SweptAxis axis = SweptAxis::none;
  double step = 0;

  bool answers_the_question() const { return comparable.pose && comparable.states && comparable.outcomes; }
  double stop_tolerance() const;    // m
  double effort_tolerance() const;  // relative
};

struct VariantChoice {
  bool quick = false;
  int threads = 1;               // all that the core may take
  bool device = false;           // a Vulkan device too
  bool device_double = false;    // .. in double precision
  bool device_outlines = false;  // .. whose loops take these outlines
  bool outline_copies = false;   // .. and whose kernels copy them
};

// The reference: the core in double, the exact outline, the tightest tolerances.
EvaluatorOptions reference_options();

// Leaves out those that need what the scene lacks. Variants on one evaluator follow each other.
std::vector<ErrorVariant> error_variants(const Scene& scene, const VariantChoice& choice);

}  // namespace wholehand
