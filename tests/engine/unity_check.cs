// SPDX-License-Identifier: MIT
// Uses every declaration of examples/unity and prints what it sees as one JSON object, which unity_test.py judges.
//   unity_check.exe SCENE BAD_SCENE
using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Reflection;
using System.Runtime.InteropServices;
using System.Threading;
using Wholehand;

static unsafe class UnityCheck {
  static string Json(object value) {
    if (value is string) return "\"" + ((string)value).Replace("\\", "\\\\").Replace("\"", "\\\"") + "\"";
    if (value is double) return ((double)value).ToString("R", CultureInfo.InvariantCulture);
    if (value is bool) return (bool)value ? "true" : "false";
    if (value is Point) return Json(new List<object> { ((Point)value).X, ((Point)value).Y, ((Point)value).Z });
    if (value is Turn) return Json(new List<object> { ((Turn)value).X, ((Turn)value).Y, ((Turn)value).Z, ((Turn)value).W });
    var map = value as IDictionary<string, object>;
    if (map != null) return "{" + string.Join(", ", map.Select(entry => Json(entry.Key) + ": " + Json(entry.Value))) + "}";
    var list = value as IEnumerable<object>;
    if (list != null) return "[" + string.Join(", ", list.Select(Json)) + "]";
    return Convert.ToString(value, CultureInfo.InvariantCulture);
  }

  static List<object> Copy(double* numbers, int count) {
    var list = new List<object>();
    for (int k = 0; k < count; ++k) list.Add(numbers[k]);
    return list;
  }

  static List<object> Each<T>(T of, Func<T, int, object> joint) {
    return Enumerable.Range(0, Native.Joints).Select(j => joint(of, j)).ToList();
  }

  // ---- declarations ----

  static object Layout() {
    var structs = new Dictionary<string, object>();
    foreach (Type type in typeof(Native).Assembly.GetTypes()) {
      if (!type.IsValueType || type.IsEnum || type.IsNested || type.GetField("Size") == null) continue;
      var members = new Dictionary<string, object> { { "", Marshal.SizeOf(type) } };
      foreach (FieldInfo field in type.GetFields(BindingFlags.Instance | BindingFlags.Public)) {
        Type own = field.FieldType.IsEnum ? Enum.GetUnderlyingType(field.FieldType) : field.FieldType;
        members[field.Name] = new List<object> { Marshal.OffsetOf(type, field.Name).ToInt64(), Marshal.SizeOf(own) };
      }
      structs[type.Name] = members;
    }
    return structs;
  }

  static object Enums() {
    var enums = new Dictionary<string, object>();
    foreach (Type type in new[] { typeof(Status), typeof(Wholehand.ValueType), typeof(SessionState) })
      foreach (object value in Enum.GetValues(type)) enums[type.Name + "." + value] = (int)value;
    foreach (FieldInfo constant in typeof(Native).GetFields())
      if (constant.IsLiteral && constant.Name != "Abi") enums["Native." + constant.Name] = (int)constant.GetRawConstantValue();
    return enums;
  }

  static object Functions() {
    return typeof(Native).GetMethods().Where(m => m.GetCustomAttributes(typeof(DllImportAttribute), false).Length > 0)
      .Select(m => (object)m.Name).ToList();
  }

  // ---- a grip ----

  static Grip SomeGrip() {
    Grip grip = Grip.Create();
    grip.Height = 0.06;
    grip.Azimuth = 0.5;
    grip.Obliquity = 0.1;
    grip.Roll = -0.4;
    grip.Offset = 0.002;
    grip.HandScale = 1.02;
    return grip;
  }

  static object OneGrip(Scene scene, int vessel) {
    Grip grip = SomeGrip();
    GripResult result = scene.Evaluate(vessel, grip);
    GripState state = scene.Hold(vessel, grip, scene.Fills(vessel)[1], scene.Tilts()[2]);
    Vessel beaker = scene.VesselAt(vessel);
    return new Dictionary<string, object> {
      { "reason", Native.Text(result.Reason) }, { "is_feasible", result.IsFeasible }, { "closure", result.Closure },
      { "score", result.Score }, { "joints", Copy(result.Joints, 72) }, { "proxies", Copy(result.Proxies, 72) },
      { "posed", Each(result, (r, j) => r.PosedJoint(j)) }, { "touch_mask", result.TouchMask },
      { "fill", state.Fill }, { "tilt", state.Tilt }, { "mass", state.Mass }, { "normal_force", state.NormalForce },
      { "json", scene.Json(vessel, grip) },
      { "name", scene.VesselName(vessel) }, { "highest", beaker.Highest }, { "place", Copy(beaker.Place, 3) },
      { "names", Each(0, (_, j) => Native.JointName(j)) },
      { "reasons", Enumerable.Range(0, 7).Select(k => (object)Native.ReasonName(k)).ToList() },
    };
  }

  static object ABatch(Scene scene, int vessel) {
    int count = 3;
    var grips = new double[count * Native.GripColumns];
    for (int k = 0; k < count; ++k) {
      Grip grip = SomeGrip();
      grip.Height += 0.01 * k;
      var row = new[] { grip.Height, grip.Azimuth, grip.Obliquity, grip.Roll, grip.Offset, grip.HandScale };
      row.CopyTo(grips, k * Native.GripColumns);
    }
    var closures = new double[count];
    var joints = new double[count * scene.Values("joints")];
    using (var batch = new Batch(scene, new[] { "closure", "joints" }, "core", true, 1)) {
      batch.Run(vessel, grips, closures, joints);
      return new Dictionary<string, object> {
        { "device", batch.Device }, { "notes", batch.Notes }, { "closure", closures.Cast<object>().ToList() },
        { "joints", joints.Cast<object>().ToList() },
      };
    }
  }

  static object Variables() {
    var names = new List<object>();
    for (uint k = 0; k < (uint)Native.wh_variables(); ++k) {
      Variable variable = Variable.Create();
      Native.Check(Native.wh_variable_at((UIntPtr)k, ref variable));
      names.Add(Native.Text(variable.Name) + " " + Native.Text(variable.Unit));
    }
    return names;
  }

  // ---- a session: the hand comes open, closes on the beaker, lifts and tilts it ----

  const double GapClosed = 0, GapOpen = 0.12;

  // Where the gripper is at a tick: its middle and its turn. It leans by 0.3 rad from the start.
  static void Gripper(long tick, out Point middle, out Turn turn, out double gap) {
    double closed = Math.Min(1, tick / 200.0), lifted = Math.Max(0, Math.Min(1, (tick - 300) / 300.0));
    gap = GapOpen - 0.06 * closed;
    middle = new Point(0.06, 0.055 + 0.05 * lifted, 0.03 * lifted);
    turn = new Turn(Math.Sin(0.15 + 0.2 * lifted), 0, 0, Math.Cos(0.15 + 0.2 * lifted));
  }

  static object ASession(Scene scene, bool isUnity) {
    var states = new List<object>();
    using (var session = new Session(scene, GapClosed, GapOpen)) {
      Measurement measurement = Measurement.Create();
      SessionOutput output = SessionOutput.Create(), grasped = output;
      for (long tick = 0; tick < 700; ++tick) {
        Point middle;
        Turn turn;
        double gap;
        Gripper(tick, out middle, out turn, out gap);
        measurement.Tick = tick;
        measurement.Gap = gap;
        if (isUnity)
          measurement.PlaceUnity(new Point(middle.X, middle.Y, -middle.Z), new Turn(-turn.X, -turn.Y, turn.Z, turn.W));
        else
          measurement.Place(middle, turn);
        session.Step(ref measurement, ref output);
        string state = output.State.ToString();
        if (states.Count == 0 || (string)states[states.Count - 1] != state) {
          states.Add(state);
          if (state == "Lift") grasped = output;
        }
      }
      Hand hand = Hand.Create();
      session.HandAt(ref hand);
      SessionVessel vessel = SessionVessel.Create();
      session.VesselAt(output.Vessel, ref vessel);
      Measurement first = Measurement.Create();
      Point startMiddle;
      Turn startTurn;
      double startGap;
      Gripper(0, out startMiddle, out startTurn, out startGap);
      first.Place(startMiddle, startTurn);
      return new Dictionary<string, object> {
        { "period", session.Period }, { "states", states }, { "grasps", output.Grasps }, { "gripper", Copy(first.Rotation, 9) },
        { "grasp_place", Copy(grasped.VesselPlace, 3) }, { "grasp_tips", Copy(grasped.Tips, 6) },
        { "feedback", output.FeedbackForce }, { "arm", Copy(output.ArmForce, 3) }, { "arm_unity", output.ArmForceUnity },
        { "weight", output.Weight }, { "tilt", output.Tilt },
        { "vessel_place", Copy(vessel.Place, 3) }, { "vessel_rotation", Copy(vessel.Rotation, 9) }, { "volume", vessel.Volume },
        { "vessel_place_unity", vessel.PlaceUnity }, { "vessel_turn_unity", vessel.TurnUnity },
        { "joints", Each(hand, (h, j) => h.Joint(j)) }, { "turns", Each(hand, (h, j) => h.JointTurn(j)) },
        { "joints_unity", Each(hand, (h, j) => h.JointUnity(j)) }, { "turns_unity", Each(hand, (h, j) => h.JointTurnUnity(j)) },
        { "radii", Each(hand, (h, j) => h.Radius(j)) },
        { "wrist", Copy(hand.Wrist, 3) }, { "wrist_unity", hand.WristUnity }, { "wrist_turn_unity", hand.WristTurnUnity },
      };
    }
  }

  // On its own thread, at the same places: 700 ticks of the clock, however long they take.
  static object AThread(Scene scene) {
    bool lastIsFelt = true;
    int felt = 0;
    SessionThread.Read read = delegate(ref Measurement measurement) {
      Point middle;
      Turn turn;
      double gap;
      Gripper(measurement.Tick, out middle, out turn, out gap);
      measurement.Place(middle, turn);
      measurement.Gap = gap;
      return measurement.Tick % 7 != 3;  // now and then a gripper has nothing to say
    };
    SessionThread.Write write = delegate(ref SessionOutput output, bool isFelt) {
      lastIsFelt = isFelt;
      if (isFelt) ++felt;
    };
    Hand hand = Hand.Create();
    SessionOutput newest = SessionOutput.Create();
    var thread = new SessionThread(scene, GapClosed, GapOpen, read, write);
    for (int k = 0; k < 6000 && !(thread.Newest(ref hand, ref newest) && newest.Grasps > 0); ++k) Thread.Sleep(10);
    long ticks = thread.Ticks;
    thread.Dispose();
    return new Dictionary<string, object> {
      { "ticks", ticks }, { "felt", felt }, { "last_is_felt", lastIsFelt }, { "grasps", newest.Grasps },
      { "wrist", hand.WristUnity },
    };
  }

  static object AFailingThread(Scene scene) {
    bool lastIsFelt = true;
    SessionThread.Read read = delegate(ref Measurement measurement) {
      measurement.Gap = measurement.Tick < 5 ? 0.1 : double.NaN;
      return true;
    };
    SessionThread.Write write = delegate(ref SessionOutput output, bool isFelt) { lastIsFelt = isFelt; };
    Hand hand = Hand.Create();
    SessionOutput newest = SessionOutput.Create();
    using (var thread = new SessionThread(scene, GapClosed, GapOpen, read, write)) {
      for (int k = 0; k < 6000; ++k) {
        try {
          thread.Newest(ref hand, ref newest);
        } catch (InvalidOperationException failure) {
          thread.Dispose();
          return new Dictionary<string, object> { { "said", failure.Message }, { "last_is_felt", lastIsFelt } };
        }
        Thread.Sleep(10);
      }
    }
    return "no failure";
  }

  // ---- wrong use ----

  static object Refusal(Action wrong) {
    try {
      wrong();
    } catch (WholehandException refusal) {
      return refusal.Status + ": " + refusal.Message;
    } catch (Exception refusal) {
      return refusal.GetType().Name;
    }
    return "accepted";
  }

  static Measurement Stretched() {
    Measurement measurement = Measurement.Create();
    measurement.Place(new Point(), new Turn(0, 0, 0, 1));
    measurement.Rotation[0] = 2;
    return measurement;
  }

  static object Refusals(Scene scene, int vessel, string bad) {
    Grip low = SomeGrip(), later = SomeGrip();
    low.Height = -1;
    later.Size = (UIntPtr)4096;
    Measurement measurement = Measurement.Create(), wrong = measurement, turned = Stretched();
    measurement.Gap = 0.1;
    wrong.Gap = double.NaN;
    wrong.Tick = turned.Tick = 1;
    SessionOutput output = SessionOutput.Create();
    Hand hand = Hand.Create();
    SessionVessel place = SessionVessel.Create();
    Scene closed = Scene.Open("small");
    closed.Dispose();
    using (var session = new Session(scene, 0, 0.1)) {
      var before = Refusal(() => session.HandAt(ref hand));
      session.Step(ref measurement, ref output);
      return new Dictionary<string, object> {
        { "bad scene", Refusal(() => Scene.Open(bad)) },
        { "no scene", Refusal(() => Scene.Open("/no/such.toml")) },
        { "bad text", Refusal(() => Scene.Parse("[hand]\nscale = 99\n", "mine")) },
        { "no text", Refusal(() => Scene.Open(null)) },
        { "vessel", Refusal(() => scene.Evaluate(7, SomeGrip())) },
        { "negative", Refusal(() => scene.Evaluate(-1, SomeGrip())) },
        { "name", Refusal(() => scene.FindVessel("bucket")) },
        { "hold", Refusal(() => scene.Hold(vessel, low, 0, 0)) },
        { "later struct", Refusal(() => scene.Evaluate(vessel, later)) },
        { "variable", Refusal(() => new Batch(scene, new[] { "color" })) },
        { "device", Refusal(() => new Batch(scene, new[] { "closure" }, "abacus")) },
        { "short array", Refusal(() => new Batch(scene, new[] { "joints" }).Run(vessel, new double[6], new double[71])) },
        { "gaps", Refusal(() => new Session(scene, 0.1, 0.1)) },
        { "before", before },
        { "not finite", Refusal(() => session.Step(ref wrong, ref output)) },
        { "no rotation", Refusal(() => session.Step(ref turned, ref output)) },
        { "same tick", Refusal(() => session.Step(ref measurement, ref output)) },
        { "session's vessel", Refusal(() => session.VesselAt(9, ref place)) },
        { "joint", Refusal(() => hand.JointUnity(24)) },
        { "closed", Refusal(() => closed.Evaluate(0, SomeGrip())) },
      };
    }
  }

  static int Main(string[] arguments) {
    using (Scene scene = Scene.Open(arguments[0])) {
      int vessel = scene.FindVessel("beaker");
      Console.WriteLine(Json(new Dictionary<string, object> {
        { "layout", Layout() }, { "enums", Enums() }, { "functions", Functions() }, { "vessels", scene.Vessels },
        { "version", Native.Text(Native.wh_version()) }, { "variables", Variables() },
        { "grip", OneGrip(scene, vessel) }, { "batch", ABatch(scene, vessel) },
        { "session", ASession(scene, false) }, { "unity", ASession(scene, true) },
        { "thread", AThread(scene) }, { "failing", AFailingThread(scene) },
        { "refusals", Refusals(scene, vessel, arguments[1]) },
      }));
    }
    return 0;
  }
}
