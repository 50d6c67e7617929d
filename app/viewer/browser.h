// SPDX-License-Identifier: MIT
// Tells the user where a view is, and opens it on a desktop.
#pragma once

#include <string>

namespace wholehand {

// Whether a desktop user is present: a display, standard output on a terminal, and not root, as whom browsers do not run.
bool has_desktop();

// Prints the address of a view, on standard error if standard output has another use, and opens it with xdg-open if there is a desktop. The browser
// gets a private file that leads to the address, not the address itself: anyone can see a program's arguments, and whoever knows the token sees the
// view. The file is removed with the object. Throws Error (failure) as print does.
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
