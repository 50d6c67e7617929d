// SPDX-License-Identifier: MIT
#include "app/viewer/serve_view.h"

#include <chrono>
#include <thread>
#include <utility>

#include "app/viewer/browser.h"
#include "base/system/interrupt.h"
#include "base/system/output.h"

namespace wholehand {

void serve_view(ViewContent content, int port, bool address_on_standard_error) {
  InterruptGuard interrupt;
  ViewServer server(std::move(content), port);
  const BrowserWindow window(server.address(), address_on_standard_error);
  finish_output();  // a user without the address has nothing to see
  while (!interrupt.flag() && !is_output_abandoned()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

}  // namespace wholehand
