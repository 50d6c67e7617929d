// SPDX-License-Identifier: MIT
// A view's server that a test is the browser of.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "app/viewer/server.h"
#include "base/text/error.h"
#include "tests/support/http_client.h"

namespace wholehand {

// A view with all that there can be.
struct ServedView {
  FrameHub frames{MOST_VIEWERS};
  std::mutex mutex;
  std::vector<std::string> controls;
  std::unique_ptr<ViewServer> server;
  std::unique_ptr<ViewAddress> at;

  ServedView() {
    ViewContent content;
    content.scene = "{\"mode\":\"live\"}";
    content.meshes = {"", std::string("\1\0\0\0", 4)};
    content.frames = &frames;
    content.state = [](const ViewContent::Query& query) {
      return "{\"tilt\":" + std::to_string(query_number(query, "tilt", 0, 3)) + "}";
    };
    content.control = [this](const std::string& body) {
      if (body == "bad") throw usage_error("what was found; what is allowed");
      const std::lock_guard lock(mutex);
      controls.push_back(body);
    };
    server = std::make_unique<ViewServer>(std::move(content), 0);
    at = std::make_unique<ViewAddress>(server->address());
  }
};

inline int status_of(const ViewAddress& at, const std::string& request) {
  HttpSocket socket(at.port);
  socket.send(request);
  return socket.read_reply().status;
}

}  // namespace wholehand
