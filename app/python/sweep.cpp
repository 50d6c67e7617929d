// SPDX-License-Identifier: MIT
// A sweep into a result file, as the program writes it; Python opens the file.
#include <pybind11/stl.h>

#include "app/program/remedy.h"
#include "app/program/values.h"
#include "app/python/bind.h"
#include "app/python/scene.h"
#include "base/system/interrupt.h"
#include "base/text/error.h"
#include "core/domain.h"
#include "core/reader/ranges.h"
#include "sweeps/run/run.h"

namespace py = pybind11;

namespace wholehand {
namespace {

struct SweepSpec {
  std::string output, on;
  std::optional<std::string> precision;
  std::optional<int> best;
  std::optional<std::vector<std::string>> keep;
  int threads = 0;
  bool refine = true, resume = false;
};

sweeps::SweepOptions options_of(const SweepSpec& spec, std::vector<std::string>& notes) {
  sweeps::SweepOptions options{.output = spec.output,
                               .on = spec.on,
                               .resume = spec.resume,
                               .refine = spec.refine,
                               .hooks = {.note = [&notes](const std::string& line) { notes.push_back(line); }}};
  if (spec.precision) options.precision = parse_precision(*spec.precision);
  if (spec.best) options.best = static_cast<int>(parse_integer(std::to_string(*spec.best), "--best", ranges::BEST));
  options.threads = checked_threads(spec.threads);
  options.hooks.warn = [&notes](const Scene& scene, Precision precision) {
    for (const std::string& line : domain_warnings(scene, precision))
      notes.push_back(line + remedy_words(Remedy::double_precision));
  };
  return options;
}

// Returns whether it is complete, the number of a signal that came meanwhile (0: none), and the notes. Only one at a time in a process; the caller
// ensures that.
py::tuple sweep(const SceneHandle& handle, const std::string& output, const std::string& on, std::optional<std::string> precision,
                std::optional<int> best, std::optional<std::vector<std::string>> keep, int threads, bool refine, bool resume) {
  prepare_device(on);
  const SweepSpec spec{output, on, std::move(precision), best, std::move(keep), threads, refine, resume};
  std::vector<std::string> notes;
  ExitCode code = ExitCode::done;
  {
    const py::gil_scoped_release other_threads;
    Scene scene = handle.described();
    if (spec.keep) {
      named_variables(scene, *spec.keep, "keep");
      scene.output.keep = spec.keep;
      scene.output.keep_place = "keep";
    }
    code = sweeps::run_sweep(scene, options_of(spec, notes));
  }
  // a signal during the ending left the sweep complete, but still belongs to Python
  return py::make_tuple(code != ExitCode::interrupted, InterruptGuard::signal_number(), notes);
}

}  // namespace

void bind_sweep(py::module_& module) {
  module.def("sweep", &sweep, py::arg("scene"), py::arg("output"), py::arg("on"), py::arg("precision"), py::arg("best"),
             py::arg("keep"), py::arg("threads"), py::arg("refine"), py::arg("resume"));
}

}  // namespace wholehand
