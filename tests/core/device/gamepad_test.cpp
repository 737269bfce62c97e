// A game controller on a pipe: what its parts mean, and that a lost one is at rest.

#include "core/device/gamepad.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>

#include "core/base/definition/schema.h"
#include "core/base/file_text.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/event_records.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::device::gamepad_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(GamepadTest, SticksAndTriggersRestInTheirDeadZones) {
  const InputFile::Range stick{-100, 100};
  EXPECT_EQ(stick_of(0, stick, 0.1), 0.0);
  EXPECT_EQ(stick_of(10, stick, 0.1), 0.0);
  EXPECT_DOUBLE_EQ(stick_of(55, stick, 0.1), 0.5);
  EXPECT_DOUBLE_EQ(stick_of(-55, stick, 0.1), -0.5);
  EXPECT_EQ(stick_of(-130, stick, 0.1), -1.0);
  const InputFile::Range trigger{0, 200};
  EXPECT_EQ(trigger_of(0, trigger, 0.1), 0.0);
  EXPECT_DOUBLE_EQ(trigger_of(110, trigger, 0.1), 0.5);
  EXPECT_EQ(trigger_of(200, trigger, 0.1), 1.0);
}

TEST(GamepadTest, TheTableIsReadWhole) {
  const auto read = [](const std::string& lines) {
    Table root = Table::parse("[gamepad]\n" + lines, "lab.toml");
    Table table = root.table("gamepad");
    const GamepadParameters p = gamepad_schema().read(table);
    root.finish();
    return p;
  };
  const GamepadParameters p = read("input = \"pad\"\ndead_zone = 0.2\nstop_button = -1\n");
  EXPECT_EQ(p.input, "pad");
  EXPECT_EQ(p.dead_zone, 0.2);
  EXPECT_EQ(p.stop_button, -1);
  EXPECT_EQ(read("input = \"pad\"\n").stop_button, 7);
  EXPECT_THAT(test::message_of([&] { read("dead_zone = 0.1\n"); }), HasSubstr("gamepad.input"));
  EXPECT_THAT(test::message_of([&] { read("input = \"p\"\nstop_button = 11\n"); }),
              HasSubstr("gamepad.stop_button"));
}

TEST(GamepadTest, ConnectedOnesAreFoundByTheirNames) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(find_gamepads(folder / "none").empty());
  write_text(folder / "usb-Pad_B-event-joystick", "");
  write_text(folder / "usb-Pad_A-event-joystick", "");
  write_text(folder / "usb-Pad_A-joystick", "");  // the old interface
  write_text(folder / "usb-Keyboard-event-kbd", "");
  EXPECT_THAT(find_gamepads(folder.path()), ElementsAre(folder / "usb-Pad_A-event-joystick",
                                                        folder / "usb-Pad_B-event-joystick"));
}

/// A named pipe, and who writes records into it.
class GamepadPipeTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
    pad_ = std::make_unique<Gamepad>(GamepadParameters{path(), 0.0, 7});
  }
  void TearDown() override { hang_up(); }
  std::string path() const { return folder_ / "pad"; }
  void put(int type, int code, int value) {
    if (writer_ < 0) {
      writer_ = open(path().c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      ASSERT_GE(writer_, 0) << "nobody reads the pipe";
    }
    std::vector<std::byte> bytes;
    test::add_record(bytes, type, code, value);
    test::add_record(bytes, EV_SYN, SYN_REPORT, 0);
    ASSERT_EQ(write(writer_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void hang_up() {
    if (writer_ >= 0) {
      close(writer_);
      writer_ = -1;
    }
  }
  void wait_for(const std::function<bool(const GamepadState&)>& wanted) {
    test::wait_until([&] { return wanted(pad_->state()); });
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<Gamepad> pad_;
  int writer_{-1};
};

TEST_F(GamepadPipeTest, EachPartMovesWhatItIsFor) {
  put(EV_ABS, ABS_X, 32767);
  wait_for([](const auto& s) { return s.move.x() == 1.0; });
  put(EV_ABS, ABS_Y, -32768);
  wait_for([](const auto& s) { return s.move.y() == 1.0; });  // away from the player
  put(EV_ABS, ABS_RZ, 255);
  wait_for([](const auto& s) { return s.depth == 1.0; });
  put(EV_ABS, ABS_Z, 255);
  wait_for([](const auto& s) { return s.depth == 0.0; });  // both are down
  put(EV_ABS, ABS_RX, -32768);
  wait_for([](const auto& s) { return s.turn.y() == -1.0; });
  put(EV_ABS, ABS_RY, 32767);
  wait_for([](const auto& s) { return s.turn.x() == 1.0; });
  put(EV_ABS, ABS_HAT0X, -1);
  wait_for([](const auto& s) { return s.turn.z() == 1.0; });
  put(EV_KEY, BTN_SOUTH, 1);
  wait_for([](const auto& s) { return s.buttons == 1; });
  put(EV_KEY, BTN_START, 1);
  wait_for([](const auto& s) { return s.buttons == (1U | 1U << 7); });
  const test::AllocationGuard guard;
  EXPECT_EQ(pad_->state().buttons, 1U | 1U << 7);
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(GamepadPipeTest, ALostOneIsAtRestUntilItIsBackAndSaysSo) {
  put(EV_ABS, ABS_X, 32767);
  put(EV_KEY, BTN_SOUTH, 1);
  wait_for([](const auto& s) { return s.move.x() == 1.0 && s.buttons == 1; });
  hang_up();
  wait_for([](const auto& s) { return s.move.x() == 0.0 && s.buttons == 0; });
  std::vector<InputChange> changes;
  test::wait_until([&] {
    const auto more = pad_->take_changes();
    changes.insert(changes.end(), more.begin(), more.end());
    return changes.size() >= 2;
  });
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_FALSE(changes[0].back);
  EXPECT_EQ(changes[0].why, "the writer of the pipe has closed it");
  EXPECT_TRUE(changes[1].back);
  put(EV_KEY, BTN_EAST, 1);
  wait_for([](const auto& s) { return s.buttons == 2; });
}

TEST(GamepadTest, WhatIsNoneIsRefusedInASentence) {
  EXPECT_THAT(test::message_of([] {
                const Gamepad pad({"/dev/null", 0.1, 7});
              }),
              HasSubstr("gamepad /dev/null: is neither an input device nor a named pipe; connect "
                        "it, check gamepad.input"));
  EXPECT_THAT(test::message_of([] {
                const Gamepad pad({"/no/such/pad", 0.1, 7});
              }),
              HasSubstr("No such file"));
}

}  // namespace
}  // namespace haptrial::device::gamepad_test
