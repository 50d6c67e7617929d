// SPDX-License-Identifier: MIT
// sanitizers: none (it runs the program)
// Whoever does what a line says to do no longer gets that line.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "tests/support/environment.h"
#include "tests/support/files.h"
#include "tests/support/meshes.h"
#include "tests/support/patient_board.h"
#include "tests/support/program.h"
#include "tests/support/sweep_results.h"

#ifdef WHOLEHAND_PROGRAM

namespace wholehand {
namespace {

// A scene and a command that get a line, words of its remedy, and what these words make of scene and command. In a command @ stands
// for the scene's file and the result's name without its end.
struct RemedyCase {
  std::string scene, command, words, mended_scene, mended_command;
};

const std::string CUP_SCENE =
    "[[vessel]]\nname = \"cup\"\nshape = \"cylinder\"\ndiameter_mm = 80\nheight_mm = 100\nwall_mm = 2\n"
    "[grips]\nheight_fraction = [0.4, 0.6]\nroll_deg = [-60, -30]\n";
const std::string EFFORTLESS = "[strength]\nefforts = false\n";
const std::string LIQUID = "[liquid]\nfills = [0, 0.5]\n", TILTS = "[tilts]\ndeg = [0, 45]\n", STRENGTH = "[strength]\n";
const std::string WHOLE = CUP_SCENE + LIQUID + TILTS + STRENGTH;

const std::string SWEEP = "sweep @.toml -o @.nc --on core ", SWEPT = SWEEP + ">/dev/null && PROGRAM ";
const std::string GRIP = "grip @.toml --vessel cup --height-mm 50 ", RANKED = SWEPT + "grip @.nc --vessel cup ";

// A page is served until somebody ends it: here once its address is there, without which it is a failure.
const std::string SHOW =
    "show() { $* >@.log 2>&1 & while ! grep -q http:// @.log && kill -0 $! 2>/dev/null; do sleep 0.05; done; "
    "grep -q http:// @.log; is_not_shown=$?; kill $! 2>/dev/null; wait $!; cat @.log; return $is_not_shown; }; ";
const std::string SHOWN = SWEEP + ">/dev/null && show PROGRAM ";

std::string board_text() {
  const TemporaryFolder folder;
  return file_text(patient_board(folder));
}

Outcome outcome_in(const TemporaryFolder& folder, const std::string& scene, const std::string& asked) {
  const std::string name = folder / "a";
  write_file(name + ".toml", scene);
  std::string command = SHOW + "PROGRAM " + asked;
  for (std::size_t at = 0; (at = command.find('@', at)) != std::string::npos;) command.replace(at, 1, name);
  return run("{ " + command + "\n} 2>&1");
}

// `code` is that of a refusal, or 0 of a note.
void expect_helps(const std::vector<RemedyCase>& cases, int code = 2) {
  for (const RemedyCase& one : cases) {
    const TemporaryFolder before, after;
    const Outcome refused = outcome_in(before, one.scene, one.command);
    EXPECT_EQ(refused.code, code) << one.command << "\n" << refused.output;
    EXPECT_TRUE(has(refused.output, one.words)) << refused.output << "lacks " << one.words;
    const Outcome followed = outcome_in(after, one.mended_scene, one.mended_command);
    EXPECT_EQ(followed.code, 0) << one.mended_command << "\n" << followed.output;
    EXPECT_FALSE(has(followed.output, one.words)) << followed.output;
  }
}

TEST(FollowedRemedies, HelpSweepAndRank) {
  const std::string rank = SWEPT + "rank @.nc ", keep = "[output]\nkeep = [\"score\"";
  expect_helps({
      {WHOLE, rank + "--where 'max(effort) < 2'", "write worst_effort, which it has", WHOLE, rank + "--where 'worst_effort < 2'"},
      {WHOLE, rank + "--where 'max(effort) < 2'", "add \"effort\" to [output] also of the scene",
       WHOLE + "[output]\nalso = [\"effort\"]\n", rank + "--where 'max(effort) < 2'"},
      {WHOLE + keep + ", \"plausible\", \"not_held\"]\n", rank + "--where 'gap_mm < 200'",
       "add \"gap\" to [output] keep of the scene", WHOLE + keep + ", \"plausible\", \"not_held\", \"gap\"]\n",
       rank + "--where 'gap_mm < 200'"},
      {WHOLE + keep + "]\n", rank, "lacks plausible, not_held, as keep of the sweep does not name them; add them",
       WHOLE + keep + ", \"plausible\", \"not_held\"]\n", rank},
      {WHOLE, SWEEP + "--best 1 --glb 2", "give --best 2 too", WHOLE, SWEEP + "--best 2 --glb 2"},
      {WHOLE, rank + "--glb 1", "give -o LIST.csv", WHOLE, rank + "--glb 1 -o @.csv"},
      {WHOLE, rank + "--best 1 --glb 2 -o @.csv", "give --best 2 too", WHOLE, rank + "--best 2 --glb 2 -o @.csv"},
      {WHOLE, rank + "--where '0 < worst_effort < 2'", "write a < b and b < c", WHOLE,
       rank + "--where '0 < worst_effort and worst_effort < 2'"},
      {WHOLE, rank + "--where 'gap > 1e'", "write 12, 0.5 or 2e-3", WHOLE, rank + "--where 'gap > 2e-3'"},
      {WHOLE + "[output]\nalso = [\"effort\"]\n", rank + "--where 'effort < 2'", "write max(effort) or min(effort)",
       WHOLE + "[output]\nalso = [\"effort\"]\n", rank + "--where 'max(effort) < 2'"},
      {WHOLE, rank + "--where 'gab > 0'", "the nearest is 'gap'", WHOLE, rank + "--where 'gap > 0'"},
      {WHOLE, rank + "--weights postur=1", "the nearest is 'posture'", WHOLE, rank + "--weights posture=1"},
      {WHOLE, rank + "--weights posture=1,", "name a term after it", WHOLE, rank + "--weights posture=1,depth=1"},
      {WHOLE, rank + "-o @.nc", "name another file for the list", WHOLE, rank + "-o @.csv"},
      {WHOLE, rank + "-o @.best.csv", "this is the sweep's own list; name another file", WHOLE, rank + "-o @.csv"},
      {CUP_SCENE, "view @.toml", "`wholehand grip --view` shows a grip of a scene", CUP_SCENE, SHOWN + GRIP + "--view"},
      {CUP_SCENE, SWEPT + "report @.nc -o @.nc", "name another file for the page", CUP_SCENE, SWEPT + "report @.nc -o @.html"},
      {CUP_SCENE + "[output]\nbest = 0\n", SWEPT + "view @.nc", "sweep with --best 1 or more", CUP_SCENE, SHOWN + "view @.nc"},
      {CUP_SCENE + "count = 3\n", SWEEP, "allowed: with sampling = \"sobol\"", CUP_SCENE + "count = 3\nsampling = \"sobol\"\n",
       SWEEP},
      {CUP_SCENE + "azimuth_deg = { from = 0, to = 1, count = 1000000 }\nobliquity_deg = { from = 0, to = 1, count = 1000000 }\n",
       SWEEP, "give [grips] fewer values", CUP_SCENE + "azimuth_deg = { from = 0, to = 1, count = 2 }\n", SWEEP},
      {WHOLE, SWEPT + "sweep @.toml -o @.nc --on core --precision float --resume", "or start again without --resume", WHOLE,
       SWEPT + "sweep @.toml -o @.nc --on core --precision float"},
      {WHOLE, SWEPT + "sweep @.toml -o @.nc --on core --precision float --resume", "name another file", WHOLE,
       SWEPT + "sweep @.toml -o @2.nc --on core --precision float --resume"},
      {WHOLE, SWEEP + ">/dev/null && mv @.nc @.nc.partial && PROGRAM rank @.nc", "finish it with wholehand sweep --resume", WHOLE,
       SWEPT + "rank @.nc"},
  });
}

TEST(FollowedRemedies, HelpGrip) {
  const std::string own_list = "--list @.best.csv ", scaled = WHOLE + "hand_scale = 1\n";
  const std::string scales = CUP_SCENE + "hand_scale = [0.9, 1]\n[output]\nbest = 1\n";
  expect_helps({
      {WHOLE, RANKED, "give --rank", WHOLE, RANKED + "--rank 1"},
      {WHOLE, SWEEP + "--no-refine >/dev/null && PROGRAM grip @.nc --vessel cup --rank 1 --refined",
       "sweep again without --no-refine", WHOLE, RANKED + "--rank 1 --refined"},
      {CUP_SCENE + TILTS, GRIP + "--fill 0.5", "add one with its fills", CUP_SCENE + TILTS + LIQUID, GRIP + "--fill 0.5"},
      {CUP_SCENE + LIQUID, GRIP + "--fill 0.5", "give --tilt-deg too", CUP_SCENE + LIQUID, GRIP + "--fill 0.5 --tilt-deg 0"},
      {WHOLE, GRIP + "--fill 1 --on vulkan", "use --on core", WHOLE, GRIP + "--fill 1 --on core"},
      {CUP_SCENE, "grip @.toml --vessel cup", "give --height-mm", CUP_SCENE, GRIP},
      {CUP_SCENE, "grip @.toml --vessel cup", "or --thumb-mm and --index-mm", CUP_SCENE,
       "grip @.toml --vessel cup --thumb-mm=-40,50,0 --index-mm 40,50,0"},
      {CUP_SCENE, "grip @.toml --vessel cup --thumb-mm 40,50,0 --index-mm 40,50,0", "give two points of the vessel's surface",
       CUP_SCENE, "grip @.toml --vessel cup --thumb-mm=-40,50,0 --index-mm 40,50,0"},
      {CUP_SCENE, GRIP + "--glb @.out --svg @.out", "give two different names", CUP_SCENE, GRIP + "--glb @.glb --svg @.svg"},
      {CUP_SCENE, GRIP + "--hand-scale 0.2 --glb @.glb", "choose another grip", CUP_SCENE, GRIP + "--glb @.glb"},
      {CUP_SCENE, GRIP + "--refined", "--refined: the rank of the grip is missing; give --rank", CUP_SCENE,
       RANKED + "--rank 1 --refined"},
      {CUP_SCENE, GRIP + own_list, "--list: the rank of the grip is missing; give --rank", CUP_SCENE,
       RANKED + "--rank 1 " + own_list},
      {CUP_SCENE, RANKED + "--rank 1 --refined " + own_list, "leave --list out", CUP_SCENE, RANKED + "--rank 1 --refined"},
      {CUP_SCENE, RANKED + "--rank 1 --hand-scale 1", "leave the option out", CUP_SCENE, RANKED + "--rank 1"},
      {scales, RANKED + "--rank 1 --hand-scale 2", "the hand scales 0.9, 1; give one of them", scales,
       RANKED + "--rank 1 --hand-scale 0.9"},
      {CUP_SCENE, "grip @.toml --vessel cub --height-mm 50", "the nearest is 'cup'", CUP_SCENE, GRIP},
      {CUP_SCENE, GRIP + "--view-port 8000", "add --view", CUP_SCENE, SHOWN + GRIP + "--view --view-port 0"},
  });
}

// Notes, which refuse nothing.
TEST(FollowedRemedies, HelpWhereALineIsANote) {
  const std::string robust = "[robust]\nfriction = 0.1\n", turned = "[robust]\nazimuth_deg = 5\n",
                    hourglass =
                        "[[vessel]]\nname = \"wine\"\noutline = [{ line = [30, 0] }, { line = [30, 30] }, { line = [5, 50] }, "
                        "{ line = [30, 70] }, { line = [30, 120] }, { line = [0, 120] }]\nwall_mm = 2\n[grips]\nheight_mm = [90]\n",
                    weightless = "[score]\nhold = 0\n";
  expect_helps(
      {
          {CUP_SCENE + STRENGTH, SWEEP, "add [tilts] with its deg", CUP_SCENE + STRENGTH + TILTS, SWEEP},
          {CUP_SCENE + STRENGTH, SWEEP, "or leave [strength] out", CUP_SCENE, SWEEP},
          {WHOLE + robust, SWEEP + "--best 0", "set 'best' of [output] above 0", WHOLE + robust + "[output]\nbest = 1\n", SWEEP},
          {WHOLE + robust, SWEEP + "--best 0", "or leave [robust] out", WHOLE, SWEEP + "--best 0"},
          {WHOLE + robust + weightless, SWEEP, "leave it out, and the scores take less time", WHOLE + weightless, SWEEP},
          {WHOLE + turned, SWEEP, "bodies of revolution; leave it out", WHOLE, SWEEP},
          {CUP_SCENE + "hand_scale = 0.09\n", SWEEP + "--precision float", "; use --precision double",
           CUP_SCENE + "hand_scale = 0.09\n", SWEEP + "--precision double"},
          {hourglass, SWEEP, "give 'floor_mm'", edited(hourglass, "wall_mm = 2", "wall_mm = 2\nfloor_mm = 55"), SWEEP},
      },
      0);
}

TEST(FollowedRemedies, HelpTrialsAndStudies) {
  const std::string trials = "trials @.toml -o @.trials --quick --threads 1 --best 0 --grips ", one = trials + "1 ",
                    study = "study @.toml --quick --threads 1 -o @.study ";
  const std::string guided = CUP_SCENE.substr(0, CUP_SCENE.find("[grips]")) + "guidance_mm = [[50, 0]]\n";
  const std::string
      alone = "--protocol six-forces ",
      task = "liquid = { name = \"red\", fill = 0.6 }\n" + LIQUID +
             "[task]\ntarget = { place_mm = [0, 80, -280], diameter_mm = 120 }\namounts_ml = { red = 60 }\ntolerance_ml = 5\n"
             "destination_mm = [0, 0, -280]\n";
  expect_helps({
      {CUP_SCENE + TILTS + EFFORTLESS, one, "leave efforts = false out", CUP_SCENE + TILTS + STRENGTH, one},
      {CUP_SCENE + STRENGTH, one, "add it to the scene, with its deg", CUP_SCENE + STRENGTH + TILTS, one},
      {CUP_SCENE + STRENGTH + TILTS, one + "--fill 0.5", "add one with its fills", WHOLE, one + "--fill 0.5"},
      {CUP_SCENE + STRENGTH + TILTS, one + "--fill 0.5", "or leave --fill out", CUP_SCENE + STRENGTH + TILTS, one},
      {WHOLE, one + alone + "--tilt-deg 30", "leave --tilt-deg out", WHOLE, one + alone},
      {WHOLE, one + alone + "--tilt-deg 30", "or ask for --protocol both", WHOLE, one + "--protocol both --tilt-deg 30"},
      {WHOLE, one + alone + "--fill 0.2 0.4", "give one fill", WHOLE, one + alone + "--fill 0.4"},
      {WHOLE, one + alone + "--fill 0.2 0.4", "or ask for --protocol both", WHOLE, one + "--protocol both --fill 0.2 0.4"},
      {WHOLE, trials + "0", "give more of one", WHOLE, one},
      {CUP_SCENE.substr(0, CUP_SCENE.find("[grips]")) + "surface = \"shell\"\n" + TILTS + STRENGTH, one, "use surface = \"solid\"",
       CUP_SCENE.substr(0, CUP_SCENE.find("[grips]")) + "surface = \"solid\"\n" + TILTS + STRENGTH, one},
      {WHOLE, one + ">/dev/null && PROGRAM " + one + "--seed 2 --resume", "leave --resume out to replace them", WHOLE,
       one + ">/dev/null && PROGRAM " + one + "--seed 2"},
      {guided, study + "--experiment sessions", "or ask for --experiment contacts or forces", guided,
       study + "--experiment forces --people 2"},
      {guided, study + "--experiment sessions", "add [task] to the scene", guided + task,
       study + "--experiment sessions --people 1"},
      {edited(guided, "cup", "all"), study + "--experiment contacts --people 20",
       "as the rows of all vessels together; give it another", guided, study + "--experiment contacts --people 20"},
      {CUP_SCENE, study + "--experiment contacts", "add guidance_mm to a vessel", guided,
       study + "--experiment contacts --people 20"},
      {guided, study + "--experiment contacts --resume", "allowed: with forces", guided,
       study + "--experiment forces --people 2 --resume"},
      {"", "stability", "or use `stability wall` for one device", "",
       "stability wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000"},
      {"", "stability --quick wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000", "leave it out", "",
       "stability wall --mass-kg 0.1 --damping-Nspm 1 --rate-hz 1000"},
  });
}

TEST(FollowedRemedies, HelpLive) {
  const std::string board = board_text(), quick = "live @.toml --no-clock --seconds 1 ", clocked = "live @.toml --seconds 0.3 ",
                    recorded = quick + "--record @.nc >/dev/null && PROGRAM ",
                    twice = recorded + quick + "--seed 2 --record @.2.nc >/dev/null && PROGRAM ",
                    replay = "live --no-clock --device replay:@.nc ";
  const std::string second = CUP_SCENE.substr(0, CUP_SCENE.find("[grips]")),
                    renamed = "[[vessel]]\nname = \"mug\"" + second.substr(second.find("\nshape"));
  expect_helps({
      {board, quick + "--advise-on core", "add --advise", board, quick + "--advise --advise-on core"},
      {board, quick + "--follow-advice", "add --advise", board, quick + "--advise --follow-advice"},
      {board + EFFORTLESS, quick + "--advise --advise-on core", "leave efforts = false out", board + STRENGTH,
       quick + "--advise --advise-on core"},
      {board, recorded + replay + "--advise --follow-advice", "allowed: with --device sim", board,
       quick + "--advise --follow-advice"},
      {board, recorded + replay + "--person 3", "allowed: with --device sim", board, quick + "--device sim --person 3"},
      {board, quick + "--device osc:0", "allowed: with --device sim and replay:FILE", board, recorded + replay},
      {board, quick + "--view", "leave one of the two out", board, clocked + "--view"},
      {board, quick + "--stream osc://127.0.0.1:9", "leave one of the two out", board, clocked + "--stream osc://127.0.0.1:9"},
      {board, recorded + replay + "--rate 500", "leave it out", board, recorded + replay},
      {board, recorded + "live --no-clock --device replay:", "give --device replay:FILE", board, recorded + replay},
      {board, clocked + "--device view", "add --view", board, clocked + "--device view --view"},
      {board, clocked + "--view-port 0", "add --view", board, clocked + "--view --view-port 0"},
      {second + renamed, quick, "a live session needs place_mm for each",
       second + "place_mm = [-150, 0, 0]\n" + renamed + "place_mm = [150, 0, 0]\n", quick},
      {second + renamed, quick, "whose vessels have places: mixing_board", board, quick},
      {board, twice + "session @.nc @.2.nc --json", "go with one recording", board, recorded + "session @.nc --json"},
      {board, recorded + "session @.nc @.nc", "each recording counts once", board, twice + "session @.nc @.2.nc"},
      {board, recorded + "session @.nc --seed 3", "goes with --study", board, recorded + "session @.nc --study --seed 3"},
      {board, recorded + "session @.nc --study --json", "goes without --study", board, recorded + "session @.nc --json"},
  });
}

TEST(FollowedRemedies, HelpWithAGripper) {
  const TemporaryFolder locks;
  const ScopedVariable folder("WHOLEHAND_LOCK_DIR", locks.path().c_str());
  const std::string board = board_text(), hand = board + "[hand]\nhandedness = ",
                    live = "live @.toml --device omega --dhd-library " STAND_IN_DHD " --seconds 0.3 ";
  expect_helps({
      {hand + "\"left\"\n", live, "set handedness = \"right\" in [hand]", hand + "\"right\"\n", live},
      {board, live + "--rate 5000", "measures at most 4,000 times a second; allowed: a --rate up to this number", board,
       live + "--rate 4000"},
  });
  const std::string bare = "live @.toml --device omega --seconds 0.3 ", none = bare + "--dhd-library /none.so";
  expect_helps(
      {
          {board, none, "name its path (--dhd-library", board, live},
          {board, none, "[device] library of the scene", board + "[device]\nlibrary = \"" STAND_IN_DHD "\"\n", bare},
          {board, none, "the environment variable WHOLEHAND_DHD_LIBRARY", board,
           "--version >/dev/null && WHOLEHAND_DHD_LIBRARY=" STAND_IN_DHD " PROGRAM " + bare},
          {board, "live @.toml --seconds 0.3 --stream osc://a..b:9", "give another host, or its address", board,
           "live @.toml --seconds 0.3 --stream osc://127.0.0.1:9"},
      },
      3);
}

// What lies where files are to be written: how it comes there, the command that is refused, words of the remedy, and what these words make
// of the folder and of the command.
struct PlaceCase {
  std::string before, command, words, mend, mended_command;
};

TEST(FollowedRemedies, HelpWhereFilesAreInTheWay) {
  const std::string sweep = "sweep a.toml --on core -o ", live = "live --no-clock --seconds 1 --record ",
                    trials = "trials a.toml --quick --best 0 --grips 1 -o ", grip = "grip a.toml --vessel cup --height-mm 50 ";
  const std::vector<PlaceCase> cases{
      {"", sweep + "-", "name one (./- where that is its name)", "", sweep + "./-"},
      {"mkdir d", sweep + "d", "is a directory; name a file", "", sweep + "d.nc"},
      {"", sweep + "d/a.nc", "is not a directory; create it", "mkdir d", sweep + "d/a.nc"},
      {"", sweep + "/proc/a.nc", "name a place elsewhere", "", sweep + "a.nc"},
      {"PROGRAM " + sweep + "a.nc; mv a.nc a", sweep + "a.nc", "have the same names; name another file", "", sweep + "b.nc"},
      {"ln -s b a.nc.partial", sweep + "a.nc", "the sweep would replace it with a file; remove it", "rm a.nc.partial",
       sweep + "a.nc"},
      {"mkdir a.nc.partial.lock", sweep + "a.nc", "is no lock of wholehand's; move it", "mv a.nc.partial.lock b", sweep + "a.nc"},
      {"ln -s b a.nc.partial.lock", sweep + "a.nc", "is no lock of wholehand's; move it", "mv a.nc.partial.lock b", sweep + "a.nc"},
      {"echo > a.nc.partial.lock", sweep + "a.nc", "or name another file with -o", "", sweep + "b.nc"},
      {"echo > a.nc", sweep + "a.nc", "is there and is no result file; name another", "", sweep + "b.nc"},
      {"echo > a.best.csv", sweep + "a.nc", "or remove it", "rm a.best.csv", sweep + "a.nc"},
      {"", sweep + "a.toml", "this is the scene file itself; name another file", "", sweep + "a.nc"},
      {"echo > a.nc", live + "a.nc", "is not overwritten; name another file", "", live + "b.nc"},
      {"echo > a.nc", live + "a.nc", "or remove it", "rm a.nc", live + "a.nc"},
      {"echo > a.nc.partial", live + "a.nc", "is still running; move it", "mv a.nc.partial b", live + "a.nc"},
      {"echo > a.nc.partial", live + "a.nc", "remove it", "rm a.nc.partial", live + "a.nc"},
      {"echo > t", trials + "t", "is not a folder; name another", "", trials + "u"},
      {"", trials + "-", "name one (./- is one too)", "", trials + "./-"},
      {"", trials + "t/u", "is not a directory; create it", "mkdir t", trials + "t/u"},
      {"", trials + "/proc/t", "name one elsewhere", "", trials + "t"},
      {"mkdir t; echo > t/trials.csv", trials + "t", "is no table of wholehand trials; name another", "", trials + "u"},
      {"echo > a.svg", grip + "--svg a.svg", "name another, or remove it", "rm a.svg", grip + "--svg a.svg"},
      {"PROGRAM sweep mesh.toml --on core -o a.nc; rm box.obj", "rank a.nc", "--apart-mm 0 lists grips without it", "",
       "rank a.nc --apart-mm 0"},
      {"PROGRAM " + live + "a.nc; nccopy -k nc4 a.nc b.nc", "session b.nc", "convert it by nccopy -k 64-bit-offset",
       "nccopy -k 64-bit-offset b.nc c.nc", "session c.nc"},
      {"mkdir d", "sweep d", "is a directory; give a scene file", "", sweep + "a.nc"},
      {"", "grip a.tml --vessel cup --height-mm 50", "give the path of a TOML file", "", grip},
  };
  for (const PlaceCase& one : cases) {
    const TemporaryFolder folder;
    write_file(folder / "a.toml", WHOLE);
    write_file(folder / "box.obj", obj_text(box_mesh({-0.03, 0, -0.03}, {0.03, 0.1, 0.03})));
    write_file(folder / "mesh.toml", "[[vessel]]\nname = \"box\"\nmesh = \"box.obj\"\n[grips]\nheight_mm = [40, 60]\n");
    const std::string start = "cd " + folder.path() + " && ";
    const Outcome refused =
        run(start + "{ " + (one.before.empty() ? ":" : one.before) + "; } >/dev/null 2>&1; PROGRAM " + one.command + " 2>&1");
    EXPECT_TRUE(refused.code == 2 || refused.code == 3) << one.command << "\n" << refused.output;
    EXPECT_TRUE(has(refused.output, one.words)) << refused.output << "lacks " << one.words;
    const Outcome followed = run(start + (one.mend.empty() ? ":" : one.mend) + " && PROGRAM " + one.mended_command + " 2>&1");
    EXPECT_EQ(followed.code, 0) << one.mend << "; " << one.mended_command << "\n" << followed.output;
  }
}

TEST(FollowedRemedies, HelpWhereAPortIsTaken) {
  const int taken = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  socklen_t size = sizeof address;
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(taken, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(taken, 1), 0);
  ASSERT_EQ(getsockname(taken, reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string board = board_text(), live = "live @.toml --seconds 0.3 --view ";
  expect_helps({{board, live + "--view-port " + std::to_string(ntohs(address.sin_port)), "leave the option out for any free port",
                 board, live}});
  close(taken);
}

// The limits stand for a machine that has no more.
TEST(FollowedRemedies, HelpWhereRoomMemoryOrThreadsEnd) {
  const TemporaryFolder meshes;
  write_file(meshes / "box.obj", obj_text(box_mesh({-0.03, 0, -0.03}, {0.03, 0.1, 0.03})));
  const std::string mesh =
                        "[[vessel]]\nname = \"cup\"\nmesh = \"" + (meshes / "box.obj") + "\"\n[grips]\nheight_fraction = [0.5]\n",
                    cramped = "--version >/dev/null && (ulimit -v 400000; PROGRAM " + SWEEP + "--threads ";
  const std::string many =
                        "height_fraction = { from = 0.3, to = 0.7, count = 60 }\nroll_deg = { from = -90, to = 0, count = 60 }\n",
                    some = "height_fraction = [0.4, 0.6]\nroll_deg = [-60, -30]\n",
                    vessel = CUP_SCENE.substr(0, CUP_SCENE.find("height_fraction")),
                    sweep = "--version >/dev/null && (ulimit -f 800; PROGRAM " + SWEEP + ")";
  expect_helps(
      {
          {vessel + many + TILTS, sweep, "keep fewer variables ([output] keep)",
           vessel + many + TILTS + "[output]\nkeep = [\"score\", \"plausible\"]\n", sweep},
          {vessel + many + TILTS, sweep, "give [grips] fewer values", vessel + some + TILTS, sweep},
          {CUP_SCENE, cramped + "256)", "raise the limits of processes (ulimit -u) and memory (ulimit -v)", CUP_SCENE,
           SWEEP + "--threads 256"},
          {"[[vessel]]\ngrid_mm = 0.2" + mesh.substr(mesh.find("\nname")), cramped + "1)", "ask for less at once", mesh,
           cramped + "1)"},
          {CUP_SCENE, "--version >/dev/null && (ulimit -n 16; PROGRAM " + SWEEP + ")", "raise this limit (ulimit -n)", CUP_SCENE,
           "--version >/dev/null && (ulimit -n 256; PROGRAM " + SWEEP + ")"},
      },
      3);
}

}  // namespace
}  // namespace wholehand

#endif
