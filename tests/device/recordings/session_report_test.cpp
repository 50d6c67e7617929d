// SPDX-License-Identifier: MIT
// Sessions made up from known courses: every number of the report is known beforehand.
// sanitizers: address
#include "device/recordings/session_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "base/files/json.h"
#include "tests/support/recorded_session.h"
#include "tests/support/special_values.h"

namespace wholehand::device {
namespace {

TEST(SessionReport, TimesOfStatesAndGrasps) {
  RecordedSession session;
  session.stretch(0.5, SessionState::free).stretch(0.25, SessionState::touching).hold(1);
  session.stretch(1, SessionState::lift).stretch(2, SessionState::tilt).stretch(0.5, SessionState::lift);
  session.stretch(1, SessionState::tilt).skip(100).stretch(3, SessionState::maintain).stretch(0.125, SessionState::free);
  session.stretch(0.25, SessionState::released);
  const SessionReport report = session.report();
  const double expected[] = {0.625, 0.25, 1.5, 3.1, 3, 0, 0.25, 0};
  for (std::size_t k = 0; k < SESSION_STATES; ++k)
    EXPECT_NEAR(report.time_in_state[k], expected[k], 1e-9) << SESSION_STATE_NAMES[k];
  EXPECT_NEAR(report.duration, 8.725, 1e-9);
  EXPECT_EQ(report.missed, 100);
  ASSERT_EQ(report.grasps.size(), 1u);
  const GraspReport& grasp = report.grasps[0];
  EXPECT_EQ(grasp.vessel, 1);
  EXPECT_NEAR(grasp.start, 0.75, 1e-9);
  EXPECT_NEAR(grasp.end, 8.35, 1e-9);
  EXPECT_NEAR(grasp.duration[0], 1.5, 1e-9);
  EXPECT_NEAR(grasp.duration[1], 3.1, 1e-9);  // the missed periods count for the state before them
  EXPECT_NEAR(grasp.duration[2], 3, 1e-9);
  ASSERT_EQ(report.runs.size(), 9u);
  EXPECT_EQ(report.runs[5].state, SessionState::tilt);
  EXPECT_EQ(report.runs[5].vessel, 1);
  EXPECT_NEAR(report.runs[5].start, 4.25, 1e-9);
  EXPECT_NEAR(report.runs[5].duration, 1.1, 1e-9);
  EXPECT_NEAR(report.runs[8].duration, 0.25, 1e-9);
}

// The fingers are pushed open for 120 ms and stop: the response ends there, to within half the filter's window.
TEST(SessionReport, ResponseTimeUntilTheGapIsAtRest) {
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    for (const double step : {0.0, 10e-6}) {  // of an encoder
      RecordedSession session(rate);
      session.stretch(0.3, SessionState::touching, [](double t, Tick& tick) { tick.device.gap = ramp_to(t, 0.3, 0.03, 0.02); })
          .hold(0);
      session.stretch(1, SessionState::lift, [step](double t, Tick& tick) {
        tick.device.gap = ramp_to(t, 0.12, 0.02, 0.0224);
        if (step > 0) tick.device.gap = step * std::round(tick.device.gap / step);
        tick.user_force = ramp_to(t, 0.12, 0.8, 3.76);
      });
      const GraspReport grasp = only_grasp(session);
      EXPECT_NEAR(grasp.response_time, 0.12, 0.011) << rate << " Hz, " << step;
      EXPECT_NEAR(grasp.tightened, 3.76, 1e-6);
      EXPECT_NEAR(grasp.before.mean, 3.76, 1e-6) << "only since then";
    }
  }
}

TEST(SessionReport, ResponseTimeNeedsCalmOf50Milliseconds) {
  // at rest for 40 ms, moving for 20 ms, again and again; then at rest
  const auto stop_and_go = [](double rest) {
    return [rest](double t, Tick& tick) {
      if (t < 0.6 && std::fmod(t, rest + 0.02) >= rest) tick.device.gap += 5e-6;  // 5 mm/s
    };
  };
  RecordedSession session;
  session.hold(0).stretch(1, SessionState::lift, stop_and_go(0.04));
  EXPECT_NEAR(only_grasp(session).response_time, 0.6, 0.011);
  RecordedSession calmer;
  calmer.hold(0).stretch(1, SessionState::lift, stop_and_go(0.08));
  EXPECT_NEAR(only_grasp(calmer).response_time, 0, 1e-9);
  // slower than 2 mm/s is at rest, faster is not
  for (const double speed : {1.9e-3, 2.1e-3}) {
    RecordedSession slow;
    slow.hold(0).stretch(1, SessionState::lift, [speed](double, Tick& tick) { tick.device.gap -= speed / 1000; });
    EXPECT_EQ(only_grasp(slow).response_time == 0, speed < 2e-3) << speed;
    EXPECT_EQ(std::isnan(only_grasp(slow).response_time), speed > 2e-3) << speed;
  }
}

TEST(SessionReport, NoResponseBeforeTheTilt) {
  RecordedSession session;
  const auto moving = [](double, Tick& tick) { tick.device.gap += 3e-6; };
  session.hold(0).stretch(0.5, SessionState::lift, moving).stretch(1, SessionState::tilt);
  const GraspReport grasp = only_grasp(session);
  EXPECT_TRUE(std::isnan(grasp.response_time));
  EXPECT_TRUE(std::isnan(grasp.tightened));
}

TEST(SessionReport, ResponseTimeWithoutSomeMeasurements) {
  RecordedSession session;
  session.hold(0).stretch(1, SessionState::lift, [](double t, Tick& tick) {
    const bool is_missing = tick.number % 3 == 0;
    tick.read = is_missing ? ReadOutcome::timeout : ReadOutcome::value;
    tick.device.gap = is_missing ? NOT_A_NUMBER : ramp_to(t, 0.2, 0.02, 0.025);
  });
  EXPECT_NEAR(only_grasp(session).response_time, 0.2, 0.012);
}

TEST(SessionReport, GripForceBeforeDuringAndAfter) {
  RecordedSession session;
  const auto about = [](double mean) {
    return [mean](double, Tick& tick) { tick.user_force = mean + (tick.number % 2 == 0 ? 0.3 : -0.3); };
  };
  session.stretch(0.1, SessionState::touching, about(9)).hold(0);
  session.stretch(1, SessionState::lift, about(2));
  session.with([](Tick& tick) { tick.tilt = radians(60); });
  session.stretch(2, SessionState::tilt, about(3)).stretch(1, SessionState::maintain, about(5));
  session.stretch(0.5, SessionState::free, about(9));
  // the first tilted tick has the largest tilt already: the way there is one tick
  GraspReport grasp = only_grasp(session);
  EXPECT_NEAR(grasp.before.mean, 2, 1e-9);
  EXPECT_NEAR(grasp.before.deviation, 0.3, 1e-3);
  EXPECT_EQ(grasp.before.count, 1000u);
  EXPECT_EQ(grasp.during.count, 1u);
  EXPECT_NEAR(grasp.after.mean, 5, 1e-9);
  EXPECT_EQ(grasp.after.count, 1000u);
  grasp = only_grasp(tilted_session(
      radians(90), [](double x) { return linear_between(x, 2, 4); }, [](double) { return 0.8; }));
  EXPECT_NEAR(grasp.before.mean, 2, 1e-9);
  EXPECT_NEAR(grasp.before.deviation, 0, 1e-9);
  EXPECT_NEAR(grasp.during.mean, 3, 2e-3);
  EXPECT_NEAR(grasp.during.deviation, 2 / std::sqrt(12), 2e-3);
  EXPECT_NEAR(grasp.after.mean, 4, 1e-9);
}

TEST(SessionReport, WayToTheTiltThatIsMaintained) {
  const RecordedSession session = tilted_session(
      radians(80), [](double) { return 2; }, [](double x) { return linear_between(x, 0.8, 2); });
  const GraspReport grasp = only_grasp(session);
  EXPECT_NEAR(degrees(grasp.largest_tilt), 80, 1e-9);
  EXPECT_NEAR(grasp.tilt_start, 1.2, 1e-9);
  EXPECT_NEAR(grasp.tilt_time, 2, 1e-9);
  EXPECT_NEAR(grasp.normal_increase, 1.2, 1e-3);
  EXPECT_NEAR(grasp.grip_change, 0, 1e-9);
}

// A tilt with a rest on the way, and back: the way there ends at the largest tilt.
TEST(SessionReport, WayBackDoesNotCount) {
  RecordedSession session;
  const auto to = [](double from, double until, double seconds) {
    return [=](double t, Tick& tick) {
      tick.tilt = radians(ramp_to(t, seconds, from, until));
      tick.normal_force = 0.8 + tick.tilt;
    };
  };
  session.hold(0).stretch(1, SessionState::lift, to(0, 0, 1)).stretch(1, SessionState::tilt, to(0, 40, 1));
  session.stretch(1, SessionState::maintain).stretch(1, SessionState::tilt, to(40, 90, 1));
  session.stretch(1, SessionState::tilt, to(90, 0, 1)).stretch(1, SessionState::lift, to(0, 0, 1));
  const GraspReport grasp = only_grasp(session);
  EXPECT_NEAR(grasp.tilt_start, 1, 1e-9);
  EXPECT_NEAR(grasp.tilt_time, 3, 2e-3);
  EXPECT_NEAR(grasp.normal_increase, radians(90), 0.1);
  EXPECT_EQ(grasp.after.count, 0u);
}

// Two slips: 100 ms at 20 mm/s, of which the last 30 ms with enough force, and 50 ms at 10 mm/s that also turn it.
TEST(SessionReport, SlipsInTheFingers) {
  RecordedSession session;
  session.hold(0).with([](Tick& tick) { tick.safety_margin = 0.5; }).stretch(0.2, SessionState::lift);
  session.stretch(0.1, SessionState::lift, [](double t, Tick& tick) {
    tick.safety_margin = t < 0.0695 ? -0.25 : 0.125;
    tick.slip_speed = 20e-3;
    tick.slip_distance += 20e-6;
  });
  session.with([](Tick& tick) { tick.slip_speed = 0; }).stretch(0.3, SessionState::lift);
  session.stretch(0.05, SessionState::lift, [](double, Tick& tick) {
    tick.safety_margin = -1;
    tick.slip_speed = 10e-3;
    tick.slip_distance += 10e-6;
    tick.slip_angle -= 1e-3;
  });
  session
      .with([](Tick& tick) {
        tick.slip_speed = 0;
        tick.safety_margin = 1;
      })
      .stretch(0.1, SessionState::lift);
  const GraspReport grasp = only_grasp(session);
  ASSERT_TRUE(grasp.slip.is_measured());
  EXPECT_EQ(grasp.slip.slips, 2);
  EXPECT_NEAR(grasp.slip.distance, 2.5e-3, 1e-12);
  EXPECT_NEAR(grasp.slip.turned, -0.05, 1e-12);
  EXPECT_NEAR(grasp.slip.below_hold, 0.12, 1e-9);
  EXPECT_EQ(grasp.slip.least_margin, -1);
  const auto json = parse_json(session_json(session.report()));
  EXPECT_EQ(json["grasps"][0]["slip"]["slips"], 2);
  EXPECT_NE(session_table(session.report())
                .find("one at 0.000 s: slid 2 times in the fingers, by 2.5 mm and -2.9 degrees; 0.120 s "
                      "with less grip than holding takes"),
            std::string::npos);
  const std::string csv = grasps_csv(session.report());
  EXPECT_NE(csv.find("slips,slip_mm,slip_turned_deg,below_hold_s,least_margin_N,type"), std::string::npos);
}

TEST(SessionReport, WithoutSlidingThereAreNoSlips) {
  RecordedSession session;
  session.hold(0).stretch(0.2, SessionState::lift);
  EXPECT_FALSE(only_grasp(session).slip.is_measured());
  EXPECT_TRUE(parse_json(session_json(session.report()))["grasps"][0]["slip"].is_null());
}

TEST(SessionReport, HowGraspsEnd) {
  RecordedSession session;
  session.hold(0).stretch(0.2, SessionState::lift).stretch(0.2, SessionState::free);  // let go
  session.hold(1).stretch(0.2, SessionState::lift).with([](Tick& tick) { ++tick.lost; });
  session.stretch(0.2, SessionState::slipped).stretch(0.1, SessionState::free);         // lost
  session.hold(0).stretch(0.2, SessionState::lift).stretch(0.2, SessionState::let_go);  // set down
  session.hold(0).stretch(0.2, SessionState::lift).with([](Tick& tick) { tick.fault = Fault::jump; });
  session.stretch(0.2, SessionState::released).with([](Tick& tick) { tick.fault = Fault::none; });  // released
  session.hold(0).stretch(0.2, SessionState::lift);
  const SessionReport report = session.report();
  ASSERT_EQ(report.grasps.size(), 5u);
  EXPECT_EQ(report.grasps[0].outcome, GraspOutcome::let_go);
  EXPECT_EQ(report.grasps[1].outcome, GraspOutcome::lost);
  EXPECT_EQ(report.grasps[2].outcome, GraspOutcome::let_go);
  EXPECT_EQ(report.grasps[3].outcome, GraspOutcome::released);
  EXPECT_EQ(report.grasps[4].outcome, GraspOutcome::recording_ends);
  EXPECT_EQ(report.lost, 1);
  EXPECT_EQ(report.fault, Fault::jump);
  ASSERT_EQ(report.vessels.size(), 3u);
  EXPECT_EQ(report.vessels[0].grasps, 4);
  EXPECT_EQ(report.vessels[0].lost, 0);
  EXPECT_EQ(report.vessels[1].lost, 1);
  EXPECT_EQ(report.vessels[2].name, "all");
  EXPECT_EQ(report.vessels[2].grasps, 5);
  EXPECT_EQ(report.vessels[2].lost, 1);
}

// From one vessel straight to another: two grasps.
TEST(SessionReport, GraspsAreOfOneVessel) {
  RecordedSession session;
  session.hold(0).stretch(0.2, SessionState::lift).hold(1).stretch(0.3, SessionState::lift);
  const SessionReport report = session.report();
  ASSERT_EQ(report.grasps.size(), 2u);
  EXPECT_NEAR(report.grasps[1].start, 0.2, 1e-9);
  EXPECT_EQ(report.grasps[1].vessel, 1);
}

TEST(SessionReport, GripLostOnTheWayIsNotAnalyzed) {
  RecordedSession session;
  const auto turning = [](double t, Tick& tick) {
    tick.tilt = radians(60 * t);
    tick.user_force = 3 - t;
    tick.normal_force = 0.8 + t;
  };
  session.hold(0).stretch(0.5, SessionState::lift).stretch(1, SessionState::tilt, turning);
  session.with([](Tick& tick) { ++tick.lost; }).stretch(0.2, SessionState::slipped);
  const GraspReport grasp = only_grasp(session);
  EXPECT_EQ(grasp.outcome, GraspOutcome::lost);
  EXPECT_EQ(grasp.course, GripCourse::not_analyzed);
  EXPECT_NEAR(grasp.tilt_start, 0.5, 1e-9);
  EXPECT_TRUE(std::isnan(grasp.tilt_time));
  EXPECT_NEAR(degrees(grasp.largest_tilt), 60, 0.1);
}

TEST(SessionReport, LiquidGuidanceAndTask) {
  RecordedSession session;
  session.recording.info.amounts = {{"water", 100e-6}, {"oil", 50e-6}};
  session.recording.info.tolerance = 2e-6;
  session.with([](Tick& tick) { tick.volume[0] = 200e-6; }).stretch(0.1, SessionState::free).hold(0);
  session.with([](Tick& tick) { tick.guidance_distance = 4e-3; });
  session.stretch(1, SessionState::lift, [](double t, Tick& tick) { tick.volume[0] = ramp_to(t, 0.5, 200e-6, 90e-6); });
  session.with([](Tick& tick) { tick.guidance_distance = NOT_A_NUMBER; });
  // it falls for a while after the grasp
  session.stretch(0.2, SessionState::free, [](double t, Tick& tick) {
    tick.arrived[0] = ramp_to(t, 0.1, 0, 101e-6);
    tick.spilled[0] = ramp_to(t, 0.1, 0, 9e-6);
  });
  session.hold(1).stretch(0.1, SessionState::lift).hold(0).stretch(0.1, SessionState::lift);
  session.with([](Tick& tick) {
    tick.destinations = 2;
    tick.task_done = true;
    tick.arrived[1] = 40e-6;
  });
  session.stretch(0.1, SessionState::free);
  const SessionReport report = session.report();
  ASSERT_EQ(report.grasps.size(), 3u);
  EXPECT_NEAR(report.grasps[0].guidance_distance, 4e-3, 1e-12);
  EXPECT_TRUE(std::isnan(report.grasps[1].guidance_distance));
  EXPECT_NEAR(report.grasps[0].poured, 110e-6, 1e-12);
  EXPECT_NEAR(report.grasps[0].arrived, 101e-6, 1e-12);
  EXPECT_NEAR(report.grasps[0].spilled, 9e-6, 1e-12);
  EXPECT_NEAR(report.grasps[1].arrived, 40e-6, 1e-12);
  EXPECT_NEAR(report.grasps[2].arrived, 0, 1e-12) << "counted with the first";
  EXPECT_EQ(report.destinations, 2);
  EXPECT_TRUE(report.task_done);
  ASSERT_EQ(report.amounts.size(), 2u);
  EXPECT_EQ(report.amounts[0].liquid, "water");
  EXPECT_NEAR(report.amounts[0].arrived, 101e-6, 1e-12);
  EXPECT_NEAR(report.amounts[0].spilled, 9e-6, 1e-12);
  EXPECT_TRUE(report.amounts[0].is_within);
  EXPECT_NEAR(report.amounts[1].wanted, 50e-6, 1e-12);
  EXPECT_FALSE(report.amounts[1].is_within);
}

TEST(SessionReport, MeansAndDeviationsOverGrasps) {
  RecordedSession session;
  for (const double grip : {2.0, 3.0, 7.0}) {
    session.hold(1).stretch(0.5, SessionState::lift, [grip](double, Tick& tick) { tick.user_force = grip; });
    session.stretch(0.1, SessionState::free);
  }
  const SessionReport report = session.report();
  EXPECT_NEAR(report.vessels[1].before.mean, 4, 1e-9);
  EXPECT_NEAR(report.vessels[1].before.deviation, std::sqrt(7.0), 1e-9);
  EXPECT_EQ(report.vessels[1].before.count, 3u);
  EXPECT_EQ(report.vessels[0].before.count, 0u);
  EXPECT_TRUE(std::isnan(report.vessels[0].before.mean));
  EXPECT_EQ(report.vessels[1].courses[0], 3);
  MeanSum one;
  one.add(5);
  one.add(NOT_A_NUMBER);
  EXPECT_EQ(one.result().mean, 5);
  EXPECT_TRUE(std::isnan(one.result().deviation));
}

TEST(SessionReport, TimingOfTheLoop) {
  RecordedSession session;
  session.stretch(1, SessionState::free, [](double, Tick& tick) {
    tick.step_time = 1e-6 * static_cast<double>((tick.number * 7) % 1000 + 1);  // 1 to 1000 us, each once
    tick.latency = tick.number == 500 ? 250e-6 : 50e-6;
  });
  const SessionReport report = session.report();
  EXPECT_NEAR(report.step.p50, 500e-6, 1e-12);
  EXPECT_NEAR(report.step.p99, 990e-6, 1e-12);
  EXPECT_NEAR(report.step.p999, 999e-6, 1e-12);
  EXPECT_NEAR(report.step.max, 1000e-6, 1e-12);
  EXPECT_NEAR(report.latency.p50, 50e-6, 1e-12);
  EXPECT_NEAR(report.latency.max, 250e-6, 1e-12);
  EXPECT_NEAR(report.period.p50, 1e-3, 1e-12);
  EXPECT_NEAR(report.period.max, 1.2e-3, 1e-12);
  EXPECT_EQ(report.missed, 0);
}

TEST(SessionReport, OfNothingAndOfNoNumbers) {
  const SessionReport empty = RecordedSession().report();
  EXPECT_EQ(empty.ticks, 0u);
  EXPECT_TRUE(empty.grasps.empty());
  EXPECT_NE(session_table(empty), "");
  EXPECT_FALSE(parse_json(session_json(empty)).empty());
  RecordedSession session = tilted_session(
      radians(90), [](double) { return NOT_A_NUMBER; }, [](double) { return NOT_A_NUMBER; });
  for (Tick& tick : session.recording.ticks) tick.device.gap = tick.volume[0] = NOT_A_NUMBER;
  const GraspReport grasp = only_grasp(session);
  EXPECT_EQ(grasp.course, GripCourse::not_analyzed);
  EXPECT_EQ(grasp.before.count, 0u);
  EXPECT_TRUE(std::isnan(grasp.response_time));
  EXPECT_TRUE(parse_json(session_json(session.report()))["grasps"][0]["poured_m3"].is_null());
  EXPECT_EQ(grasps_csv(session.report()).find("nan"), std::string::npos);
  EXPECT_EQ(session_table(session.report()).find("nan"), std::string::npos);
}

TEST(SessionReport, TableCsvAndJsonSayTheSame) {
  const RecordedSession session = tilted_session(
      radians(90), [](double x) { return linear_between(x, 3, 6); }, [](double x) { return linear_between(x, 0.8, 2); });
  const SessionReport report = session.report();
  const auto json = parse_json(session_json(report));
  ASSERT_EQ(json["grasps"].size(), 1u);
  EXPECT_EQ(json["grasps"][0]["vessel"], "one");
  EXPECT_EQ(json["grasps"][0]["type"], "G2");
  EXPECT_EQ(json["grasps"][0]["outcome"], "let go");
  EXPECT_DOUBLE_EQ(json["grasps"][0]["grip_change_N"].get<double>(), report.grasps[0].grip_change);
  EXPECT_DOUBLE_EQ(json["grasps"][0]["duration_s"]["maintain"].get<double>(), 1);
  EXPECT_EQ(json["vessels"][2]["types"]["G2"], 1);
  EXPECT_DOUBLE_EQ(json["time_in_state_s"]["tilt"].get<double>(), report.time_in_state[3]);
  const std::string table = session_table(report);
  for (const char* part :
       {"Session of 4.700 s in bench, on omega.7, 1,000 Hz", "maintain  1.000", "G2", "let go", "grasps 1, lost 0"})
    EXPECT_NE(table.find(part), std::string::npos) << part << " is not in\n" << table;
  const std::string csv = grasps_csv(report);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
  const auto cells = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  EXPECT_EQ(cells(csv.substr(0, csv.find('\n'))), cells(csv.substr(csv.find('\n'))));
  EXPECT_NE(csv.find("\n1,one,0.2,4.2,1,2,1,0,3,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",G2,"), std::string::npos) << csv;
  const std::string states = states_csv(report);
  EXPECT_NE(states.find("\n1.2,2,tilt,one\n"), std::string::npos) << states;
  EXPECT_NE(states.find("\n0,0.2,free,\n"), std::string::npos) << states;
}

TEST(SessionReport, WithoutAClockThereIsNoTiming) {
  RecordedSession session;
  session.stretch(0.5, SessionState::free);
  EXPECT_NE(session_table(session.report()).find("timing, us"), std::string::npos);
  EXPECT_TRUE(parse_json(session_json(session.report()))["timing_s"]["period"].contains("p50"));
  session.recording.info.has_clock = false;
  const std::string table = session_table(session.report());
  EXPECT_EQ(table.find("timing, us"), std::string::npos) << table;
  EXPECT_NE(table.find("timing: none, as the session ran without a clock; ticks recorded 500\n"), std::string::npos) << table;
  const auto json = parse_json(session_json(session.report()));
  EXPECT_TRUE(json["timing_s"].is_null());
  EXPECT_EQ(json["has_clock"], false);
}

TEST(TurningBack, IsZeroForOneWay) {
  const double up[] = {0, 1, 1, 3}, down[] = {3, 2, -1}, both[] = {0, 2, 1.5, 4}, gaps[] = {0, NOT_A_NUMBER, 1};
  EXPECT_EQ(turning_back(up), 0);
  EXPECT_EQ(turning_back(down), 0);
  EXPECT_EQ(turning_back(both), 0.5);
  EXPECT_EQ(turning_back(gaps), 0);
  EXPECT_EQ(turning_back({}), 0);
}

}  // namespace
}  // namespace wholehand::device
