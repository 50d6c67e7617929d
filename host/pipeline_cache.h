// SPDX-License-Identifier: MIT
// Keeps compiled pipelines between runs, one file per device and driver. It serves GPUs: lavapipe provides no data to keep, and Mesa caches for it.
// The files count towards cache_limit. A missing or damaged cache, or a read-only folder, only costs compilation.
#pragma once

#include <string>

#include "host/vulkan.h"

namespace wholehand::host {

// Makes device.cache, from its file if there is one. Throws Error (usage) as cache_limit does. If `folder` is empty, it is $XDG_CACHE_HOME/wholehand
// or ~/.cache/wholehand, and a CPU driver keeps nothing.
void open_pipeline_cache(DeviceState& device, const std::string& folder);

// Rewrites the file if pipelines were added. Never throws.
void save_pipeline_cache(DeviceState& device) noexcept;

}  // namespace wholehand::host
