// SPDX-License-Identifier: MIT
// Telling a person where a view is, and opening it on a desktop.
#pragma once

#include <string>

namespace wholehand {

// Whether there is somebody with a desktop before it: a display, standard output on a terminal, and not root, as whom browsers do not run.
bool has_desktop();

// Prints the address of a view, on standard error where standard output is for something else, and opens it with xdg-open where there is a
// desktop. The browser is given a file of the user's own that leads there, not the address: what programs are started with is there for all to
// see, and who knows the token sees the view. The file goes with the object. Throws Error (failure) as print does.
class BrowserWindow {
 public:
  BrowserWindow(const std::string& address, bool on_standard_error);
  ~BrowserWindow();
  BrowserWindow(const BrowserWindow&) = delete;
  BrowserWindow& operator=(const BrowserWindow&) = delete;

 private:
  void open(const std::string& address);
  std::string file_;
};

}  // namespace wholehand
