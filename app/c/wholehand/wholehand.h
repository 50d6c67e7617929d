/* SPDX-License-Identifier: MIT
 *
 * wholehand as a C library: how a whole hand holds a vessel, and what the two fingers of a haptic gripper feel.
 *
 * Rules that hold for every function:
 *
 *   - All units are SI: m, kg, s, N, rad.
 *   - Frames: the vessel frame has its origin at the vessel's base and +y along its axis. The scene's places are in
 *     the world frame, right-handed, +y up and +z towards the person. Rotations are 3 x 3 matrices, row by row; their columns
 *     are the axes of the turned frame.
 *   - Every function that can fail returns a wh_status. WH_OK is 0. If a call fails, wh_message() on the same thread says why,
 *     in one line.
 *   - No function throws, or keeps a pointer that it was given.
 *   - Objects are opaque. Whoever opens an object frees it. wh_..._free takes the address of the handle and sets the handle
 *     to NULL; a NULL handle does nothing there, and gives WH_ARGUMENT everywhere else. Objects may be freed in any order.
 *   - A scene may be used by any number of threads. A batch or a session belongs to one thread at a time; a second one
 *     that enters gets WH_BUSY.
 *   - Structs begin with their size. The caller sets it (WH_INIT does). A later library takes the smaller struct of an earlier
 *     header of the same WH_ABI, and treats missing members as 0. It refuses a struct of a later header, which is
 *     larger, with WH_ARGUMENT.
 *   - The library prints nothing. It keeps files in the user's cache folder (XDG_CACHE_HOME, else HOME/.cache), as the program
 *     does: samples of meshes, and what devices compile. The core's threads live as long as the call that needs them. A Vulkan
 *     driver may start threads that live as long as the batch.
 */
#ifndef WHOLEHAND_WHOLEHAND_H
#define WHOLEHAND_WHOLEHAND_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define WH_API __attribute__((visibility("default")))
#else
#define WH_API
#endif

/* The number in the name of the shared library (libwholehand.so.0). It increases when something in this header changes its
 * meaning or its place. A new function, or a new member at the end of a struct, does not increase it. */
#define WH_ABI 0

enum {
  WH_JOINTS = 24, /* thumb 4, then 5 each of index, middle, ring and little finger, from the base to the tip */
  WH_FINGERS = 5, /* thumb, index, middle, ring, little */
  WH_GRIP_COLUMNS = 6
};

typedef enum wh_status {
  WH_OK = 0,
  WH_INPUT = 2,    /* a scene, a name or a number that is not allowed; wh_message() says where, and what is allowed */
  WH_SYSTEM = 3,   /* no memory, no file, no device */
  WH_ARGUMENT = 4, /* an impossible pointer (null), size, type or index */
  WH_BUSY = 5      /* another thread is in this object */
} wh_status;

/* The line for the last call of this thread that did not return WH_OK; never NULL. */
WH_API const char* wh_message(void);
/* "0.4.0". */
WH_API const char* wh_version(void);
/* WH_ABI of the library. */
WH_API int wh_abi(void);

/* Zeroes a struct, and sets its size. */
#define WH_INIT(pointer) wh_init((pointer), sizeof *(pointer))
WH_API void wh_init(void* structure, size_t size);

/* ---- scenes ---- */

typedef struct wh_scene wh_scene;

/* From a file, or the name of a scene that is shipped with the library ("three_beakers"). Meshes are read and sampled, which
 * may take seconds the first time. */
WH_API wh_status wh_scene_open(const char* path_or_name, wh_scene** scene);
/* From text (TOML, docs/scene.md) of `length` bytes. `name` stands for it in messages; NULL: "text". Mesh paths
 * start from the folder of `name`. */
WH_API wh_status wh_scene_parse(const char* text, size_t length, const char* name, wh_scene** scene);
WH_API void wh_scene_free(wh_scene** scene);

WH_API wh_status wh_scene_vessels(const wh_scene* scene, size_t* count);

typedef struct wh_vessel {
  size_t size;
  const char* name;         /* lives as long as the scene */
  double lowest, highest;   /* y in the vessel frame */
  double capacity;          /* m3 upright to the brim; 0: it has no cavity */
  double mass;              /* of the empty vessel */
  double center_of_mass[3]; /* of the empty vessel, vessel frame */
  double place[3];          /* of the vessel frame's origin at the start of a session, world frame */
} wh_vessel;

WH_API wh_status wh_scene_vessel(const wh_scene* scene, size_t index, wh_vessel* vessel);
WH_API wh_status wh_scene_find_vessel(const wh_scene* scene, const char* name, size_t* vessel);
/* The states of a sweep: fills of a vessel (shares of its capacity; without liquid one, the empty vessel: 0) and tilts (rad).
 * `values` may be NULL; else it has room for `room` numbers. `count` gets their number. WH_ARGUMENT: there is too little
 * room. */
WH_API wh_status wh_scene_fills(const wh_scene* scene, size_t vessel, double* values, size_t room, size_t* count);
WH_API wh_status wh_scene_tilts(const wh_scene* scene, double* values, size_t room, size_t* count);

/* Name of a joint: OpenXR's enumerant, "XR_HAND_JOINT_THUMB_METACARPAL_EXT". NULL if no joint has this number.
 * Lives as long as the library. */
WH_API const char* wh_joint_name(int joint);

/* Why a grip is not feasible, by the value of the variable "reason": "" (0), "degenerate", "not_converged", "misses",
 * "too_wide", "too_narrow", "on_mouth". NULL if no reason has this number. Lives as long as the library. */
WH_API const char* wh_reason_name(int reason);

/* ---- variables: what can be known of a grip ---- */

enum { WH_DOUBLE = 0, WH_FLOAT = 1, WH_INT32 = 2 };

typedef struct wh_variable {
  size_t size;
  const char* name;      /* "score", "joints"; lives as long as the library */
  const char* unit;      /* "m", "1" */
  const char* long_name; /* one line */
  const char* comment;   /* formula, or what special values mean; may be empty */
  const char* dims;      /* its dimensions besides the grips, the slowest first: "fill tilt", "joint xyz", "" */
  int32_t is_integer;    /* 1: whole numbers and masks; 0: reals */
  int32_t reserved;      /* 0 */
} wh_variable;

WH_API size_t wh_variables(void);
WH_API wh_status wh_variable_at(size_t index, wh_variable* variable);
/* The number of values for each grip in this scene. 0: the scene lacks what the variable needs, and no batch accepts it.
 * WH_INPUT: no variable has this name. */
WH_API wh_status wh_variable_values(const wh_scene* scene, const char* name, size_t* values);

/* ---- batches: many grips, some variables ---- */

typedef struct wh_batch wh_batch;

/* `on`: "core", "vulkan" or a device's name; NULL: "core". `is_double`: 0 computes in float, on devices and on the core.
 * `threads`: of the core, up to 1024; 0: all. On a device this compiles its programs, which may take a second: keep the batch. */
WH_API wh_status wh_batch_open(const wh_scene* scene, const char* const* variables, size_t count, const char* on, int is_double,
                               int threads, wh_batch** batch);
WH_API void wh_batch_free(wh_batch** batch);
/* "core, 2 threads", or the device's name; lives as long as the batch. */
WH_API wh_status wh_batch_device(const wh_batch* batch, const char** name);

/* Notes of the last run, a line each ("out of memory: chunks of 4096", "device lost: ..."); "": nothing. Lives until
 * the next run. */
WH_API wh_status wh_batch_notes(const wh_batch* batch, const char** notes);

/* Where one variable's values go: value v of grip i at (char*)data + i * grip_stride + v * value_stride, in bytes. A stride
 * may be negative. */
typedef struct wh_output {
  size_t size;
  void* data;
  int32_t type;                        /* WH_DOUBLE, WH_FLOAT, or WH_INT32 (not for reals) */
  int32_t reserved;                    /* 0 */
  ptrdiff_t grip_stride, value_stride; /* both 0: grip after grip, without gaps */
} wh_output;

/* `grips`: `count` rows of WH_GRIP_COLUMNS doubles: height, azimuth, obliquity, roll, offset, hand_scale (0 counts as 1); the
 * rows are `grips_stride` bytes apart (0: without gaps). `outputs`: one for each variable of the batch, in their order. The
 * data of outputs and grips must not overlap, and grips must not change during the call. Missing values of an infeasible grip
 * are NaN, integers -1, masks 0. Efforts of implausible grips are NaN too. If the result is WH_ARGUMENT or WH_INPUT, nothing is
 * written. */
WH_API wh_status wh_batch_run(wh_batch* batch, size_t vessel, const double* grips, size_t count, ptrdiff_t grips_stride,
                              const wh_output* outputs, size_t outputs_count);

/* ---- one grip, with everything ---- */

typedef struct wh_grip {
  size_t size;
  double height, azimuth, obliquity, roll, offset, hand_scale; /* hand_scale 0 counts as 1 */
} wh_grip;

typedef struct wh_grip_result {
  size_t size;
  const char* reason; /* why it is not feasible; "": it is. Lives as long as the library */
  int32_t is_feasible;
  int32_t is_plausible;    /* nowhere deeper than the depth limit, not through the table and not beyond the wrist */
  int32_t is_antipodal;    /* both contact angles are within the friction cone */
  int32_t is_grazing;      /* a contact normal is within 1 degree of perpendicular to the thumb-index line */
  int32_t overlaps_itself; /* two fingers lie deeper in each other than the depth limit */
  int32_t is_through_table;
  uint32_t touch_mask; /* bit j: joint j touches */
  uint32_t used_mask;  /* bit f: finger f has a touching joint */
  uint32_t tip_mask, finger_mask,
      inner_mask;      /* bit j: joint j was brought to the glass, by its role: a tip, of a finger that did not touch, another */
  int32_t is_not_held; /* plausible, and holding takes more than all of the hand's strength; 0 without [strength] */
  double closure;      /* of the hand: 0 open, 1 closed */
  double gap;          /* between the tips of thumb and index finger */
  double thumb_angle, index_angle;  /* between outward normal and thumb-index line */
  double midpoint[3];               /* of the two tips, vessel frame */
  double joints[WH_JOINTS][3];      /* of the rigged hand, vessel frame; NaN if the grip is not feasible, as all below */
  double posed[WH_JOINTS][3];       /* with its fingers on the glass */
  double proxies[WH_JOINTS][3];     /* these, moved out of the glass for drawing */
  double separation[WH_JOINTS];     /* of the posed joint's sphere from the glass; below 0: inside */
  double phalanx_depth, palm_depth; /* the deepest of fingers and palm in the glass, at least 0 */
  double score;                     /* 0 to 1; 0 if the grip is not feasible, not plausible or not held */
  double score_terms[6];            /* fingers, contacts, depth, posture, force, hold */
  double wrist_share;               /* the largest share of a range that the wrist takes; above 1: beyond; NaN without [arm] */
  double wrist_flexion, wrist_deviation, wrist_pronation; /* there; below 0: extension, radial, supination; NaN without [arm] */
  int32_t
      is_beyond_wrist; /* no arm reaches the hand within the ranges of its wrist, so that it is not plausible; 0 without [arm] */
} wh_grip_result;

WH_API wh_status wh_grip_evaluate(const wh_scene* scene, size_t vessel, const wh_grip* grip, wh_grip_result* result);

typedef struct wh_grip_state {
  size_t size;
  double fill, tilt;
  double liquid_volume, liquid_mass, poured; /* m3, kg, m3 */
  double mass;                               /* of vessel and liquid */
  double center_of_mass[3];                  /* of both, vessel frame */
  double pivot_length;                       /* m */
  double torque, exact_torque;               /* N m */
  double normal_force, feedback_force;       /* N */
  double hold_force;                         /* N; infinite if the pinch is not antipodal */
  double effort, effort_low;                 /* shares of the hand's strength; infinite: nothing holds; NaN without efforts */
} wh_grip_state;

/* A feasible grip that holds the vessel at a fill (share of its capacity) and a tilt (0 .. pi). WH_INPUT: the grip is not
 * feasible. */
WH_API wh_status wh_grip_hold(const wh_scene* scene, size_t vessel, const wh_grip* grip, double fill, double tilt,
                              wh_grip_state* state);

/* Everything that `wholehand grip --json` prints, over the scene's own fills and tilts: one JSON object, UTF-8, ended by a
 * zero byte. Free it with wh_text_free. */
WH_API wh_status wh_grip_json(const wh_scene* scene, size_t vessel, const wh_grip* grip, char** text);
WH_API void wh_text_free(char** text);

/* ---- sessions: a gripper's measurement in, forces and the whole hand out ---- */

typedef struct wh_session wh_session;

/* `gap_closed` and `gap_open` are the gripper's own range; [device] gap_mm of the scene, if present, overrides it. [device]
 * also says how the device frame lies in the world (origin, axes, workspace_scale) and which button is the clutch. */
WH_API wh_status wh_session_open(const wh_scene* scene, double gap_closed, double gap_open, wh_session** session);
WH_API void wh_session_free(wh_session** session);
/* Seconds of a tick: 1 / [live] rate_Hz. */
WH_API wh_status wh_session_period(const wh_session* session, double* seconds);

typedef struct wh_measurement {
  size_t size;
  int64_t tick;       /* number of the period (wh_session_period), 0 to 2^53, greater than the one before */
  double position[3]; /* middle of the two tracked points, device frame: +x right, +y up, +z towards the person; up to 25 m */
  /* of the gripper in the device frame; R^T R may differ from the identity by 1e-3. All 0 counts as no rotation: the gripper's
     +x then runs along its closing line (to the index finger of a right hand, to the thumb of a left one), and the palm faces
     away from the person */
  double rotation[9];
  double gap;        /* between the two tracked points; up to 10 m */
  uint32_t buttons;  /* bit k: button k is pressed */
  uint32_t reserved; /* 0 */
} wh_measurement;

/* The state of a session: nothing is touched; a tip is on a vessel; held and upright; held and turning; held, tilted and still;
 * lost, and the vessel returns to where it stood; WH_RELEASED (only in `wholehand live`); put down where it stood or at its
 * destination, to which the vessel now moves. Later versions may add numbers. */
enum { WH_FREE, WH_TOUCHING, WH_LIFT, WH_TILT, WH_MAINTAIN, WH_SLIPPED, WH_RELEASED, WH_LET_GO };

typedef struct wh_session_output {
  size_t size;
  int32_t state;                      /* WH_FREE .. */
  int32_t vessel;                     /* touched, held or returning; -1: none */
  double arm_force[3];                /* to render, device frame; the method's own, without limits, ramp and slew */
  double grip_force;                  /* on each finger; positive opens */
  double normal_force;                /* F_n of the method, with F_base */
  double feedback_force;              /* F of the method: what each finger feels */
  double user_force;                  /* of the user's grip, by the method */
  double weight;                      /* of vessel and liquid, as far as it is lifted */
  double torque;                      /* tau of the method, N m */
  double tilt, flow;                  /* of the held vessel; flow over its lip, m3/s */
  double closure, gap;                /* of the hand */
  double vessel_place[3];             /* of that vessel, world frame */
  double vessel_rotation[9];          /* vessel frame to world frame */
  double tips[2][3];                  /* thumb and index finger, world frame */
  uint32_t touch_mask;                /* bit j: joint j of the holding hand touches */
  uint32_t used_mask;                 /* bit f: finger f has a touching joint */
  int32_t grasps, lost, destinations; /* counts since the start */
  int32_t is_task_done;
} wh_session_output;

/* Neither allocates nor blocks: for the 1 kHz thread of an engine. A measurement that is not finite, or not later than the one
 * before, is WH_INPUT, and the session stays as it was. The caller limits the forces to the gripper's range, and sends
 * none if measurements stop. */
WH_API wh_status wh_session_step(wh_session* session, const wh_measurement* measurement, wh_session_output* output);

typedef struct wh_session_vessel {
  size_t size;
  double place[3], rotation[9];    /* of the vessel frame in the world frame */
  double volume, arrived, spilled; /* m3: its liquid in it, in the target, and on the table */
} wh_session_vessel;

/* Where a vessel is after the last step. Does not allocate. */
WH_API wh_status wh_session_vessel_at(wh_session* session, size_t index, wh_session_vessel* vessel);

typedef struct wh_hand {
  size_t size;
  double joints[WH_JOINTS][3]; /* for drawing: moved out of all vessels, world frame */
  double radii[WH_JOINTS];     /* of the skin around them */
  /* x, y, z, w of each joint as OpenXR has it: +z along the bone away from the tip, +y out of the back of the hand. The bone of a
     joint runs to the next joint of its finger */
  double quaternions[WH_JOINTS][4];
  int32_t contacts[WH_JOINTS];  /* 0 free, 1 touching, 2 brought to the glass, 3 tracked by the gripper, 4 tracked and touching */
  double wrist[3], rotation[9]; /* of the hand frame: its origin, and its axes as columns; a left hand has the mirrored +y and +z */
  double wrist_quaternion[4];
} wh_hand;

/* The whole hand of the last step, as displayed. It takes longer than the step, and does not allocate either. WH_ARGUMENT
 * before the first step. */
WH_API wh_status wh_session_hand(wh_session* session, wh_hand* hand);

#ifdef __cplusplus
}
#endif

#endif
