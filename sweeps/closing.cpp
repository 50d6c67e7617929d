#include "sweeps/closing.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>

#include "sweeps/readable.h"

namespace wholehand {
namespace {

double seconds(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

}  // namespace

std::string opening_lines(const Scene& scene, const Plan& plan, const BackendInfo& info) {
  const auto grips = static_cast<double>(plan.grips() * scene.vessels.size());
  std::string text = fmt::format("{}: {} grips of {} vessel{}", scene.name.empty() ? "sweep" : scene.name, readable_count(grips),
                                 scene.vessels.size(), scene.vessels.size() == 1 ? "" : "s");
  const std::size_t states = scene.tilts.size() * scene_fills(scene);
  if (states > 0) text += fmt::format(", {} states each", readable_count(static_cast<double>(states)));
  text +=
      fmt::format("\non {}{} ({}), {} precision\n", info.device, info.backend == "vulkan" && info.is_cpu ? ", a CPU driver" : "",
                  info.driver, info.precision == Precision::single ? "single" : "double");
  if (plan.copies() > 1) {
    text += fmt::format("azimuth left out: the vessels are bodies of revolution, so one stands for all {}\n",
                        readable_count(static_cast<double>(plan.copies())));
  }
  return text;
}

std::string closing_lines(const std::vector<std::string>& files, const SweepTimes& times) {
  struct stat status {};
  const double size = stat(files.front().c_str(), &status) == 0 ? static_cast<double>(status.st_size) : 0;
  std::string text = fmt::format("wrote {} ({})", files.front(), readable_bytes(size));
  for (std::size_t i = 1; i < files.size(); ++i) text += ", " + files[i];
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  const double rate = static_cast<double>(times.written_bytes) / std::max(times.writing, 1e-9);
  text += fmt::format(
      "\n{:.2f} s: kernels {:.2f}, file writing {:.3f} ({:.0f} MB/s), everything else {:.2f}; CPU {:.2f} s; peak memory {}\n",
      times.wall, times.kernels, times.writing, rate * 1e-6, times.wall - times.kernels - times.writing,
      seconds(usage.ru_utime) + seconds(usage.ru_stime), readable_bytes(1024.0 * static_cast<double>(usage.ru_maxrss)));
  return text;
}

}  // namespace wholehand
