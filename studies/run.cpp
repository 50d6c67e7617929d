// SPDX-License-Identifier: MIT
#include "studies/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/parallel.h"
#include "studies/contacts.h"
#include "studies/output.h"
#include "studies/page.h"
#include "studies/summary.h"
#include "studies/table.h"
#include "sweeps/closing.h"
#include "system/file_set.h"
#include "system/files.h"
#include "system/interrupt.h"
#include "system/output.h"
#include "system/output_lock.h"
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

// They get their names once all are whole.
void write_study(const StudyFiles& files, const Scene& scene, const StudyOptions& options, const ContactPlan& plan,
                 const ContactStudy& study) {
  FileSet set;
  try {
    // the table gets its name first: beside it a folder's study.nc is known as ours
    set.write(files.csv, study_csv(study.rows), STUDY_REMEDY);
    write_study_dataset(set.on_the_way(files.nc), scene, options, study.rows);
    set.write(files.page, study_page(scene, options, plan, study.rows), STUDY_REMEDY);
    set.give_names(STUDY_REMEDY);
  } catch (const Error& error) {
    throw Error(error.code, set.with_own_names(error.what()), error.remedy);
  }
}

}  // namespace

ExitCode run_study(const Scene& scene, const StudyOptions& options) {
  const ContactPlan plan(scene);
  prepare_study_folder(options.folder);
  const StudyFiles files(options.folder);
  const OutputLock lock(files.lock, "folder");
  remove_unfinished_study(files);
  InterruptGuard interrupt;
  say_opening(scene, options, plan);
  const std::optional<ContactStudy> study = study_contacts(plan, options, interrupt.flag());
  if (!study) {
    say_note("interrupted; nothing is written");
    return ExitCode::interrupted;
  }
  write_study(files, scene, options, plan, *study);
  print(study_summary(study->rows));
  print(fmt::format("\nwrote {}, {}, {}\n", files.csv, files.nc, files.page));
  return ExitCode::done;
}

}  // namespace wholehand
