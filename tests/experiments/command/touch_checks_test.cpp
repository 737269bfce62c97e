// Six installations of a Touch, staged in folders: each is told what is wrong and what to do.

#include "experiments/command/start/touch_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using State = MachineCheck::State;

/// A root and a home of their own, with a Touch for which all is well.
class StagedTouch : public testing::Test {
 protected:
  void plug_in(bool hid) {
    const std::string usb = "sys/devices/usb1/1-4";
    write(usb + "/idVendor", "2988\n");
    write(usb + "/idProduct", "0302\n");
    const std::string inner = usb + "/1-4:1.0" + (hid ? "/0003:2988:0302.0001" : "");
    const std::string node = hid ? "sys/class/hidraw/hidraw3" : "sys/class/tty/ttyACM0";
    fs::create_directories(root() / inner);
    fs::create_directories(root() / node);
    fs::create_directory_symlink("../../../../" + inner, root() / node / "device");
    write(hid ? "dev/hidraw3" : "dev/ttyACM0", "");
  }
  void install(const std::string& name) {
    write("usr/lib/libHD.so.3.4.0", "");
    fs::create_symlink("libHD.so.3.4.0", root() / "usr/lib/libHD.so");
    write("usr/lib/libPhantomIOLib42.so", "");
    date_driver(std::chrono::year{2023} / 11 / 15);
    write("usr/share/3DSystems/config/" + name + ".config", "");
  }
  void date_driver(const std::chrono::year_month_day& day) {
    const std::chrono::sys_seconds morning = std::chrono::sys_days{day};
    fs::last_write_time(root() / "usr/lib/libPhantomIOLib42.so",
                        std::chrono::file_clock::from_sys(morning));
  }
  void write(const std::string& file, const std::string& text) {
    fs::create_directories((root() / file).parent_path());
    test::write_text(root() / file, text);
  }
  fs::path root() const { return folder_.path(); }

  TouchSearch search() {
    return {root(), root() / "home", "/usr/share/3DSystems", std::nullopt,
            [this](const fs::path& file) {
              return !closed_.contains("/" + fs::relative(file, root()).string());
            }};
  }
  /// The checks that ask for something to be done.
  static std::vector<std::string> to_do(const TouchSearch& search) {
    std::vector<std::string> sentences;
    for (const MachineCheck& check : check_touch(search)) {
      if (check.state == State::kLimited) {
        sentences.push_back(check.what + ": " + check.found);
      }
    }
    return sentences;
  }

  std::set<std::string> closed_;  // files that the user may not open

 private:
  test::TemporaryFolder folder_;
};

TEST_F(StagedTouch, AllIsWell) {
  plug_in(true);
  install("Default Device");
  std::vector<std::string> found;
  for (const MachineCheck& check : check_touch(search())) {
    EXPECT_EQ(check.state, State::kReady) << check.found;
    found.push_back(check.found);
  }
  EXPECT_THAT(
      found,
      ElementsAre("Touch HID (USB 2988:0302) is connected as /dev/hidraw3, which you may open",
                  "OpenHaptics 3.4.0 is installed", "libPhantomIOLib42.so is a file of 2023-11",
                  "GTDD_HOME is /usr/share/3DSystems",
                  "set up is \"Default Device\"; give it as name in [open_haptics], because on "
                  "some systems OpenHaptics opens no device without one"));
}

TEST_F(StagedTouch, ATouchUsbThatTheUserMayNotOpenNeedsTheGroupDialout) {
  plug_in(false);
  install("Default Device");
  closed_ = {"/dev/ttyACM0"};
  EXPECT_THAT(
      to_do(search()),
      ElementsAre("touch: Touch USB (USB 2988:0302) is connected as /dev/ttyACM0, which you "
                  "may not open; run: sudo adduser $USER dialout, then log out and in again"));
  closed_.clear();
  EXPECT_THAT(to_do(search()), IsEmpty());
}

TEST_F(StagedTouch, ATouchHidWithoutAUdevRuleIsGivenTheRule) {
  plug_in(true);
  install("Default Device");
  closed_ = {"/dev/hidraw3"};
  const std::string rule =
      "KERNEL==\"hidraw*\", ATTRS{idVendor}==\"2988\", MODE=\"0660\", GROUP=\"plugdev\", "
      "TAG+=\"uaccess\"";
  EXPECT_THAT(
      to_do(search()),
      ElementsAre("touch: Touch HID (USB 2988:0302) is connected as /dev/hidraw3, which you "
                  "may not open, and no udev rule names it; write the line " +
                  rule +
                  " into /etc/udev/rules.d/70-touch.rules, run: sudo udevadm control "
                  "--reload, and plug it in again"));
  write("etc/udev/rules.d/70-touch.rules", rule + "\n");
  EXPECT_THAT(
      to_do(search()),
      ElementsAre("touch: Touch HID (USB 2988:0302) is connected as /dev/hidraw3, which you "
                  "may not open although /etc/udev/rules.d/70-touch.rules names it; run: sudo "
                  "udevadm control --reload, plug it in again, and join the group that the "
                  "rule names"));
}

TEST_F(StagedTouch, AConfigurationFolderThatIsLeftOverIsNamed) {
  plug_in(true);
  install("Default Device");
  fs::create_directories(root() / "home/.3dsystems/config");
  EXPECT_THAT(
      to_do(search()),
      ElementsAre("touch folder: ~/.3dsystems/config is left from when a Touch was first "
                  "plugged in, and later starts fail because of it; unplug the Touch, run: mv "
                  "~/.3dsystems/config ~/.3dsystems/config.old, plug it in and run "
                  "Touch_Setup"));
}

TEST_F(StagedTouch, ADeviceWithoutTheDefaultNameNeedsItsName) {
  plug_in(true);
  install("Left");
  TouchSearch wanted = search();
  EXPECT_THAT(
      to_do(wanted),
      ElementsAre("touch name: no device has the default name, so that none opens without its "
                  "name; write name = \"Left\" in [open_haptics]; set up is \"Left\""));
  wanted.definition = "Right";
  EXPECT_THAT(
      to_do(wanted),
      ElementsAre("touch name: [open_haptics] names \"Right\", but set up is \"Left\"; write "
                  "that as name, or run Touch_Setup"));
  wanted.definition = "Left";
  EXPECT_THAT(to_do(wanted), IsEmpty());
  write("usr/share/3DSystems/config/Default PHANToM.config", "");
  wanted.definition = "";
  EXPECT_THAT(
      to_do(wanted),
      ElementsAre("touch name: the definition gives no name, and on some systems OpenHaptics "
                  "opens no device without one; write name = \"Default PHANToM\" in "
                  "[open_haptics]; set up is \"Default PHANToM\", \"Left\""));
}

TEST_F(StagedTouch, APluggedInDeviceWithoutAnySoftwareIsToldAllThatIsMissing) {
  plug_in(true);
  TouchSearch wanted = search();
  wanted.gtdd_home.clear();
  EXPECT_THAT(
      to_do(wanted),
      ElementsAre(
          "touch library: libHD.so is not there; install OpenHaptics for Linux (3.4) from "
          "https://support.3dsystems.com",
          "touch driver: libPhantomIOLib42.so is not there, without which OpenHaptics finds no "
          "device; install the Touch Device Driver (TouchDriver_2023_11_15 or later) from "
          "https://support.3dsystems.com",
          "touch settings: GTDD_HOME is not set; add the line GTDD_HOME=/usr/share/3DSystems "
          "to /etc/environment and log in again",
          "touch name: no device is set up; run Touch_Setup and write the name that you give "
          "there as name in [open_haptics]"));
  wanted.gtdd_home = "/opt/touch";
  EXPECT_THAT(
      to_do(wanted)[2],
      "touch settings: GTDD_HOME is /opt/touch, but /opt/touch/config is not there; run: sudo "
      "mkdir -p /opt/touch/config; sudo chmod a+rwx /opt/touch/config; Touch_Setup");
}

TEST_F(StagedTouch, ADriverFromBeforeTheHidModelIsToldToBeOld) {
  plug_in(true);
  install("Default Device");
  date_driver(std::chrono::year{2022} / 4 / 4);
  EXPECT_THAT(
      to_do(search()),
      ElementsAre("touch driver: libPhantomIOLib42.so is a file of 2022-04, and a Touch HID "
                  "needs a driver of 2023 or later; install the Touch Device Driver "
                  "(TouchDriver_2023_11_15 or later) from https://support.3dsystems.com"));
}

TEST_F(StagedTouch, WithoutATouchLittleIsSaid) {
  EXPECT_THAT(check_touch(search()), IsEmpty()) << "nothing of the vendor's is here";
  install("Default Device");
  const std::vector<MachineCheck> found = check_touch(search());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].state, State::kAbsent);
  EXPECT_EQ(found[0].found, "no Touch is on USB (2988:0302 or 0301:2988); check cable and power");
}

}  // namespace
}  // namespace haptrial::experiments
