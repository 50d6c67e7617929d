// SPDX-License-Identifier: MIT
// The page in headless Chromium: at the widths of a phone and of a desk, light, dark and on paper.
// sanitizers: none
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>

#include "evidence/report/page.h"
#include "tests/support/files.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

std::string output_of(const std::string& command, int& code) {
  std::string output;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return output;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) output.append(buffer.data(), n);
  const int status = pclose(pipe);
  code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return output;
}

class ReportBrowser : public testing::Test {
 protected:
  void SetUp() override {
    int code = 0;
    browser = output_of("command -v chromium-headless-shell || command -v chromium", code);
    ASSERT_EQ(code, 0) << "no Chromium here: chromium-headless-shell of packages.txt";
    browser.erase(browser.find_last_not_of('\n') + 1);
    sweeps::SweepResult result(swept.path);
    page = report_page(result, swept.scene);
  }

  // What Chromium prints, its log included. No name but this machine's can be found from there.
  std::string browse(const std::string& options, const std::string& html) {
    const std::string path = swept.folder / "page.html";
    std::ofstream(path) << html;
    int code = 0;
    const std::string output =
        output_of("timeout 120 " + browser +
                      " --headless --no-sandbox --disable-gpu --hide-scrollbars --disable-dev-shm-usage --user-data-dir=" +
                      (swept.folder / "profile") + " --host-resolver-rules='MAP * ~NOTFOUND' --enable-logging=stderr " + options +
                      " file://" + path + " 2>&1",
                  code);
    EXPECT_EQ(code, 0) << output.substr(0, 2000);
    EXPECT_EQ(output.find(":CONSOLE"), std::string::npos) << output.substr(output.find(":CONSOLE"), 500);
    return output;
  }

  static std::string attribute(const std::string& dom, const std::string& name) {
    std::smatch found;
    return std::regex_search(dom, found, std::regex("<html[^>]* " + name + "=\"([^\"]*)\"")) ? found[1].str() : "missing";
  }

  // with [strength], so that the page has every part
  SweptScene swept{edited(RESULT_SCENE, NO_EFFORTS, "[strength]\n"), Precision::single};
  std::string browser, page;
};

TEST_F(ReportBrowser, FitsEveryWidthInLightAndDark) {
  const std::string script =
      "<script>" + file_text(WHOLEHAND_SOURCE_DIR "/tests/evidence/report/browser_test.js") + "</script></body>";
  const std::string watched = edited(page, "</body>", script);
  for (const int width : {400, 800, 1400}) {
    for (const bool is_dark : {false, true}) {
      SCOPED_TRACE(std::to_string(width) + (is_dark ? " dark" : " light"));
      const std::string dom = browse("--window-size=" + std::to_string(width) +
                                         ",900 --dump-dom --blink-settings=preferredColorScheme=" + (is_dark ? "0" : "1"),
                                     watched);
      EXPECT_EQ(attribute(dom, "data-wrong"), "");
      EXPECT_EQ(attribute(dom, "data-width"), std::to_string(width));
      EXPECT_EQ(attribute(dom, "data-ground"), is_dark ? "dark" : "light");
      const std::string headings = attribute(dom, "data-headings");
      for (const char* heading : {"Grips of cups", "What was asked", "How it ran", "cup", "flask", "Effort over the tilt",
                                  "Agreement with the core", "What others call a held grasp", "The words"})
        EXPECT_NE(("|" + headings + "|").find("|" + std::string(heading) + "|"), std::string::npos) << headings;
    }
  }
}

TEST_F(ReportBrowser, PrintsOnAFewPages) {
  const std::string pdf = swept.folder / "page.pdf";
  browse("--no-pdf-header-footer --print-to-pdf=" + pdf, page);
  const std::string text = file_text(pdf);
  ASSERT_EQ(text.rfind("%PDF", 0), 0u);
  std::smatch count;
  ASSERT_TRUE(std::regex_search(text, count, std::regex("/Count ([0-9]+)")));
  const int pages = std::stoi(count[1]);
  EXPECT_GE(pages, 3);
  EXPECT_LE(pages, 12) << "of two vessels";
}

}  // namespace
}  // namespace wholehand
