#include "experiments/screen/screen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "core/base/error.h"
#include "core/render/flat/trial_display.h"
#include "core/render/gl/image.h"
#include "core/stimulus/stimulus.h"
#include "protocols/force_training/path_drawing.h"
#include "tests/core/render/flat/pixels.h"
#include "tests/experiments/frame_periods.h"
#include "tests/experiments/shipped.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial::experiments {
namespace {

using render::Image;
using stimulus::Presentation;
using test::VirtualDisplay;
using testing::ElementsAre;
using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr int kWidth = 800;
constexpr int kHeight = 600;
const Eigen::Vector3d kNoForce = Eigen::Vector3d::Zero();

const std::vector<Eigen::Vector3d>& path() {
  static const stimulus::Stimulus stimulus = stimulus::make_stimulus({}, {}, 3);
  return stimulus.path.points();
}

Presentation running() {
  Presentation seen;
  seen.tool = path()[path().size() / 3];
  seen.show_trajectory = seen.show_target_bar = seen.show_applied_bar = true;
  seen.target_force = 8.0;
  seen.applied_force = 5.0;
  seen.progress = 0.3;
  seen.instruction = stimulus::Instruction::kMatch;
  return seen;
}

int largest_difference(const Image& a, const Image& b) {
  int largest = a.rgb.size() == b.rgb.size() ? 0 : 255;
  for (std::size_t i = 0; i < a.rgb.size() && i < b.rgb.size(); ++i) {
    largest = std::max(largest, std::abs(int{a.rgb[i]} - int{b.rgb[i]}));
  }
  return largest;
}

class ScreenTest : public testing::Test {
 protected:
  void SetUp() override {
    display_.emplace(kWidth, kHeight);
    options_.title = "participant";
  }
  render::TrialDisplayStyle style() const {
    render::TrialDisplayStyle style;
    style.width = kWidth;
    style.height = kHeight;
    return style;
  }
  Image on_monitor() const { return {kWidth, kHeight, display_->screenshot()}; }

  std::optional<VirtualDisplay> display_;
  protocols::ScreenOptions options_;
};

/// A drawing that takes long to begin, as that of a bone does.
TEST_F(ScreenTest, HasShownADrawingOnlyWhenItsFirstPictureIsOut) {
  Screen screen(options_, style());
  std::atomic<bool> drawn{false};
  class Slow final : public protocols::Drawing {
   public:
    explicit Slow(std::atomic<bool>& drawn) : drawn_(drawn) { std::this_thread::sleep_for(100ms); }
    void draw(const stimulus::Shown&) override {
      std::this_thread::sleep_for(100ms);
      drawn_ = true;
    }

   private:
    std::atomic<bool>& drawn_;
  };
  const std::uint64_t number =
      screen.show([&](const render::Gl&, int, int) { return std::make_unique<Slow>(drawn); });
  while (!screen.has_shown(number)) {
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_TRUE(drawn);
  EXPECT_FALSE(screen.has_shown(number + 1));
}

TEST_F(ScreenTest, ShowsATrialAsTheRendererDrawsItOffScreen) {
  Screen screen(options_, style());
  screen.show(protocols::path_drawing(style(), path()));
  screen.observe(running(), kNoForce, 1e-3);
  const Image expected = render::render_presentation(style(), path(), running());
  test::wait_until([&] { return largest_difference(screen.screenshot(), expected) <= 2; });
  test::wait_until(
      [&] { return largest_difference(on_monitor(), expected) <= 2; });  // on the monitor too
  Presentation moved = running();
  moved.tool = path().back();
  screen.observe(moved, kNoForce, 1e-3);
  const Image later = render::render_presentation(style(), path(), moved);
  test::wait_until([&] { return largest_difference(on_monitor(), later) <= 2; });
  EXPECT_EQ(screen.trouble(), "");
}

/// The copy against the server's own memory: each pixel the mean of those that it stands for.
TEST_F(ScreenTest, IsMirroredInASmallPicture) {
  Screen screen(options_, style());
  ScreenMirror mirror(screen);
  screen.show_text({"A page", "that is read", "", std::nullopt});
  const test::TemporaryFolder folder;
  const auto copy = [&] {
    test::write_text(folder / "mirror.png", mirror.picture());
    return render::read_png(folder / "mirror.png");
  };
  const int times = (kWidth + ScreenMirror::kWidth - 1) / ScreenMirror::kWidth;
  test::wait_until([&] {
    const Image small = copy();
    const Image expected = render::coarser(on_monitor(), times);
    const bool has_letters = *std::ranges::min_element(expected.rgb) < 128;
    return has_letters && largest_difference(small, expected) <= 2;
  });
  EXPECT_LE(copy().width, ScreenMirror::kWidth);
}

TEST_F(ScreenTest, ShowsTextsAndCountsDownByItself) {
  Screen screen(options_, style());
  screen.show_text({"Rest", "Let go of the handle.", "", 30.0});
  const auto shown = [&] { return render::find(on_monitor(), style().target_colour).count; };
  test::wait_until([&] { return shown() > 300; });  // the countdown's colour
  const Image first = on_monitor();
  test::wait_until([&] { return on_monitor().rgb != first.rgb; });  // a second later
  screen.show_text({"Thanks", "", "", std::nullopt});
  test::wait_until([&] { return shown() == 0; });
  EXPECT_GT(render::find(on_monitor(), style().marker_colour).count, 300);
  screen.show(protocols::path_drawing(style(), path()));
  screen.observe(running(), kNoForce, 1e-3);
  test::wait_until([&] { return shown() > 1000; });  // back to the trial
}

TEST_F(ScreenTest, APilotHasAnOrangeFrameAndSaysSo) {
  const Screen screen(options_, style(), {}, {"PILOT T01", true});
  const auto is_orange = [](const Image& picture, int x, int y) {
    const std::uint8_t* p = &picture.rgb[3 * static_cast<std::size_t>(y * kWidth + x)];
    return p[0] > 200 && p[1] > 80 && p[1] < 150 && p[2] < 40;
  };
  test::wait_until([&] { return is_orange(on_monitor(), kWidth / 2, 1); });
  const Image picture = on_monitor();
  EXPECT_TRUE(is_orange(picture, 1, kHeight / 2));
  EXPECT_TRUE(is_orange(picture, kWidth - 2, kHeight / 2));
  EXPECT_TRUE(is_orange(picture, kWidth / 2, kHeight - 2));
  int letters = 0;
  for (int y = 10; y < 40; ++y) {
    for (int x = 10; x < 200; ++x) {
      letters += is_orange(picture, x, y) ? 1 : 0;
    }
  }
  EXPECT_GT(letters, 100);
}

TEST_F(ScreenTest, WordsOverThePictureStandAtItsLowerEdgeAndGo) {
  std::atomic<bool> noted{false};
  ScreenCallbacks callbacks;
  callbacks.words = [&] { return std::string(noted ? "Noted: a mistake" : ""); };
  Screen screen(options_, style(), callbacks);
  screen.show(protocols::path_drawing(style(), path()));
  screen.observe(running(), kNoForce, 1e-3);
  const Image expected = render::render_presentation(style(), path(), running());
  const auto differs = [&](int from, int to) {
    const Image seen = on_monitor();
    int count = 0;
    for (int i = 3 * kWidth * from; i < 3 * kWidth * to; ++i) {
      const auto at = static_cast<std::size_t>(i);
      count += std::abs(int{seen.rgb[at]} - int{expected.rgb[at]}) > 40 ? 1 : 0;
    }
    return count;
  };
  constexpr int kEdge = kHeight - kHeight / 8;
  test::wait_until([&] { return differs(0, kHeight) == 0; });
  noted = true;
  test::wait_until([&] { return differs(kEdge, kHeight) > 300; });
  EXPECT_EQ(differs(0, kEdge), 0);
  noted = false;
  test::wait_until([&] { return differs(0, kHeight) == 0; });
}

TEST_F(ScreenTest, CountsItsFramesFromTheFirstTickOn) {
  Screen screen(options_, style());
  const ScreenSummary pace = screen.summary();
  // Xvfb has no refresh to wait for: the timer's rate, and a sentence.
  EXPECT_FALSE(pace.refresh_locked);
  EXPECT_EQ(pace.rate, Screen::kTimerRate);
  EXPECT_THAT(pace.notice, HasSubstr("a timer draws the screen at 60 Hz"));
  std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(screen.take_frames().empty()) << "no tick yet";
  screen.show(protocols::path_drawing(style(), path()));
  screen.observe(running(), kNoForce, 1e-3);
  std::vector<record::FrameRow> frames;
  test::wait_until([&] {
    std::ranges::copy(screen.take_frames(), std::back_inserter(frames));
    return frames.size() > 60;
  });
  std::int64_t last = 0;
  for (const record::FrameRow& frame : frames) {
    EXPECT_GT(frame.time_ns, last);
    EXPECT_GT(frame.frame_time_ns, 0);
    EXPECT_LT(frame.frame_time_ns, frame.time_ns + 1'000'000'000);
    EXPECT_GE(frame.dropped, 0);
    last = frame.time_ns;
  }
  EXPECT_LT(test::unaccounted_periods(frames, Screen::kTimerRate), 2.0);
  for (const record::FrameRow& frame : screen.take_frames()) {
    EXPECT_GT(frame.time_ns, last) << "taken once";
  }
  const ScreenSummary after = screen.summary();
  EXPECT_GE(after.frames, frames.size());
  EXPECT_GT(after.draw_median_ms, 0.0);
  EXPECT_GE(after.draw_worst_ms, after.draw_median_ms);
  std::printf("%zu pictures, drawn in %.2f ms (median), %.2f ms (worst)\n", frames.size(),
              after.draw_median_ms, after.draw_worst_ms);
}

TEST_F(ScreenTest, ThePhotodiodesSquareIsWhiteDuringTheRunOnly) {
  options_.photodiode = protocols::Photodiode::kRun;
  Screen screen(options_, style());
  const auto corner = [&] { return render::pixel(on_monitor(), 5, kHeight - 6); };
  const Eigen::Vector3d white = Eigen::Vector3d::Constant(255.0);
  screen.show(protocols::path_drawing(style(), path()));
  test::wait_until([&] { return corner() == Eigen::Vector3d::Zero(); });
  screen.observe(running(), kNoForce, 1e-3);
  test::wait_until([&] { return corner() == white; });
  Presentation waiting = running();
  waiting.instruction = stimulus::Instruction::kRest;
  screen.observe(waiting, kNoForce, 1e-3);
  test::wait_until([&] { return corner() == Eigen::Vector3d::Zero(); });
  screen.observe(running(), kNoForce, 1e-3);
  screen.show_text({"Rest", "", "", std::nullopt});
  test::wait_until([&] { return corner() == Eigen::Vector3d::Zero(); });  // no trial
}

TEST_F(ScreenTest, ThePhotodiodesSquareTogglesEveryFrame) {
  options_.photodiode = protocols::Photodiode::kEveryFrame;
  Screen screen(options_, style());
  int white = 0;
  int black = 0;
  test::wait_until([&] {
    const double shade = render::pixel(screen.screenshot(), 5, kHeight - 6).x();
    white += shade == 255.0;
    black += shade == 0.0;
    return white >= 3 && black >= 3;
  });
}

TEST_F(ScreenTest, ThePhotodiodesSquareFlashesWithAnOnset) {
  options_.photodiode = protocols::Photodiode::kOnset;
  options_.photodiode_time = 5.0;  // long enough to be seen on a busy machine
  markers::OnsetLog log;
  Screen screen(options_, style());
  screen.flash_with(&log);
  screen.show(protocols::path_drawing(style(), path()));
  screen.observe(running(), kNoForce, 1e-3);
  const auto corner = [&] { return render::pixel(on_monitor(), 5, kHeight - 6); };
  const Eigen::Vector3d white = Eigen::Vector3d::Constant(255.0);
  test::wait_until([&] { return corner() == Eigen::Vector3d::Zero(); });
  EXPECT_TRUE(screen.take_flashes().empty());
  markers::TickOnsets begun;
  begun.add({});
  log.put(begun);
  test::wait_until([&] { return corner() == white; });
  test::wait_until([&] { return corner() == Eigen::Vector3d::Zero(); });  // its time is over
  const std::vector<Flash> flashes = screen.take_flashes();
  ASSERT_EQ(flashes.size(), 1u);
  EXPECT_EQ(flashes[0].onsets, 1u);
  const auto frames = screen.take_frames();
  ASSERT_LT(flashes[0].frame, static_cast<std::int64_t>(frames.size()));
  EXPECT_EQ(flashes[0].time_ns, frames[static_cast<std::size_t>(flashes[0].frame)].time_ns);
  screen.flash_with(nullptr);
}

TEST_F(ScreenTest, KeysPointerAndCloseButtonReachTheCallbacks) {
  std::mutex mutex;
  std::vector<Request> requests;
  ScreenPointer pointer;
  std::atomic<int> closed{0};
  ScreenCallbacks callbacks;
  callbacks.key = [&](const render::KeyPress& press) {
    const std::lock_guard lock(mutex);
    if (const auto request = request_of(press)) {
      requests.push_back(*request);
    }
  };
  callbacks.pointer = [&](const ScreenPointer& now) {
    const std::lock_guard lock(mutex);
    pointer = now;
  };
  callbacks.closed = [&] { ++closed; };
  Screen screen(options_, style(), callbacks);
  screen.show(protocols::path_drawing(style(), path()));
  screen.observe(running(), kNoForce, 1e-3);
  screen.screenshot();  // the trial's view is there
  display_->press_key("participant", ' ');
  display_->press_key("participant", 'x');  // asks for nothing
  display_->press_key("participant", 0xff1b);
  test::wait_until([&] {
    const std::lock_guard lock(mutex);
    return requests.size() == 2;
  });
  EXPECT_THAT(requests, ElementsAre(Request::kStart, Request::kEmergencyStop));

  // At the end of the path as drawn, the pointer is at the end of the path.
  Presentation at_end = running();
  at_end.tool = path().back();
  at_end.show_target_bar = at_end.show_applied_bar = false;
  const Image image = render::render_presentation(style(), path(), at_end);
  const render::Blob marker = render::find(image, style().marker_colour);
  display_->move_pointer(static_cast<int>(marker.centre.x()), static_cast<int>(marker.centre.y()));
  display_->press_button("participant", 4);
  test::wait_until([&] {
    const std::lock_guard lock(mutex);
    return std::abs(pointer.x - path().back().x()) < 5e-4 &&
           std::abs(pointer.z - path().back().z()) < 5e-4 && pointer.wheel == 1.0;
  });
  display_->ask_to_close("participant");
  test::wait_until([&] { return closed == 1; });
}

TEST_F(ScreenTest, APointerThatRestsIsWhereTheNewTrialShowsIt) {
  std::mutex mutex;
  ScreenPointer pointer;
  ScreenCallbacks callbacks;
  callbacks.pointer = [&](const ScreenPointer& now) {
    const std::lock_guard lock(mutex);
    pointer = now;
  };
  const Presentation at_end = [] {
    Presentation seen = running();
    seen.tool = path().back();
    seen.show_target_bar = seen.show_applied_bar = false;
    return seen;
  }();
  const render::Blob marker =
      render::find(render::render_presentation(style(), path(), at_end), style().marker_colour);
  display_->move_pointer(static_cast<int>(marker.centre.x()), static_cast<int>(marker.centre.y()));
  Screen screen(options_, style(), callbacks);  // with a view of its own, and no trial
  std::this_thread::sleep_for(200ms);
  screen.show(protocols::path_drawing(style(), path()));
  test::wait_until([&] {
    const std::lock_guard lock(mutex);
    return std::abs(pointer.x - path().back().x()) < 5e-4 &&
           std::abs(pointer.z - path().back().z()) < 5e-4;
  });
}

TEST_F(ScreenTest, ObserveDoesNotAllocate) {
  Screen screen(options_, style());
  const Presentation seen = running();
  const test::AllocationGuard guard;
  for (int i = 0; i < 10000; ++i) {
    screen.observe(seen, kNoForce, 1e-3);
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(ScreenTest, AServoThreadAndASessionThreadUseItAtOnce) {
  Screen screen(options_, style());
  screen.show(protocols::path_drawing(style(), path()));
  std::atomic<bool> over{false};
  std::thread servo([&] {
    Presentation seen = running();
    for (std::size_t i = 0; !over; ++i) {
      seen.tool = path()[i % path().size()];
      screen.observe(seen, kNoForce, 1e-3);
      std::this_thread::sleep_for(1ms);
    }
  });
  std::size_t frames = 0;
  for (int i = 0; i < 20 || frames <= 5; ++i) {
    if (i % 2 == 0) {
      screen.show_text({"Page", "", "", 5.0});
    } else {
      screen.show(protocols::path_drawing(style(), path()));
    }
    std::this_thread::sleep_for(30ms);
    frames += screen.take_frames().size();
    EXPECT_EQ(screen.screenshot().width, kWidth);
  }
  over = true;
  servo.join();
  EXPECT_EQ(screen.trouble(), "");
}

TEST_F(ScreenTest, FailuresToOpenAreSentences) {
  options_.monitor = 4;
  try {
    const Screen screen(options_, style());
    FAIL() << "it was opened";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("screen.monitor is 4"));
  }
  options_.monitor = 0;
  render::TrialDisplayStyle large = style();
  large.height = 2000;
  large.bar_height = 580.0;  // fits the style's own size, not the screen's
  try {
    const Screen screen(options_, large);
    FAIL() << "it was opened";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the screen has 800 x 600 pixels"));
  }
}

TEST_F(ScreenTest, AKeyThatIsTappedBetweenTwoPicturesIsHeldForOne) {
  std::mutex mutex;
  std::vector<std::vector<int>> held;
  ScreenCallbacks callbacks;
  callbacks.held = [&](const std::vector<int>& keys) {
    const std::lock_guard lock(mutex);
    held.push_back(keys);
  };
  options_.full_screen = false;
  Screen screen(options_, style(), callbacks);
  constexpr std::size_t kTaps = 5;
  for (std::size_t tap = 1; tap <= kTaps; ++tap) {
    display_->press_key("participant", 't');
    test::wait_until([&] {
      const std::lock_guard lock(mutex);
      return held.size() == 2 * tap;
    });  // down and up
  }
  const std::lock_guard lock(mutex);
  ASSERT_EQ(held.size(), 2 * kTaps);
  for (std::size_t i = 0; i < held.size(); ++i) {
    EXPECT_EQ(held[i], i % 2 == 0 ? std::vector<int>{'T'} : std::vector<int>{});
  }
}

TEST_F(ScreenTest, ADisplayThatEndsIsTroubleAndSaysSoAtOnce) {
  std::atomic<int> closed{0};
  ScreenCallbacks callbacks;
  callbacks.closed = [&] { ++closed; };
  const Screen screen(options_, style(), callbacks);
  display_->end();
  test::wait_until([&] { return closed == 1; });
  EXPECT_THAT(screen.trouble(), HasSubstr("the screen has stopped: the display is gone"));
}

}  // namespace
}  // namespace haptrial::experiments
