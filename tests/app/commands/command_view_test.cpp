// SPDX-License-Identifier: MIT
// The built program's views: `live --view`, `view` of recordings and results, `grip --view`; how they end, what they refuse, and
// that nobody who watches, or does worse, costs the session a tick.
// sanitizers: thread
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/viewer/browser.h"
#include "app/viewer/frame.h"
#include "app/viewer/server.h"
#include "base/files/json.h"
#include "base/text/error.h"
#include "core/meshes/vessel.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "device/recordings/recording.h"
#include "tests/support/files.h"
#include "tests/support/http_client.h"
#include "tests/support/patient_board.h"
#include "tests/support/program.h"
#include "tests/support/result_reader.h"

namespace wholehand {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A program that shows a view, once it has printed its address.
class Viewed {
 public:
  explicit Viewed(const std::string& arguments) {
    process_ = fork();
    if (process_ == 0) {
      const std::string command =
          std::string("exec ") + WHOLEHAND_PROGRAM + " " + arguments + " >" + (folder_ / "out") + " 2>" + (folder_ / "err");
      execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      _exit(127);
    }
    for (int k = 0; k < 12000 && at.port == 0; ++k) {
      for (const std::string& text : {out(), err()}) {
        const std::size_t line = text.find("view: http://");
        if (line != std::string::npos && text.find('\n', line) != std::string::npos) at = ViewAddress(text.substr(line));
      }
      if (at.port == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_NE(at.port, 0) << out() << err();
  }
  ~Viewed() {
    if (process_ > 0) kill(process_, SIGKILL), waitpid(process_, nullptr, 0);
  }
  std::string out() const { return file_text(folder_ / "out"); }
  std::string err() const { return file_text(folder_ / "err"); }
  int interrupt() {
    kill(process_, SIGINT);
    return wait();
  }
  int wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  json get(const std::string& path) const { return parse_json(at.get(path).body); }

  ViewAddress at{""};

 private:
  TemporaryFolder folder_;
  pid_t process_ = 0;
};

bool is_same(const json& seen, double truth) { return seen.get<float>() == static_cast<float>(truth); }

// ---- live ----

TEST(LiveView, ShowsASessionWhileItRuns) {
  const TemporaryFolder folder;
  Viewed live("live " + patient_board(folder) + " --view --seconds 3");
  const json scene = live.get("scene.json");
  EXPECT_EQ(scene["mode"], "live");
  EXPECT_EQ(scene["title"], "mixing_board");
  HttpSocket socket(live.at.port);
  socket.send(live.at.request("frames"));
  std::int64_t before = -1;
  int frames = 0;
  std::set<std::string> states;
  for (std::string event = socket.read_event(); !event.empty(); event = socket.read_event()) {
    if (event.find("reason") != std::string::npos) break;
    const json frame = parse_json(event);
    EXPECT_GT(frame["tick"], before) << "later than the one before";
    before = frame["tick"];
    EXPECT_NEAR(frame["t"].get<double>(), 1e-3 * static_cast<double>(before), 1e-9);
    states.insert(frame["state"]);
    ++frames;
    if (frame["state"] == "released") break;
  }
  EXPECT_EQ(socket.read_event("end"), "{\"reason\":\"done\"}");
  EXPECT_GT(frames, 30);
  EXPECT_TRUE(states.count("lift") && states.count("released")) << "the last tick is seen";
  EXPECT_EQ(live.wait(), 0) << live.err();
  EXPECT_EQ(live.out().rfind("view: http://127.0.0.1:", 0), 0u) << live.out();
}

// What is shown of a replay is what was recorded, tick by tick.
TEST(LiveView, WhatIsShownIsWhatWasRecorded) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.nc";
  ASSERT_EQ(run("PROGRAM live --no-clock --seconds 6 --record " + file).code, 0);
  const device::Recording recording = device::read_recording(file);
  Viewed live("live --view --device replay:" + file);
  HttpSocket socket(live.at.port);
  socket.send(live.at.request("frames"));
  const device::LiveScene scene(read_scene_file(find_scene("mixing_board")));
  FrameMaker maker(scene);
  device::VesselTracker tracker(scene.scene);
  std::size_t k = 0;
  int compared = 0;
  for (std::string event = socket.read_event(); !event.empty() && event.find("\"tick\"") != std::string::npos;
       event = socket.read_event()) {
    const json seen = parse_json(event);
    if (seen["state"] == "released") break;
    while (k < recording.ticks.size() && recording.ticks[k].number <= seen["tick"]) tracker.follow(recording.ticks[k++]);
    ASSERT_GT(k, 0u);
    const device::Tick& tick = recording.ticks[k - 1];
    ASSERT_EQ(tick.number, seen["tick"]);
    const device::DisplayTiming timing{seen["timing"]["rate"], seen["timing"]["step"], seen["timing"]["missed"]};
    const json truth =
        parse_json(frame_json(maker.make(tick, tracker.poses(), device::hand_view(scene, tick, tracker.poses()), timing)));
    EXPECT_EQ(seen, truth) << tick.number;
    ++compared;
  }
  EXPECT_GT(compared, 60);
  EXPECT_EQ(live.wait(), 0);
}

TEST(LiveView, WithJsonTheAddressIsNotInTheReport) {
  const TemporaryFolder folder;
  Viewed live("live " + patient_board(folder) + " --view --json --seconds 0.2");
  EXPECT_EQ(live.wait(), 0);
  EXPECT_EQ(parse_json(live.out())["fault"], json());
  EXPECT_EQ(live.err().rfind("view: http://127.0.0.1:", 0), 0u) << live.err();
}

TEST(LiveView, ASignalEndsItAndSaysSo) {
  const TemporaryFolder folder;
  Viewed live("live " + patient_board(folder) + " --view");
  HttpSocket socket(live.at.port);
  socket.send(live.at.request("frames"));
  EXPECT_FALSE(socket.read_event().empty());
  const ViewAddress at = live.at;
  std::thread later([&] { EXPECT_EQ(live.interrupt(), 130); });
  EXPECT_EQ(socket.read_event("end"), "{\"reason\":\"interrupted\"}");
  later.join();
  EXPECT_FALSE(HttpSocket(at.port).is_open());
}

// What is posted moves the hand that is seen.
TEST(LiveView, ThePageMayBeTheGripper) {
  const TemporaryFolder folder;
  Viewed live("live " + patient_board(folder) + " --view --device view --seconds 20");
  const json scene = live.get("scene.json");
  EXPECT_EQ(scene["control"], true);
  const json start = scene["control_limits"]["start"];
  HttpSocket frames(live.at.port), controls(live.at.port);
  frames.send(live.at.request("frames"));
  const auto tips_middle = [&] {
    const json frame = parse_json(frames.read_event());
    Triple middle{};
    for (std::size_t k = 0; k < 3; ++k)
      middle[k] = 0.5 * (frame["rigged"][THUMB_TIP][k].get<double>() + frame["rigged"][INDEX_TIP][k].get<double>());
    return middle;
  };
  Triple wanted = start["position"];
  EXPECT_LT(std::hypot(tips_middle()[0] - wanted[0], tips_middle()[1] - wanted[1]), 1e-4) << "where it starts";
  wanted[0] += 0.05;
  wanted[1] += 0.03;
  json control{{"position", wanted}, {"rotation", start["rotation"]}, {"gap", start["gap"]}, {"buttons", 0}, {"sequence", 1}};
  controls.send(live.at.post(json_text(control)));
  EXPECT_EQ(controls.read_reply().status, 204);
  double away = 1;
  for (int k = 0; k < 600 && away > 1e-4; ++k) {
    const Triple middle = tips_middle();
    away = std::hypot(middle[0] - wanted[0], middle[1] - wanted[1], middle[2] - wanted[2]);
  }
  EXPECT_LT(away, 1e-4);
  control["gap"] = "wide";
  controls.send(live.at.post(json_text(control)));
  const HttpReply refused = controls.read_reply();
  EXPECT_EQ(refused.status, 400);
  EXPECT_NE(refused.body.find("gap"), std::string::npos) << refused.body;
  EXPECT_EQ(live.interrupt(), 130);
}

// k_open is of the device's gap, and what the page moves is the hand's.
TEST(LiveView, ThePageIsToldTheStiffnessOfTheHandsGap) {
  const TemporaryFolder folder;
  std::string scene = file_text(find_scene("mixing_board"));
  scene.insert(scene.find("[force]\n") + 8, "k_open_N_m = 500\n");
  std::ofstream(folder / "half.toml") << scene << "\n[device]\ngap_mm = [20, 60]\n[live]\nlate_steps = 1000\n";
  Viewed live("live " + (folder / "half.toml") + " --view --device view --seconds 20");
  const json limits = live.get("scene.json")["control_limits"];
  const double range = limits["gap"][1].get<double>() - limits["gap"][0].get<double>();
  EXPECT_NEAR(limits["opening_N_m"].get<double>(), 500 * 0.04 / range, 1e-9);
  EXPECT_EQ(live.interrupt(), 130);
}

TEST(LiveView, OnlyWithThePageAsGripperAreControlsTaken) {
  const TemporaryFolder folder;
  Viewed live("live " + patient_board(folder) + " --view --seconds 20");
  EXPECT_EQ(live.get("scene.json")["control"], false);
  HttpSocket socket(live.at.port);
  socket.send(live.at.post("{}"));
  EXPECT_EQ(socket.read_reply().status, 405);
  EXPECT_EQ(live.interrupt(), 130);
}

// 200 connections, eight viewers of whom one does not read, and requests of every kind, while every tick is recorded.
TEST(LiveView, AStormOfConnectionsCostsTheSessionNothing) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.nc";
  Viewed live("live " + patient_board(folder) + " --view --json --seconds 4 --record " + file);
  std::vector<HttpSocket> viewers, others;
  for (int k = 0; k < MOST_VIEWERS; ++k) {
    viewers.emplace_back(live.at.port, k == 0 ? 4096 : 0);
    viewers.back().send(live.at.request("frames"));
  }
  for (int k = 0; k < 200; ++k) others.emplace_back(live.at.port);
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (k % 4 == 0) others[k].send(live.at.request("scene.json"));
    if (k % 4 == 1) others[k].send("GET / HTTP/1.1\r\n");
    if (k % 4 == 2) others[k].send(std::string(100000, 'x'));
  }
  int seen = 0;
  for (std::string event = viewers[1].read_event(); !event.empty() && event.find("released") == std::string::npos;
       event = viewers[1].read_event())
    ++seen;
  EXPECT_GT(seen, 60);
  EXPECT_EQ(live.wait(), 0) << live.err();
  const json report = parse_json(live.out());
  EXPECT_TRUE(report["fault"].is_null());
  EXPECT_TRUE(report["recorded_wholly"]);
  EXPECT_EQ(report["ticks"].get<int>() + report["missed"].get<int>(), 4000);
  const device::Recording recording = device::read_recording(file);
  EXPECT_EQ(recording.ticks.size(), report["ticks"].get<std::size_t>() + 1) << "and the one with which it ended";
}

// ---- recordings ----

TEST(ViewCommand, ShowsARecordingAtAnyMoment) {
  const TemporaryFolder folder;
  const std::string file = folder / "mine.nc";
  ASSERT_EQ(run("PROGRAM live --no-clock --seconds 12 --record " + file).code, 0);
  const device::Recording recording = device::read_recording(file);
  Viewed view("view " + file);
  const json scene = view.get("scene.json");
  EXPECT_EQ(scene["mode"], "recording");
  EXPECT_EQ(scene["title"], "mine.nc");
  const json frames = view.get("recording?from=2&to=11.5&rate=60")["frames"];
  ASSERT_EQ(frames.size(), 571u);
  for (std::size_t k = 0; k < frames.size(); k += 30) {
    const std::size_t at = static_cast<std::size_t>((2 + static_cast<double>(k) / 60) * 1000 + 1e-6);
    const device::Tick& tick = recording.ticks[at];
    EXPECT_EQ(frames[k]["tick"], tick.number);
    EXPECT_TRUE(is_same(frames[k]["forces"]["feedback"], tick.feedback));
    EXPECT_TRUE(is_same(frames[k]["gap"], tick.gap));
  }
  EXPECT_EQ(view.interrupt(), 0);
}

// ---- grips ----

TEST(ViewCommand, ShowsTheBestGripsOfASweep) {
  const TemporaryFolder folder;
  const std::string file = folder / "best.nc";
  const std::string scene_file = folder / "robust.toml";
  std::string text = file_text(find_scene("small"));
  text.replace(text.find("height_mm = 3\n"), std::string("height_mm = 3\n").size(), "count = 8\n");
  write_file(scene_file, text);
  ASSERT_EQ(run("PROGRAM sweep " + scene_file + " --on core --best 3 -o " + file + " >/dev/null").code, 0);
  const auto heights = read_values(file, "best_height"), rolls = read_values(file, "best_roll"),
             scores = read_values(file, "best_score"), means = read_values(file, "best_robust_mean"),
             lows = read_values(file, "best_robust_low");
  const Scene small = read_scene_file(find_scene("small"));
  ASSERT_EQ(heights.size(), 3 * small.vessels.size());
  Viewed view("view " + file);
  const json scene = view.get("scene.json");
  EXPECT_EQ(scene["mode"], "grips");
  std::size_t g = 0;
  for (std::size_t v = 0; v < small.vessels.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k, ++g) {
      ASSERT_LT(g, scene["grips"].size());
      EXPECT_EQ(scene["grips"][g]["label"], small.vessels[v].name + ", rank " + std::to_string(k + 1));
      EXPECT_EQ(scene["grips"][g]["vessel"], v);
      EXPECT_EQ(scene["grips"][g]["height_m"], heights[g]);
      EXPECT_EQ(scene["grips"][g]["roll_rad"], rolls[g]);
      EXPECT_NEAR(scene["grips"][g]["score"].get<double>(), scores[g], 1e-12) << "of a sweep in double precision";
      EXPECT_EQ(scene["grips"][g]["robust"]["mean"], means[g]);
      EXPECT_EQ(scene["grips"][g]["robust"]["low"], lows[g]);
      if (k > 0) {
        EXPECT_LE(lows[g], lows[g - 1]);
      }
      const json frame = view.get("state?grip=" + std::to_string(g) + "&fill=0&tilt=0.3");
      EXPECT_EQ(frame["vessel"], v);
      EXPECT_TRUE(is_same(frame["gap"], scene["grips"][g]["gap_m"]));
    }
  }
  EXPECT_EQ(g, scene["grips"].size());
  EXPECT_EQ(view.interrupt(), 0);
  EXPECT_EQ(view.err(), "");
}

TEST(ViewCommand, ShowsTheGripsOfAList) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.nc", list = folder / "list.csv";
  ASSERT_EQ(run("PROGRAM sweep small --on core -o " + file + " >/dev/null").code, 0);
  ASSERT_EQ(run("PROGRAM rank " + file + " --where 'roll_deg < 0' --best 2 -o " + list + " >/dev/null").code, 0);
  Viewed view("view " + file + " --list " + list);
  const json grips = view.get("scene.json")["grips"];
  ASSERT_EQ(grips.size(), 2 * read_scene_file(find_scene("small")).vessels.size());
  for (const json& grip : grips) EXPECT_LT(grip["roll_rad"].get<double>(), 0) << "as the condition has it";
  EXPECT_EQ(view.interrupt(), 0);
}

TEST(ViewCommand, ShowsAGripBesideItsReport) {
  const std::string grip = "grip three_beakers --vessel beaker1 --height-mm 58.5 --roll-deg 22 --fill 0.5 --tilt-deg 40 --json";
  Viewed view(grip + " --view");
  const json reported = parse_json(view.out());
  EXPECT_EQ(reported, parse_json(run("PROGRAM " + grip).output));
  const json scene = view.get("scene.json");
  EXPECT_EQ(scene["fills"], json({0.5}));
  ASSERT_EQ(scene["tilts"].size(), 1u);
  EXPECT_DOUBLE_EQ(scene["tilts"][0], radians(40));
  const json frame = view.get("state?grip=0&fill=0.5&tilt=0");
  const json& vessel = frame["vessels"][0];
  for (std::size_t j = 0; j < JOINT_COUNT; ++j) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(frame["joints"][j][k].get<double>() - vessel["place"][k].get<double>(), reported["proxies_m"][j][k].get<double>(),
                  1e-7);
      EXPECT_NEAR(frame["rigged"][j][k].get<double>() - vessel["place"][k].get<double>(), reported["joints_m"][j][k].get<double>(),
                  1e-7);
    }
  }
  const json tilted = view.get("state?grip=0&fill=0.5&tilt=" + std::to_string(radians(40)));
  EXPECT_NEAR(tilted["forces"]["feedback"].get<double>(), reported["states"][0]["feedback_force_N"].get<double>(), 1e-5);
  EXPECT_EQ(view.interrupt(), 0);
}

// ---- refusals ----

TEST(ViewCommand, RefusesWhatCannotBeShown) {
  const TemporaryFolder folder;
  const std::string text = folder / "text", empty = folder / "empty", cut = folder / "cut.nc", whole = folder / "whole.nc",
                    none = folder / "none.nc";
  std::ofstream(text) << "not a recording\n";
  std::ofstream(empty) << "";
  ASSERT_EQ(run("PROGRAM sweep small --on core -o " + whole + " >/dev/null").code, 0);
  ASSERT_EQ(run("PROGRAM sweep small --on core --best 0 -o " + none + " >/dev/null").code, 0);
  std::ofstream(cut, std::ios::binary) << file_text(whole).substr(0, 3000);
  for (const std::string& file : {text, empty, cut, folder / "missing", std::string("/"), std::string("/dev/null")})
    expect_error("view " + file, 2, file);
  for (const std::string& file : {text, empty, scenes_dir() + "/small.toml", std::string("three_beakers")})
    expect_error("view " + file, 2,
                 "view takes a recording of `wholehand live --record` or of `wholehand trials`, or a result of "
                 "`wholehand sweep`");
  expect_error("view " + none, 2, "this result lists no best grips");
  expect_error("view " + whole + " --view-port 65536", 2, "--view-port");
  expect_error("view " + whole + " --view-port x", 2, "--view-port");
  expect_error("live --view --no-clock", 2, "--no-clock");
  expect_error("live --view-port 8000", 2, "add --view");
  expect_error("grip three_beakers --vessel beaker1 --height-mm 50 --view-port 8000", 2, "add --view");
  expect_error("live --device view --seconds 1", 2, "--view");
}

TEST(ViewCommand, APortThatIsTakenIsNamedAndNothingIsLeft) {
  const TemporaryFolder folder, boards;
  Viewed live("live " + patient_board(boards) + " --view --seconds 20");
  expect_error("live --view --seconds 1 --view-port " + std::to_string(live.at.port) + " --record " + (folder / "p.nc"), 2,
               "--view-port " + std::to_string(live.at.port));
  EXPECT_TRUE(fs::is_empty(fs::path(folder / "p.nc").parent_path())) << "the next start would be refused";
  EXPECT_EQ(live.interrupt(), 130);
}

TEST(Browser, OpensNothingWhereNobodySitsBeforeIt) {
  // standard output of a test is no terminal
  EXPECT_FALSE(has_desktop());
}

}  // namespace
}  // namespace wholehand
