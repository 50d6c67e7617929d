// SPDX-License-Identifier: MIT
// The built program's `live`: options, exit codes, recording, replay, signals, disks that fill up.
// sanitizers: thread
#include "app/commands/live.h"

#include <gtest/gtest.h>
#include <lo/lo.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "app/commands/open_gripper.h"
#include "base/files/json.h"
#include "base/text/error.h"
#include "core/reader/reader.h"
#include "core/reader/shipped.h"
#include "core/vectors.h"
#include "device/recordings/recording.h"
#include "device/session/tick.h"
#include "tests/support/files.h"
#include "tests/support/http_client.h"
#include "tests/support/live_script.h"
#include "tests/support/patient_board.h"

namespace wholehand {
namespace {

namespace fs = std::filesystem;

Scene board_scene() { return read_scene_file(find_scene("mixing_board")); }

TEST(OpenGripper, RefusesOtherNames) {
  const Scene scene = board_scene();
  for (const char* name : {"",
                           "simulator",
                           "sim:1",
                           "view",
                           "view:1",
                           "hid:",
                           "usb:",
                           "omega:",
                           "omega:x",
                           "omega:65536",
                           "haply:",
                           "haply:x",
                           "haply:0",
                           "haply:65536",
                           "haply::10001",
                           "haplya",
                           "haply/",
                           "haply/a,",
                           "haply/,b",
                           "haply/a,b,c",
                           "haply:10001/a b",
                           "replay",
                           "osc",
                           "osc:",
                           "osc:x",
                           "osc:-1",
                           "osc:65536",
                           "osc:127.0.0.1:",
                           "osc::9000",
                           "osc://127.0.0.1:9000",
                           "osc:::1:9000",
                           "osc:a b:9000"}) {
    try {
      open_gripper(name, scene, 1, "");
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::usage) << name;
      EXPECT_NE(std::string(error.what()).find("--device"), std::string::npos) << error.what();
    }
  }
}

TEST(OpenGripper, ThePageIsOneWhereThereIsAPage) {
  const Scene scene = board_scene();
  device::ViewInput input(scene);
  EXPECT_EQ(open_gripper("view", scene, 1, "", WATCHDOG, &input)->limits().address, "view");
}

// ---- the program ----

struct LiveOutcome {
  int code = -1;
  std::string output, errors;
};

// Starts the program with arguments as a shell takes them, standard output and errors into files. `limit`: of a file's size, 0:
// none.
class Program {
 public:
  explicit Program(const std::string& arguments, rlim_t limit = 0) {
    process_ = fork();
    if (process_ != 0) return;
    if (limit > 0) {
      const rlimit size{limit, limit};
      setrlimit(RLIMIT_FSIZE, &size);
    }
    const std::string command =
        std::string("exec ") + WHOLEHAND_PROGRAM + " live " + arguments + " >" + (folder_ / "out") + " 2>" + (folder_ / "err");
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  void send(int signal) const { kill(process_, signal); }
  LiveOutcome wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), file_text(folder_ / "out"),
            file_text(folder_ / "err")};
  }
  std::string out() const { return file_text(folder_ / "out"); }
  std::string errors() const { return file_text(folder_ / "err"); }

 private:
  TemporaryFolder folder_;
  pid_t process_ = 0;
};

TEST(Live, ShowsAWholeSessionWithoutADevice) {
  const LiveOutcome outcome = Program("--no-clock").wait();
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  for (const char* part : {"tutorial is at its destination", "beaker3 is held at 130 mm",
                           "grasps 4, lost 0, destinations 1; the task is done", "red 7"})
    EXPECT_NE(outcome.output.find(part), std::string::npos) << outcome.output << "lacks " << part;
}

TEST(Live, KeepsItsRateWithAClock) {
  const TemporaryFolder folder;
  const LiveOutcome outcome = Program(patient_board(folder) + " --json --seconds 2 --rate 1250").wait();
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const auto report = parse_json(outcome.output);
  EXPECT_EQ(report["rate_Hz"], 1250);
  EXPECT_EQ(report["ticks"].get<int>() + report["missed"].get<int>(), 2500) << "every period is a tick or missed";
  EXPECT_GT(report["ticks"], 1250);
  EXPECT_NEAR(report["period_s"]["p50"], 8e-4, 2e-4);
  EXPECT_TRUE(report["fault"].is_null());
}

// What a page would post of a mouse that takes the board's first full beaker from its place, over the target, and tilts it there.
nlohmann::json dragged(const Scene& scene, double time) {
  const Triple home = scene.vessels[1].place, mouth = scene.task->target_place;
  // at 75 degrees the lip is 4 cm below the tips and 5 cm further from the person
  const Triple held{home[0], home[1] + 0.07, home[2]}, lifted{home[0], home[1] + 0.3, home[2]},
      over{mouth[0], mouth[1] + 0.12, mouth[2] + 0.05};
  Triple place = point_between({0, 0.07, 0.19}, held, ease(time, 0, 1));
  place = point_between(place, lifted, ease(time, 2, 2.7));
  place = point_between(place, over, ease(time, 2.7, 3.5));
  const double tilt = radians(75) * ease(time, 3.5, 4.7), c = std::cos(tilt), s = std::sin(tilt);
  return {{"position", place},
          {"rotation", {1, 0, 0, 0, c, s, 0, -s, c}},
          {"gap", 0.125 + (0.079 - 0.125) * ease(time, 1.1, 1.8)},
          {"buttons", 0},
          {"sequence", static_cast<std::int64_t>(time * 1000) + 1}};
}

// Everything between a mouse and the target container but the mouse: requests, parser, gripper, loop.
TEST(Live, WhatAPagePostsGraspsLiftsTiltsAndPours) {
  const TemporaryFolder folder;
  const Scene scene = board_scene();
  Program program(patient_board(folder) + " --view --device view --json");
  for (int k = 0; k < 1200 && program.errors().find("/\n") == std::string::npos; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const ViewAddress page(program.errors());
  ASSERT_NE(page.port, 0) << program.errors();
  HttpSocket socket(page.port);
  const auto began = std::chrono::steady_clock::now();
  for (double time = 0; time < 7;) {  // from 5 s on the vessel stays as it is, and pours
    socket.send(page.post(json_text(dragged(scene, time))));
    ASSERT_EQ(socket.read_reply().status, 204) << time;
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
    time = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  }
  socket.send(page.post("{}"));
  const HttpReply refused = socket.read_reply();
  EXPECT_EQ(refused.status, 400);
  EXPECT_EQ(refused.body.rfind("control: 'position' is missing", 0), 0u) << refused.body;
  program.send(SIGINT);
  const LiveOutcome outcome = program.wait();
  ASSERT_EQ(outcome.code, 130) << outcome.errors;
  const auto report = parse_json(outcome.output);
  EXPECT_EQ(report["fault"], "interrupted");
  EXPECT_EQ(report["device"]["address"], "view");
  EXPECT_EQ(report["grasps"], 1);
  EXPECT_EQ(report["lost"], 0) << "it is held until the end";
  const auto red =
      std::find_if(report["amounts"].begin(), report["amounts"].end(), [](const auto& a) { return a["liquid"] == "red"; });
  EXPECT_GT((*red)["arrived_m3"], 20e-6);
  EXPECT_LT((*red)["spilled_m3"], (*red)["arrived_m3"]);
}

// Sixty frames a second at most, and of all of them the last.
TEST(Live, StreamsToWhoeverListens) {
  struct Heard {
    int frames = 0;
    std::string state;
  } heard;
  const lo_server server = lo_server_new(nullptr, nullptr);
  lo_server_add_method(
      server, "/wholehand/state", "is",
      [](const char*, const char*, lo_arg** values, int, lo_message, void* to) {
        static_cast<Heard*>(to)->state = static_cast<const char*>(static_cast<void*>(values[1]));
        return 0;
      },
      &heard);
  lo_server_add_method(
      server, "/wholehand/end", "i",
      [](const char*, const char*, lo_arg**, int, lo_message, void* to) {
        ++static_cast<Heard*>(to)->frames;
        return 0;
      },
      &heard);
  const TemporaryFolder folder;
  Program program(patient_board(folder) +
                  " --json --seconds 2 --stream osc://localhost:" + std::to_string(lo_server_get_port(server)));
  while (heard.state != "released" && lo_server_recv_noblock(server, 60000) > 0) {
  }
  while (lo_server_recv_noblock(server, 200) > 0) {
  }
  lo_server_free(server);
  const LiveOutcome outcome = program.wait();
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("--stream"), std::string::npos) << "it stays on this machine";
  EXPECT_EQ(heard.state, "released");
  EXPECT_GT(heard.frames, 10) << "on however busy a machine";
  EXPECT_LE(heard.frames, 2 * 60 + 2);
}

// A replay feels and records the session again, to the bit.
TEST(Live, AReplayGivesTheSameForcesToTheBit) {
  const TemporaryFolder folder;
  const std::string first = folder / "first.nc", second = folder / "second.nc";
  // with a clock: a session in which periods may be missed
  const LiveOutcome once = Program(patient_board(folder) + " --seconds 4 --record " + first).wait();
  ASSERT_EQ(once.code, 0) << once.errors;
  const LiveOutcome again = Program("--no-clock --device replay:" + first + " --record " + second).wait();
  ASSERT_EQ(again.code, 0) << again.errors;
  const device::Recording a = device::read_recording(first), b = device::read_recording(second);
  ASSERT_GT(a.ticks.size(), 1000u);
  ASSERT_EQ(a.ticks.size(), b.ticks.size());
  int held = 0;
  for (std::size_t k = 0; k < a.ticks.size(); ++k) {
    ASSERT_EQ(a.ticks[k].number, b.ticks[k].number) << k;
    ASSERT_EQ(a.ticks[k].state, b.ticks[k].state) << k;
    ASSERT_EQ(a.ticks[k].written.arm, b.ticks[k].written.arm) << k;
    ASSERT_EQ(a.ticks[k].written.grip, b.ticks[k].written.grip) << k;
    held += device::is_held(a.ticks[k].state);
  }
  EXPECT_GT(held, 100) << "of a session in which something is held";
  EXPECT_EQ(a.ticks.back().state, device::SessionState::released);
}

// The recording says whose hand it was: a replay has that hand, and so the same closures.
TEST(Live, AReplayHasThePersonsHand) {
  const TemporaryFolder folder;
  const std::string first = folder / "first.nc", second = folder / "second.nc";
  const LiveOutcome once = Program("--person 3 --seed 2 --no-clock --seconds 12 --record " + first).wait();
  ASSERT_EQ(once.code, 0) << once.errors;
  const LiveOutcome again = Program("--no-clock --device replay:" + first + " --record " + second).wait();
  ASSERT_EQ(again.code, 0) << again.errors;
  const device::Recording a = device::read_recording(first), b = device::read_recording(second);
  ASSERT_EQ(a.ticks.size(), b.ticks.size());
  for (std::size_t k = 0; k < a.ticks.size(); ++k) {
    ASSERT_EQ(a.ticks[k].closure, b.ticks[k].closure) << k;
    ASSERT_EQ(a.ticks[k].touch_mask, b.ticks[k].touch_mask) << k;
    ASSERT_EQ(a.ticks[k].written.grip, b.ticks[k].written.grip) << k;
  }
  EXPECT_EQ(b.info.person, std::optional<std::uint64_t>(3));
  EXPECT_EQ(b.info.seed, 2u);
  EXPECT_GT(a.ticks.back().grasps, 0) << "of a session in which something is held";
}

TEST(Live, SignalsEndItCleanly) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const TemporaryFolder folder;
    const std::string file = folder / "a.nc";
    Program program(patient_board(folder) + " --record " + file);
    // until something is held: a force is on the gripper then
    for (int k = 0; k < 600 && program.out().find("is held") == std::string::npos; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    program.send(signal);
    const LiveOutcome outcome = program.wait();
    EXPECT_EQ(outcome.code, 130) << signal << outcome.errors;
    const device::Recording recording = device::read_recording(file);
    ASSERT_FALSE(recording.ticks.empty());
    const device::Tick& last = recording.ticks.back();
    EXPECT_EQ(last.state, device::SessionState::released) << signal;
    EXPECT_EQ(last.fault, device::Fault::interrupted) << signal;
    EXPECT_EQ(last.written.grip, 0) << signal;
    EXPECT_GT(recording.ticks[recording.ticks.size() - 2].written.grip, 0.5) << "it let go at once";
    ASSERT_TRUE(recording.end);
    EXPECT_EQ(recording.end->fault, device::Fault::interrupted);
  }
}

// The disk ends the recording, not the session; but what was asked for is not all there.
TEST(Live, AFullDiskEndsTheRecordingAndNotTheSession) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.nc";
  const LiveOutcome outcome = Program("--no-clock --record " + file, 4 << 20).wait();
  EXPECT_EQ(outcome.code, 3) << outcome.errors;
  EXPECT_NE(outcome.output.find("the task is done"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("recorded in part in " + file), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.errors.rfind("wholehand: live: ", 0), 0u) << "told as it happens: " << outcome.errors;
  EXPECT_NE(outcome.errors.find("File too large"), std::string::npos) << outcome.errors;
  EXPECT_GT(device::read_recording(file).ticks.size(), 1000u);
}

// Somebody's file at the recording's name stays, and nothing of the recording is lost.
TEST(Live, OneLineSaysWhereTheRecordingIsWhenItsNameIsTaken) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.nc";
  Program program(patient_board(folder) + " --seconds 30 --record " + file);
  for (int k = 0; k < 6000 && !fs::exists(file + ".partial"); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  write_file(file, "a letter");
  const LiveOutcome outcome = program.wait();
  EXPECT_EQ(outcome.code, 3) << "nothing is at the name that was asked for";
  EXPECT_EQ(outcome.errors, "wholehand: live: " + file +
                                ": another file appeared there during the session, and is not overwritten; the complete "
                                "recording is " +
                                file + ".partial\n");
  EXPECT_NE(outcome.output.find("recorded in " + file + ".partial\n"), std::string::npos) << outcome.output;
  EXPECT_EQ(outcome.output.find("another file"), std::string::npos) << "said once: " << outcome.output;
  EXPECT_EQ(file_text(file), "a letter");
  const device::Recording recording = device::read_recording(file + ".partial");
  EXPECT_EQ(recording.note, "");
  EXPECT_GT(recording.ticks.size(), 0u);
  EXPECT_TRUE(recording.end);
}

void expect_refused(const std::string& arguments, int code, const std::string& gist) {
  const LiveOutcome outcome = Program(arguments).wait();
  EXPECT_EQ(outcome.code, code) << arguments << outcome.errors;
  EXPECT_EQ(outcome.output, "") << arguments;
  EXPECT_EQ(outcome.errors.rfind("wholehand: ", 0), 0u) << outcome.errors;
  EXPECT_EQ(outcome.errors.find('\n'), outcome.errors.size() - 1) << outcome.errors;
  EXPECT_NE(outcome.errors.find(gist), std::string::npos) << outcome.errors << "lacks " << gist;
}

TEST(Live, RefusesWhatIsNotAllowedInOneLine) {
  const TemporaryFolder folder;
  std::ofstream(folder / "notes.txt") << "not a recording";
  expect_refused("--device robot", 2, "--device 'robot': allowed: sim");
  expect_refused("--rate 100", 2, "--rate");
  expect_refused("--person -1", 2, "--person");
  expect_refused("--person a", 2, "--person");
  expect_refused("--person 3 --device hid", 2, "--person: only the simulated gripper is held by a virtual person");
  expect_refused("--person 3 --device replay:" + (folder / "notes.txt"), 2, "--person: only the simulated gripper");
  expect_refused("--rate 10000", 2, "--rate");
  expect_refused("--seconds 0", 2, "--seconds");
  expect_refused("--no-clock --device hid", 2, "--no-clock");
  expect_refused("--device view", 2, "--device view: the page of the view is the gripper, and there is no view; add --view");
  expect_refused("--device osc:9000x", 2,
                 "--device 'osc:9000x': its port is not a whole number from 0 to 65535; allowed: osc:PORT, or osc:HOST:PORT");
  expect_refused("--no-clock --device osc:0", 2, "--no-clock");
  expect_refused("--device osc:192.0.2.7:9000", 3, "osc:192.0.2.7:9000: this machine cannot listen there");
  expect_refused("--device haply:10001x", 2,
                 "--device 'haply:10001x': its port is not a whole number from 1 to 65535; allowed: haply, ");
  expect_refused("--device haply:1", 3, "haply:1: no Inverse Service answers there (Connection refused); start it ");
  // a session that would hear itself
  for (const char* arguments :
       {"--device osc:9000 --stream osc://127.0.0.1:9000", "--device osc:9000 --stream osc://localhost:9000",
        "--device osc:0.0.0.0:9000 --stream osc://127.0.0.1:9000"})
    expect_refused(arguments, 2, " listens there for its hand; give one of the two another port");
  expect_refused("--stream http://127.0.0.1:9000", 2, "--stream 'http://127.0.0.1:9000': it does not begin with osc://");
  expect_refused("--stream osc://127.0.0.1", 2, "there is no port");
  expect_refused("--stream osc://a..b:9000", 3, "host 'a..b' is not found");
  expect_refused("--no-clock --stream osc://127.0.0.1:9000", 2, "--stream: it sends a session in real time");
  expect_refused("--device replay:" + (folder / "none.nc"), 2, "none.nc");
  expect_refused("--device replay:" + (folder / "notes.txt"), 2, "notes.txt");
  expect_refused("--rate 2000 --device replay:" + (folder / "notes.txt"), 2, "--rate: a recording is replayed at its own rate");
  expect_refused("three_beakers", 2,
                 "stand in each other; a live session needs place_mm for each; shipped scenes whose vessels have "
                 "places: mixing_board");
  // only where places would help
  std::string many;
  for (int k = 0; k <= device::LIVE_VESSELS; ++k)
    many +=
        "[[vessel]]\nname = \"v" + std::to_string(k) + "\"\nshape = \"cylinder\"\ndiameter_mm = 76\nheight_mm = 100\nwall_mm = 2\n";
  write_file(folder / "many.toml", many);
  expect_refused(folder / "many.toml", 2, "this scene has " + std::to_string(device::LIVE_VESSELS + 1) + "\n");
  expect_refused("no_such_scene", 2, "no_such_scene");
  expect_refused("--record " + (folder / "notes.txt"), 2, "notes.txt");
  EXPECT_EQ(file_text(folder / "notes.txt"), "not a recording") << "it is still there";
  expect_refused("--record " + (folder / "none/a.nc"), 2, "none");
}

// From the theory of rendered walls: gains beyond it need --unsafe-gains.
TEST(Live, GainsThatAreNotStableAreRefused) {
  const TemporaryFolder folder;
  std::string text = file_text(find_scene("mixing_board"));
  std::ofstream(folder / "stiff.toml") << text << "\n[live]\nK_N_m = 5000\n";
  expect_refused(folder / "stiff.toml", 2, "K_N_m = 5000 with B_Ns_m = 1, and the device feels 2 times these values");
  EXPECT_EQ(Program((folder / "stiff.toml") + " --unsafe-gains --no-clock --seconds 1").wait().code, 0);
  EXPECT_EQ(Program((folder / "stiff.toml") + " --rate 8000 --no-clock --seconds 1").wait().code, 0) << "a higher rate bears more";
}

}  // namespace
}  // namespace wholehand
