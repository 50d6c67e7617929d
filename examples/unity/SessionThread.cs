// SPDX-License-Identifier: MIT
// A session on a thread of its own at the session's rate (1 kHz by default). An engine's Update() or FixedUpdate() comes at 50 to
// 144 Hz, and forces that are rendered so rarely shake. The engine reads the hand whenever it likes; the thread waits for it no
// longer than a copy takes.
using System;
using System.Diagnostics;
using System.Threading;

namespace Wholehand {

public sealed class SessionThread : IDisposable {
  // Reads the gripper. The session's own thread calls it in every tick. False: there is no measurement, and no force is rendered.
  public delegate bool Read(ref Measurement measurement);
  // Renders the forces within the gripper's limits, or none where `isFelt` is false.
  public delegate void Write(ref SessionOutput output, bool isFelt);

  readonly Session session_;
  readonly Read read_;
  readonly Write write_;
  readonly Thread thread_;
  readonly object lock_ = new object();  // held for a copy of some hundred bytes
  Hand hand_ = Hand.Create();
  SessionOutput output_ = SessionOutput.Create();
  long ticks_;
  Exception failure_;
  volatile bool ends_;

  public SessionThread(Scene scene, double gapClosed, double gapOpen, Read read, Write write) {
    session_ = new Session(scene, gapClosed, gapOpen);
    read_ = read;
    write_ = write;
    thread_ = new Thread(Run) { IsBackground = true, Priority = ThreadPriority.Highest, Name = "wholehand" };
    thread_.Start();
  }

  // What the newest tick gave; false before the first one. Throws what ended the session.
  public bool Newest(ref Hand hand, ref SessionOutput output) {
    lock (lock_) {
      if (failure_ != null) throw new InvalidOperationException("the session has ended: " + failure_.Message, failure_);
      hand = hand_;
      output = output_;
      return ticks_ > 0;
    }
  }

  public long Ticks { get { lock (lock_) return ticks_; } }

  // Ends the thread after a last call that renders no force.
  public void Dispose() {
    ends_ = true;
    thread_.Join();
    session_.Dispose();
  }

  void Run() {
    var measurement = Measurement.Create();
    var output = SessionOutput.Create();
    var hand = Hand.Create();
    try {
      double period = session_.Period;
      var clock = Stopwatch.StartNew();
      for (long last = -1; !ends_;) {
        // the number of the period that it is now: one that was missed stays missing
        long now = (long)(clock.Elapsed.TotalSeconds / period);
        if (now <= last) {
          Thread.Sleep(0);  // gives way to others; a real sleep may take 1 ms, or 15 ms on Windows
          continue;
        }
        last = measurement.Tick = now;
        bool isRead = read_(ref measurement);
        if (isRead) session_.Step(ref measurement, ref output);
        write_(ref output, isRead);
        if (isRead) Show(ref hand, ref output);
      }
    } catch (Exception failure) {
      Keep(failure);
    }
    try {
      write_(ref output, false);
    } catch (Exception failure) {
      Keep(failure);
    }
  }

  // Keeps the first failure: it says what happened.
  void Keep(Exception failure) {
    lock (lock_) failure_ = failure_ ?? failure;
  }

  void Show(ref Hand hand, ref SessionOutput output) {
    session_.HandAt(ref hand);
    lock (lock_) {
      hand_ = hand;
      output_ = output;
      ++ticks_;
    }
  }
}

}  // namespace Wholehand
