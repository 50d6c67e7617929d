/* SPDX-License-Identifier: MIT
 *
 * The C face from C11: what a program does with it, and what it does wrong. Built against the installed package; prints a line for each check
 * that fails, and "all checks passed" where none does. */
#define _GNU_SOURCE /* __libc_malloc goes with it */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <wholehand/wholehand.h>

static int checks = 0, failures = 0;

static void check(int holds, const char* what, int line) {
  ++checks;
  if (holds) return;
  ++failures;
  printf("use.c:%d: not so: %s (the library's last line: %s)\n", line, what, wh_message());
}
#define CHECK(condition) check((condition) != 0, #condition, __LINE__)
/* A call that must fail with a status, and with a line that has these words. */
#define FAILS(status, words, call)                \
  do {                                            \
    CHECK((call) == (status));                    \
    CHECK(strstr(wh_message(), (words)) != NULL); \
    CHECK(strchr(wh_message(), '\n') == NULL);    \
  } while (0)

/* ---- how often this thread asks for memory: the program's malloc goes before the C library's, in the library too ---- */

static _Thread_local long asked = 0;
#ifndef WITHOUT_COUNTING
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t number, size_t size);
void* __libc_realloc(void* memory, size_t size);
void* malloc(size_t size) {
  ++asked;
  return __libc_malloc(size);
}
void* calloc(size_t number, size_t size) {
  ++asked;
  return __libc_calloc(number, size);
}
void* realloc(void* memory, size_t size) {
  ++asked;
  return __libc_realloc(memory, size);
}
#endif

/* ---- a glass of 70 mm that is 100 mm high, with a wall of 2 mm ---- */

static const char GLASS[] =
    "[[vessel]]\n"
    "name = \"glass\"\n"
    "shape = \"cylinder\"\n"
    "diameter_mm = 70\n"
    "height_mm = 100\n"
    "wall_mm = 2\n"
    "liquid = { name = \"water\", fill = 0.5 }\n"
    "[liquid]\n"
    "fills = [0, 0.5]\n"
    "[grips]\n"
    "height_mm = [50]\n"
    "[tilts]\n"
    "deg = [0, 45, 90]\n"
    "[strength]\n"
    "[device]\n"
    "gap_mm = [0, 25]\n";
static const double PI = 3.14159265358979323846;
static const double RADIUS = 35e-3, INNER = 33e-3, HEIGHT = 100e-3, WALL = 2e-3, GRAVITY = 9.80665;

static wh_scene* glass(void) {
  wh_scene* scene = NULL;
  CHECK(wh_scene_parse(GLASS, sizeof GLASS - 1, NULL, &scene) == WH_OK);
  return scene;
}

static void library(void) {
  CHECK(wh_abi() == WH_ABI);
  CHECK(strlen(wh_version()) >= 5);
  CHECK(wh_message() != NULL);
  CHECK(strcmp(wh_joint_name(0), "XR_HAND_JOINT_THUMB_METACARPAL_EXT") == 0);
  CHECK(strcmp(wh_joint_name(WH_JOINTS - 1), "XR_HAND_JOINT_LITTLE_TIP_EXT") == 0);
  CHECK(wh_joint_name(WH_JOINTS) == NULL && wh_joint_name(-1) == NULL);
  CHECK(strcmp(wh_reason_name(0), "") == 0 && strcmp(wh_reason_name(3), "misses") == 0);
  CHECK(wh_reason_name(-1) == NULL && wh_reason_name(7) == NULL);
}

static void scenes(void) {
  wh_scene* scene = NULL;
  CHECK(wh_scene_open("three_beakers", &scene) == WH_OK);
  size_t count = 0, at = 9;
  CHECK(wh_scene_vessels(scene, &count) == WH_OK && count == 3);
  CHECK(wh_scene_find_vessel(scene, "beaker2", &at) == WH_OK && at == 1);
  CHECK(wh_scene_fills(scene, 0, NULL, 0, &count) == WH_OK && count == 5);
  double fills[5], tilts[31];
  CHECK(wh_scene_fills(scene, 0, fills, 5, &count) == WH_OK && fills[0] == 0 && fills[4] == 1);
  CHECK(wh_scene_tilts(scene, tilts, 31, &count) == WH_OK && count == 31 && fabs(tilts[30] - 150 * PI / 180) < 1e-15);
  FAILS(WH_ARGUMENT, "31 values, and room for 30", wh_scene_tilts(scene, tilts, 30, &count));
  FAILS(WH_INPUT, "beaker1, beaker2, beaker3", wh_scene_find_vessel(scene, "mug", &at));
  FAILS(WH_INPUT, "two?lines", wh_scene_find_vessel(scene, "two\nlines", &at));
  wh_scene* const gone = scene;
  wh_scene_free(&scene);
  CHECK(scene == NULL && gone != NULL);
  wh_scene_free(&scene);
  wh_scene_free(NULL);
  FAILS(WH_ARGUMENT, "null", wh_scene_vessels(scene, &count));
  FAILS(WH_INPUT, "no scene file", wh_scene_open("three_beaker", &scene));
  CHECK(scene == NULL);
  FAILS(WH_INPUT, "empty", wh_scene_open("", &scene));
  FAILS(WH_INPUT, "mine:1:", wh_scene_parse("[vesel]", 7, "mine", &scene));
  FAILS(WH_INPUT, "", wh_scene_parse("", 0, NULL, &scene));
  FAILS(WH_ARGUMENT, "null", wh_scene_parse(NULL, 0, NULL, &scene));
  FAILS(WH_ARGUMENT, "null", wh_scene_open(NULL, &scene));
  FAILS(WH_ARGUMENT, "null", wh_scene_open("small", NULL));

  /* a cylinder with a wall and a floor: closed forms */
  scene = glass();
  wh_vessel vessel;
  WH_INIT(&vessel);
  CHECK(wh_scene_vessel(scene, 0, &vessel) == WH_OK);
  CHECK(strcmp(vessel.name, "glass") == 0 && vessel.lowest == 0 && vessel.highest == HEIGHT);
  const double cavity = PI * INNER * INNER * (HEIGHT - WALL), whole = PI * RADIUS * RADIUS * HEIGHT;
  CHECK(fabs(vessel.capacity / cavity - 1) < 1e-12);
  CHECK(fabs(vessel.mass / (2230 * (whole - cavity)) - 1) < 1e-12);
  FAILS(WH_ARGUMENT, "1 vessels, and none of number 1", wh_scene_vessel(scene, 1, &vessel));
  wh_scene_free(&scene);
}

static void grips(void) {
  wh_scene* scene = glass();
  wh_grip grip;
  wh_grip_result result;
  WH_INIT(&grip);
  WH_INIT(&result);
  grip.height = 50e-3;
  CHECK(wh_grip_evaluate(scene, 0, &grip, &result) == WH_OK);
  CHECK(result.is_feasible && strcmp(result.reason, "") == 0 && result.is_antipodal);
  CHECK(fabs(result.gap - 2 * RADIUS) < 40e-3 && result.gap > 2 * RADIUS); /* from joint to joint: the tips are outside */
  CHECK(result.score > 0 && result.score < 1);
  for (int j = 0; j < WH_JOINTS; ++j) {
    const double* p = result.proxies[j];
    if (p[1] > 0 && p[1] < HEIGHT) CHECK(hypot(p[0], p[2]) >= RADIUS - 1e-9);
    CHECK(((result.touch_mask >> j & 1) != 0) == (result.separation[j] <= 0.2e-3)); /* the scene's contact tolerance */
  }
  const wh_grip_result first = result;
  grip.hand_scale = 1;
  CHECK(wh_grip_evaluate(scene, 0, &grip, &result) == WH_OK && memcmp(&first, &result, sizeof result) == 0);

  wh_grip_state state;
  WH_INIT(&state);
  CHECK(wh_grip_hold(scene, 0, &grip, 0.5, 0, &state) == WH_OK);
  const double water = 0.5 * PI * INNER * INNER * (HEIGHT - WALL);
  CHECK(fabs(state.liquid_volume / water - 1) < 1e-12 && state.poured == 0);
  CHECK(fabs(state.center_of_mass[0]) < 1e-12 && fabs(state.center_of_mass[2]) < 1e-12);
  CHECK(state.effort > 0 && state.effort < 1 && state.effort_low <= state.effort);
  CHECK(wh_grip_hold(scene, 0, &grip, 0.5, PI, &state) == WH_OK);
  CHECK(fabs(state.poured / water - 1) < 1e-9 && state.liquid_volume < 1e-12); /* upside down */
  FAILS(WH_INPUT, "fill is 1.5", wh_grip_hold(scene, 0, &grip, 1.5, 0, &state));
  FAILS(WH_INPUT, "tilt is nan", wh_grip_hold(scene, 0, &grip, 0.5, NAN, &state));

  char* text = NULL;
  CHECK(wh_grip_json(scene, 0, &grip, &text) == WH_OK);
  CHECK(text && strncmp(text, "{\"", 2) == 0 && strstr(text, "\"feasible\":true") && text[strlen(text) - 1] == '}');
  wh_text_free(&text);
  CHECK(text == NULL);
  wh_text_free(&text);

  grip.height = 0.4; /* above the glass */
  CHECK(wh_grip_evaluate(scene, 0, &grip, &result) == WH_OK);
  CHECK(!result.is_feasible && strcmp(result.reason, "misses") == 0 && isnan(result.joints[0][0]) && result.score == 0);
  FAILS(WH_INPUT, "not feasible (misses)", wh_grip_hold(scene, 0, &grip, 0.5, 0, &state));
  grip.height = NAN;
  FAILS(WH_INPUT, "height", wh_grip_evaluate(scene, 0, &grip, &result));
  grip.height = 0.05;
  grip.hand_scale = 21;
  FAILS(WH_INPUT, "hand_scale 21; allowed", wh_grip_evaluate(scene, 0, &grip, &result));
  grip.hand_scale = 0;

  /* structs of an earlier and of a later header */
  struct {
    wh_grip grip;
    double later;
  } large = {{sizeof large, 0.05, 0, 0, 0, 0, 0}, 7};
  FAILS(WH_ARGUMENT, "later header", wh_grip_evaluate(scene, 0, &large.grip, &result));
  wh_grip small = grip;
  const size_t sizes[] = {0, 3, 12, sizeof small - 8};
  for (int k = 0; k < 4; ++k) {
    small.size = sizes[k];
    FAILS(WH_ARGUMENT, "WH_INIT", wh_grip_evaluate(scene, 0, &small, &result));
  }
  FAILS(WH_ARGUMENT, "null", wh_grip_evaluate(scene, 0, NULL, &result));
  FAILS(WH_ARGUMENT, "null", wh_grip_evaluate(scene, 0, &grip, NULL));
  FAILS(WH_ARGUMENT, "null", wh_grip_evaluate(NULL, 0, &grip, &result));
  FAILS(WH_ARGUMENT, "none of number 1", wh_grip_evaluate(scene, 1, &grip, &result));
  FAILS(WH_ARGUMENT, "null", wh_grip_json(scene, 0, &grip, NULL));
  wh_scene_free(&scene);
}

enum { GRIPS = 300 };

/* Some of them above the glass. */
static void make_grips(double rows[][WH_GRIP_COLUMNS]) {
  for (int i = 0; i < GRIPS; ++i) {
    const double row[WH_GRIP_COLUMNS] = {i * 0.5e-3, i * 0.02, 0.001 * (i % 100), -0.005 * i, 0, i % 2 ? 1 : 0.9};
    memcpy(rows[i], row, sizeof row);
  }
}

static wh_output output_to(void* data, int type) {
  wh_output output;
  WH_INIT(&output);
  output.data = data;
  output.type = type;
  return output;
}

static double rows[GRIPS][WH_GRIP_COLUMNS];

/* The same numbers as one grip after the other. */
static void batches(void) {
  make_grips(rows);
  wh_scene* scene = glass();
  const char* names[] = {"score", "posed", "touch_mask", "reason", "feedback_force"};
  wh_batch* batch = NULL;
  CHECK(wh_batch_open(scene, names, 5, NULL, 1, 0, &batch) == WH_OK);
  wh_scene* kept = scene;
  wh_scene_free(&kept); /* the batch goes on */
  scene = glass();
  const char* device = NULL;
  CHECK(wh_batch_device(batch, &device) == WH_OK && strncmp(device, "core", 4) == 0);
  static double score[GRIPS], posed[GRIPS][WH_JOINTS][3];
  static float force[2 * 3][GRIPS]; /* a plane for each state */
  static int32_t touch[GRIPS], reason[GRIPS];
  wh_output outputs[5] = {output_to(score, WH_DOUBLE), output_to(posed, WH_DOUBLE), output_to(touch, WH_INT32),
                          output_to(reason, WH_INT32), output_to(force, WH_FLOAT)};
  outputs[4].grip_stride = sizeof force[0][0];
  outputs[4].value_stride = sizeof force[0];
  CHECK(wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5) == WH_OK);
  int feasible = 0, infeasible = 0;
  for (int i = 0; i < GRIPS; ++i) {
    wh_grip grip;
    wh_grip_result result;
    WH_INIT(&grip);
    WH_INIT(&result);
    memcpy(&grip.height, rows[i], sizeof rows[i]);
    CHECK(wh_grip_evaluate(scene, 0, &grip, &result) == WH_OK);
    CHECK(score[i] == result.score && (uint32_t)touch[i] == result.touch_mask && (reason[i] == 0) == result.is_feasible);
    if (!result.is_feasible) {
      ++infeasible;
      CHECK(isnan(posed[i][0][0]) && isnan(force[0][i]));
      continue;
    }
    ++feasible;
    CHECK(memcmp(posed[i], result.posed, sizeof posed[i]) == 0);
    wh_grip_state state;
    WH_INIT(&state);
    CHECK(wh_grip_hold(scene, 0, &grip, 0.5, PI / 4, &state) == WH_OK);
    CHECK(fabs(force[1 * 3 + 1][i] - state.feedback_force) <= 1e-6 * fabs(state.feedback_force) + 1e-7);
  }
  CHECK(feasible > 100 && infeasible > 20);

  /* every second grip, and a device */
  static double half[GRIPS / 2];
  const wh_output one = output_to(half, WH_DOUBLE);
  wh_batch* scores = NULL;
  CHECK(wh_batch_open(scene, names, 1, "core", 1, 1, &scores) == WH_OK);
  CHECK(wh_batch_run(scores, 0, rows[0], GRIPS / 2, 2 * sizeof rows[0], &one, 1) == WH_OK);
  for (int i = 0; i < GRIPS / 2; ++i) CHECK(half[i] == score[2 * i]);
  CHECK(wh_batch_run(scores, 0, rows[GRIPS - 1], GRIPS / 2, -(ptrdiff_t)sizeof rows[0], &one, 1) == WH_OK); /* from the last on */
  for (int i = 0; i < GRIPS / 2; ++i) CHECK(half[i] == score[GRIPS - 1 - i]);
  const char* notes = NULL;
  CHECK(wh_batch_notes(scores, &notes) == WH_OK && strcmp(notes, "") == 0);
  wh_batch_free(&scores);
  FAILS(WH_ARGUMENT, "null", wh_batch_notes(scores, &notes));
  CHECK(wh_batch_open(scene, names, 1, "vulkan", 1, 0, &scores) == WH_OK);
  CHECK(wh_batch_run(scores, 0, rows[0], GRIPS / 2, 2 * sizeof rows[0], &one, 1) == WH_OK);
  int apart = 0; /* a grip whose touch is decided within the tolerance may have another score */
  for (int i = 0; i < GRIPS / 2; ++i) apart += !(fabs(half[i] - score[2 * i]) < 1e-5);
  CHECK(apart <= 2);
  wh_batch_free(&scores);
  CHECK(scores == NULL);

  /* what is wrong */
  FAILS(WH_INPUT, "scoer", wh_batch_open(scene, (const char*[]){"scoer"}, 1, NULL, 1, 0, &scores));
  FAILS(WH_INPUT, "", wh_batch_open(scene, names, 1, "abacus", 1, 0, &scores));
  FAILS(WH_ARGUMENT, "null", wh_batch_open(scene, (const char*[]){NULL}, 1, NULL, 1, 0, &scores));
  FAILS(WH_ARGUMENT, "null", wh_batch_open(NULL, names, 1, NULL, 1, 0, &scores));
  FAILS(WH_INPUT, "-1 threads; allowed", wh_batch_open(scene, names, 1, NULL, 1, -1, &scores));
  FAILS(WH_INPUT, "100000000 threads; allowed", wh_batch_open(scene, names, 1, NULL, 1, 100000000, &scores));
  FAILS(WH_INPUT, "a?b", wh_batch_open(scene, (const char*[]){"a\nb"}, 1, NULL, 1, 0, &scores));
  FAILS(WH_INPUT, "needs [table]", wh_batch_open(scene, (const char*[]){"through_table"}, 1, NULL, 1, 0, &scores));
  FAILS(WH_ARGUMENT, "5 variables, and there are 4", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 4));
  FAILS(WH_ARGUMENT, "none of number 1", wh_batch_run(batch, 1, rows[0], GRIPS, 0, outputs, 5));
  FAILS(WH_ARGUMENT, "null", wh_batch_run(batch, 0, NULL, GRIPS, 0, outputs, 5));
  FAILS(WH_ARGUMENT, "reaches further", wh_batch_run(batch, 0, rows[0], GRIPS, PTRDIFF_MAX / 8, outputs, 5));
  outputs[1].grip_stride = 8;
  FAILS(WH_ARGUMENT, "a stride of posed is 0", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[1].value_stride = PTRDIFF_MAX / 8;
  FAILS(WH_ARGUMENT, "posed reach further", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[1] = output_to(posed, WH_DOUBLE);
  outputs[1].reserved = 1;
  FAILS(WH_ARGUMENT, "reserved", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[1] = output_to(posed, WH_DOUBLE);
  FAILS(WH_ARGUMENT, "null", wh_batch_run(NULL, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[0].type = WH_INT32;
  FAILS(WH_ARGUMENT, "score is real", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[0].type = 7;
  FAILS(WH_ARGUMENT, "type 7", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[0] = output_to(NULL, WH_DOUBLE);
  FAILS(WH_ARGUMENT, "score are null", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[0] = output_to(score, WH_DOUBLE);
  outputs[0].size += 8;
  FAILS(WH_ARGUMENT, "later header", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[0].size = 12; /* half a pointer */
  FAILS(WH_ARGUMENT, "WH_INIT", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[0] = output_to(score, WH_DOUBLE);
  outputs[2].size = 8;
  FAILS(WH_ARGUMENT, "WH_INIT", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  outputs[2] = output_to(touch, WH_INT32);
  outputs[0] = output_to(score, WH_DOUBLE);
  rows[GRIPS - 1][3] = INFINITY;
  score[0] = -7;
  FAILS(WH_INPUT, "grip 299: roll inf", wh_batch_run(batch, 0, rows[0], GRIPS, 0, outputs, 5));
  CHECK(score[0] == -7); /* nothing was written */
  CHECK(wh_batch_run(batch, 0, NULL, 0, 0, outputs, 5) == WH_OK);
  wh_batch_free(&batch);
  wh_scene_free(&scene);
}

static void variables(void) {
  wh_scene* scene = glass();
  int reals = 0, integers = 0;
  for (size_t k = 0; k < wh_variables(); ++k) {
    wh_variable variable;
    WH_INIT(&variable);
    CHECK(wh_variable_at(k, &variable) == WH_OK);
    CHECK(strlen(variable.name) > 0 && strlen(variable.unit) > 0 && strlen(variable.long_name) > 0 && variable.dims);
    (variable.is_integer ? &integers : &reals)[0] += 1;
    size_t values = 99;
    CHECK(wh_variable_values(scene, variable.name, &values) == WH_OK);
    /* a batch takes what the scene has, and nothing else */
    wh_batch* batch = NULL;
    CHECK((wh_batch_open(scene, &variable.name, 1, NULL, 1, 1, &batch) == WH_OK) == (values > 0));
    wh_batch_free(&batch);
    if (strcmp(variable.dims, "fill tilt") == 0) CHECK(values == 6 || values == 0);
    if (strcmp(variable.dims, "joint xyz") == 0) CHECK(values == 72);
    if (strcmp(variable.dims, "") == 0) CHECK(values <= 1);
  }
  CHECK(reals > 20 && integers > 10);
  wh_variable variable;
  WH_INIT(&variable);
  size_t values = 0;
  FAILS(WH_ARGUMENT, "none of number", wh_variable_at(wh_variables(), &variable));
  FAILS(WH_INPUT, "no variable 'nothing'", wh_variable_values(scene, "nothing", &values));
  wh_scene_free(&scene);
}

/* A hand of 96 mm closes about the glass within a second, lifts it by 10 cm within another, tilts it by 30 degrees, and opens. */
static wh_measurement moment(int64_t tick) {
  const double t = tick * 1e-3;
  wh_measurement in;
  WH_INIT(&in);
  in.tick = tick;
  in.position[1] = 55e-3 + 0.1 * fmin(1, fmax(0, t - 1));
  const double closed = t < 5 ? fmin(1, t) : 1 - fmin(1, 2 * (t - 5));
  in.gap = 25e-3 - 10e-3 * closed;
  const double angle = -PI / 6 * fmin(1, fmax(0, t - 2.5)), c = cos(angle), s = sin(angle);
  const double rotation[9] = {1, 0, 0, 0, c, -s, 0, s, c};
  memcpy(in.rotation, rotation, sizeof rotation);
  return in;
}

static void sessions(void) {
  wh_scene* scene = glass();
  wh_vessel facts;
  WH_INIT(&facts);
  CHECK(wh_scene_vessel(scene, 0, &facts) == WH_OK);
  wh_session* session = NULL;
  CHECK(wh_session_open(scene, 0, 1, &session) == WH_OK);
  wh_scene_free(&scene); /* the session goes on */
  double period = 0;
  CHECK(wh_session_period(session, &period) == WH_OK && period == 1e-3);
  wh_hand hand;
  wh_session_vessel vessel;
  wh_session_output out;
  WH_INIT(&hand);
  WH_INIT(&vessel);
  WH_INIT(&out);
  FAILS(WH_ARGUMENT, "before the first step", wh_session_hand(session, &hand));
  CHECK(wh_session_vessel_at(session, 0, &vessel) == WH_OK && fabs(vessel.volume / facts.capacity - 0.5) < 1e-12);
  const double water = vessel.volume, weight = GRAVITY * (facts.mass + 1000 * water);
  int seen[WH_LET_GO + 1] = {0};
  const long before = asked;
  for (int64_t tick = 0; tick < 6000; ++tick) {
    const wh_measurement in = moment(tick);
    if (wh_session_step(session, &in, &out) != WH_OK || wh_session_hand(session, &hand) != WH_OK ||
        wh_session_vessel_at(session, 0, &vessel) != WH_OK) {
      CHECK(!"a step fails");
      break;
    }
    seen[out.state] += 1;
    const int is_held = out.state == WH_LIFT || out.state == WH_TILT || out.state == WH_MAINTAIN;
    if (tick == 2400) { /* lifted, and not yet tilted: closed forms */
      CHECK(out.state == WH_LIFT && out.vessel == 0 && out.tilt < 1e-12);
      CHECK(fabs(out.weight / weight - 1) < 1e-9);
      CHECK(fabs(out.arm_force[1] + weight) < 1e-9 * weight && fabs(out.arm_force[0]) < 1e-9);
      CHECK(fabs(vessel.place[1] - 0.1) < 1e-9 && out.feedback_force > 0.5 && out.grip_force > 0.5);
    }
    if (tick == 4900) CHECK(fabs(out.tilt - PI / 6) < 1e-9 && out.torque > 0 && out.state == WH_MAINTAIN);
    if (is_held && tick < 2400)
      for (int j = 0; j < WH_JOINTS; ++j) {
        const double y = hand.joints[j][1] - vessel.place[1];
        if (y > 0 && y < HEIGHT && hypot(hand.joints[j][0], hand.joints[j][2]) < RADIUS - 1e-9) CHECK(!"a joint is in the glass");
      }
    for (int j = 0; j < WH_JOINTS; ++j) {
      const double* q = hand.quaternions[j];
      if (!(fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-12)) CHECK(!"a quaternion is not unit");
    }
  }
  CHECK(asked == before); /* nothing of it allocates */
  CHECK(seen[WH_LIFT] > 1000 && seen[WH_TILT] > 100 && seen[WH_MAINTAIN] > 100 && seen[WH_SLIPPED] > 0);
  CHECK(out.grasps == 1 && out.lost == 1);
  CHECK(fabs(vessel.volume + vessel.arrived + vessel.spilled - water) < 1e-12);

  /* what is wrong: the session stays as it was */
  wh_measurement in = moment(6000);
  in.gap = NAN;
  FAILS(WH_INPUT, "finite", wh_session_step(session, &in, &out));
  in = moment(6000);
  in.rotation[0] = 2;
  FAILS(WH_INPUT, "rotation", wh_session_step(session, &in, &out));
  in = moment(6000);
  in.rotation[0] = -1; /* a mirror */
  FAILS(WH_INPUT, "rotation", wh_session_step(session, &in, &out));
  in = moment(-5);
  FAILS(WH_INPUT, "tick is -5; allowed: 0", wh_session_step(session, &in, &out));
  in = moment(INT64_MAX);
  FAILS(WH_INPUT, "allowed: 0 to 2^53", wh_session_step(session, &in, &out));
  in = moment(6000);
  in.position[0] = 1e300;
  FAILS(WH_INPUT, "out of reach", wh_session_step(session, &in, &out));
  in = moment(5999);
  FAILS(WH_INPUT, "tick 5999 does not come after", wh_session_step(session, &in, &out));
  in = moment(6000);
  in.size = 1000;
  FAILS(WH_ARGUMENT, "later header", wh_session_step(session, &in, &out));
  in = moment(6000);
  memset(in.rotation, 0, sizeof in.rotation);
  CHECK(wh_session_step(session, &in, &out) == WH_OK);
  FAILS(WH_ARGUMENT, "null", wh_session_step(session, NULL, &out));
  FAILS(WH_ARGUMENT, "null", wh_session_step(session, &in, NULL));
  FAILS(WH_ARGUMENT, "none of number 1", wh_session_vessel_at(session, 1, &vessel));
  wh_session_free(&session);
  CHECK(session == NULL);
  FAILS(WH_ARGUMENT, "session is null", wh_session_step(session, &in, &out));
  FAILS(WH_ARGUMENT, "session is null", wh_session_hand(session, &hand));
  scene = glass();
  FAILS(WH_INPUT, "finite", wh_session_open(scene, NAN, 1, &session));
  wh_scene_free(&scene);
  const char* device = strstr(GLASS, "[device]"); /* without it the caller's gaps count */
  CHECK(wh_scene_parse(GLASS, (size_t)(device - GLASS), NULL, &scene) == WH_OK);
  FAILS(WH_INPUT, "gap", wh_session_open(scene, 1, 0, &session)); /* closed is wider than open */
  wh_scene_free(&scene);
}

/* ---- two threads ---- */

struct shared {
  wh_session* session;
  wh_batch* batch;
  atomic_int is_seen;
};

static void* step_on(void* argument) {
  struct shared* shared = argument;
  wh_session_output out;
  WH_INIT(&out);
  for (int64_t tick = 0; !atomic_load(&shared->is_seen); ++tick) {
    const wh_measurement in = moment(tick);
    const wh_status status = wh_session_step(shared->session, &in, &out);
    if (status == WH_BUSY) atomic_store(&shared->is_seen, 1);
  }
  return NULL;
}

static void* run_on(void* argument) {
  struct shared* shared = argument;
  static double score[GRIPS];
  const wh_output output = output_to(score, WH_DOUBLE);
  while (!atomic_load(&shared->is_seen))
    if (wh_batch_run(shared->batch, 0, rows[0], GRIPS, 0, &output, 1) == WH_BUSY) atomic_store(&shared->is_seen, 1);
  return NULL;
}

static void threads(void) {
  make_grips(rows);
  wh_scene* scene = glass();
  struct shared shared = {0};
  const char* name = "score";
  CHECK(wh_session_open(scene, 0, 1, &shared.session) == WH_OK);
  CHECK(wh_batch_open(scene, &name, 1, NULL, 1, 1, &shared.batch) == WH_OK);
  /* until one of the two sees the other in there: both never are */
  pthread_t other;
  pthread_create(&other, NULL, step_on, &shared);
  wh_hand hand;
  WH_INIT(&hand);
  while (!atomic_load(&shared.is_seen))
    if (wh_session_hand(shared.session, &hand) == WH_BUSY) atomic_store(&shared.is_seen, 1);
  pthread_join(other, NULL);
  atomic_store(&shared.is_seen, 0);
  pthread_create(&other, NULL, run_on, &shared);
  static double score[GRIPS];
  const wh_output output = output_to(score, WH_DOUBLE);
  while (!atomic_load(&shared.is_seen))
    if (wh_batch_run(shared.batch, 0, rows[0], GRIPS, 0, &output, 1) == WH_BUSY) {
      CHECK(strstr(wh_message(), "another thread") != NULL);
      atomic_store(&shared.is_seen, 1);
    }
  pthread_join(other, NULL);
  wh_session_free(&shared.session);
  wh_batch_free(&shared.batch);
  wh_scene_free(&scene);
}

/* use json SCENE VESSEL HEIGHT: the text of a grip. */
static int print_json(char** arguments) {
  wh_scene* scene = NULL;
  size_t vessel = 0;
  wh_grip grip;
  char* text = NULL;
  WH_INIT(&grip);
  grip.height = strtod(arguments[2], NULL);
  const int is_there = wh_scene_open(arguments[0], &scene) == WH_OK &&
                       wh_scene_find_vessel(scene, arguments[1], &vessel) == WH_OK &&
                       wh_grip_json(scene, vessel, &grip, &text) == WH_OK;
  puts(is_there ? text : wh_message());
  wh_text_free(&text);
  wh_scene_free(&scene);
  return !is_there;
}

int main(int count, char** arguments) {
  if (count == 5 && strcmp(arguments[1], "json") == 0) return print_json(arguments + 2);
  library();
  scenes();
  grips();
  batches();
  variables();
  sessions();
  threads();
  if (failures > 0) {
    printf("%d of %d checks failed\n", failures, checks);
    return 1;
  }
  printf("all %d checks passed\n", checks);
  return 0;
}
