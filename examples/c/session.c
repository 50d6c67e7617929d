/* SPDX-License-Identifier: MIT
 *
 * A session without a gripper: numbers take the place of what an engine's 1 kHz thread reads from its device. The hand closes about a
 * beaker, lifts it, and the program prints what the fingers feel.
 *   cc session.c $(pkg-config --cflags --libs wholehand) -lm -o session */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <wholehand/wholehand.h>

static const char* const STATES[] = {"free", "touching", "lift", "tilt", "maintain", "slipped", "released", "let go"};

static void must(wh_status status) {
  if (status == WH_OK) return;
  fprintf(stderr, "session: %s\n", wh_message());
  exit(status);
}

int main(void) {
  wh_scene* scene = NULL;
  must(wh_scene_open("mixing_board", &scene));
  size_t beaker = 0;
  must(wh_scene_find_vessel(scene, "beaker1", &beaker));
  wh_vessel vessel;
  WH_INIT(&vessel);
  must(wh_scene_vessel(scene, beaker, &vessel));
  wh_session* session = NULL;
  must(wh_session_open(scene, 0, 25e-3, &session)); /* the gap of the gripper, closed and open */

  wh_measurement in;
  wh_session_output out;
  wh_hand hand;
  WH_INIT(&in);
  WH_INIT(&out);
  WH_INIT(&hand);
  int state = -1;
  for (in.tick = 0; in.tick < 3000; ++in.tick) {
    const double t = 1e-3 * (double)in.tick;
    in.position[0] = vessel.place[0];
    in.position[1] = 55e-3 + 0.1 * fmin(1, fmax(0, t - 1.5)); /* up by 10 cm from 1.5 s on */
    in.position[2] = vessel.place[2];
    in.gap = 25e-3 - 8e-3 * fmin(1, t); /* closing during the first second */
    must(wh_session_step(session, &in, &out));
    if ((int)out.state == state) continue;
    state = (int)out.state;
    printf("%.3f s: %s\n", t, STATES[state]);
  }
  must(wh_session_hand(session, &hand));
  printf("held: %.2f N pull the arm down, %.2f N open each finger\n", -out.arm_force[1], out.grip_force);
  printf("tip of the middle finger: %.1f, %.1f, %.1f mm\n", 1e3 * hand.joints[13][0], 1e3 * hand.joints[13][1],
         1e3 * hand.joints[13][2]);
  wh_session_free(&session);
  wh_scene_free(&scene);
  return 0;
}
