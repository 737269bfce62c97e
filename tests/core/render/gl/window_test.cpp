#include "core/render/gl/window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <thread>

#include "core/base/error.h"
#include "core/render/flat/text_screen.h"
#include "core/render/flat/trial_display.h"
#include "tests/core/render/flat/pixels.h"
#include "tests/support/message_of.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial::render {
namespace {

using test::VirtualDisplay;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kWidth = 800;
constexpr int kHeight = 600;

class WindowTest : public testing::Test {
 protected:
  void SetUp() override { display_.emplace(kWidth, kHeight); }
  static WindowOptions small() { return {"small", 320, 240, false, 0, false}; }
  Image on_monitor() const { return {kWidth, kHeight, display_->screenshot()}; }

  std::optional<VirtualDisplay> display_;
};

TEST_F(WindowTest, DrawsAsOffScreen) {
  TrialDisplayStyle style;
  style.width = kWidth;
  style.height = kHeight;
  std::vector<Eigen::Vector3d> path;
  for (int i = 0; i <= 200; ++i) {
    path.push_back({0.0005 * i - 0.05, 0.0, 0.02 * std::sin(0.1 * i)});
  }
  stimulus::Presentation seen;
  seen.tool = path[80];
  seen.show_trajectory = seen.show_target_bar = seen.show_applied_bar = seen.show_saturation = true;
  seen.target_force = 8.0;
  seen.applied_force = 5.0;
  const Image expected = render_presentation(style, path, seen);

  Window window({"trial", kWidth, kHeight, true, 0, true});
  ASSERT_EQ(window.width(), kWidth);
  ASSERT_EQ(window.height(), kHeight);
  TrialDisplay display(window.gl(), style, kWidth, kHeight);
  display.set_trajectory(path);
  display.draw(seen);
  const Image drawn = window.read();
  window.swap();
  // Another driver may round the blend at an edge another way.
  int largest = 0;
  for (std::size_t i = 0; i < drawn.rgb.size(); ++i) {
    largest = std::max(largest, std::abs(int{drawn.rgb[i]} - int{expected.rgb[i]}));
  }
  EXPECT_LE(largest, 2);
  test::wait_until(
      [&] { return on_monitor().rgb == drawn.rgb; });  // the monitor shows what was drawn
  EXPECT_GT(find(drawn, style.target_colour).count, 1000);
}

TEST_F(WindowTest, ShowsTextInAWindowInTheMiddle) {
  Window window(small());
  const Colour paper{1.0, 1.0, 1.0};
  TextScreen text(window.gl(), 320, 240, paper, Colour{}, Colour{});
  text.draw({"Rest", "Let go.", "", 30.0});
  const Image drawn = window.read();
  window.swap();
  EXPECT_GT(find(drawn, Colour{}).count, 300);
  const auto shown = [&] {
    const Image monitor = on_monitor();
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        if (pixel(monitor, x + (kWidth - 320) / 2, y + (kHeight - 240) / 2) != pixel(drawn, x, y)) {
          return false;
        }
      }
    }
    return true;
  };
  test::wait_until(shown);
}

TEST_F(WindowTest, KeysMouseAndCloseButtonArrive) {
  Window window(small());
  EXPECT_FALSE(window.close_asked());
  std::vector<KeyPress> keys;
  const auto polled = [&](const auto& good) {
    test::wait_until([&] {
      window.poll();
      for (const KeyPress& key : window.take_keys()) {
        keys.push_back(key);
      }
      return good();
    });
  };
  for (const unsigned long keysym : {0xff1bul, 0x70ul, 0x20ul, 0xff0dul, 0xffc0ul}) {
    display_->press_key("small", keysym);  // Escape, p, space, Enter, F3
  }
  polled([&] { return keys.size() == 7; });
  EXPECT_THAT(keys, ElementsAre(KeyPress{KeyPress::kEscape}, KeyPress{'P'},
                                KeyPress{KeyPress::kOther, U'p'}, KeyPress{KeyPress::kSpace},
                                KeyPress{KeyPress::kOther, U' '}, KeyPress{KeyPress::kEnter},
                                KeyPress{KeyPress::kOther}));
  display_->move_pointer((kWidth - 320) / 2 + 30, (kHeight - 240) / 2 + 70);
  polled([&] { return window.pointer().position == Eigen::Vector2d(30.0, 70.0); });
  display_->press_button("small", 4);
  display_->press_button("small", 4);
  display_->press_button("small", 5);
  display_->press_button("small", 1);
  polled([&] { return window.pointer().buttons == 1u; });
  EXPECT_EQ(window.pointer().wheel, 1.0);
  display_->ask_to_close("small");
  polled([&] { return window.close_asked(); });
}

// A German layout exchanges Y and Z; a French one moves A, Q and M and types digits with Shift; the
// key of F has another alphabet on a Russian one.
TEST_F(WindowTest, AKeyIsTheCharacterThatTheLayoutGivesIt) {
  constexpr unsigned long kCyrillicA = 0x6c1, kPadOne = 0xffb1, kPadEnter = 0xff8d;
  display_->relabel_keys({{'y', 'z'},
                          {'z', 'y'},
                          {'a', 'q'},
                          {'q', 'a'},
                          {';', 'm'},
                          {'m', ','},
                          {'1', '&'},
                          {'f', kCyrillicA}});
  Window window(small());
  for (const unsigned long keysym : std::initializer_list<unsigned long>{
           'z', 'y', 'a', 'q', 'm', ',', '&', kCyrillicA, kPadOne, kPadEnter}) {
    display_->press_key("small", keysym);
  }
  std::vector<int> keys;
  std::u32string typed;
  test::wait_until([&] {
    window.poll();
    for (const KeyPress& key : window.take_keys()) {
      key.character == 0 ? keys.push_back(key.key) : typed.push_back(key.character);
    }
    return keys.size() == 10;
  });
  EXPECT_THAT(keys,
              ElementsAre('Z', 'Y', 'A', 'Q', 'M', ',', '1', 'F', '1', int{KeyPress::kEnter}));
  EXPECT_EQ(typed, U"zyaqm,&а");
}

TEST_F(WindowTest, AKeyThatIsHeldTypesOnceAndLetsGoOfItselfAlone) {
  constexpr unsigned long kPadFive = 0xffb5;
  Window window(small());
  std::vector<KeyPress> keys;
  const auto poll_until = [&](const std::vector<int>& held) {
    test::wait_until([&] {
      window.poll();
      for (const KeyPress& key : window.take_keys()) {
        keys.push_back(key);
      }
      return window.held_keys() == held;
    });
  };
  for (int i = 0; i < 3; ++i) {
    display_->hold_key("small", '5');  // as a keyboard repeats it
  }
  display_->hold_key("small", kPadFive);
  poll_until({'5', '5'});
  EXPECT_EQ(std::ranges::count(keys, KeyPress{KeyPress::kOther, U'5'}), 1);
  EXPECT_EQ(std::ranges::count(keys, KeyPress{'5'}), 2);
  display_->release_key("small", kPadFive);
  poll_until({'5'});
  display_->release_key("small", '5');
  poll_until({});
}

TEST_F(WindowTest, AClickShorterThanAPictureIsSeen) {
  Window window(small());
  display_->press_button("small", 3);
  display_->release_button("small", 3);
  test::wait_until([&] {
    window.poll();
    return window.pointer().buttons == 2u;
  });
  test::wait_until([&] {
    window.poll();
    return window.pointer().buttons == 0u;
  });
}

TEST_F(WindowTest, OneAtATimeAndAgainAfterwards) {
  {
    const Window first(small());
    EXPECT_THROW(const Window second(small()), RunError);
  }
  const Window again(small());
  EXPECT_EQ(again.width(), 320);
}

TEST_F(WindowTest, AMonitorThatIsNotThereIsNamed) {
  try {
    const Window window({"far", 320, 240, true, 3, true});
    FAIL() << "it was opened";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("screen.monitor is 3; allowed: 0 to 0"));
  }
  EXPECT_EQ(Window(small()).height(), 240) << "the failure left nothing open";
}

TEST_F(WindowTest, AnotherThreadThanTheFirstMayOwnIt) {
  Image image;
  std::thread([&] {
    Window window(small());
    Painter painter(window.gl(), 320, 240);
    painter.begin(Colour{0.0, 1.0, 0.0});
    painter.end();
    image = window.read();
  }).join();
  EXPECT_EQ(find(image, Colour{0.0, 1.0, 0.0}).count, 320 * 240);
}

TEST(WindowWithoutDisplayTest, SaysSoInASentence) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  try {
    const Window window({});
    FAIL() << "it was opened";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no window can be opened"));
    EXPECT_THAT(error.what(), HasSubstr("DISPLAY"));
  }
}

std::string ends_with(Window& window) {
  return test::message_of<RunError>([&] {
    for (;;) {
      window.swap();
      window.poll();
    }
  });
}

TEST_F(WindowTest, ADisplayThatEndsIsAnErrorAndNotTheEndOfTheProgram) {
  Window window(small());
  display_->end();
  EXPECT_THAT(ends_with(window), HasSubstr("the display is gone"));
}

TEST_F(WindowTest, AWindowThatAnotherProgramDestroysIsAnErrorLikewise) {
  Window window(small());
  display_->destroy_window(small().title);
  EXPECT_THAT(ends_with(window), HasSubstr("the display is gone"));
}

}  // namespace
}  // namespace haptrial::render
