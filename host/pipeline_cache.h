// SPDX-License-Identifier: MIT
// Compiled pipelines kept between runs, one file per device and driver. For GPUs: lavapipe gives nothing to keep (Mesa caches for
// it). They count towards cache_limit. No cache, a damaged one or a folder that cannot be written only costs the compilation.
#pragma once

#include <string>

#include "host/vulkan.h"

namespace wholehand::host {

// Makes device.cache, from its file where there is one. Throws Error (usage) as cache_limit does. `folder` empty: $XDG_CACHE_HOME/wholehand or
// ~/.cache/wholehand, nothing kept
// on a CPU driver.
void open_pipeline_cache(DeviceState& device, const std::string& folder);

// Writes the file again if pipelines were added. Never throws.
void save_pipeline_cache(DeviceState& device) noexcept;

}  // namespace wholehand::host
