// SPDX-License-Identifier: MIT
// Serves a view that does not change by itself.
#pragma once

#include "app/viewer/server.h"

namespace wholehand {

// Serves it, prints its address, and returns after a signal. Throws Error as ViewServer and BrowserWindow do.
void serve_view(ViewContent content, int port, bool address_on_standard_error);

}  // namespace wholehand
