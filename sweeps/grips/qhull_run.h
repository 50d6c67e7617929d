// SPDX-License-Identifier: MIT
// One computation of Qhull.
#pragma once

#include <libqhull_r/libqhull_r.h>

namespace wholehand::sweeps {

// Qhull's memory, which it frees in two steps.
class QhullRun {
 public:
  QhullRun() { qh_zero(&qhull_, nullptr); }
  ~QhullRun() {
    qh_freeqhull(&qhull_, !qh_ALL);
    int long_blocks = 0, long_bytes = 0;
    qh_memfreeshort(&qhull_, &long_blocks, &long_bytes);
  }
  QhullRun(const QhullRun&) = delete;
  QhullRun& operator=(const QhullRun&) = delete;
  qhT* get() { return &qhull_; }

 private:
  qhT qhull_{};
};

}  // namespace wholehand::sweeps
