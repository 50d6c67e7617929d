// SPDX-License-Identifier: MIT
#include "studies/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/parallel.h"
#include "studies/contact_page.h"
#include "studies/contacts.h"
#include "studies/folder.h"
#include "studies/page.h"
#include "studies/summary.h"
#include "sweeps/closing.h"
#include "system/interrupt.h"
#include "system/output.h"
#include "system/readable.h"

namespace wholehand {
namespace {

void say_opening(const Scene& scene, const StudyOptions& options, const ContactPlan& plan) {
  print(fmt::format("{}: contacts, {} people with {} each, in {} poses; {}\n", scene.name.empty() ? "study" : scene.name,
                    readable_number(options.people), counted(plan.grasps().size(), "grasp"), STUDY_POSES.size(),
                    counted(static_cast<std::uint64_t>(thread_count(options.threads)), "thread")));
  if (!plan.unheld().empty())
    say_note(fmt::format("the mean person cannot hold {}: there everybody plans no roll", fmt::join(plan.unheld(), ", ")));
}

StudyPage page_of(const Scene& scene, const StudyOptions& options, const ContactPlan& plan, const ContactStudy& study) {
  StudyPage page;
  page.title = study_title(scene);
  page.seed = options.seed;
  page.lead = fmt::format("{} virtual people with {} each, and {} samples of the paper's size; seed {}.",
                          readable_number(options.people), counted(plan.grasps().size(), "grasp"),
                          readable_number(static_cast<std::uint64_t>(options.resamples)), options.seed);
  add_contact_sections(page, plan, study.rows);
  return page;
}

}  // namespace

ExitCode run_study(const Scene& scene, const StudyOptions& options) {
  const ContactPlan plan(scene);
  const StudyFolder folder(options.folder);
  InterruptGuard interrupt;
  say_opening(scene, options, plan);
  const std::optional<ContactStudy> study = study_contacts(plan, options, interrupt.flag());
  if (!study) {
    say_note("interrupted; nothing is written");
    return ExitCode::interrupted;
  }
  folder.write(scene, options, page_of(scene, options, plan, *study), study->rows);
  print(study_summary(study->rows));
  print("\n" + folder.written() + "\n");
  return ExitCode::done;
}

}  // namespace wholehand
