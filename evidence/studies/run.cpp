// SPDX-License-Identifier: MIT
#include "evidence/studies/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "base/files/checksum.h"
#include "base/numbers/parallel.h"
#include "base/system/build_id.h"
#include "base/system/interrupt.h"
#include "base/system/output.h"
#include "base/system/version.h"
#include "base/text/readable.h"
#include "base/text/text.h"
#include "core/meshes/vessel.h"
#include "device/advice/adviser.h"
#include "device/loop/gains.h"
#include "evidence/studies/advice_statistics.h"
#include "evidence/studies/answer.h"
#include "evidence/studies/contact_page.h"
#include "evidence/studies/contact_pool.h"
#include "evidence/studies/contacts.h"
#include "evidence/studies/folder.h"
#include "evidence/studies/force_page.h"
#include "evidence/studies/forces.h"
#include "evidence/studies/grasp_table.h"
#include "evidence/studies/journal.h"
#include "evidence/studies/page.h"
#include "evidence/studies/paper_sample.h"
#include "evidence/studies/people_loop.h"
#include "evidence/studies/person_answers.h"
#include "evidence/studies/sensitivity_page.h"
#include "evidence/studies/session_charts.h"
#include "evidence/studies/session_page.h"
#include "evidence/studies/session_statistics.h"
#include "evidence/studies/sessions.h"
#include "evidence/studies/statistic_words.h"
#include "evidence/studies/summary.h"

namespace wholehand {
namespace {

std::string name_of(const Scene& scene) { return scene.file.empty() ? "the scene" : scene.file; }

class StudyRun {
 public:
  StudyRun(const Scene& scene, const StudyOptions& options) : scene_(scene), options_(options) {
    if (options.people.contacts > 0) contacts_.emplace(scene);
    if (options.people.sessions > 0) {
      if (!scene.task) {
        const bool has_guidance = std::any_of(scene.vessels.begin(), scene.vessels.end(),
                                              [](const VesselData& vessel) { return !vessel.guidance.empty(); });
        throw usage_error(
            fmt::format("{}: sessions need a task, which says what is poured; add [task] to the scene, or ask for "
                        "--experiment {}forces",
                        name_of(scene), has_guidance ? "contacts or " : ""));
      }
      session_vessels_ = session_vessels(scene);
      check_live(scene);
    }
    if (options.people.forces > 0) {
      const std::vector<std::size_t> vessels = paper_vessels(scene, SampleVessels::any);
      if (vessels.empty())
        throw usage_error(
            fmt::format("{}: the scene has a task, and no vessel has a liquid to be lifted; people lift such a vessel in "
                        "the experiment of forces",
                        name_of(scene)));
      force_vessel_ = vessels.front();
      check_live(force_scene(scene, force_vessel_));
    }
    if (options.people.advice > 0) {
      if (!scene.task)
        throw usage_error(fmt::format(
            "{}: the experiment of advice needs a task, which says what is poured; add [task] to the scene", name_of(scene)));
      device::advice_scene(scene);  // refuses a scene without strengths
      check_live(scene);
    }
    folder_.emplace(options.folder, contacts_ ? options.people.contacts * contacts_->grasps().size() * STUDY_POSES.size() : 0);
    page_.title = study_title(scene);
    page_.seed = options.seed;
  }

  ExitCode run() {
    InterruptGuard interrupt;
    stop_ = &interrupt.flag();
    if (std::max({options_.people.forces, options_.people.sessions, options_.people.advice}) > 0) open_journal();
    const bool done = run_contacts() && run_forces() && run_sessions() && run_advice();
    if (!done) {
      print_note(journal_ ? "interrupted; no table is written. Go on with --resume" : "interrupted; nothing is written");
      return ExitCode::interrupted;
    }
    if (!sensitivity_.empty()) page_.sections.push_back(sensitivity_section(sensitivity_));
    const std::string note = few_people_note(fewest_people());
    page_.lead =
        fmt::format("{}, and {} samples of the paper's size; seed {}.{}", joined(lead_, "; "),
                    readable_number(static_cast<std::uint64_t>(options_.resamples)), options_.seed, note.empty() ? "" : " " + note);
    const std::string inside = count_inside(rows_).of > 0 ? inside_sentence(rows_) : "";
    StudyRow share;
    share.experiment = share.vessel = ALL_VESSELS;
    share.statistic = INSIDE_SHARE;
    share.value = inside_share(rows_);
    page_.sections.insert(page_.sections.begin(), answer_section(rows_));
    rows_.insert(rows_.end(), sensitivity_.begin(), sensitivity_.end());
    if (!inside.empty()) rows_.push_back(share);
    const StudyPeople& people = options_.people;
    folder_->add_people(scene_.people, options_.seed, std::max({people.contacts, people.forces, people.sessions, people.advice}));
    folder_->write(scene_, options_, page_, rows_);
    print(study_summary(rows_));
    if (!inside.empty()) print("\nAll experiments: " + inside + "\n");
    if (!note.empty()) print("\n" + note + "\n");
    print("\n" + folder_->written() + "\n");
    end_journal();
    return ExitCode::done;
  }

 private:
  // The smallest number of people in an experiment that runs.
  std::uint64_t fewest_people() const {
    const StudyPeople& people = options_.people;
    std::uint64_t fewest = 0;
    for (const std::uint64_t count : {people.contacts, people.forces, people.sessions, people.advice})
      if (count > 0 && (fewest == 0 || count < fewest)) fewest = count;
    return fewest;
  }

  // Shares over all people of the sessions, which have no interval at the paper's sample size.
  static void add_share(std::vector<StudyRow>& rows, std::uint64_t people, const char* statistic, std::uint64_t yes,
                        std::uint64_t of) {
    StudyRow row;
    row.experiment = "sessions";
    row.vessel = ALL_VESSELS;
    row.statistic = statistic;
    row.value = static_cast<double>(yes) / static_cast<double>(of);
    row.count.people = people;
    rows.push_back(row);
  }

  // Refuses before any work what `wholehand live` would refuse: vessels in each other, nothing to do for the scene's own hand, unstable gains.
  static void check_live(const Scene& scene) {
    const device::LiveScene live(scene);
    device::plan_sim_jobs(scene);
    device::refuse_unstable_gains(scene, {live.hand.scale * live.hand.gap_closed, live.hand.scale * live.hand.gap_open}, false);
  }

  void say(const std::string& what) const {
    print(fmt::format("{}: {}; {}\n", scene_.name.empty() ? "study" : scene_.name, what,
                      counted(static_cast<std::uint64_t>(thread_count(options_.threads)), "thread")));
  }

  // The journal of the experiments that take long for each person.
  void open_journal() {
    const StudyIdentity identity{{"text of the scene", checksum_text(scene_.text.data(), scene_.text.size())},
                                 {"set of meshes", mesh_keys(scene_)},
                                 {"seed", fmt::format("{}", options_.seed)},
                                 {JOURNAL_BUILD, fmt::format("{} {}", version(), build_id())}};
    const std::size_t given_up = options_.resumes ? 0 : parts_in_journal(folder_->files().journal);
    journal_ = std::make_unique<StudyJournal>(folder_->files().journal, identity, options_.resumes);
    if (given_up > 0)
      print_note(fmt::format("{} of an interrupted study are given up; --resume would have kept them", counted(given_up, "part")));
    if (journal_->done() > 0) {
      const std::size_t forces = journal_->people_done("forces", options_.people.forces),
                        sessions = journal_->people_done("sessions", options_.people.sessions);
      if (options_.people.advice > 0)
        print_note(fmt::format("goes on: {} of {} people of advice are done",
                               readable_number(journal_->people_done("advice", options_.people.advice)),
                               readable_number(options_.people.advice)));
      if (options_.people.forces > 0 || options_.people.sessions > 0)
        print_note(fmt::format("goes on: {} of {} people of forces and {} of {} people of sessions are done",
                               readable_number(forces), readable_number(options_.people.forces), readable_number(sessions),
                               readable_number(options_.people.sessions)));
    } else if (options_.resumes) {
      print_note("there is no interrupted study in this folder; it begins anew");
    }
    if (journal_->damaged() > 0)
      print_note(
          fmt::format("the journal has {} that cannot be read; these people are done again", counted(journal_->damaged(), "line")));
  }

  // Keeps what other people or experiments have done.
  void end_journal() {
    if (!journal_) return;
    const std::size_t others = journal_->done_beside(options_.people.forces, options_.people.sessions, options_.people.advice);
    journal_.reset();
    if (others == 0) {
      std::remove(folder_->files().journal.c_str());
    } else {
      print_note(fmt::format("{} stays: it has {} of people or experiments that were not asked for now", folder_->files().journal,
                             counted(others, "part")));
    }
  }

  void keep(std::vector<StudyRow> rows, std::vector<StudyRow> sensitivity) {
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    sensitivity_.insert(sensitivity_.end(), sensitivity.begin(), sensitivity.end());
  }

  bool run_contacts() {
    if (!contacts_) return true;
    const std::uint64_t people = options_.people.contacts;
    const std::string grasps = counted(contacts_->grasps().size(), "grasp");
    say(fmt::format("contacts, {} with {} each, in {} poses", counted(people, "person", "people"), grasps, STUDY_POSES.size()));
    if (!contacts_->unheld().empty())
      print_note(
          fmt::format("the mean person cannot hold {}: there everybody plans the roll 0", joined(contacts_->unheld(), ", ")));
    std::optional<ContactStudy> study =
        study_contacts(*contacts_, options_, *stop_, [this](std::uint64_t person, std::span<const ContactGrasp> made) {
          folder_->add_grasps(contact_grasp_rows(*contacts_, table_person(scene_.people, options_.seed, person), made));
        });
    if (!study) return false;
    add_contact_sections(page_, *contacts_, study->rows);
    lead_.push_back(fmt::format("contacts: {} with {} each", counted(people, "virtual person", "virtual people"), grasps));
    keep(std::move(study->rows), std::move(study->sensitivity));
    return true;
  }

  bool run_forces() {
    const std::uint64_t people = options_.people.forces;
    if (people == 0) return true;
    const std::string& vessel = scene_.vessels[force_vessel_].name;
    say(fmt::format("forces, {} with {} choices each, on {}", counted(people, "person", "people"), FORCE_CHOICES, vessel));
    const auto numbers = of_people("forces", people, options_.threads, *journal_, *stop_, [this](std::uint64_t person) {
      return to_numbers(forces_of_person(scene_, force_vessel_, options_.seed, person, *stop_));
    });
    if (*stop_) return false;
    std::vector<ForcesOfPerson> found;
    for (const auto& of_person : numbers) {
      found.push_back(forces_from_numbers(of_person));
      folder_->add_grasps(force_grasp_rows(vessel, table_person(scene_.people, options_.seed, found.size() - 1), found.back()));
    }
    const auto gripped = std::count_if(found.begin(), found.end(), [](const ForcesOfPerson& forces) {
      return std::all_of(forces.begin(), forces.end(), [](const ForceOutcome& one) { return one.has_gripped; });
    });
    if (static_cast<std::uint64_t>(gripped) < people)
      print_note(fmt::format("{} of {} people did not grip in every trial; they are left out where they did not",
                             readable_number(people - static_cast<std::uint64_t>(gripped)), readable_number(people)));
    std::vector<StudyRow> rows = force_rows(found, vessel, options_.seed, options_.resamples, options_.threads);
    page_.sections.push_back(force_section(rows));
    lead_.push_back("forces: " + counted(people, "person", "people"));
    keep(std::move(rows), force_sensitivity(found, options_.seed));
    return true;
  }

  bool run_sessions() {
    const std::uint64_t people = options_.people.sessions;
    if (people == 0) return true;
    say(fmt::format("sessions, {} the task {} times", counted(people, "person who does", "people who do"), SESSIONS_PER_PERSON));
    const auto numbers = of_people("sessions", people, options_.threads, *journal_, *stop_, [this](std::uint64_t person) {
      return to_numbers(sessions_of_person(scene_, options_.seed, person, *stop_));
    });
    if (*stop_) return false;
    std::vector<SessionSubject> found;
    std::uint64_t broken = 0, without = 0;
    for (const auto& of_person : numbers) {
      PersonSessions sessions = sessions_from_numbers(of_person);
      broken += static_cast<std::uint64_t>(sessions.broken);
      without += sessions.grasps.empty() ? 1 : 0;
      folder_->add_grasps(session_grasp_rows(scene_, table_person(scene_.people, options_.seed, found.size()), sessions.grasps));
      found.push_back({std::move(sessions.grasps)});
    }
    if (broken > 0)
      print_note(
          fmt::format("{} did not come to an end by themselves; what was done until then counts", counted(broken, "session")));
    std::vector<StudyRow> rows = session_rows(found, session_vessels_, {options_.seed, options_.resamples, options_.threads, true});
    add_share(rows, people, "people_with_grasps_share", people - without, people);
    add_share(rows, people, "whole_sessions_share", people * SESSIONS_PER_PERSON - broken, people * SESSIONS_PER_PERSON);
    page_.sections.push_back(session_section(session_vessels_, rows, true));
    page_.sections.back().charts = session_charts(found, session_vessels_, rows);
    lead_.push_back(fmt::format("sessions: {}, {} each", counted(people, "person", "people"), SESSIONS_PER_PERSON));
    keep(std::move(rows), session_sensitivity(found, session_vessels_, options_.seed));
    return true;
  }

  bool run_advice() {
    const std::uint64_t people = options_.people.advice;
    if (people == 0) return true;
    say(fmt::format("advice, {} the task without and with it", counted(people, "person who does", "people who do")));
    const auto numbers = of_people("advice", people, options_.threads, *journal_, *stop_, [this](std::uint64_t person) {
      return to_numbers(advised_person(scene_, options_.seed, person, *stop_));
    });
    if (*stop_) return false;
    std::vector<AdvisedPerson> found;
    for (const auto& of_person : numbers) found.push_back(person_from_numbers(of_person));
    const auto broken = std::count_if(found.begin(), found.end(),
                                      [](const AdvisedPerson& one) { return one.without.is_whole == 0 || one.with.is_whole == 0; });
    if (broken > 0)
      print_note(fmt::format("{} of {} people have a session that did not come to an end by itself; their times do not count",
                             readable_number(static_cast<std::uint64_t>(broken)), readable_number(people)));
    std::vector<StudyRow> rows = advice_rows(found, options_.seed, options_.resamples, options_.threads);
    page_.sections.push_back(advice_section(rows));
    lead_.push_back("advice: " + counted(people, "person", "people"));
    keep(std::move(rows), {});
    return true;
  }

  const Scene& scene_;
  const StudyOptions& options_;
  std::optional<ContactPlan> contacts_;
  SessionVessels session_vessels_;
  std::size_t force_vessel_ = 0;
  std::optional<StudyFolder> folder_;
  std::unique_ptr<StudyJournal> journal_;
  const std::atomic<bool>* stop_ = nullptr;
  StudyPage page_;
  std::vector<std::string> lead_;
  std::vector<StudyRow> rows_, sensitivity_;
};

}  // namespace

ExitCode run_study(const Scene& scene, const StudyOptions& options) { return StudyRun(scene, options).run(); }

}  // namespace wholehand
