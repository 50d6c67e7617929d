// SPDX-License-Identifier: MIT
#include "evidence/trials/run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

#include "base/files/checksum.h"
#include "base/files/file_set.h"
#include "base/files/files.h"
#include "base/files/output_lock.h"
#include "base/numbers/parallel.h"
#include "base/system/build_id.h"
#include "base/system/interrupt.h"
#include "base/system/output.h"
#include "base/system/progress.h"
#include "base/system/version.h"
#include "base/text/printable.h"
#include "base/text/readable.h"
#include "evidence/trials/analysis.h"
#include "evidence/trials/cases.h"
#include "evidence/trials/dataset.h"
#include "evidence/trials/disagreements.h"
#include "evidence/trials/journal.h"
#include "evidence/trials/output.h"
#include "evidence/trials/page.h"
#include "evidence/trials/scatter.h"
#include "evidence/trials/summary.h"
#include "sweeps/plan/variables.h"

namespace wholehand {
namespace {

std::string numbers_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += fmt::format("{} ", value);
  return text;
}

std::string checksum_of(const std::string& text) { return checksum_text(text.data(), text.size()); }

std::string settings_text(const TrialSettings& settings) {
  std::string text = fmt::format("{} ", TRIAL_MODEL_NAMES[static_cast<std::size_t>(settings.model)]);
  text += numbers_text({settings.squeeze, settings.mass, settings.friction, settings.tilt_rate, settings.hold_time,
                        settings.push_time, settings.push_acceleration, settings.largest_move, settings.largest_turn, settings.slip,
                        settings.start_overlap, settings.buried});
  for (const TrialMaterial& material : settings.materials)
    text += material.name + " " + numbers_text({material.mass, material.friction, material.torsion});
  return text;
}

// Writes each grip in full, not just its number, because with another mesh or version of a scene the number may mean another grip.
std::string grips_text(const std::vector<TrialGrip>& grips) {
  std::string text;
  for (const TrialGrip& grip : grips)
    text += fmt::format("{} {} {} ", grip.vessel, grip.number, static_cast<int>(grip.sample)) +
            numbers_text({grip.score, grip.grip.height, grip.grip.azimuth, grip.grip.obliquity, grip.grip.roll, grip.grip.offset,
                          grip.grip.hand_scale});
  return text;
}

std::string cases_text(const std::vector<std::vector<TrialCase>>& cases) {
  std::string text;
  for (std::size_t v = 0; v < cases.size(); ++v)
    for (const TrialCase& one : cases[v])
      text += fmt::format("{} {} {} {} ", v, static_cast<int>(one.protocol), one.direction, one.material) +
              numbers_text({one.fill, one.tilt});
  return text;
}

TrialIdentity identity_of(const Scene& scene, const TrialOptions& options, const TriedGrips& tried, const TrialEngine& engine) {
  return {{"text of the scene", checksum_of(scene.text)},
          {"choice of grips", checksum_of(grips_text(tried.grips))},
          {"choice of states", checksum_of(cases_text(tried.cases))},
          {"model, mass, friction or material", checksum_of(settings_text(options.settings))},
          {"number of deviations", fmt::format("{}", options.scatter)},
          {"seed", fmt::format("{}", options.seed)},
          {"engine", engine.name()},
          {"form of the vessels", checksum_of(fmt::format("{}", fmt::join(tried.forms, "; ")))},
          {JOURNAL_BUILD, fmt::format("{} {}", version(), build_id())}};
}

void check_trial_scene(const Scene& scene, std::size_t scatter) {
  const char* name = scene.file.empty() ? "the scene" : scene.file.c_str();
  if (!scene.strength)
    throw usage_error(
        fmt::format("{}: trials need the strength of the hand, which this scene does not have; leave efforts = false out of "
                    "[strength]",
                    name));
  if (scene.tilts.empty())
    throw usage_error(fmt::format("{}: trials need [tilts], as efforts do; add it to the scene, with its deg", name));
  if (scatter > 0 && !scene.robust)
    throw usage_error(
        fmt::format("{}: --scatter needs [robust], whose deviations it takes; add it to the scene, or leave --scatter out", name));
}

// Text from outside the program, in one line of plain characters, for a table and a page.
std::string plain_detail(std::string detail) {
  for (char& c : detail)
    if (c < ' ' || c > '~') c = ' ';
  return detail;
}

class Trials {
 public:
  Trials(const Scene& scene, const TrialOptions& options, const OpenTrialEngine& open, sweeps::SweepResult* result)
      : scene_(scene), options_(options), result_(result), predictor_(checked(scene, options.scatter), options.settings) {
    find_cases();
    engine_ = open(predictor_.scene(), *predictor_.core(), options.settings);
    check_models();
    find_forms();
    if (options.scatter > 0) scatter_.emplace(predictor_.scene(), options.settings, open);
    prepare_trials_folder(options.folder);
  }

  ExitCode run() {
    const TrialFiles files(options_.folder);
    const OutputLock lock(files.lock, "folder");
    remove_unfinished(files);
    InterruptGuard interrupt;
    choose_grips(interrupt);
    if (interrupt.flag()) return interrupted(0, false);
    const TrialIdentity identity = identity_of(scene_, options_, tried_, *engine_);
    if (options_.resume && !begins_with(files.journal, JOURNAL_START)) {
      if (has_finished_trials(options_.folder, identity_text(identity))) {
        print(fmt::format("{}: these trials are complete; there is nothing to resume\n", one_line(options_.folder)));
        return ExitCode::done;
      }
      // a request to resume is no request to replace a complete result
      if (begins_with(files.csv, TRIALS_CSV_START))
        throw usage_error(
            fmt::format("{}: other trials are complete there, or of another build; leave --resume out to replace them, or "
                        "name another folder with -o",
                        options_.folder));
      print_note(options_.folder + ": no interrupted trials are there: starting from the first grip");
    }
    TrialJournal::Found found;
    const auto journal = open_journal(files, identity, found);
    print_trials_header();
    const std::size_t done = try_all(*journal, found, interrupt);
    if (done < tried_.grips.size()) return interrupted(done, true);
    tried_.found.clear();
    for (std::size_t g = 0; g < tried_.grips.size(); ++g) tried_.found.push_back(std::move(found.at(g)));
    if (!write_files(files, identity, interrupt.flag())) {
      print_note("interrupted before the files were written; go on with --resume");
      return ExitCode::interrupted;
    }
    std::remove(files.journal.c_str());
    return ExitCode::done;
  }

 private:
  static const Scene& checked(const Scene& scene, std::size_t scatter) {
    check_trial_scene(scene, scatter);
    return scene;
  }

  void find_cases() {
    tried_.cases.resize(scene_.vessels.size());
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v)
      if (is_asked(v)) tried_.cases[v] = trial_cases(scene_, *predictor_.core(), v, options_);
  }

  bool is_asked(std::size_t vessel) const { return !options_.vessel || *options_.vessel == vessel; }

  // Throws Error (usage) for the first vessel without a model, and names one that can be tried instead.
  void check_models() const {
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      if (!is_asked(v)) continue;
      try {
        engine_->check(v);
      } catch (const Error& error) {
        const std::optional<std::size_t> other = first_with_model(v);
        if (error.code != ExitCode::usage || !other) throw;
        throw usage_error(fmt::format("{}; or try another vessel: --vessel {}", error.what(), scene_.vessels[*other].name));
      }
    }
  }

  void find_forms() {
    tried_.forms.resize(scene_.vessels.size());
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v)
      if (is_asked(v)) tried_.forms[v] = engine_->form_text(v);
  }

  std::optional<std::size_t> first_with_model(std::size_t but) const {
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v) {
      if (v == but) continue;
      try {
        engine_->check(v);
        return v;
      } catch (const Error&) {  // this one has none either
      }
    }
    return std::nullopt;
  }

  // By the scene's own friction, so that the same grips are tried with any friction.
  void choose_grips(InterruptGuard& interrupt) {
    const sweeps::Plan plan(scene_, result_ && sweeps::keeps_vectors(result_->variables()));
    if (result_) result_->use(scene_, plan);
    const bool is_own = std::isnan(options_.settings.friction);
    const std::shared_ptr<const Evaluator> core = is_own ? predictor_.core() : make_core_evaluator(scene_);
    tried_.grips = choose_trial_grips({scene_, plan, core, result_}, options_, interrupt.flag());
  }

  std::unique_ptr<TrialJournal> open_journal(const TrialFiles& files, const TrialIdentity& identity, TrialJournal::Found& found) {
    const bool is_there = begins_with(files.journal, JOURNAL_START);
    if (!options_.resume || !is_there) {
      if (is_there) print_note(files.journal + ": the interrupted trials are begun again; --resume would go on with them");
      return std::make_unique<TrialJournal>(files.journal, identity);
    }
    std::vector<std::size_t> counts;
    for (std::size_t g = 0; g < tried_.grips.size(); ++g) counts.push_back(tried_.cases_of(g).size());
    std::size_t damaged = 0;
    auto journal = std::make_unique<TrialJournal>(files.journal, identity, counts, found, damaged);
    if (damaged > 0)
      print_note(fmt::format("{}: {} not as {} written; {} tried again", files.journal,
                             counted(damaged, "line") + (damaged == 1 ? " is" : " are"), damaged == 1 ? "it was" : "they were",
                             damaged == 1 ? "its grip is" : "their grips are"));
    print_note(fmt::format("goes on after {} of {}", found.size(), counted(tried_.grips.size(), "grip")));
    return journal;
  }

  void print_trials_header() const {
    std::size_t trials = 0;
    for (std::size_t g = 0; g < tried_.grips.size(); ++g) trials += tried_.cases_of(g).size();
    print(fmt::format(
        "{}: {}, {} in {}, {}{}{}\n", scene_.name.empty() ? "trials" : scene_.name, counted(tried_.grips.size(), "grip"),
        counted(trials, "trial"), engine_->name(), counted(static_cast<std::uint64_t>(thread_count(options_.threads)), "thread"),
        options_.scatter > 0 ? fmt::format("; each grip is then tried at {}", counted(options_.scatter, "deviation")) : "",
        options_.quick ? "; --quick: fewer grips and states" : ""));
    for (std::size_t v = 0; v < scene_.vessels.size(); ++v)
      if (!tried_.forms[v].empty()) print(fmt::format("  {}: {}\n", scene_.vessels[v].name, tried_.forms[v]));
  }

  // Tries the grips that are not in `found`. Returns how many are finished in the end.
  std::size_t try_all(TrialJournal& journal, TrialJournal::Found& found, InterruptGuard& interrupt) {
    std::vector<std::size_t> open;
    for (std::size_t g = 0; g < tried_.grips.size(); ++g)
      if (!found.contains(g)) open.push_back(g);
    const std::size_t before = found.size();
    std::vector<GripFinding> findings(open.size());
    std::vector<std::atomic<bool>> is_done(open.size());
    std::atomic<std::size_t> done = before;
    Progress progress(tried_.grips.size(), before, "grips");
    in_parallel(
        open.size(), options_.threads,
        [&](std::size_t k) {
          if (interrupt.flag()) return;
          findings[k] = try_grip(open[k]);
          journal.add(open[k], findings[k]);
          is_done[k] = true;
          ++done;
        },
        [&](std::size_t) { progress.update("trials", done); });
    progress.clear();
    for (std::size_t k = 0; k < open.size(); ++k)
      if (is_done[k]) found.emplace(open[k], std::move(findings[k]));
    return found.size();
  }

  GripFinding try_grip(std::size_t g) const {
    const TrialGrip& grip = tried_.grips[g];
    const std::vector<TrialCase>& cases = tried_.cases_of(g);
    GripFinding finding;
    finding.prediction = predictor_.predict(grip.vessel, grip.grip, cases);
    finding.outcomes = engine_->run(grip.vessel, grip.grip, cases);
    if (finding.outcomes.size() != cases.size())
      throw failure_error("the engine answered another number of trials than it was asked");
    for (TrialOutcome& outcome : finding.outcomes) {
      outcome.detail = plain_detail(outcome.detail);
      outcome.held = outcome.held && !outcome.discarded;
    }
    if (scatter_) {
      finding.placements = scatter_->place(grip, cases, options_.scatter, options_.seed);
      finding.robust = scatter_->robust(grip);
    }
    return finding;
  }

  ExitCode interrupted(std::size_t done, bool has_journal) const {
    print_note(has_journal
                   ? fmt::format("interrupted after {} of {}; go on with --resume", done, counted(tried_.grips.size(), "grip"))
                   : std::string("interrupted before the first grip"));
    return ExitCode::interrupted;
  }

  // Renames the files once all are complete. The journal is removed after that, so --resume repairs a kill during the renames. False: stopped before
  // the first of them.
  bool write_files(const TrialFiles& files, const TrialIdentity& identity, const std::atomic<bool>& stop) {
    const TrialAnalysis analysis = analyze_trials(scene_, tried_, options_);
    std::vector<ShownDisagreement> shown;
    FileSet set;
    try {
      // renames the table first: beside it a folder's trials.nc is recognized as ours
      set.write(files.csv, trials_csv(scene_, options_.settings, tried_), TRIALS_REMEDY);
      const TrialOrigin origin{engine_->name(), identity_text(identity)};
      write_trials_dataset(set.temporary_path(files.nc), scene_, options_, tried_, origin);
      shown = show_disagreements(files, set, scene_, predictor_, *engine_, tried_, analysis, stop);
      if (stop) return false;
      const TrialPageSource source{scene_, options_, tried_, analysis, shown, origin.engine, origin.identity};
      set.write(files.page, trials_page(source), TRIALS_REMEDY);
      set.commit(TRIALS_REMEDY);
    } catch (const Error& error) {
      throw Error(error.code, set.with_own_names(error.what()), error.remedy);
    }
    print(trials_summary(scene_, options_, analysis));
    const auto recordings = static_cast<std::uint64_t>(
        std::count_if(shown.begin(), shown.end(), [](const auto& one) { return !one.recording.empty(); }));
    print("\n" +
          one_line(fmt::format("wrote {}, {}, {}{}", files.csv, files.nc, files.page,
                               recordings == 0 ? "" : fmt::format(" and {} of disagreements", counted(recordings, "recording")))) +
          "\n");
    return true;
  }

  const Scene& scene_;
  const TrialOptions& options_;
  sweeps::SweepResult* result_;
  TrialPredictor predictor_;
  std::unique_ptr<TrialEngine> engine_;
  std::optional<GripScatter> scatter_;
  TriedGrips tried_;
};

}  // namespace

ExitCode run_trials(const Scene& scene, const TrialOptions& options, const OpenTrialEngine& open, sweeps::SweepResult* result) {
  return Trials(scene, options, open, result).run();
}

}  // namespace wholehand
