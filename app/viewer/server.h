// SPDX-License-Identifier: MIT
// Serves a view to browsers on this machine: the page, its data, and its actions. docs/view.md is the protocol.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/viewer/frame_hub.h"

namespace wholehand {

constexpr int MOST_VIEWERS = 8;               // that are sent frames
constexpr std::size_t MOST_CONNECTIONS = 32;  // of any kind

// The content of a view. Unset parts give 404. Many threads call the functions at once; an Error that they throw becomes the answer (400), with its
// line as the reason.
struct ViewContent {
  using Query = std::map<std::string, std::string>;
  std::string scene;                                          // scene.json
  std::vector<std::string> meshes;                            // of each vessel; empty: not a mesh
  FrameHub* frames = nullptr;                                 // must outlive the server
  std::function<std::string(const Query&)> recording, state;  // JSON
  std::function<void(const std::string& body)> control;
};

class ViewServer {
 public:
  // `port` 0: any. Throws Error as LocalServer::bind does.
  ViewServer(ViewContent content, int port);
  // Stops.
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  // "http://127.0.0.1:PORT/TOKEN/". Whoever knows it sees the view; the token is new with each server.
  const std::string& address() const;
  // Gives viewers a moment to learn that their frames have ended, and cuts all connections.
  void stop();

 private:
  class Pages;
  std::unique_ptr<Pages> pages_;
};

// Whether a request's Host names this server: 127.0.0.1 or localhost with its port, which clients omit if it is 80.
bool is_own_host(std::string_view host, int port);

// Parses a number of a query: the whole text, finite and in its range. Throws Error (usage).
double query_number(const ViewContent::Query& query, const std::string& name, double low, double high);

}  // namespace wholehand
