#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/definition/given_in.h"
#include "core/base/definition/schema_forward.h"
#include "core/channel/channel_options.h"
#include "core/control/handle_loop.h"
#include "core/device/certificate.h"
#include "core/device/envelope.h"
#include "core/device/gamepad.h"
#include "core/device/handle_part.h"
#include "core/device/motor_faults.h"
#include "core/device/mouse.h"
#include "core/device/pedal.h"
#include "core/device/vendor_devices.h"
#include "core/device/virtual_device.h"
#include "core/questions/page.h"
#include "core/render/flat/trial_display_style.h"
#include "core/sound/cue.h"
#include "core/stream/marker_options.h"
#include "core/stream/side_stream.h"
#include "core/subject/hand_parameters.h"
#include "protocols/definition/groups.h"
#include "protocols/definition/schedule.h"
#include "protocols/definition/screen_options.h"
#include "protocols/definition/session_plan.h"
#include "protocols/definition/tutoring_options.h"

namespace haptrial::sound {
struct CueSet;
}

namespace haptrial::protocols {

/// A part of a device that sessions drive (core/device/handle_part.h), as a definition states it.
struct DeviceArm {
  device::EnvelopeLimits limits;
  std::string name{};  // in sentences; empty: the only one
  device::Part part{device::Part::kTip};
  std::size_t of{0};                    // number of the arm that is the tip of its device
  double radius{1.0};                   // of the fingers about the axis of a rotation [m]
  std::optional<double> handle_mass{};  // at the fingers, in place of that of [hand] [kg]
  // Faults of a virtual device's motors there, in N and m at the fingers; nothing: [device] has
  // them.
  std::optional<device::MotorFaults> faults{};

  device::PartUnits units() const { return device::units_of(part, radius); }
};

/// How many devices these are.
inline int tips_of(const std::vector<DeviceArm>& arms) {
  return static_cast<int>(std::ranges::count(arms, device::Part::kTip, &DeviceArm::part));
}

/// A key of a definition that gives buttons of the devices a function.
struct ButtonUse {
  std::string key;           // "buttons.next_tool"
  std::uint32_t buttons{0};  // any of these, a bit each
  /// The part of a trial in which they are heard, by its place in the definition: "stages[2]" is
  /// within "stages", and all are within "".
  std::string heard_in{};
  std::optional<std::size_t> device{};  // whose buttons, from 0; nothing: any device's
};

enum class Integrator { kExact, kCvode };

/// Use of an analog pedal: nothing; something that keys or buttons do as well; something that
/// nothing else does.
enum class PedalUse : std::uint8_t { kNone, kBeside, kOnly };

/// A definition file, read and valid as a whole: here the parts that every protocol has, loop,
/// plan, devices, hand, screen. A protocol derives its own, and answers what is asked of it.
struct Definition {
  virtual ~Definition() = default;

  std::string protocol;   // its name, as in [experiment]
  std::string text;       // the file, unchanged, with its lab file's behind it (lab_file.h)
  std::string file_name;  // without folders
  std::shared_ptr<const Table> document;  // of the text, with the tables that it need not state
  std::string lab;                        // as [lab] names it; empty: none
  std::string name;
  double rate{1000.0};  // of the servo loop [Hz]
  Design design;
  std::vector<StudyGroup> groups{};          // in their order; one of everybody if none is stated
  std::vector<SessionPlan> session_plans{};  // (sessions()) or none: nothing is said of them
  bool mirror_left_handed{false};  // left-handed participants have the mirror image at x = 0
  double recovery{3.0};            // without force after an abort [s]
  device::EnvelopeLimits envelope;
  device::VirtualDeviceParameters device;
  std::string certificate_file;                      // as [device] names it; empty: none
  std::optional<device::Certificate> certificate{};  // its key figures
  subject::HandParameters hand;
  Integrator integrator{Integrator::kExact};
  render::TrialDisplayStyle display;
  ScreenOptions screen;
  SessionTexts texts;
  haptrial::questions::PagePlan pages;  // beside the trials
  std::string language;                 // of the texts; empty: the definition's own
  std::string language_texts;           // the file with them; empty: there is none
  // Parameters of the devices that may take the virtual one's place; a table that is left out has
  // its defaults.
  device::VendorSetups vendor{};
  device::MouseParameters mouse{};
  device::GamepadParameters gamepad{};
  device::PedalParameters pedal{};                  // beside any of them
  std::vector<channel::ChannelOptions> channels{};  // other instruments
  std::vector<sound::Actuator> actuators{};         // on channels of the sound card
  markers::MarkerOptions markers{};
  TutoringOptions tutoring{};

  /// The document, of which nothing has been read. Any thread.
  Table root() const;
  /// How many sessions each participant comes to, on days of their own; at least 1.
  virtual int sessions() const { return 1; }
  /// Gets what is stated about a session, from 1; the default where nothing is stated.
  const SessionPlan& session_plan(int session) const;
  std::string session_name(int session) const;  // its number if it has none
  /// Whether participants of a group come to a session. @param group  empty: of none
  bool comes(int session, std::string_view group) const;
  int sessions_of(std::string_view group) const;  // to which they come
  /// Whether a tutor leads the hand in a trial of a session, if there is one (--tutor).
  bool is_led(int session, const GivenPlace& place) const;
  /// The trial of a session with its number among those of all sessions that give what the study
  /// gives, so that every other one is every other one of the course.
  GivenPlace in_course(int session, GivenPlace place) const;
  /// Trials of a session that count for in_course(); 0: a session alternates for itself.
  virtual int trials_in(int /*session*/) const { return 0; }
  /// A session drives these parts of devices, 1 to kMostDevices of them; the first is a tip.
  virtual std::vector<DeviceArm> arms() const { return {{envelope}}; }
  int devices() const { return static_cast<int>(arms().size()); }  // these parts
  virtual PedalUse pedal_use() const { return PedalUse::kNone; }
  /// The protocol's own keys that give buttons a function.
  virtual std::vector<ButtonUse> button_uses() const { return {}; }
  /// Lines that say what the definition asks for.
  virtual std::vector<std::string> description() const = 0;
  /// Lines on how firmly the loop lets the devices be held, for a check of a device.
  virtual std::vector<std::string> margins() const { return {}; }
  /// Names of its blocks; none where blocks have no names.
  virtual std::vector<std::string> block_names() const { return {}; }
  /// Notes what recorded sessions may have, but no session may begin with.
  virtual void check_new_session(Table& root) const { static_cast<void>(root); }
  /// Sentences on what is allowed but spoils the data without a word. None where all is well.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// Parts that a session leaves out when its participant is virtual, in sentences.
  virtual std::vector<std::string> left_out_of_dry_runs() const { return {}; }
  /// Text of the script beside the definition that chooses what is presented; empty: it has none.
  virtual std::string presenting_script() const { return {}; }
  /// That text, and those of scripts by which virtual participants answer.
  virtual std::string scripts() const { return presenting_script(); }
  /// Time of a participant's session at most, roughly, without breaks [s]. @param trials  of it
  virtual double longest(int trials) const = 0;

  /// Meanings of the codes of its markers: here a trial and the stages of /samples.
  virtual std::vector<markers::MarkerMeaning> marker_meanings() const;
  /// Sounds that the session plays beside those of the protocol itself; null: none.
  virtual const sound::CueSet* sounds() const { return nullptr; }
  /// Whether a session with a person wants a sound card.
  virtual bool is_heard() const { return sounds() != nullptr; }

  /// Streams of a session beside its samples, from tables of the protocol's own.
  virtual std::vector<stream::SideStream> side_streams() const { return {}; }

  /// The case of a curriculum that the session is of; empty: there is none.
  virtual std::string case_of_session() const { return {}; }

  /// Whether there is a force that the participant is to follow or to recall.
  virtual bool has_target() const { return true; }
  /// Whether the pointer of the participant's window answers something.
  virtual bool hears_pointer() const { return false; }
  /// Text that the participant reads before the first trial.
  virtual std::string instructions() const { return texts.instructions; }
  /// The functions of the protocol's own that held keys of the participant's window stand for, a
  /// bit each but kPauseBit. @param held  codes of the window
  virtual std::uint32_t functions_of(const std::vector<int>& held) const {
    static_cast<void>(held);
    return 0;
  }
  /// Conditions as sessions record them, and as tables show them; a condition that is not named is
  /// shown as it is recorded.
  virtual std::map<std::string, std::string> shown_conditions() const { return {}; }
  /// Bits of DeviceReading::keys while keys are held: functions_of(held), and kPauseBit.
  std::uint32_t bits_of(const std::vector<int>& held) const;
};

/// Reads what every protocol has, but design, recovery and display, which protocols say in their
/// own ways.
void read_common(Table& root, std::string_view file_name, Definition& definition);

/// Notes what no table can see alone, and plans participants beyond the groups' sizes.
void check_common(Table& root, Definition& definition);

/// Notes codes of markers that are out of range or have two meanings; when all else is read.
void check_markers(Table& root, const Definition& definition);

/// Notes a speed that the envelope ends, either as such or as a jump within a tick.
void reject_speed(Table& root, const Definition& definition, const char* table, const char* key,
                  double speed);

/// The loop of the device with the longest velocity window, so that damping that is safe for it is
/// safe with all devices of the definition.
control::HandleLoop handle_loop(const Definition& definition);

}  // namespace haptrial::protocols
