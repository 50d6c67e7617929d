/* SPDX-License-Identifier: MIT
 *
 * Scores grips of a beaker at many heights and rolls, and asks what the best one takes to pour.
 *   cc best_grip.c $(pkg-config --cflags --libs wholehand) -o best_grip */
#include <stdio.h>
#include <stdlib.h>

#include <wholehand/wholehand.h>

enum { HEIGHTS = 60, ROLLS = 40, GRIPS = HEIGHTS * ROLLS };
static const double DEGREE = 3.14159265358979323846 / 180;

static void must(wh_status status) {
  if (status == WH_OK) return;
  fprintf(stderr, "best_grip: %s\n", wh_message());
  exit(status);
}

int main(void) {
  wh_scene* scene = NULL;
  must(wh_scene_open("three_beakers", &scene));
  size_t vessel = 0;
  must(wh_scene_find_vessel(scene, "beaker1", &vessel));

  /* all grips at once, on all threads of the core */
  static double grips[GRIPS][WH_GRIP_COLUMNS], score[GRIPS];
  for (int h = 0; h < HEIGHTS; ++h)
    for (int r = 0; r < ROLLS; ++r) {
      double* grip = grips[h * ROLLS + r];
      grip[0] = 0.010 + 0.0015 * h;     /* height, m */
      grip[3] = (-90 + 3 * r) * DEGREE; /* roll, rad */
      grip[5] = 1;                      /* size of the hand */
    }
  const char* variables[] = {"score"};
  wh_batch* batch = NULL;
  must(wh_batch_open(scene, variables, 1, "core", 1, 0, &batch));
  wh_output output;
  WH_INIT(&output);
  output.data = score;
  must(wh_batch_run(batch, vessel, grips[0], GRIPS, 0, &output, 1));
  int best = 0;
  for (int i = 1; i < GRIPS; ++i)
    if (score[i] > score[best]) best = i;

  /* the best one, with everything */
  wh_grip grip;
  wh_grip_result result;
  wh_grip_state state;
  WH_INIT(&grip);
  WH_INIT(&result);
  WH_INIT(&state);
  grip.height = grips[best][0];
  grip.roll = grips[best][3];
  must(wh_grip_evaluate(scene, vessel, &grip, &result));
  printf("best of %d grips: height %.1f mm, roll %.0f degrees, score %.3f\n", GRIPS, 1e3 * grip.height, grip.roll / DEGREE,
         result.score);
  for (int tilt = 0; tilt <= 90; tilt += 45) {
    must(wh_grip_hold(scene, vessel, &grip, 0.75, tilt * DEGREE, &state));
    printf("tilted by %2d degrees: %3.0f mL left, %.2f N at the fingers, effort %.3f\n", tilt, 1e6 * state.liquid_volume,
           state.feedback_force, state.effort);
  }
  wh_batch_free(&batch);
  wh_scene_free(&scene);
  return 0;
}
