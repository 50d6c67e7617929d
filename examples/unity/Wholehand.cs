// SPDX-License-Identifier: MIT
// wholehand for C#: app/c/wholehand/wholehand.h of ABI 0 as P/Invoke declarations (Native, and a struct for each of C's), and
// classes on top of them (Scene, Batch, Session). These free what they hold, and throw a WholehandException with its line.
//
// For Unity put this file and SessionThread.cs into Assets/, allow unsafe code, and put libwholehand.so into Assets/Plugins/. See
// docs/engines.md. Units are SI. All frames are wholehand's (right-handed, +y up) but where a name ends in Unity.
using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Wholehand {

public enum Status { Ok = 0, Input = 2, System = 3, Argument = 4, Busy = 5 }
public enum ValueType { Double = 0, Float = 1, Int32 = 2 }
public enum SessionState { Free, Touching, Lift, Tilt, Maintain, Slipped, Released, LetGo }

public sealed class WholehandException : Exception {
  public readonly Status Status;
  public WholehandException(Status status, string line) : base(line) { Status = status; }
}

// ---- small geometry, with the way to and from Unity's left-handed axes: z changes its sign. The same both ways. ----

[StructLayout(LayoutKind.Sequential)]
public struct Point {
  public double X, Y, Z;
  public Point(double x, double y, double z) { X = x; Y = y; Z = z; }
  public Point FlippedUnity() { return new Point(X, Y, -Z); }
}

// A unit quaternion.
[StructLayout(LayoutKind.Sequential)]
public struct Turn {
  public double X, Y, Z, W;
  public Turn(double x, double y, double z, double w) { X = x; Y = y; Z = z; W = w; }
  public Turn FlippedUnity() { return new Turn(-X, -Y, Z, W); }

  // From a 3 x 3 rotation, row by row. Finds the largest of the four numbers first, so that nothing is divided by a small one.
  public static unsafe Turn OfRotation(double* m) {
    double trace = m[0] + m[4] + m[8];
    if (trace > 0) {
      double s = 2 * Math.Sqrt(1 + trace);
      return new Turn((m[7] - m[5]) / s, (m[2] - m[6]) / s, (m[3] - m[1]) / s, s / 4);
    }
    if (m[0] >= m[4] && m[0] >= m[8]) {
      double s = 2 * Math.Sqrt(1 + m[0] - m[4] - m[8]);
      return new Turn(s / 4, (m[1] + m[3]) / s, (m[2] + m[6]) / s, (m[7] - m[5]) / s);
    }
    if (m[4] >= m[8]) {
      double s = 2 * Math.Sqrt(1 - m[0] + m[4] - m[8]);
      return new Turn((m[1] + m[3]) / s, s / 4, (m[5] + m[7]) / s, (m[2] - m[6]) / s);
    }
    double r = 2 * Math.Sqrt(1 - m[0] - m[4] + m[8]);
    return new Turn((m[2] + m[6]) / r, (m[5] + m[7]) / r, r / 4, (m[3] - m[1]) / r);
  }

  public unsafe void ToRotation(double* m) {
    double n = 2 / (X * X + Y * Y + Z * Z + W * W);
    m[0] = 1 - n * (Y * Y + Z * Z); m[1] = n * (X * Y - Z * W); m[2] = n * (X * Z + Y * W);
    m[3] = n * (X * Y + Z * W); m[4] = 1 - n * (X * X + Z * Z); m[5] = n * (Y * Z - X * W);
    m[6] = n * (X * Z - Y * W); m[7] = n * (Y * Z + X * W); m[8] = 1 - n * (X * X + Y * Y);
  }
}

// ---- the structs of C, member by member. Size comes first; Create() sets it. Text that lives in the library is an IntPtr. ----

[StructLayout(LayoutKind.Sequential)]
public unsafe struct Vessel {
  public UIntPtr Size;
  public IntPtr Name;
  public double Lowest, Highest, Capacity, Mass;
  public fixed double CenterOfMass[3];
  public fixed double Place[3];
  public static Vessel Create() { return new Vessel { Size = (UIntPtr)sizeof(Vessel) }; }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct Variable {
  public UIntPtr Size;
  public IntPtr Name, Unit, LongName, Comment, Dims;
  public int IsInteger, Reserved;
  public static Variable Create() { return new Variable { Size = (UIntPtr)sizeof(Variable) }; }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct Output {
  public UIntPtr Size;
  public IntPtr Data;
  public ValueType Type;
  public int Reserved;
  public IntPtr GripStride, ValueStride;
  public static Output Create() { return new Output { Size = (UIntPtr)sizeof(Output) }; }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct Grip {
  public UIntPtr Size;
  public double Height, Azimuth, Obliquity, Roll, Offset, HandScale;
  public static Grip Create() { return new Grip { Size = (UIntPtr)sizeof(Grip) }; }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct GripResult {
  public UIntPtr Size;
  public IntPtr Reason;
  public int IsFeasible, IsPlausible, IsAntipodal, IsGrazing, OverlapsItself, IsThroughTable;
  public uint TouchMask, UsedMask, TipMask, FingerMask, InnerMask;
  public int IsNotHeld;
  public double Closure, Gap, ThumbAngle, IndexAngle;
  public fixed double Midpoint[3];
  public fixed double Joints[3 * Native.Joints];
  public fixed double Posed[3 * Native.Joints];
  public fixed double Proxies[3 * Native.Joints];
  public fixed double Separation[Native.Joints];
  public double PhalanxDepth, PalmDepth, Score;
  public fixed double ScoreTerms[6];
  public double WristShare, WristFlexion, WristDeviation, WristPronation;
  public int IsBeyondWrist;
  public static GripResult Create() { return new GripResult { Size = (UIntPtr)sizeof(GripResult) }; }
  // A joint of the hand at rest on the glass, vessel frame.
  public Point PosedJoint(int joint) { fixed (double* all = Posed) return Native.PointOf(all, joint); }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct GripState {
  public UIntPtr Size;
  public double Fill, Tilt, LiquidVolume, LiquidMass, Poured, Mass;
  public fixed double CenterOfMass[3];
  public double PivotLength, Torque, ExactTorque, NormalForce, FeedbackForce, HoldForce, Effort, EffortLow;
  public static GripState Create() { return new GripState { Size = (UIntPtr)sizeof(GripState) }; }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct Measurement {
  public UIntPtr Size;
  public long Tick;
  public fixed double Position[3];
  public fixed double Rotation[9];
  public double Gap;
  public uint Buttons, Reserved;
  public static Measurement Create() { return new Measurement { Size = (UIntPtr)sizeof(Measurement) }; }
  // Middle of the two tracked points and turn of the gripper, in the device frame: +x right, +y up, +z towards the person.
  public void Place(Point position, Turn turn) {
    fixed (double* p = Position, m = Rotation) {
      p[0] = position.X; p[1] = position.Y; p[2] = position.Z;
      turn.ToRotation(m);
    }
  }
  // The same in Unity's axes, whose +z points away from the person.
  public void PlaceUnity(Point position, Turn turn) { Place(position.FlippedUnity(), turn.FlippedUnity()); }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct SessionOutput {
  public UIntPtr Size;
  public SessionState State;
  public int Vessel;
  public fixed double ArmForce[3];
  public double GripForce, NormalForce, FeedbackForce, UserForce, Weight, Torque, Tilt, Flow, Closure, Gap;
  public fixed double VesselPlace[3];
  public fixed double VesselRotation[9];
  public fixed double Tips[6];
  public uint TouchMask, UsedMask;
  public int Grasps, Lost, Destinations, IsTaskDone;
  public static SessionOutput Create() { return new SessionOutput { Size = (UIntPtr)sizeof(SessionOutput) }; }
  public Point ArmForceUnity { get { fixed (double* force = ArmForce) return Native.PointOf(force, 0).FlippedUnity(); } }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct SessionVessel {
  public UIntPtr Size;
  public fixed double Place[3];
  public fixed double Rotation[9];
  public double Volume, Arrived, Spilled;
  public static SessionVessel Create() { return new SessionVessel { Size = (UIntPtr)sizeof(SessionVessel) }; }
  public Point PlaceUnity { get { fixed (double* place = Place) return Native.PointOf(place, 0).FlippedUnity(); } }
  public Turn TurnUnity { get { fixed (double* rotation = Rotation) return Turn.OfRotation(rotation).FlippedUnity(); } }
}

[StructLayout(LayoutKind.Sequential)]
public unsafe struct Hand {
  public UIntPtr Size;
  public fixed double Joints[3 * Native.Joints];
  public fixed double Radii[Native.Joints];
  public fixed double Quaternions[4 * Native.Joints];
  public fixed int Contacts[Native.Joints];
  public fixed double Wrist[3];
  public fixed double Rotation[9];
  public fixed double WristQuaternion[4];
  public static Hand Create() { return new Hand { Size = (UIntPtr)sizeof(Hand) }; }
  // Radius of the skin about a joint.
  public double Radius(int joint) { Native.Within(joint); fixed (double* all = Radii) return all[joint]; }
  public Point Joint(int joint) { fixed (double* all = Joints) return Native.PointOf(all, joint); }
  public Point JointUnity(int joint) { return Joint(joint).FlippedUnity(); }
  // As OpenXR has it: -z runs along the bone to the next joint. In Unity's axes it is +z.
  public Turn JointTurn(int joint) { fixed (double* all = Quaternions) return Native.TurnOf(all, joint); }
  public Turn JointTurnUnity(int joint) { return JointTurn(joint).FlippedUnity(); }
  public Point WristUnity { get { fixed (double* place = Wrist) return Native.PointOf(place, 0).FlippedUnity(); } }
  public Turn WristTurnUnity { get { fixed (double* turn = WristQuaternion) return Native.TurnOf(turn, 0).FlippedUnity(); } }
}

// ---- the functions of C. Text goes in as UTF-8 with a zero at its end. ----

public static unsafe class Native {
  public const int Abi = 0, Joints = 24, Fingers = 5, GripColumns = 6;
  const string Library = "wholehand";
  const CallingConvention C = CallingConvention.Cdecl;

  [DllImport(Library, CallingConvention = C)] public static extern IntPtr wh_message();
  [DllImport(Library, CallingConvention = C)] public static extern IntPtr wh_version();
  [DllImport(Library, CallingConvention = C)] public static extern int wh_abi();
  [DllImport(Library, CallingConvention = C)] public static extern void wh_init(void* structure, UIntPtr size);

  [DllImport(Library, CallingConvention = C)] public static extern Status wh_scene_open(byte[] pathOrName, out SceneHandle scene);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_scene_parse(byte[] text, UIntPtr length, byte[] name, out SceneHandle scene);
  [DllImport(Library, CallingConvention = C)] public static extern void wh_scene_free(ref IntPtr scene);
  [DllImport(Library, CallingConvention = C)] public static extern Status wh_scene_vessels(SceneHandle scene, out UIntPtr count);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_scene_vessel(SceneHandle scene, UIntPtr index, ref Vessel vessel);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_scene_find_vessel(SceneHandle scene, byte[] name, out UIntPtr vessel);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_scene_fills(SceneHandle scene, UIntPtr vessel, double[] values, UIntPtr room, out UIntPtr count);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_scene_tilts(SceneHandle scene, double[] values, UIntPtr room, out UIntPtr count);
  [DllImport(Library, CallingConvention = C)] public static extern IntPtr wh_joint_name(int joint);
  [DllImport(Library, CallingConvention = C)] public static extern IntPtr wh_reason_name(int reason);

  [DllImport(Library, CallingConvention = C)] public static extern UIntPtr wh_variables();
  [DllImport(Library, CallingConvention = C)] public static extern Status wh_variable_at(UIntPtr index, ref Variable variable);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_variable_values(SceneHandle scene, byte[] name, out UIntPtr values);

  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_batch_open(SceneHandle scene, IntPtr[] variables, UIntPtr count, byte[] on, int isDouble,
                                            int threads, out BatchHandle batch);
  [DllImport(Library, CallingConvention = C)] public static extern void wh_batch_free(ref IntPtr batch);
  [DllImport(Library, CallingConvention = C)] public static extern Status wh_batch_device(BatchHandle batch, out IntPtr name);
  [DllImport(Library, CallingConvention = C)] public static extern Status wh_batch_notes(BatchHandle batch, out IntPtr notes);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_batch_run(BatchHandle batch, UIntPtr vessel, double[] grips, UIntPtr count, IntPtr gripsStride,
                                           [In] Output[] outputs, UIntPtr outputsCount);

  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_grip_evaluate(SceneHandle scene, UIntPtr vessel, ref Grip grip, ref GripResult result);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_grip_hold(SceneHandle scene, UIntPtr vessel, ref Grip grip, double fill, double tilt,
                                           ref GripState state);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_grip_json(SceneHandle scene, UIntPtr vessel, ref Grip grip, out IntPtr text);
  [DllImport(Library, CallingConvention = C)] public static extern void wh_text_free(ref IntPtr text);

  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_session_open(SceneHandle scene, double gapClosed, double gapOpen, out SessionHandle session);
  [DllImport(Library, CallingConvention = C)] public static extern void wh_session_free(ref IntPtr session);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_session_period(SessionHandle session, out double seconds);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_session_step(SessionHandle session, ref Measurement measurement, ref SessionOutput output);
  [DllImport(Library, CallingConvention = C)]
  public static extern Status wh_session_vessel_at(SessionHandle session, UIntPtr index, ref SessionVessel vessel);
  [DllImport(Library, CallingConvention = C)] public static extern Status wh_session_hand(SessionHandle session, ref Hand hand);

  // Throws where a call did not go well. It must follow on the same thread, as the line is the thread's own.
  public static void Check(Status status) {
    if (status != Status.Ok) throw new WholehandException(status, Text(wh_message()));
  }

  public static byte[] Utf8(string text) { return text == null ? null : Encoding.UTF8.GetBytes(text + "\0"); }

  public static string Text(IntPtr text) {
    if (text == IntPtr.Zero) return null;
    int length = 0;
    while (Marshal.ReadByte(text, length) != 0) ++length;
    var bytes = new byte[length];
    Marshal.Copy(text, bytes, 0, length);
    return Encoding.UTF8.GetString(bytes);
  }

  public static string JointName(int joint) { return Text(wh_joint_name(joint)); }
  // Why a grip is not feasible, by the number of the variable "reason".
  public static string ReasonName(int reason) { return Text(wh_reason_name(reason)); }

  internal static UIntPtr Index(int index) {
    if (index < 0) throw new ArgumentOutOfRangeException("index", index, "an index is 0 or more");
    return (UIntPtr)(uint)index;
  }

  // A joint's number comes from the caller: memory behind the 24 is never read.
  internal static Point PointOf(double* all, int index) {
    Within(index);
    return new Point(all[3 * index], all[3 * index + 1], all[3 * index + 2]);
  }
  internal static Turn TurnOf(double* all, int index) {
    Within(index);
    return new Turn(all[4 * index], all[4 * index + 1], all[4 * index + 2], all[4 * index + 3]);
  }
  internal static void Within(int joint) {
    if (joint < 0 || joint >= Joints) throw new ArgumentOutOfRangeException("joint", joint, "a joint is 0 to 23");
  }
}

// ---- handles: freed once, also when nobody calls Dispose, and never while a call uses them ----

public sealed class SceneHandle : SafeHandle {
  public SceneHandle() : base(IntPtr.Zero, true) {}
  public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
  protected override bool ReleaseHandle() { IntPtr own = handle; Native.wh_scene_free(ref own); return true; }
}

public sealed class BatchHandle : SafeHandle {
  public BatchHandle() : base(IntPtr.Zero, true) {}
  public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
  protected override bool ReleaseHandle() { IntPtr own = handle; Native.wh_batch_free(ref own); return true; }
}

public sealed class SessionHandle : SafeHandle {
  public SessionHandle() : base(IntPtr.Zero, true) {}
  public override bool IsInvalid { get { return handle == IntPtr.Zero; } }
  protected override bool ReleaseHandle() { IntPtr own = handle; Native.wh_session_free(ref own); return true; }
}

// ---- classes: every call that fails throws a WholehandException; one on a disposed object throws an ObjectDisposedException ----

// Any number of threads may use a scene.
public sealed class Scene : IDisposable {
  internal readonly SceneHandle Handle;
  Scene(SceneHandle handle) { Handle = handle; }
  public void Dispose() { Handle.Dispose(); }

  public static Scene Open(string pathOrName) {
    SceneHandle scene;
    RefuseOtherLibrary();
    Native.Check(Native.wh_scene_open(Native.Utf8(pathOrName), out scene));
    return new Scene(scene);
  }

  // TOML text; `name` stands for it in messages.
  public static Scene Parse(string text, string name = null) {
    SceneHandle scene;
    RefuseOtherLibrary();
    byte[] bytes = Encoding.UTF8.GetBytes(text);
    Native.Check(Native.wh_scene_parse(bytes, (UIntPtr)bytes.Length, Native.Utf8(name), out scene));
    return new Scene(scene);
  }

  public int Vessels { get { UIntPtr count; Native.Check(Native.wh_scene_vessels(Handle, out count)); return (int)count; } }

  public Vessel VesselAt(int index) {
    Vessel vessel = Vessel.Create();
    Native.Check(Native.wh_scene_vessel(Handle, Native.Index(index), ref vessel));
    return vessel;
  }

  public string VesselName(int index) {
    string name = Native.Text(VesselAt(index).Name);
    GC.KeepAlive(this);  // the text is the scene's
    return name;
  }

  public int FindVessel(string name) {
    UIntPtr index;
    Native.Check(Native.wh_scene_find_vessel(Handle, Native.Utf8(name), out index));
    return (int)index;
  }

  public double[] Fills(int vessel) {
    UIntPtr count;
    Native.Check(Native.wh_scene_fills(Handle, Native.Index(vessel), null, UIntPtr.Zero, out count));
    var values = new double[(int)count];
    Native.Check(Native.wh_scene_fills(Handle, Native.Index(vessel), values, count, out count));
    return values;
  }

  public double[] Tilts() {
    UIntPtr count;
    Native.Check(Native.wh_scene_tilts(Handle, null, UIntPtr.Zero, out count));
    var values = new double[(int)count];
    Native.Check(Native.wh_scene_tilts(Handle, values, count, out count));
    return values;
  }

  // How many values a variable has for each grip.
  public int Values(string variable) {
    UIntPtr values;
    Native.Check(Native.wh_variable_values(Handle, Native.Utf8(variable), out values));
    return (int)values;
  }

  public GripResult Evaluate(int vessel, Grip grip) {
    GripResult result = GripResult.Create();
    Native.Check(Native.wh_grip_evaluate(Handle, Native.Index(vessel), ref grip, ref result));
    return result;
  }

  public GripState Hold(int vessel, Grip grip, double fill, double tilt) {
    GripState state = GripState.Create();
    Native.Check(Native.wh_grip_hold(Handle, Native.Index(vessel), ref grip, fill, tilt, ref state));
    return state;
  }

  // All that `wholehand grip --json` prints.
  public string Json(int vessel, Grip grip) {
    IntPtr text;
    Native.Check(Native.wh_grip_json(Handle, Native.Index(vessel), ref grip, out text));
    try {
      return Native.Text(text);
    } finally {
      Native.wh_text_free(ref text);
    }
  }

  // Structs of another ABI have other members.
  static void RefuseOtherLibrary() {
    int found = Native.wh_abi();
    if (found == Native.Abi) return;
    throw new WholehandException(Status.Argument,
                                 "Wholehand.cs is for ABI " + Native.Abi + " of libwholehand; this one has " + found);
  }
}

// One thread at a time.
public sealed class Batch : IDisposable {
  readonly BatchHandle handle_;
  readonly int[] values_;  // of each variable, a grip

  // `on`: "core", "vulkan" or a device's name. `threads`: of the core; 0: all.
  public Batch(Scene scene, string[] variables, string on = "core", bool isDouble = true, int threads = 0) {
    values_ = new int[variables.Length];
    var names = new IntPtr[variables.Length];
    try {
      for (int k = 0; k < names.Length; ++k) {
        values_[k] = scene.Values(variables[k]);
        byte[] bytes = Native.Utf8(variables[k]);
        names[k] = Marshal.AllocHGlobal(bytes.Length);
        Marshal.Copy(bytes, 0, names[k], bytes.Length);
      }
      Native.Check(Native.wh_batch_open(scene.Handle, names, (UIntPtr)names.Length, Native.Utf8(on), isDouble ? 1 : 0, threads,
                                        out handle_));
    } finally {
      foreach (IntPtr name in names) Marshal.FreeHGlobal(name);
    }
  }

  public void Dispose() { handle_.Dispose(); }
  public string Device {
    get {
      IntPtr name;
      Native.Check(Native.wh_batch_device(handle_, out name));
      return Kept(name);
    }
  }

  // What the last run had to say, a line each; "": nothing.
  public string Notes {
    get {
      IntPtr notes;
      Native.Check(Native.wh_batch_notes(handle_, out notes));
      return Kept(notes);
    }
  }

  // Text that is the batch's: the collector must not free it before it is read.
  string Kept(IntPtr text) {
    string kept = Native.Text(text);
    GC.KeepAlive(this);
    return kept;
  }

  // `grips`: rows of height, azimuth, obliquity, roll, offset, hand scale. `outputs`: an array for each variable, with room for the
  // values of all grips, grip after grip.
  public void Run(int vessel, double[] grips, params double[][] outputs) {
    int count = grips.Length / Native.GripColumns;
    if (grips.Length % Native.GripColumns != 0)
      throw new ArgumentException("grips are rows of 6 numbers; these are " + grips.Length);
    if (outputs.Length != values_.Length)
      throw new ArgumentException("there are " + values_.Length + " variables and " + outputs.Length + " arrays for them");
    var pins = new GCHandle[outputs.Length];
    var places = new Output[outputs.Length];
    try {
      for (int k = 0; k < outputs.Length; ++k) {
        long numbers = (long)count * values_[k];
        if (outputs[k].LongLength < numbers)
          throw new ArgumentException("array " + k + " has room for " + outputs[k].Length + " numbers, and needs " + numbers);
        pins[k] = GCHandle.Alloc(outputs[k], GCHandleType.Pinned);
        places[k] = Output.Create();
        places[k].Data = pins[k].AddrOfPinnedObject();
        places[k].Type = ValueType.Double;
      }
      Native.Check(Native.wh_batch_run(handle_, Native.Index(vessel), grips, (UIntPtr)count, IntPtr.Zero, places,
                                       (UIntPtr)places.Length));
    } finally {
      foreach (GCHandle pin in pins)
        if (pin.IsAllocated) pin.Free();
    }
  }
}

// One thread at a time: a second one gets Status.Busy. No call makes garbage for the collector.
public sealed class Session : IDisposable {
  readonly SessionHandle handle_;

  // Gaps of the gripper when it is closed and open.
  public Session(Scene scene, double gapClosed, double gapOpen) {
    Native.Check(Native.wh_session_open(scene.Handle, gapClosed, gapOpen, out handle_));
  }

  public void Dispose() { handle_.Dispose(); }
  // Seconds of a tick.
  public double Period { get { double seconds; Native.Check(Native.wh_session_period(handle_, out seconds)); return seconds; } }

  // The caller limits the forces to what the gripper can do, and sends none when measurements stay away.
  public void Step(ref Measurement measurement, ref SessionOutput output) {
    Native.Check(Native.wh_session_step(handle_, ref measurement, ref output));
  }

  public void VesselAt(int index, ref SessionVessel vessel) {
    Native.Check(Native.wh_session_vessel_at(handle_, Native.Index(index), ref vessel));
  }

  // The whole hand of the last step.
  public void HandAt(ref Hand hand) { Native.Check(Native.wh_session_hand(handle_, ref hand)); }
}

}  // namespace Wholehand
