// SPDX-License-Identifier: MIT
// The grasps that a person makes in the experiment of contacts, and their results.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/evaluator.h"
#include "core/people/person.h"
#include "core/scene.h"
#include "evidence/studies/contact_tally.h"
#include "evidence/studies/paper_sample.h"

namespace wholehand {

// The poses in which each grasp is evaluated.
constexpr std::array<Pose, 2> STUDY_POSES{Pose::paper, Pose::articulated};
extern const std::array<const char*, STUDY_POSES.size()> STUDY_POSE_NAMES;

// A vessel with guidance points.
struct StudyVessel {
  std::size_t place = 0;  // in the scene
  std::string name;
  std::size_t sample = 0;           // grasps at the paper's size
  bool is_of_paper = false;         // stands for one of the paper's three, and counts in `all`
  std::size_t first = 0, last = 0;  // its planned grasps [first, last)
};

struct PlannedGrasp {
  std::size_t vessel = 0;    // of the study
  std::size_t point = 0;     // guidance point
  std::uint64_t number = 0;  // names the grasp's own draws
  GripInput grip;            // before adding the person's own habits and scatter
  Triple place{};            // of the guidance point on the surface, vessel frame, m
};

// All grasps of one person. The same for every person of a scene; may be used by any thread.
class ContactPlan {
 public:
  // `scene` must outlive the plan. Throws Error (usage) if no vessel has guidance points, one is named ALL_VESSELS, or the gap of the scene's hand
  // does not fall as it closes.
  explicit ContactPlan(const Scene& scene);

  const std::vector<StudyVessel>& vessels() const { return vessels_; }
  const std::vector<PlannedGrasp>& grasps() const { return grasps_; }
  // Guidance points at which the mean person cannot hold the vessel with any roll: "beaker1 at 65 mm".
  const std::vector<std::string>& unheld() const { return unheld_; }

  // The grasps of person `number`: grasps() in the first of STUDY_POSES, then in the next.
  std::vector<ContactGrasp> of_person(std::uint64_t seed, std::uint64_t number) const;

 private:
  void plan_vessel(const Evaluator& core, StudyVessel& vessel);

  const Scene& scene_;
  std::vector<StudyVessel> vessels_;
  std::vector<PlannedGrasp> grasps_;
  std::vector<std::string> unheld_;
  std::array<Scene, STUDY_POSES.size()> bare_;  // the vessels of the study, with only what touching needs
};

}  // namespace wholehand
