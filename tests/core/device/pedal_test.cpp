// An analog pedal as Linux delivers it: records in pieces, calibration, what a missing or a lost
// device is called. Pipes stand for devices; a device that the kernel makes is tried where it can.

#include "core/device/pedal.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "core/base/definition/schema.h"
#include "core/device/axis_names.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/event_records.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace haptrial::device::pedal_test {
namespace {

using testing::HasSubstr;

TEST(PedalTest, DepthGoesFromTheDeadZoneToTheEndEitherWay) {
  EXPECT_EQ(depth_of(0, 0, 200, 0.1), 0.0);
  EXPECT_EQ(depth_of(20, 0, 200, 0.1), 0.0);
  EXPECT_DOUBLE_EQ(depth_of(110, 0, 200, 0.1), 0.5);
  EXPECT_EQ(depth_of(200, 0, 200, 0.1), 1.0);
  EXPECT_EQ(depth_of(300, 0, 200, 0.1), 1.0);
  EXPECT_EQ(depth_of(-50, 0, 200, 0.1), 0.0);
  EXPECT_DOUBLE_EQ(depth_of(64, 255, 0, 0.0), 191.0 / 255.0) << "many pedals count down";
}

PedalParameters read(const std::string& text) {
  Table root = Table::parse(text, "lab.toml");
  Table table = root.table("pedal");
  const PedalParameters p = pedal_schema().read(table);
  root.finish();
  return p;
}

TEST(PedalTest, TheTableIsReadWhole) {
  const PedalParameters p = read(
      "[pedal]\ninput = \"/dev/input/event3\"\naxis = \"ABS_RZ\"\n"
      "released = 255\npressed = 12\ndead_zone = 0.2\n");
  EXPECT_EQ(p.input, "/dev/input/event3");
  EXPECT_EQ(p.axis, ABS_RZ);
  EXPECT_EQ(p.released, 255.0);
  EXPECT_EQ(p.pressed, 12.0);
  EXPECT_EQ(p.dead_zone, 0.2);
  const PedalParameters plain = read("[pedal]\ninput = \"p\"\naxis = \"ABS_GAS\"\n");
  EXPECT_FALSE(plain.released || plain.pressed);
  for (const std::string& name : axis_names()) {
    EXPECT_EQ(axis_name(axis_of(name)), name);
  }
  const auto refusal = [](const std::string& more) {
    return test::message_of([&] { read("[pedal]\ninput = \"p\"\n" + more); });
  };
  EXPECT_THAT(refusal("axis = \"ABS_GASS\"\n"), HasSubstr("did you mean ABS_GAS?"));
  EXPECT_THAT(refusal("axis = \"ABS_X\"\nreleased = 3\npressed = 3\n"),
              HasSubstr("pedal.pressed is 3; allowed: another value than pedal.released"));
  EXPECT_THAT(refusal("axis = \"ABS_X\"\ndead_zone = 0.95\n"), HasSubstr("at most 0.9"));
}

/// A named pipe, and who writes records into it.
class PedalPipeTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(mkfifo(path().c_str(), 0600), 0); }
  void TearDown() override { hang_up(); }
  std::string path() const { return folder_ / "pedal"; }
  PedalParameters parameters() const {
    PedalParameters p;
    p.input = path();
    p.axis = ABS_GAS;
    p.released = 0.0;
    p.pressed = 100.0;
    p.dead_zone = 0.0;
    return p;
  }
  void put(int value) {
    if (writer_ < 0) {
      writer_ = open(path().c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      ASSERT_GE(writer_, 0) << "nobody reads the pipe";
    }
    const auto bytes = test::report_of(ABS_GAS, value);
    ASSERT_EQ(write(writer_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void hang_up() {
    if (writer_ >= 0) {
      close(writer_);
      writer_ = -1;
    }
  }
  static void wait_for(Pedal& pedal, double depth) {
    test::wait_until([&] { return pedal.depth() == depth; });
  }
  static std::vector<Pedal::Change> change_of(Pedal& pedal) {
    std::vector<Pedal::Change> changes;
    test::wait_until([&] {
      changes = pedal.take_changes();
      return !changes.empty();
    });
    return changes;
  }

  test::TemporaryFolder folder_;
  int writer_{-1};
};

TEST_F(PedalPipeTest, TheNewestDepthIsThereWithoutWaiting) {
  Pedal pedal(parameters());
  EXPECT_EQ(pedal.depth(), 0.0) << "up until something is heard of it";
  put(25);
  wait_for(pedal, 0.25);
  for (int value = 0; value <= 100; ++value) {
    put(value);
  }
  wait_for(pedal, 1.0);
  const test::AllocationGuard guard;
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i) {
    sum += pedal.depth();
  }
  EXPECT_EQ(guard.count(), 0);
  EXPECT_EQ(sum, 1000.0);
  EXPECT_TRUE(pedal.take_changes().empty());
}

TEST_F(PedalPipeTest, ALostPedalIsUpUntilItIsBackAndSaysSo) {
  Pedal pedal(parameters());
  put(80);
  wait_for(pedal, 0.8);
  hang_up();
  wait_for(pedal, 0.0);  // nobody holds a pedal that is not there
  const auto lost = change_of(pedal);
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_FALSE(lost[0].back);
  EXPECT_EQ(lost[0].why, "the writer of the pipe has closed it");
  const auto back = change_of(pedal);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_TRUE(back[0].back);
  put(60);
  wait_for(pedal, 0.6);
}

TEST_F(PedalPipeTest, WhatIsNoPedalIsRefusedInASentence) {
  const auto refusal = [](PedalParameters p) {
    return test::message_of([&] { const Pedal pedal(p); });
  };
  PedalParameters p = parameters();
  p.pressed.reset();
  EXPECT_THAT(refusal(p), HasSubstr("does not say how far its axis goes; state pedal.pressed"));
  p.input = folder_ / "nothing";
  EXPECT_THAT(refusal(p), HasSubstr("nothing: No such file or directory; connect it, check "
                                    "pedal.input"));
  p.input = "/dev/null";
  EXPECT_THAT(refusal(p), HasSubstr("/dev/null: is neither an input device nor a named pipe"));
  if (geteuid() != 0) {
    ASSERT_EQ(chmod(path().c_str(), 0), 0);
    EXPECT_THAT(refusal(parameters()), HasSubstr("Permission denied"));
  }
}

/// A device with one axis that the kernel makes, and its file.
class KernelDevice {
 public:
  static constexpr int kLowest = -20, kHighest = 380;
  bool make() {
    file_ = open("/dev/uinput", O_WRONLY | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) {
      return false;
    }
    uinput_setup setup{};
    setup.id.bustype = BUS_USB;
    std::snprintf(setup.name, sizeof(setup.name), "haptrial test pedal");
    uinput_abs_setup axis{};
    axis.code = ABS_BRAKE;
    axis.absinfo.minimum = kLowest;
    axis.absinfo.maximum = kHighest;
    char name[64]{};
    if (ioctl(file_, UI_SET_EVBIT, EV_ABS) < 0 || ioctl(file_, UI_SET_ABSBIT, ABS_BRAKE) < 0 ||
        ioctl(file_, UI_ABS_SETUP, &axis) < 0 || ioctl(file_, UI_DEV_SETUP, &setup) < 0 ||
        ioctl(file_, UI_DEV_CREATE) < 0 || ioctl(file_, UI_GET_SYSNAME(sizeof(name)), name) < 0) {
      return false;
    }
    for (const auto& entry :
         std::filesystem::directory_iterator("/sys/devices/virtual/input/" + std::string(name))) {
      if (entry.path().filename().string().starts_with("event")) {
        path_ = "/dev/input/" + entry.path().filename().string();
      }
    }
    for (int tries = 0; tries < 100 && access(path_.c_str(), R_OK) != 0; ++tries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));  // udev makes the file
    }
    return access(path_.c_str(), R_OK) == 0;
  }
  ~KernelDevice() { remove(); }
  void put(int value) const {
    const auto bytes = test::report_of(ABS_BRAKE, value);
    ASSERT_EQ(write(file_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void remove() {
    if (file_ >= 0) {
      ioctl(file_, UI_DEV_DESTROY);
      close(file_);
      file_ = -1;
    }
  }
  const std::string& path() const { return path_; }

 private:
  int file_{-1};
  std::string path_;
};

TEST(PedalDeviceTest, ADeviceOfTheKernelStatesItsRangeAndIsMissed) {
  KernelDevice device;
  if (!device.make()) {
    GTEST_SKIP() << "/dev/uinput is absent or closed, so the kernel makes no device to read";
  }
  PedalParameters p;
  p.input = device.path();
  p.axis = ABS_GAS;
  EXPECT_THAT(test::message_of([&] { const Pedal pedal(p); }),
              HasSubstr("has no axis ABS_GAS; it has ABS_BRAKE (-20 to 380, now 0)"));
  p.axis = ABS_BRAKE;
  p.dead_zone = 0.0;
  Pedal pedal(p);
  const auto wait_for = [&pedal](double depth) {
    test::wait_until([&] { return pedal.depth() == depth; });
  };
  wait_for(0.05);  // its value at the opening
  device.put(180);
  wait_for(0.5);
  device.remove();
  wait_for(0.0);
  EXPECT_EQ(pedal.take_changes().size(), 1u);
}

}  // namespace
}  // namespace haptrial::device::pedal_test
