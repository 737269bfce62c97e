#pragma once

namespace haptrial::test {

/// Failure of a stand-in library from some tick on.
enum class Failure : int {
  kNone,
  kNoDevice,
  kLostLink,
  kTimeout,
  kNotFinite,
  kJump,
  kForcesOffByButton,
  kForcesOffByVelocity,
  kForcesOffByWatchdog,
  kMotorsWarm,
  kForceRefused,
  kStall,      // the vendor's own thread stops
  kSlowCall,   // 5 ms in every read
  kSaturated,  // these two are return values above zero: no error
  kTimeGuard,
  kHang,          // a read that never comes back
  kCrash,         // a read that kills the program
  kButton,        // the handle's button 0 is pressed
  kMalformed,     // these are of a service that sends states as text: half a state,
  kMissingField,  // a state without velocity,
  kOtherDevice,   // a state of another device,
  kNoGrip,        // one without the grip,
  kNoPower,       // a device whose power supply was unplugged,
  kLate,          // a state that comes 8 ms late,
  kDoubled,       // that comes twice,
  kMissing,       // or, one in ten, not at all
};

/// State of a stand-in, in the vendor's axes and units.
struct StandInView {
  double position[3];
  double force[3];  // that the motors give
  double torque[3];
  double grip;
  long ticks;  // periods that passed
  bool forces_on;
  bool open;
};

/// Setup of a stand-in, and its order.
struct StandInSetup {
  double effector_mass;  // [kg]
  int gravity;
  int window_ms;
  int window_mode;
  double max_force;  // [N]
  int watchdog;
  int threshold;
  int time_guard_us;
  double rate;  // of the scheduler [Hz]
  int angular_window_ms, gripper_window_ms;
  double max_torque;      // [N·m]
  double max_grip_force;  // [N]
  char calls[1024];       // names of the set-up calls, each with a blank behind it
};

// Each stand-in exports these with C linkage beside the vendor's functions:
//   void stand_in_reset()                       as if just plugged in
//   void stand_in_fail(int failure, long tick)  from that tick on
//   void stand_in_place(const double p[3])      the handle rests there; its spring too
//   void stand_in_turn(const double r[9])       a rotation by rows, from now on
//   void stand_in_activate()                    wrist and gripper have motors (STAND_IN_ACTIVE=1)
//   void stand_in_buttons(unsigned mask)
//   void stand_in_view(StandInView*)
//   void stand_in_setup(StandInSetup*)
//   void stand_in_manual(int on)                HD only: no thread; stand_in_step() is one period
//   void stand_in_step()

}  // namespace haptrial::test
